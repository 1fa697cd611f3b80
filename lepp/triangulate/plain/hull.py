"""Incremental insertion, first part: the points that extend the hull.

Few of the points of a random set are outside the hull of those before them (about log(n)**2 of n).
They are inserted here, in order, and make the root triangles; every other point is handed to the
root that holds it. Edges and half-edges are those of `lepp.triangulate.plain.subdivision`.
"""

from typing import NamedTuple

import numpy as np

from lepp.geometry.predicates import ORIENTATION_BOUND, UNDERFLOW, orientation
from lepp.jit import inlined, kernel
from lepp.jit.memory import in_one_block

_LEFT_OUT = -1
# `place` of a point that sees hull edge e is _SEES - e; of a point in root triangle t it is t.
_SEES = -2
# `on_edge` of a point on hull edge e is _ON_HULL + e; on an inner edge of the roots 1; else 0.
_ON_HULL = 2


class Hull(NamedTuple):
    """The hull as a ring of edges, counter-clockwise, and where the points are that are not in yet.

    Lists of points are linked through `following`; -1 ends a list.
    """

    after: np.ndarray  # (e,) int32, next edge of the ring
    before: np.ndarray  # (e,) int32, previous edge
    start: np.ndarray  # (e,) int32, first vertex
    inner: np.ndarray  # (e,) int32, half-edge on the inside
    seeing: np.ndarray  # (e,) int32, first of the points that are listed as seeing this edge
    lying: np.ndarray  # (e,) int32, first of the points that lie on it
    following: np.ndarray  # (n,) int32
    place: np.ndarray  # (n,) int32, root triangle, _SEES - e, or _LEFT_OUT
    on_edge: np.ndarray  # (n,) int32, _ON_HULL + e; 1 on an inner edge of the roots; else 0
    also: np.ndarray  # (n,) int32, the second root, plus one, of a point between two; else 0
    repeats: np.ndarray  # (n,) int32, the point that this one repeats, or -1


def empty_hull(n: int) -> Hull:
    """Return a hull with room for n points, none of them in yet."""
    ring, point = (2 * n + 4, np.int32), (n, np.int32)
    hull = Hull(
        *in_one_block(ring, ring, ring, ring, ring, ring, point, point, point, point, point)
    )
    hull.place.fill(_LEFT_OUT)
    hull.on_edge.fill(0)
    hull.also.fill(0)
    hull.repeats.fill(-1)
    return hull


@inlined
def orient(points, a, b, c):
    """Return `orientation` of three points given by their indices."""
    return orientation(
        points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
    )


@inlined
def same(points, a, b):
    """Tell whether two points coincide."""
    return points[a, 0] == points[b, 0] and points[a, 1] == points[b, 1]


@kernel
def _first_chain(points, repeats):
    """Return the points before the first turn: distinct, in the order of their line.

    Returns
    -------
    chain : (k,) int64 ndarray
        The turn is to the left of it.
    turn : int
        The first point that is not on the line; n where there is none.
    """
    n = len(points)
    other = 1
    while other < n and same(points, 0, other):
        other += 1
    turn = min(other + 1, n)
    while turn < n and orient(points, 0, other, turn) == 0:
        turn += 1
    if turn == n:
        return np.zeros(1, np.int64), n
    axis = 0 if points[0, 0] != points[other, 0] else 1
    order = np.argsort(points[:turn, axis], kind="mergesort")  # stable: the first of equals leads
    chain = np.empty(turn, np.int64)
    n_chain = 0
    for i in order:
        if n_chain and same(points, chain[n_chain - 1], i):
            repeats[i] = chain[n_chain - 1]
        else:
            chain[n_chain] = i
            n_chain += 1
    chain = chain[:n_chain].copy()
    if orient(points, chain[0], chain[n_chain - 1], turn) < 0:
        chain = chain[::-1].copy()
    return chain, turn


