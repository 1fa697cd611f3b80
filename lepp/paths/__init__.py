"""Longest-edge propagation paths: successors, sizes, neighbour types, terminal edges, regions."""
