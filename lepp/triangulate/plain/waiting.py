"""The points that are not in yet while the hull grows, and where each of them is.

Points outside are listed with one hull edge that they see, points on the hull with the edge that
they lie on, so that whoever covers or splits an edge finds those whom it concerns. A list begins in
`seeing` or `lying` and goes on through `following`; -1 ends it.
"""

from typing import NamedTuple

import numpy as np

from lepp.jit import inlined
from lepp.jit.memory import in_one_block

DONE = 0
"""State of a point that is a vertex already, or that repeats one."""
OUTSIDE = 1
"""State of a point outside the hull: it sees hull edge `of`."""
ON_HULL = 2
"""State of a point on hull edge `of`."""
INSIDE = 3
"""State of a point inside root triangle `of`."""
ON_SIDE = 4
"""State of a point on a side of root triangle `of`: and of `beyond`, unless that is -1."""


class Places(NamedTuple):
    """Where each of n points is."""

    of: np.ndarray  # (n,) int32, hull edge or root triangle, according to the state
    beyond: np.ndarray  # (n,) int32, the second root triangle of a point on a side, or -1
    repeats: np.ndarray  # (n,) int32, the point that this one repeats, or -1
    state: np.ndarray  # (n,) int8


class Waiting(NamedTuple):
    """The same, and lists of those that wait at each of e hull edges."""

    seeing: np.ndarray  # (e,) int32, the first of the points outside that are listed with this edge
    lying: np.ndarray  # (e,) int32, the first of the points on it
    following: np.ndarray  # (n,) int32, the next point of the list
    of: np.ndarray
    beyond: np.ndarray
    repeats: np.ndarray
    state: np.ndarray


def nobody_placed(n: int) -> Places:
    """Return room for n points."""
    point = (n, np.int32)
    places = Places(*in_one_block(point, point, point, (n, np.int8)))
    places.state.fill(DONE)
    places.repeats.fill(-1)
    return places


def nobody_waiting(n: int) -> Waiting:
    """Return room for n points, and for the hull edges that they can make."""
    edge = (2 * n + 4, np.int32)
    seeing, lying, following = in_one_block(edge, edge, (n, np.int32))
    return Waiting(seeing, lying, following, *nobody_placed(n))


@inlined
def wait_outside(waiting, i, edge):
    """List a point with a hull edge that it sees."""
    waiting.state[i], waiting.of[i] = OUTSIDE, edge
    waiting.following[i] = waiting.seeing[edge]
    waiting.seeing[edge] = i


@inlined
def wait_on_hull(waiting, i, edge):
    """List a point with the hull edge that it lies on."""
    waiting.state[i], waiting.of[i] = ON_HULL, edge
    waiting.following[i] = waiting.lying[edge]
    waiting.lying[edge] = i


@inlined
def hand_over(waiting, i, state, root, beyond):
    """Leave a point to the root triangle that it is in, or to the one or two beside its side."""
    waiting.state[i], waiting.of[i], waiting.beyond[i] = state, root, beyond


@inlined
def repeat(waiting, i, kept):
    """Leave out a point that repeats another, or is this one."""
    waiting.state[i] = DONE
    if i != kept:
        waiting.repeats[i] = kept