@kernel
def _start_hull(points, hull, chain, turn):
    """Make the hull of the chain, there and back, and list the later points with what they see.

    Edges 0 .. k - 1 lead along the chain and stay; k .. 2 k - 1 lead back and will be covered by
    the first point off the line. Points that continue the chain beyond its ends are listed with
    those, too: what they will see then is decided as for any other point.
    """
    n_side = len(chain) - 1
    for j in range(2 * n_side):
        hull.after[j] = (j + 1) % (2 * n_side)
        hull.before[j] = (j - 1) % (2 * n_side)
        hull.start[j] = chain[j] if j < n_side else chain[2 * n_side - j]
        hull.inner[j] = 2 * j if j < n_side else 2 * (2 * n_side - 1 - j) + 1
        hull.seeing[j] = -1
        hull.lying[j] = -1
    a, b = chain[0], chain[n_side]
    axis = 0 if points[a, 0] != points[b, 0] else 1
    upwards = 1.0 if points[a, axis] < points[b, axis] else -1.0
    keys = np.empty(n_side + 1)
    for j in range(n_side + 1):
        keys[j] = upwards * points[chain[j], axis]
    seeing, lying, following = hull.seeing, hull.lying, hull.following
    place, on_edge = hull.place, hull.on_edge
    for i in range(turn, len(points)):
        side = orient(points, a, b, i)
        if side == 0:
            key = upwards * points[i, axis]
            j = np.searchsorted(keys, key, side="right") - 1
            if j >= 0 and keys[j] == key:
                hull.repeats[i] = chain[j]
                continue
            if 0 <= j < n_side:
                on_edge[i] = _ON_HULL + j
                place[i] = n_side - 1 - j  # the root that the first turn will make there
                following[i] = lying[j]
                lying[j] = i
                continue
        edge = 0 if side < 0 else n_side
        place[i] = _SEES - edge
        following[i] = seeing[edge]
        seeing[edge] = i


@kernel
def sweep_hull(points, hull, roots, split):
    """Insert the points that are outside the hull, or on it, at their turn.

    Each point outside is listed with one hull edge that it sees, and moved on when that edge is
    covered, until it falls into one of the triangles made here, the roots.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
    hull : Hull
        From `empty_hull`; `place`, `also`, `on_edge` and `repeats` are the answer for the points
        that are left.
    roots : (2 n, 6) int32 ndarray, output
        Vertices and half-edges of the root triangles.
    split : (4 n,) int32 ndarray, output
        The first of the two edges into which an edge was split; 0 for none.

    Returns
    -------
    n_roots, n_edges : int
    """
    n_roots = 0
    chain, turn = _first_chain(points, hull.repeats)
    if turn == len(points):
        return 0, 0
    _start_hull(points, hull, chain, turn)
    n_edges = len(chain) - 1
    n_ring = 2 * n_edges
    place, on_edge = hull.place, hull.on_edge
    for q in range(turn, len(points)):
        if place[q] <= _SEES:
            fan = _visible_chain(points, hull, q)
            _cover(hull, roots, fan, q, n_roots, n_edges, n_ring)
            for j in range(len(fan) - 1):
                i = hull.lying[fan[j]]
                while i >= 0:
                    on_edge[i] = 1
                    hull.also[i] = n_roots + j + 1
                    i = hull.following[i]
                _settle(points, hull, hull.seeing[fan[j]], q, fan, n_roots, n_ring)
            n_roots += len(fan) - 1
            n_edges += len(fan)
            n_ring += 2
        elif on_edge[q] >= _ON_HULL:
            _split_hull_edge(points, hull, q, split, n_edges, n_ring)
            n_edges += 2
            n_ring += 2
    return n_roots, n_edges


@kernel
def _visible_chain(points, hull, q):
    """Return the hull edges that point q sees, and the edge that follows them."""
    first = last = _SEES - hull.place[q]
    edge = hull.before[first]
    while orient(points, hull.start[edge], hull.start[first], q) < 0:
        first = edge
        edge = hull.before[edge]
    edge = hull.after[last]
    while orient(points, hull.start[edge], hull.start[hull.after[edge]], q) < 0:
        last = edge
        edge = hull.after[edge]
    n_fan = 2
    edge = first
    while edge != last:
        edge = hull.after[edge]
        n_fan += 1
    fan = np.empty(n_fan, np.int32)
    edge = first
    for j in range(n_fan):
        fan[j] = edge
        edge = hull.after[edge]
    return fan


