"""The results directory: what is in it, and how it survives."""
