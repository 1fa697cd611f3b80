"""What is said of one mesh, on the terminal and on a page."""
