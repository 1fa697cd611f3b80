"""Longest-edge propagation paths: successors, sizes, terminal edges and their regions."""

from dataclasses import dataclass

import numpy as np

from lepp.edges import edge_ranks
from lepp.jit import kernel
from lepp.triangulation import Triangulation

TYPE_NONE, TYPE_A, TYPE_B, TYPE_C = 0, 1, 2, 3
"""Type of a longest-edge neighbour (Definition 1): none; E its shortest, middle, longest edge."""

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
    successors = _successors(triangulation.neighbors, _ranks(triangulation))
    return _follow(successors, np.empty(0, np.int32))


def lepp_paths(triangulation: Triangulation) -> LeppPaths:
    """Return the longest-edge propagation paths of all triangles.

    Parameters
    ----------
    triangulation : Triangulation

    Returns
    -------
    LeppPaths
    """
    ranks = _ranks(triangulation)
    successors = _successors(triangulation.neighbors, ranks)
    ends = np.empty(len(successors), np.int32)
    sizes = _follow(successors, ends)
    types = _neighbor_types(triangulation.neighbors, successors, ranks)
    terminal_edges, regions = _regions(triangulation.triangles, ranks, ends)
    return LeppPaths(sizes, successors, types, terminal_edges, regions)


def _ranks(triangulation: Triangulation) -> np.ndarray:
    if triangulation.ranks is not None:
        return triangulation.ranks
    return edge_ranks(triangulation.points, triangulation.triangles)


@kernel
def _successors(neighbors, ranks):
    """Return the neighbour across the longest edge of each triangle."""
    successors = np.empty(len(ranks), np.int32)
    for t in range(len(ranks)):
        successors[t] = neighbors[t, ranks[t] & 3]
    return successors


@kernel
def _follow(successors, ends):
    """Follow all paths; return the LEPP sizes.

    Paths are short, and all are followed at once, a step a round, without a branch to mispredict.
    What is left after some rounds is walked, each path to the first triangle whose size is known
    and then again to write the sizes down: linear for a path of any length.

    Parameters
    ----------
    successors : (m,) int32 ndarray
    ends : (m,) or (0,) int32 ndarray, output
        The last triangle of each path; of a terminal pair the one with the smaller index. Not
        wanted if empty.
    """
    m = len(successors)
    wanted = len(ends) > 0
    sizes = np.zeros(m, np.int32)
    pending = np.empty(m + 1, np.int32)
    n_pending = 0
    for t in range(m):
        s = successors[t]
        on = max(s, 0)
        known = sizes[on]
        terminal = successors[on] == t
        size = known + 1 if known > 0 else 0
        size = 2 if terminal else size
        size = 1 if s < 0 else size
        sizes[t] = size
        if wanted:
            end = min(s, t) if terminal else ends[on]
            ends[t] = t if s < 0 else end
        pending[n_pending] = t
        n_pending += size == 0
    for _ in range(_ROUNDS):
        n_before, n_pending = n_pending, 0
        for k in range(n_before):
            t = pending[k]
            s = successors[t]
            known = sizes[s]
            size = known + 1 if known > 0 else 0
            sizes[t] = size
            if wanted:
                ends[t] = ends[s]
            pending[n_pending] = t
            n_pending += size == 0
    for k in range(n_pending):
        steps = 0
        last = pending[k]
        while sizes[last] == 0:
            last = successors[last]
            steps += 1
        size = sizes[last] + steps
        t = pending[k]
        while sizes[t] == 0:
            sizes[t] = size
            if wanted:
                ends[t] = ends[last]
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
def _regions(triangles, ranks, ends):
    """Return the terminal edges, and which of them the path of each triangle ends at."""
    m = len(ends)
    edges = np.empty((m, 2), np.int32)
    number = np.empty(m, np.int32)
    n_edges = 0
    for t in range(m):
        longest = ranks[t] & 3
        number[t] = n_edges
        edges[n_edges, 0] = triangles[t, longest + 1 if longest < 2 else 0]
        edges[n_edges, 1] = triangles[t, longest - 1 if longest > 0 else 2]
        n_edges += ends[t] == t  # else it is overwritten
    regions = np.empty(m, np.int32)
    for t in range(m):
        regions[t] = number[ends[t]]
    return edges[:n_edges].copy(), regions
