"""Incremental insertion, first part: the points that extend the hull.

Few of the points of a random set are outside the hull of those before them (about log(n)**2 of n).
They are inserted here, in order, and make the root triangles; every other point is handed to the
root that holds it.
"""

from typing import NamedTuple

import numpy as np

from lepp.geometry.predicates import orient, orientation, same, turn_is_certain
from lepp.jit import inner, kernel
from lepp.triangulate.plain.cells import settle_by_cells
from lepp.triangulate.plain.edges import parts_of
from lepp.triangulate.plain.ring import empty_ring, replace_edges, visible_chain
from lepp.triangulate.plain.waiting import (
    INSIDE,
    ON_HULL,
    ON_SIDE,
    OUTSIDE,
    Places,
    hand_over,
    nobody_placed,
    nobody_waiting,
    repeat,
    wait_on_hull,
    wait_outside,
)

#: One point in so many goes ahead, to find roots for the others, if those are this many.
_OPENING = 128
_FEWEST = 1 << 6


class Roots(NamedTuple):
    """The root triangles of n points, and where the others are.

    Attributes
    ----------
    places : Places
        Every point that is no vertex yet, and repeats none of them, is `INSIDE` or `ON_SIDE`.
    rows : (r, 6) int32 ndarray
        Vertices and half-edges; none where all points lie on one line.
    n_edges : int
        Edges so far.
    split : (4 n,) int32 ndarray
        The first of the two edges into which an edge was split; 0 for none.
    """

    places: Places
    rows: np.ndarray
    n_edges: int
    split: np.ndarray


def hull_roots(points: np.ndarray) -> Roots:
    """Insert the points that are outside the hull, or on it, at their turn.

    Most points of a large set are inside a root that the first points make. They are done with
    when that is seen, and extend no hull: only the others are swept.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
        Finite, C-contiguous.
    """
    n = len(points)
    opening = n // _OPENING
    if opening < _FEWEST:
        return _swept(points, n)
    places = nobody_placed(n)
    settle_by_cells(points, opening, _swept(points[:opening], opening).rows, places)
    left = np.flatnonzero(places.state != INSIDE).astype(np.int32)
    roots = _swept(points[left], n)
    of, beyond, repeats, state = roots.places
    places.of[left], places.beyond[left], places.state[left] = of, beyond, state
    places.repeats[left] = np.where(repeats < 0, -1, left[repeats])
    roots.rows[:, :3] = left[roots.rows[:, :3]]
    return roots._replace(places=places)


def _swept(points: np.ndarray, n_all: int) -> Roots:
    """Do the same for points that are all swept, with room to split the edges of `n_all` points.

    A point outside waits at one hull edge that it sees, and moves on when that edge is covered,
    until it falls into one of the triangles made here, the roots.
    """
    n = len(points)
    ring, waiting = empty_ring(n), nobody_waiting(n)
    rows, split = np.empty((2 * n, 6), np.int32), np.zeros(4 * n_all, np.int32)
    n_roots = n_edges = 0
    turn, axis = _first_turn(points)
    if turn < n:
        chain = _chain(points, turn, axis, waiting.repeats)
        n_roots, n_edges = _sweep(points, ring, waiting, rows, split, chain, turn)
    places = Places(waiting.of, waiting.beyond, waiting.repeats, waiting.state)
    return Roots(places, rows[:n_roots], n_edges, split)


@kernel
def _sweep(points, ring, waiting, roots, split, chain, turn):
    """Insert the points from the first turn on.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
    ring : Ring
        From `empty_ring`.
    waiting : Waiting
        From `nobody_waiting`.
    roots : (2 n, 6) int32 ndarray, output
        Vertices and half-edges of the root triangles.
    split : (4 n,) int32 ndarray, output
        As in `Roots`.
    chain : (k,) int64 ndarray
        From `_chain`.
    turn : int
        From `_first_turn`.

    Returns
    -------
    n_roots, n_edges : int
    """
    _start_ring(ring, waiting, chain)
    _list_all(points, waiting, chain, turn)
    n_roots, n_edges = 0, len(chain) - 1
    n_ring = 2 * n_edges
    for q in range(turn, len(points)):
        if waiting.state[q] == OUTSIDE:
            fan = visible_chain(points, ring, waiting.of[q], q)
            corners = ring.start[fan]
            _cover(ring, waiting, roots, fan, q, n_roots, n_edges, n_ring)
            for edge in fan[:-1]:
                _settle(points, waiting, waiting.seeing[edge], q, corners, n_roots, n_ring)
            n_roots += len(fan) - 1
            n_edges += len(fan)
            n_ring += 2
        elif waiting.state[q] == ON_HULL:
            _split_hull_edge(points, ring, waiting, q, split, n_edges, n_ring)
            n_edges += 2
            n_ring += 2
    return n_roots, n_edges


