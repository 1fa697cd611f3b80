"""Edges as they are numbered in plain insertion, and the adjacency that they carry.

Edge e has the half-edges 2e and 2e + 1, one for each side, so the twin of half-edge h is h ^ 1. The
half-edge of a triangle (a, b, c) across from a runs from b to c. No edge is ever removed; one that
is split into two keeps its number for those who ask for its parts.
"""

from lepp.jit import inlined, kernel


@inlined
def parts_of(half_edge, part):
    """Return the two parts of a half-edge, in its direction, of an edge split into part, part + 1.

    Edge `part` is the half where half-edge 2e of the edge begins.
    """
    if half_edge & 1:
        return 2 * part + 3, 2 * part + 1
    return 2 * part, 2 * part + 2


@kernel
def link(half_edges, owners):
    """Replace each half-edge by the triangle on its other side, -1 at the boundary.

    Parameters
    ----------
    half_edges : (m, 3) int32 ndarray
        Overwritten.
    owners : (h,) int32 ndarray
        The triangle of each half-edge, plus one; zero at the boundary.
    """
    for t in range(len(half_edges)):
        for k in range(3):
            half_edges[t, k] = owners[half_edges[t, k] ^ 1] - 1
