"""Running a design: its tasks, where they are computed, how they are kept going."""
