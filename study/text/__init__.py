"""Numbers, formulas and lists as a reader sees them."""
