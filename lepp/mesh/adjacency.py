"""Neighbours of triangles that are given without them."""

import numpy as np

from lepp.jit import inner, kernel

NON_MANIFOLD, FOLDED, TWINNED = 1, 2, 4
"""Flags of a triangle: it shares an edge with two or more others; it runs along an edge in the same
direction as the other triangle there; the same triangle is its neighbour across all three edges."""


@kernel
def link_triangles(triangles, n_points, neighbors):
    """Find the neighbour of each triangle across each edge.

    The half-edges are sorted by their larger, then by their smaller vertex (two counting sorts, so
    in linear time); those of one edge then stand together.

    Parameters
    ----------
    triangles : (m, 3) int32 ndarray
    n_points : int
    neighbors : (m, 3) int32 ndarray, output

    Returns
    -------
    (m,) uint8 ndarray
        For each triangle the flags that hold; where none does, all neighbours are right.
    """
    m = len(triangles)
    low, high = np.empty(3 * m, np.int32), np.empty(3 * m, np.int32)
    for t in range(m):
        for k in range(3):
            a, b = triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
            low[3 * t + k], high[3 * t + k] = min(a, b), max(a, b)
    order = _counting_sort(np.arange(3 * m), high, n_points)
    order = _counting_sort(order, low, n_points)
    flags = np.zeros(m, np.uint8)
    first = 0
    while first < 3 * m:
        h = order[first]
        last = first + 1
        while last < 3 * m and low[order[last]] == low[h] and high[order[last]] == high[h]:
            last += 1
        if last == first + 1:
            neighbors[h // 3, h % 3] = -1
        elif last == first + 2:
            g = order[first + 1]
            neighbors[h // 3, h % 3] = g // 3
            neighbors[g // 3, g % 3] = h // 3
            if triangles[h // 3, (h % 3 + 1) % 3] == triangles[g // 3, (g % 3 + 1) % 3]:
                flags[h // 3] |= FOLDED
                flags[g // 3] |= FOLDED
        else:
            for i in range(first, last):
                neighbors[order[i] // 3, order[i] % 3] = -1
                flags[order[i] // 3] |= NON_MANIFOLD
        first = last
    for t in range(m):
        one, two, three = neighbors[t, 0], neighbors[t, 1], neighbors[t, 2]
        if one >= 0 and one == two and two == three:
            flags[t] |= TWINNED
    return flags


@inner
def _counting_sort(order, keys, n_keys):
    """Return `order` sorted, stably, by `keys[order]`."""
    end = np.zeros(n_keys + 1, np.int64)
    for key in keys:
        end[key + 1] += 1
    for key in range(n_keys):
        end[key + 1] += end[key]
    result = np.empty_like(order)
    for i in order:
        result[end[keys[i]]] = i
        end[keys[i]] += 1
    return result
