"""Meshes from files: reading, what their paths say, writing that back."""
