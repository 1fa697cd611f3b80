"""Delaunay triangulation by insertion along a Hilbert curve, each point into a cavity."""
