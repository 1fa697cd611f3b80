"""The hull as a ring of edges, counter-clockwise."""

from typing import NamedTuple

import numpy as np

from lepp.geometry.predicates import orient
from lepp.jit import inner
from lepp.jit.memory import in_one_block


class Ring(NamedTuple):
    """Hull edges, past and present, in the order in which they were made: e in all.

    Those of the present are linked. One that has been covered or split keeps its row.
    """

    after: np.ndarray  # (e,) int32, next edge of the ring
    before: np.ndarray  # (e,) int32, previous edge
    start: np.ndarray  # (e,) int32, first vertex
    inner: np.ndarray  # (e,) int32, half-edge on the inside
    root: np.ndarray  # (e,) int32, root triangle on the inside


def empty_ring(n: int) -> Ring:
    """Return room for the hull edges that n points can make: two each."""
    edge = (2 * n + 4, np.int32)
    return Ring(*in_one_block(edge, edge, edge, edge, edge))


@inner
def visible_chain(points, ring, first, q):
    """Return the hull edges that point q sees, and the edge that follows them.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
    ring : Ring
    first : int
        Any edge that q sees.
    q : int

    Returns
    -------
    fan : (k,) int32 ndarray
        Hull edges in their order.
    """
    last = first
    edge = ring.before[first]
    while orient(points, ring.start[edge], ring.start[first], q) < 0:
        first = edge
        edge = ring.before[edge]
    edge = ring.after[last]
    while orient(points, ring.start[edge], ring.start[ring.after[edge]], q) < 0:
        last = edge
        edge = ring.after[edge]
    n_fan = 2
    edge = first
    while edge != last:
        edge = ring.after[edge]
        n_fan += 1
    fan = np.empty(n_fan, np.int32)
    edge = first
    for j in range(n_fan):
        fan[j] = edge
        edge = ring.after[edge]
    return fan


@inner
def replace_edges(ring, first, last, incoming, vertex):
    """Put two edges that meet at a vertex into the ring, in place of those from `first` to `last`.

    They are edges `incoming` and `incoming` + 1; their `inner` and `root` are left to the caller.
    """
    outgoing = incoming + 1
    before, after = ring.before[first], ring.after[last]
    ring.start[incoming] = ring.start[first]
    ring.start[outgoing] = vertex
    ring.after[before] = incoming
    ring.before[incoming] = before
    ring.after[incoming] = outgoing
    ring.before[outgoing] = incoming
    ring.after[outgoing] = after
    ring.before[after] = outgoing
