"""Paths where every triangle has one longest edge: all are followed at once."""

import numpy as np

from lepp.jit import kernel

# Rounds over all unfinished paths before the rest, if any are longer, are walked one by one.
_ROUNDS = 40


def single_edges(ranks: np.ndarray) -> np.ndarray:
    """Return the longest edge of each triangle, where it has one.

    Parameters
    ----------
    ranks : (m,) uint8 ndarray
        Of `lepp.geometry.lengths`, with one longest edge each.

    Returns
    -------
    (m,) uint8 ndarray
        0, 1 or 2: the edge across from that vertex.
    """
    return (ranks & np.uint8(7)) >> np.uint8(1)  # 1, 2, 4 -> 0, 1, 2


@kernel
def step_over(neighbors, edges):
    """Return the neighbour of each triangle across one of its edges.

    Parameters
    ----------
    neighbors : (m, 3) int32 ndarray
    edges : (m,) uint8 ndarray
        0, 1 or 2 each.

    Returns
    -------
    (m,) int32 ndarray
        -1 where the edge is on the boundary.
    """
    successors = np.empty(len(edges), np.int32)
    for t in range(len(edges)):
        successors[t] = neighbors[t, edges[t]]
    return successors


@kernel
def follow(successors):
    """Follow all paths.

    Paths are short, and all are followed at once, a step a round, without a branch to mispredict.
    What is left after some rounds is walked, each path to the first triangle whose size is known
    and then again to write the sizes down: linear for a path of any length.

    Parameters
    ----------
    successors : (m,) int32 ndarray
        Two triangles that share the longest edge of both succeed each other.

    Returns
    -------
    sizes : (m,) int32 ndarray
        The LEPP sizes; none if a path does not end.
    ends : (m,) int32 ndarray
        The last triangle of each path; of a terminal pair the one with the smaller index.
    """
    # What is known of a path is one number, its size before its end: so one place is looked up.
    m = len(successors)
    known = np.zeros(m, np.int64)
    step = np.int64(1) << 32
    pending = np.empty(m + 1, np.int32)
    n_pending = 0
    for t in range(m):
        s = successors[t]
        on = max(s, 0)
        following = known[on]
        path = following + step if following > 0 else 0
        path = 2 * step + min(s, t) if successors[on] == t else path
        path = step + t if s < 0 else path
        known[t] = path
        pending[n_pending] = t
        n_pending += path == 0
    for _ in range(_ROUNDS):
        n_before, n_pending = n_pending, 0
        for k in range(n_before):
            t = pending[k]
            following = known[successors[t]]
            path = following + step if following > 0 else 0
            known[t] = path
            pending[n_pending] = t
            n_pending += path == 0
    sizes, ends = np.empty(m, np.int32), np.empty(m, np.int32)
    for k in range(n_pending):
        steps = 0
        last = pending[k]
        while known[last] == 0:
            last = successors[last]
            steps += 1
            if steps > m:
                return sizes[:0], ends
        path = known[last] + steps * step
        t = pending[k]
        while known[t] == 0:
            known[t] = path
            path -= step
            t = successors[t]
    for t in range(m):
        sizes[t], ends[t] = known[t] >> 32, known[t] & (step - 1)
    return sizes, ends
