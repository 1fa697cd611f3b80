"""Plain insertion in the given order: the hull first, then the inside of each root triangle."""
