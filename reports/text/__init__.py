"""Numbers and words as a reader sees them."""
