"""The order of edges: which of a triangle's edges is its longest, and which its shortest.

The edges of a mesh are ordered by (squared length, smaller vertex index, larger vertex index), the
same from both sides; so equal longest edges cannot send a path round for ever.
"""

import numpy as np

from lepp.jit import kernel

# Squares of lengths outside these bounds may have lost bits to over- or underflow.
_SAFE_MIN, _SAFE_MAX = 2.0**-900, 2.0**900


def edge_ranks(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Find the longest and the shortest edge of each triangle.

    Parameters
    ----------
    points : (n, 2) or (n, 3) float64 ndarray
    triangles : (m, 3) int32 ndarray

    Returns
    -------
    (m,) uint8 ndarray
        ``4 * shortest + longest``, where edge k is the one across from vertex k.
    """
    ranks = np.empty(len(triangles), np.uint8)
    rank_edges = _rank_edges_in_space if points.shape[1] == 3 else _rank_edges
    if not rank_edges(points, triangles, ranks):
        # A power of two changes no bit of a length.
        extent = np.ptp(points / 4.0, axis=0).max()
        rank_edges(np.ldexp(points, -int(np.frexp(extent)[1]) - 2), triangles, ranks)
    return ranks


@kernel
def is_safe(across_a, across_b, across_c):
    """Tell whether squared lengths cannot have lost bits to over- or underflow."""
    total = across_a + across_b + across_c
    return (
        (across_a > _SAFE_MIN)
        & (across_b > _SAFE_MIN)
        & (across_c > _SAFE_MIN)
        & (total < _SAFE_MAX)
    )


@kernel
def _is_longer(square_1, a_1, b_1, square_2, a_2, b_2):
    """Tell whether edge 1 follows edge 2 in the order of edges."""
    if square_1 != square_2:
        return square_1 > square_2
    low_1, low_2 = min(a_1, b_1), min(a_2, b_2)
    return low_1 > low_2 or (low_1 == low_2 and max(a_1, b_1) > max(a_2, b_2))


@kernel
def _rank_of_equals(a, b, c, across_a, across_b, across_c):
    """Return the rank of a triangle with equal edges."""
    a_b = _is_longer(across_a, b, c, across_b, c, a)
    b_c = _is_longer(across_b, c, a, across_c, a, b)
    c_a = _is_longer(across_c, a, b, across_a, b, c)
    longest = 0 if a_b and not c_a else (1 if b_c and not a_b else 2)
    shortest = 0 if c_a and not a_b else (1 if a_b and not b_c else 2)
    return 4 * shortest + longest


@kernel
def rank(a, b, c, across_a, across_b, across_c):
    """Return ``4 * shortest + longest`` of a triangle with these vertices and squared lengths."""
    if (across_a == across_b) | (across_b == across_c) | (across_c == across_a):
        return _rank_of_equals(a, b, c, across_a, across_b, across_c)
    a_b = across_a > across_b
    long, short = (across_a, across_b) if a_b else (across_b, across_a)
    longest, shortest = (0, 4) if a_b else (1, 0)
    longest = 2 if across_c > long else longest
    shortest = 8 if across_c < short else shortest
    return shortest + longest


@kernel
def _rank_edges(points, triangles, ranks):
    """Write the ranks; tell whether all squared lengths were safe."""
    safe = True
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ax, ay = points[a, 0], points[a, 1]
        bx, by = points[b, 0], points[b, 1]
        cx, cy = points[c, 0], points[c, 1]
        across_a = (bx - cx) * (bx - cx) + (by - cy) * (by - cy)
        across_b = (cx - ax) * (cx - ax) + (cy - ay) * (cy - ay)
        across_c = (ax - bx) * (ax - bx) + (ay - by) * (ay - by)
        safe &= is_safe(across_a, across_b, across_c)
        ranks[t] = rank(a, b, c, across_a, across_b, across_c)
    return safe


@kernel
def _rank_edges_in_space(points, triangles, ranks):
    """Do the same as `_rank_edges` for points with three coordinates."""
    safe = True
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        across_a = across_b = across_c = 0.0
        for k in range(3):
            across_a += (points[b, k] - points[c, k]) ** 2
            across_b += (points[c, k] - points[a, k]) ** 2
            across_c += (points[a, k] - points[b, k]) ** 2
        safe &= is_safe(across_a, across_b, across_c)
        ranks[t] = rank(a, b, c, across_a, across_b, across_c)
    return safe
