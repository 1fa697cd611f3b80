"""Paths where triangles have several longest edges: of the ways, the shortest is taken."""

import numpy as np

from lepp.jit import inner, kernel


@kernel
def choose_edges(triangles, neighbors, ranks):
    """Choose the longest edge across which each path goes on; return sizes, edges and ends.

    A triangle's size is 1 if one of its longest edges is on the boundary; 2 if one is among the
    longest of the neighbour across it, too; else one more than the smallest of those neighbours'.
    These have longer edges, so that the sizes can be found depth first, with a stack in which
    lengths ascend.

    Parameters
    ----------
    triangles, neighbors : (m, 3) int32 ndarray
    ranks : (m,) uint8 ndarray
        Of `lepp.geometry.lengths`.

    Returns
    -------
    sizes : (m,) int32 ndarray
        Empty if a path does not end.
    edges : (m,) uint8 ndarray
        Of several that give the smallest size a terminal one, if there is one; of several of these
        the one with the largest vertex numbers.
    ends : (m,) int32 ndarray
        The terminal edge of each path: 3 t + k for edge k of triangle t, the first at that edge.
    """
    m = len(ranks)
    sizes = np.zeros(m, np.int32)
    edges = np.zeros(m, np.uint8)
    ends = np.empty(m, np.int32)
    stack = np.empty(m + 1, np.int32)
    for first in range(m):
        top = 0
        stack[0] = first
        while top >= 0:
            t = stack[top]
            size, edge, end, waits_for = _best_way(triangles, neighbors, ranks, sizes, ends, t)
            if waits_for < 0:
                sizes[t], edges[t], ends[t] = size, edge, end
                top -= 1
            else:
                top += 1
                if top > m:
                    return sizes[:0], edges, ends
                stack[top] = waits_for
    return sizes, edges, ends


@inner
def _best_way(triangles, neighbors, ranks, sizes, ends, t):
    """Return the smallest size that the longest edges of a triangle give, and by which.

    Returns
    -------
    size, edge, end : int
    waits_for : int
        A neighbour whose size has to be known before; -1 if there is none.
    """
    best, best_edge, best_end = 0, 0, 0
    best_cost = 0
    best_low, best_high = -1, -1
    for k in range(3):
        if not (ranks[t] >> k) & 1:
            continue
        s = neighbors[t, k]
        terminal = True
        if s < 0:
            size, end = 1, 3 * t + k
        else:
            back = 0 if neighbors[s, 0] == t else (1 if neighbors[s, 1] == t else 2)
            if (ranks[s] >> back) & 1:
                size, end = 2, min(3 * t + k, 3 * s + back)
            elif sizes[s] > 0:
                size, end, terminal = sizes[s] + 1, ends[s], False
            else:
                return 0, 0, 0, s
        a, b = triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
        low, high = min(a, b), max(a, b)
        follows = low > best_low or (low == best_low and high > best_high)
        cost = 2 * size - terminal
        if best == 0 or cost < best_cost or (cost == best_cost and follows):
            best, best_edge, best_end, best_cost = size, k, end, cost
            best_low, best_high = low, high
    return best, best_edge, best_end, -1