@kernel
def _first_turn(points):
    """Return the first point that is not on the line of those before it, and along what they lie.

    Returns
    -------
    turn : int
        n where there is none.
    axis : int
        0 if the points before have different x, else 1.
    """
    n = len(points)
    other = 1
    while other < n and same(points, 0, other):
        other += 1
    turn = min(other + 1, n)
    while turn < n and orient(points, 0, other, turn) == 0:
        turn += 1
    return turn, 0 if turn < n and points[0, 0] != points[other, 0] else 1


def _chain(points: np.ndarray, turn: int, axis: int, repeats: np.ndarray) -> np.ndarray:
    """Return the points before the first turn: distinct, in the order of their line.

    Returns
    -------
    (k,) int64 ndarray
        The turn is to the left of it.
    """
    order = np.argsort(points[:turn, axis], kind="stable")  # the first of equals leads
    along = points[order, axis]
    leads = np.append(True, along[1:] != along[:-1])
    chain = order[leads]
    repeats[order[~leads]] = chain[np.cumsum(leads) - 1][~leads]
    (ax, ay), (bx, by), (x, y) = points[[chain[0], chain[-1], turn]].tolist()
    return chain if orientation(ax, ay, bx, by, x, y) > 0 else chain[::-1].copy()


@inner
def _start_ring(ring, waiting, chain):
    """Make the hull of the chain, there and back.

    Edges 0 .. k - 1 lead along the chain and stay: the first point off the line makes k roots on
    their left. Edges k .. 2 k - 1 lead back, and will be covered by that point.
    """
    n_side = len(chain) - 1
    for j in range(2 * n_side):
        ring.after[j] = (j + 1) % (2 * n_side)
        ring.before[j] = (j - 1) % (2 * n_side)
        ring.start[j] = chain[j] if j < n_side else chain[2 * n_side - j]
        ring.inner[j] = 2 * j if j < n_side else 2 * (2 * n_side - 1 - j) + 1
        ring.root[j] = n_side - 1 - j if j < n_side else -1
        waiting.seeing[j] = -1
        waiting.lying[j] = -1


@inner
def _list_all(points, waiting, chain, turn):
    """List the points from `turn` on with an edge of the first hull.

    Points that continue the chain beyond its ends are listed with those that see the edges back:
    what they will see then is decided as for any other point.
    """
    n_side = len(chain) - 1
    a, b = chain[0], chain[n_side]
    axis = 0 if points[a, 0] != points[b, 0] else 1
    upwards = 1.0 if points[a, axis] < points[b, axis] else -1.0
    keys = np.empty(n_side + 1)
    for j in range(n_side + 1):
        keys[j] = upwards * points[chain[j], axis]
    for i in range(turn, len(points)):
        side = orient(points, a, b, i)
        if side == 0:
            key = upwards * points[i, axis]
            j, above = -1, n_side + 1  # the last vertex that is not beyond the point
            while above - j > 1:
                middle = (j + above) // 2
                if keys[middle] <= key:
                    j = middle
                else:
                    above = middle
            if j >= 0 and keys[j] == key:
                waiting.repeats[i] = chain[j]
                continue
            if 0 <= j < n_side:
                wait_on_hull(waiting, i, j)
                continue
        wait_outside(waiting, i, 0 if side < 0 else n_side)


@inner
def _cover(ring, waiting, roots, fan, q, n_roots, n_edges, n_ring):
    """Join point q to the edges of `fan` (all but its last) and renew the hull there.

    Points that lie on these edges are from now on between two roots.
    """
    n_fan = len(fan) - 1
    for j in range(n_fan):
        edge = fan[j]
        root = roots[n_roots + j]
        root[0] = q
        root[1] = ring.start[fan[j + 1]]
        root[2] = ring.start[edge]
        root[3] = ring.inner[edge] ^ 1
        root[4] = 2 * (n_edges + j)  # edge n_edges + j runs from the fan's vertex j to q
        root[5] = 2 * (n_edges + j + 1) + 1
        i = waiting.lying[edge]
        while i >= 0:
            hand_over(waiting, i, ON_SIDE, ring.root[edge], n_roots + j)
            i = waiting.following[i]
    incoming, outgoing = n_ring, n_ring + 1
    replace_edges(ring, fan[0], fan[n_fan - 1], incoming, q)
    ring.inner[incoming] = 2 * n_edges
    ring.inner[outgoing] = 2 * (n_edges + n_fan) + 1
    ring.root[incoming] = n_roots
    ring.root[outgoing] = n_roots + n_fan - 1
    for edge in (incoming, outgoing):
        waiting.seeing[edge] = -1
        waiting.lying[edge] = -1


