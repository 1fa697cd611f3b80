"""Longest-edge propagation paths: successors, sizes, terminal edges and their regions.

The edges of a mesh are ordered by (squared length, smaller vertex index, larger vertex index), the
same from both sides; so equal longest edges cannot send a path round for ever.
"""

from dataclasses import dataclass

import numpy as np

from lepp.jit import inlined, kernel
from lepp.triangulation import Triangulation

TYPE_NONE, TYPE_A, TYPE_B, TYPE_C = 0, 1, 2, 3
"""Type of a longest-edge neighbour (Definition 1): none; E is its shortest, middle, longest edge."""

# Squares of lengths outside these bounds may have lost bits to over- or underflow.
_SAFE_MIN, _SAFE_MAX = 2.0**-900, 2.0**900
# Rounds over all unfinished paths before the rest, if any are longer, are walked one by one.
_ROUNDS = 40


@dataclass(frozen=True, eq=False)
class LeppPaths:
    """The longest-edge propagation path of every triangle of a mesh.

    Attributes
    ----------
    sizes : (m,) int32 ndarray
        Triangles on Lepp(t), t and the terminal triangles included.
    successors : (m,) int32 ndarray
        The neighbour across the longest edge; -1 where that is on the boundary.
    neighbor_types : (m,) int8 ndarray
        Of that neighbour: TYPE_A, TYPE_B, TYPE_C; TYPE_NONE at the boundary.
    terminal_edges : (k, 2) int32 ndarray
        Vertices of the edges at which paths end; ordered by their (first) terminal triangle.
    regions : (m,) int32 ndarray
        Which terminal edge the path of each triangle ends at.
    """

    sizes: np.ndarray
    successors: np.ndarray
    neighbor_types: np.ndarray
    terminal_edges: np.ndarray
    regions: np.ndarray


def lepp_sizes(triangulation: Triangulation) -> np.ndarray:
    """Return the number of triangles on the longest-edge propagation path of each triangle.

    Parameters
    ----------
    triangulation : Triangulation

    Returns
    -------
    (m,) int32 ndarray
        1 where the longest edge is on the boundary; in time linear in m, however long the paths.
    """
    _, successors = _longest_edges(triangulation)
    return _sizes(successors)


def lepp_paths(triangulation: Triangulation) -> LeppPaths:
    """Return the longest-edge propagation paths of all triangles.

    Parameters
    ----------
    triangulation : Triangulation

    Returns
    -------
    LeppPaths
    """
    ranks, successors = _longest_edges(triangulation)
    sizes = _sizes(successors)
    types = _neighbor_types(triangulation.neighbors, successors, ranks)
    terminal_edges, regions = _regions(triangulation.triangles, ranks, successors, sizes)
    return LeppPaths(sizes, successors, types, terminal_edges, regions)


def _longest_edges(triangulation: Triangulation) -> tuple[np.ndarray, np.ndarray]:
    """Return the (longest, shortest) edges, as 4 * shortest + longest, and the successors."""
    points, triangles = triangulation.points, triangulation.triangles
    m = len(triangles)
    ranks, successors = np.empty(m, np.uint8), np.empty(m, np.int32)
    space = points.shape[1] == 3
    order = _order_edges_in_space if space else _order_edges
    if order(points, triangles, triangulation.neighbors, ranks, successors):
        # A power of two changes no bit of a length; centred, no difference can overflow.
        extent = np.ptp(points / 4.0, axis=0).max()
        scaled = np.ldexp(points, -int(np.frexp(extent)[1]) - 2)
        order(scaled, triangles, triangulation.neighbors, ranks, successors)
    return ranks, successors


@inlined
def _is_longer(square_1, a_1, b_1, square_2, a_2, b_2):
    """Tell whether edge 1 follows edge 2 in the order of edges."""
    if square_1 != square_2:
        return square_1 > square_2
    low_1, low_2 = min(a_1, b_1), min(a_2, b_2)
    return low_1 > low_2 or (low_1 == low_2 and max(a_1, b_1) > max(a_2, b_2))


@inlined
def _order(t, a, b, c, across_a, across_b, across_c, neighbors, ranks, successors):
    """Write the rank and the successor of a triangle with these squared edge lengths."""
    a_b = across_a > across_b
    long, short = (across_a, across_b) if a_b else (across_b, across_a)
    longest, shortest = (0, 1) if a_b else (1, 0)
    longest = 2 if across_c > long else longest
    shortest = 2 if across_c < short else shortest
    if (across_a == across_b) | (across_b == across_c) | (across_c == across_a):
        a_b = _is_longer(across_a, b, c, across_b, c, a)
        b_c = _is_longer(across_b, c, a, across_c, a, b)
        c_a = _is_longer(across_c, a, b, across_a, b, c)
        longest = 0 if a_b and not c_a else (1 if b_c and not a_b else 2)
        shortest = 0 if c_a and not a_b else (1 if a_b and not b_c else 2)
    ranks[t] = 4 * shortest + longest
    successors[t] = neighbors[t, longest]