@kernel
def _cover(hull, roots, fan, q, n_roots, n_edges, n_ring):
    """Join point q to the edges of `fan` (all but its last) and renew the hull there."""
    n_fan = len(fan) - 1
    for j in range(n_fan):
        root = roots[n_roots + j]
        root[0] = q
        root[1] = hull.start[fan[j + 1]]
        root[2] = hull.start[fan[j]]
        root[3] = hull.inner[fan[j]] ^ 1
        root[4] = 2 * (n_edges + j)  # edge n_edges + j runs from the fan's vertex j to q
        root[5] = 2 * (n_edges + j + 1) + 1
    incoming, outgoing = n_ring, n_ring + 1
    hull.start[incoming] = hull.start[fan[0]]
    hull.inner[incoming] = 2 * n_edges
    hull.start[outgoing] = q
    hull.inner[outgoing] = 2 * (n_edges + n_fan) + 1
    _replace_edges(hull, fan[0], fan[n_fan - 1], incoming, outgoing)


@kernel
def _replace_edges(hull, first, last, incoming, outgoing):
    """Put two edges into the ring in the place of those from `first` to `last`."""
    before, after = hull.before[first], hull.after[last]
    hull.after[before] = incoming
    hull.before[incoming] = before
    hull.after[incoming] = outgoing
    hull.before[outgoing] = incoming
    hull.after[outgoing] = after
    hull.before[after] = outgoing
    for edge in (incoming, outgoing):
        hull.seeing[edge] = -1
        hull.lying[edge] = -1


@kernel
def _settle(points, hull, i, q, fan, n_roots, n_ring):
    """Place the points that saw a covered edge: outside still, on the new hull, or in a root.

    Such a point can see no other part of the hull than before and the two new edges; so if it sees
    none of these it is in the cone of the new triangles, and in front of the covered edges.

    Parameters
    ----------
    i : int
        The first of the list.
    """
    following, place = hull.following, hull.place
    n_fan = len(fan) - 1
    vertices = np.empty(n_fan + 1, np.int32)
    for j in range(n_fan + 1):
        vertices[j] = hull.start[fan[j]]
    x, y = points[q, 0], points[q, 1]
    to_x, to_y = np.empty(n_fan + 1), np.empty(n_fan + 1)
    for j in range(n_fan + 1):
        to_x[j], to_y[j] = points[vertices[j], 0] - x, points[vertices[j], 1] - y
    first_x, first_y, last_x, last_y = to_x[0], to_y[0], to_x[n_fan], to_y[n_fan]
    # Heads of the lists of those that see the two new edges.
    head, other_head = hull.seeing[n_ring], hull.seeing[n_ring + 1]
    while i >= 0:
        current = i
        i = following[i]
        dx, dy = points[current, 0] - x, points[current, 1] - y
        left, right = first_x * dy, first_y * dx
        side = left - right
        certain = abs(side) > ORIENTATION_BOUND * (abs(left) + abs(right)) + UNDERFLOW
        left, right = last_x * dy, last_y * dx
        other_side = left - right
        certain &= abs(other_side) > ORIENTATION_BOUND * (abs(left) + abs(right)) + UNDERFLOW
        low, high = 0, n_fan
        while high - low > 1:
            middle = (low + high) // 2
            left, right = to_x[middle] * dy, to_y[middle] * dx
            certain &= abs(left - right) > ORIENTATION_BOUND * (abs(left) + abs(right)) + UNDERFLOW
            below = left < right
            low = middle if below else low
            high = high if below else middle
        if not certain:
            head, other_head = _settle_exactly(
                points, hull, vertices, current, q, n_roots, n_ring, head, other_head
            )
            continue
        sees_first, sees_second = side > 0.0, other_side < 0.0
        at = n_roots + low
        at = _SEES - n_ring - 1 if sees_second else at
        place[current] = _SEES - n_ring if sees_first else at
        following[current] = head if sees_first else other_head
        head = current if sees_first else head
        other_head = current if sees_second and not sees_first else other_head
    hull.seeing[n_ring], hull.seeing[n_ring + 1] = head, other_head


