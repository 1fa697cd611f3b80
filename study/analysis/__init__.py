"""The statistics of a study: from its results to tidy tables."""
