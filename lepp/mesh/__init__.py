"""Meshes of triangles: what they are, how they are checked and taken from other libraries."""