@kernel
def _settle_exactly(points, hull, vertices, i, q, n_roots, n_ring, head, other_head):
    """Place a point that saw a covered edge, whichever way it lies.

    Returns
    -------
    head, other_head : int
        The first points that see the two new edges.
    """
    low, high = 0, len(vertices) - 1
    side = orient(points, q, vertices[low], i)
    other_side = orient(points, q, vertices[high], i)
    if side > 0:
        hull.place[i] = _SEES - n_ring
        hull.following[i] = head
        return i, other_head
    if other_side < 0:
        hull.place[i] = _SEES - (n_ring + 1)
        hull.following[i] = other_head
        return head, i
    if side == 0 and other_side == 0:
        hull.place[i] = _LEFT_OUT
        if i != q:
            hull.repeats[i] = q
    elif side == 0 or other_side == 0:
        edge = n_ring if side == 0 else n_ring + 1
        hull.place[i] = n_roots if side == 0 else n_roots + high - 1
        hull.on_edge[i] = _ON_HULL + edge
        hull.following[i] = hull.lying[edge]
        hull.lying[edge] = i
    else:
        while high - low > 1:
            middle = (low + high) // 2
            turn = orient(points, q, vertices[middle], i)
            if turn < 0:
                low = middle
            else:
                high = middle
            if turn == 0:
                low = middle - 1
                hull.on_edge[i] = 1
                hull.also[i] = n_roots + middle + 1
        hull.place[i] = n_roots + low
    return head, other_head


@kernel
def _split_hull_edge(points, hull, q, split, n_edges, n_ring):
    """Make point q, which lies on a hull edge, a vertex of the hull.

    Its root triangle is split later; edges n_edges and n_edges + 1 are the parts of its side.
    """
    edge = hull.on_edge[q] - _ON_HULL
    hull.on_edge[q] = 1
    split[hull.inner[edge] >> 1] = n_edges
    first, second = parts_of(hull.inner[edge], n_edges)
    a, b = hull.start[edge], hull.start[hull.after[edge]]
    incoming, outgoing = n_ring, n_ring + 1
    hull.start[incoming] = a
    hull.inner[incoming] = first
    hull.start[outgoing] = q
    hull.inner[outgoing] = second
    _replace_edges(hull, edge, edge, incoming, outgoing)
    i = hull.seeing[edge]
    while i >= 0:  # a point that saw the edge sees both parts
        following = hull.following[i]
        hull.place[i] = _SEES - incoming
        hull.following[i] = hull.seeing[incoming]
        hull.seeing[incoming] = i
        i = following
    axis = 0 if points[a, 0] != points[b, 0] else 1
    i = hull.lying[edge]
    while i >= 0:
        following = hull.following[i]
        if same(points, i, q):
            if i != q:
                hull.repeats[i] = q
                hull.place[i] = _LEFT_OUT
                hull.on_edge[i] = 0
        else:
            towards_a = (points[i, axis] < points[q, axis]) == (points[a, axis] < points[b, axis])
            part = incoming if towards_a else outgoing
            hull.on_edge[i] = _ON_HULL + part
            hull.following[i] = hull.lying[part]
            hull.lying[part] = i
        i = following


@kernel
def parts_of(half_edge, n_edges):
    """Return the two parts of a half-edge, in its direction, of an edge split into n_edges, + 1."""
    if half_edge & 1:
        return 2 * n_edges + 3, 2 * n_edges + 1
    return 2 * n_edges, 2 * n_edges + 2
