"""Statistics of groups: tests, intervals, models and their fits. No table is made here."""