@inner
def _settle(points, waiting, i, q, corners, n_roots, n_ring):
    """Place the points that saw a covered edge: outside still, on the new hull, or in a root.

    Such a point can see no other part of the hull than before and the two new edges; so if it sees
    none of these it is in the cone of the new triangles, and in front of the covered edges.

    Parameters
    ----------
    i : int
        The first of the list.
    corners : (k + 1,) int32 ndarray
        The vertices of the k covered edges: root n_roots + j lies between corners j and j + 1.
    n_ring : int
        The first of the two new edges.
    """
    n_fan = len(corners) - 1
    q_x, q_y = points[q, 0], points[q, 1]
    to_x, to_y = np.empty(n_fan + 1), np.empty(n_fan + 1)
    for j in range(n_fan + 1):
        to_x[j], to_y[j] = points[corners[j], 0] - q_x, points[corners[j], 1] - q_y
    first_x, first_y, last_x, last_y = to_x[0], to_y[0], to_x[n_fan], to_y[n_fan]
    state, of, following = waiting.state, waiting.of, waiting.following
    heads = waiting.seeing[n_ring : n_ring + 2]
    first_head, second_head = heads[0], heads[1]
    while i >= 0:
        current = i
        i = following[i]
        dx, dy = points[current, 0] - q_x, points[current, 1] - q_y
        left, right = first_x * dy, first_y * dx
        sees_first = left > right
        certain = turn_is_certain(left, right)
        left, right = last_x * dy, last_y * dx
        sees_second = left < right
        certain &= turn_is_certain(left, right)
        low, high = 0, n_fan
        while high - low > 1:
            middle = (low + high) // 2
            left, right = to_x[middle] * dy, to_y[middle] * dx
            certain &= turn_is_certain(left, right)
            below = left < right
            low = middle if below else low
            high = high if below else middle
        if not certain:
            heads[0], heads[1] = first_head, second_head
            _settle_exactly(points, waiting, current, q, corners, n_roots, n_ring)
            first_head, second_head = heads[0], heads[1]
            continue
        # Selections in place of branches, which would be mispredicted.
        state[current] = OUTSIDE if sees_first | sees_second else INSIDE
        not_first = n_ring + 1 if sees_second else n_roots + low
        of[current] = n_ring if sees_first else not_first
        following[current] = first_head if sees_first else second_head
        first_head = current if sees_first else first_head
        second_head = current if sees_second and not sees_first else second_head
    heads[0], heads[1] = first_head, second_head


@inner
def _settle_exactly(points, waiting, i, q, corners, n_roots, n_ring):
    """Place a point that saw a covered edge, whichever way it lies."""
    low, high = 0, len(corners) - 1
    side = orient(points, q, corners[low], i)
    other_side = orient(points, q, corners[high], i)
    if side > 0:
        wait_outside(waiting, i, n_ring)
    elif other_side < 0:
        wait_outside(waiting, i, n_ring + 1)
    elif side == 0 and other_side == 0:
        repeat(waiting, i, q)
    elif side == 0:
        wait_on_hull(waiting, i, n_ring)
    elif other_side == 0:
        wait_on_hull(waiting, i, n_ring + 1)
    else:
        while high - low > 1:
            middle = (low + high) // 2
            turn = orient(points, q, corners[middle], i)
            if turn == 0:
                hand_over(waiting, i, ON_SIDE, n_roots + middle - 1, n_roots + middle)
                return
            if turn < 0:
                low = middle
            else:
                high = middle
        hand_over(waiting, i, INSIDE, n_roots + low, -1)


@inner
def _split_hull_edge(points, ring, waiting, q, split, n_edges, n_ring):
    """Make point q, which lies on a hull edge, a vertex of the hull.

    Its root triangle is split later; edges n_edges and n_edges + 1 are the parts of its side.
    """
    edge = waiting.of[q]
    a, b = ring.start[edge], ring.start[ring.after[edge]]
    incoming, outgoing = n_ring, n_ring + 1
    replace_edges(ring, edge, edge, incoming, q)
    split[ring.inner[edge] >> 1] = n_edges
    ring.inner[incoming], ring.inner[outgoing] = parts_of(ring.inner[edge], n_edges)
    for part in (incoming, outgoing):
        ring.root[part] = ring.root[edge]
        waiting.seeing[part] = -1
        waiting.lying[part] = -1
    i = waiting.seeing[edge]
    while i >= 0:  # a point that saw the edge sees both parts
        following = waiting.following[i]
        wait_outside(waiting, i, incoming)
        i = following
    axis = 0 if points[a, 0] != points[b, 0] else 1
    i = waiting.lying[edge]
    while i >= 0:
        following = waiting.following[i]
        if same(points, i, q):
            repeat(waiting, i, q)
        else:
            towards_a = (points[i, axis] < points[q, axis]) == (points[a, axis] < points[b, axis])
            wait_on_hull(waiting, i, incoming if towards_a else outgoing)
        i = following
    hand_over(waiting, q, ON_SIDE, ring.root[edge], -1)
