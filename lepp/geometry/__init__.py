"""Exact geometry: signs of determinants, lengths, the order of points along a Hilbert curve."""
