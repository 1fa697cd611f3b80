"""Results in, one HTML file out; and the command line."""