@inlined
def _unsafe(across_a, across_b, across_c):
    """Tell whether squared lengths may have lost bits to over- or underflow."""
    total = across_a + across_b + across_c
    return not ((across_a > _SAFE_MIN) & (across_b > _SAFE_MIN) & (across_c > _SAFE_MIN)) or not (
        total < _SAFE_MAX
    )


@kernel
def _order_edges(points, triangles, neighbors, ranks, successors):
    """Write ranks and successors; tell whether any squared length is unsafe."""
    unsafe = False
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ax, ay = points[a, 0], points[a, 1]
        bx, by = points[b, 0], points[b, 1]
        cx, cy = points[c, 0], points[c, 1]
        across_a = (bx - cx) * (bx - cx) + (by - cy) * (by - cy)
        across_b = (cx - ax) * (cx - ax) + (cy - ay) * (cy - ay)
        across_c = (ax - bx) * (ax - bx) + (ay - by) * (ay - by)
        unsafe |= _unsafe(across_a, across_b, across_c)
        _order(t, a, b, c, across_a, across_b, across_c, neighbors, ranks, successors)
    return unsafe


@kernel
def _order_edges_in_space(points, triangles, neighbors, ranks, successors):
    """Do the same as `_order_edges` for points with three coordinates."""
    unsafe = False
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        across_a = across_b = across_c = 0.0
        for k in range(3):
            across_a += (points[b, k] - points[c, k]) ** 2
            across_b += (points[c, k] - points[a, k]) ** 2
            across_c += (points[a, k] - points[b, k]) ** 2
        unsafe |= _unsafe(across_a, across_b, across_c)
        _order(t, a, b, c, across_a, across_b, across_c, neighbors, ranks, successors)
    return unsafe


@kernel
def _sizes(successors):
    """Return the LEPP sizes.

    Paths are short, and all are followed at once, a step a round, without a branch to mispredict.
    What is left after some rounds is walked, each path to the first triangle whose size is known
    and then again to write the sizes down: linear for a path of any length.
    """
    m = len(successors)
    sizes = np.zeros(m, np.int32)
    pending = np.empty(m + 1, np.int32)
    n_pending = 0
    for t in range(m):
        s = successors[t]
        on = max(s, 0)
        known = sizes[on]
        size = known + 1 if known > 0 else 0
        size = 2 if successors[on] == t else size
        size = 1 if s < 0 else size
        sizes[t] = size
        pending[n_pending] = t
        n_pending += size == 0
    for _ in range(_ROUNDS):
        n_before, n_pending = n_pending, 0
        for k in range(n_before):
            t = pending[k]
            known = sizes[successors[t]]
            size = known + 1 if known > 0 else 0
            sizes[t] = size
            pending[n_pending] = t
            n_pending += size == 0
    for k in range(n_pending):
        steps = 0
        t = pending[k]
        while sizes[t] == 0:
            t = successors[t]
            steps += 1
        size = sizes[t] + steps
        t = pending[k]
        while sizes[t] == 0:
            sizes[t] = size
            size -= 1
            t = successors[t]
    return sizes


@kernel
def _neighbor_types(neighbors, successors, ranks):
    """Return the type of each triangle's longest-edge neighbour."""
    types = np.empty(len(successors), np.int8)
    for t in range(len(successors)):
        s = max(successors[t], 0)
        shared = 0 if neighbors[s, 0] == t else (1 if neighbors[s, 1] == t else 2)
        longest, shortest = ranks[s] & 3, ranks[s] >> 2
        kind = TYPE_A if shared == shortest else TYPE_B
        kind = TYPE_C if shared == longest else kind
        types[t] = kind if successors[t] >= 0 else TYPE_NONE
    return types


@kernel
def _regions(triangles, ranks, successors, sizes):
    """Return the terminal edges, and which of them the path of each triangle ends at."""
    m = len(successors)
    edges = np.empty((m, 2), np.int32)
    regions = np.empty(m, np.int32)
    n_edges = 0
    end = np.zeros(sizes.max() + 2, np.int64)
    for t in range(m):
        s = successors[t]
        end[sizes[t] + 1] += 1
        if s < 0 or (successors[s] == t and t < s):
            longest = ranks[t] & 3
            edges[n_edges, 0] = triangles[t, (longest + 1) % 3]
            edges[n_edges, 1] = triangles[t, (longest + 2) % 3]
            regions[t] = n_edges
            if s >= 0:
                regions[s] = n_edges
            n_edges += 1
    for size in range(1, len(end)):
        end[size] += end[size - 1]
    by_size = np.empty(m, np.int32)  # a successor comes before its triangle
    for t in range(m):
        by_size[end[sizes[t]]] = t
        end[sizes[t]] += 1
    for t in by_size:
        s = successors[t]
        if s >= 0 and successors[s] != t:
            regions[t] = regions[s]
    return edges[:n_edges].copy(), regions
