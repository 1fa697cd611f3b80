"""What pages are made of: blocks, plots, data, templates."""
