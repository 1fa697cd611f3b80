"""Delaunay triangulation: points inserted along a Hilbert curve, each into a cavity made for it.

The triangles whose circle holds a new point (those *in conflict* with it) form a polygon about it,
the cavity, which is then triangulated anew by joining the point to its corners. The points come in
rounds: every 16**k-th along the curve, then every 16**(k - 1)-th, ..., then all; so each round
refines the mesh of the last evenly, and a point is near the one before it.

The mesh is one array of rows, a row a triangle, of 8 unsigned 32-bit lanes:

- lane k, for k = 0, 1, 2: vertex k, counter-clockwise; points are numbered along the curve;
- lane 4 + k: the twin of half-edge k, which is across from vertex k;
- lanes 3 and 7: not used.

Half-edge k of the triangle in row t has the number 8 t + k, so that ``rows[h]`` is the vertex
across from half-edge h, and ``rows[h + 4]`` its twin. One more vertex, at infinity, makes a
triangle with each edge of the hull. Its coordinates are nan, so that every test of such an outer
triangle fails the floating filter and takes the rare branch, where it is sorted out.
"""

import numpy as np

from lepp.edges import is_safe, rank
from lepp.hilbert import hilbert_order
from lepp.jit import kernel
from lepp.predicates import (
    IN_CIRCLE_BOUND,
    UNDERFLOW,
    orientation,
    uncertain_in_circle,
)

_U0, _U1, _U2, _U3, _U4, _U5, _U6, _U8 = (np.uint64(k) for k in (0, 1, 2, 3, 4, 5, 6, 8))
_ROW = ~np.uint64(7)  # takes a half-edge to half-edge 0 of its triangle
_ROUND_SHIFT = 4  # the points of a round are every 2**4-th of the next
_FIRST_CAPACITY = 64


def delaunay(
    points: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray | None]:
    """Return the Delaunay triangulation.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
        Finite, C-contiguous.

    Returns
    -------
    triangles, neighbors : (m, 3) int32 ndarray
        As in `lepp.Triangulation`; m is 0 when all points lie on one line. Of four or more points
        on an empty circle, the diagonals depend on the points alone.
    repeated : (k, 2) int32 ndarray
        Points left out and the points that they repeat.
    ranks : (m,) uint8 ndarray or None
        As from `lepp.edges.edge_ranks`: here the coordinates are at hand. None where lengths are so
        extreme that it must find them.
    """
    n = len(points)
    order = hilbert_order(points)
    coordinates = _gather(points, order)
    first, second, third = _first_triangle(coordinates, n)
    if third == n:
        none = np.empty((0, 3), np.int32)
        return none, none, np.empty((0, 2), np.int32), None
    rows = np.empty(16 * n + 16, np.uint32)
    _write_first_triangle(rows, first, second, third, n)
    repeats = np.full(n, -1, np.int32)
    n_rows = _insert_all(coordinates, rows, n, order, repeats)
    rows = rows[: 8 * n_rows]
    m = _drop_outer(rows, n)
    triangles, neighbors, ranks, safe = _arrays(rows, m, coordinates, order)
    left_out = np.flatnonzero(repeats >= 0)
    repeated = np.column_stack((order[left_out], order[repeats[left_out]])).astype(np.int32)
    repeated = repeated[np.argsort(repeated[:, 0])]
    return triangles, neighbors, repeated, ranks if safe else None


@kernel
def _gather(points, order):
    """Return the coordinates in the given order, x and y in turn, then those of infinity (nan)."""
    n = len(order)
    coordinates = np.empty(2 * n + 2)
    for k in range(n):
        i = np.uint64(order[k])
        coordinates[2 * k], coordinates[2 * k + 1] = points[i, 0], points[i, 1]
    coordinates[2 * n] = coordinates[2 * n + 1] = np.nan
    return coordinates


@kernel
def _first_triangle(xy, n):
    """Return three points that turn left; n for the third where all are on one line."""
    second = 1
    while second < n and xy[2 * second] == xy[0] and xy[2 * second + 1] == xy[1]:
        second += 1
    for third in range(second + 1, n):
        turn = orientation(
            xy[0], xy[1], xy[2 * second], xy[2 * second + 1], xy[2 * third], xy[2 * third + 1]
        )
        if turn > 0:
            return 0, second, third
        if turn < 0:
            return second, 0, third
    return 0, 0, n


@kernel
def _write_first_triangle(rows, first, second, third, infinity):
    """Write a triangle into row 0, and the three outside it into the next."""
    corners = (first, second, third)
    for k in range(3):
        after, before = (k + 1) % 3, (k + 2) % 3
        outer = 8 * (1 + k)
        rows[k], rows[4 + k] = corners[k], outer
        rows[outer], rows[outer + 1], rows[outer + 2] = infinity, corners[before], corners[after]
        rows[outer + 4] = k
        rows[outer + 5] = 8 * (1 + before) + 2
        rows[outer + 6] = 8 * (1 + after) + 1


@kernel
def _next(h):
    """Return the half-edge after h, counter-clockwise, in its triangle."""
    return h - _U2 if h & _U3 == _U2 else h + _U1


@kernel
def _previous(h):
    """Return the half-edge before h in its triangle."""
    return h + _U2 if h & _U3 == _U0 else h - _U1


@kernel
def _sees(ax, ay, bx, by, x, y):
    """Tell whether a point is in conflict with the outer triangle of a hull edge.

    It is if it lies to the left of the edge from a to b (which has the hull on its right), or on
    the open edge itself.
    """
    side = orientation(ax, ay, bx, by, x, y)
    if side != 0:
        return side > 0
    if ax != bx:
        return min(ax, bx) < x < max(ax, bx)
    return min(ay, by) < y < max(ay, by)


@kernel
def _in_conflict(ax, ay, bx, by, cx, cy, x, y):
    """Tell, exactly, whether a point is in conflict with a triangle; infinity is nan."""
    if ax != ax:
        return _sees(bx, by, cx, cy, x, y)
    if bx != bx:
        return _sees(cx, cy, ax, ay, x, y)
    if cx != cx:
        return _sees(ax, ay, bx, by, x, y)
    return uncertain_in_circle(ax, ay, bx, by, cx, cy, x, y) > 0


@kernel
def _insert(xy, rows, n_rows, infinity, points, start, order, repeats, space):
    """Insert points one after the other.

    For each: *walk* to a triangle in conflict with it; *dig* the cavity, depth first and
    counter-clockwise about the point, changing nothing (the triangles in conflict make a tree, as
    no vertex is inside the cavity: none is met twice); *fill* the cavity with the triangles that
    join the point to its sides. The three are one function, with plain arrays as its local
    variables, because to pass arrays on for each point would count their references, which doubles
    the time.

    Parameters
    ----------
    xy : (2 n + 2,) float64 ndarray
    rows : (16 n + 16,) uint32 ndarray
        The mesh; updated.
    n_rows : uint64
    infinity : uint64
        The vertex at infinity.
    points : (first, stop, step, coarse)
        The points first, first + step, ... below stop, without those that have none of the bits
        of `coarse`.
    start : uint64
        Half-edge 0 of the triangle from which to walk to the first; its vertex 0 must be finite.
    order : (n,) uint32 ndarray
        Where points coincide, the original number of the one kept becomes the lowest.
    repeats : (n,) int32 ndarray, output
        For a point left out, the one that it repeats.
    space : (cavity, sides, corners, offsets, edges, ends)
        Room to work in, from `_room`.

    Returns
    -------
    p : int
        `stop`, or more, when all points are in; else the first that is not, for lack of room.
    n_rows, start : uint64
    """
    # Of each triangle of the cavity, half-edge 0. Of each of its sides, counter-clockwise: the
    # half-edge outside, the vertex where it begins, and that vertex relative to the point. Of each
    # edge still to be crossed: the half-edge inside, the vertex where it ends; that vertex relative
    # to the point, its squared distance, and the cross product of the edge's two ends.
    cavity, sides, corners, offsets, edges, ends = space
    full = np.uint64(len(cavity)) - _U3
    p, stop, step, coarse = points
    while p < stop:
        next_p = p + step
        if next_p & coarse == 0:
            next_p += step
        i, j = _U2 * np.uint64(p), _U2 * np.uint64(min(next_p, stop - 1))
        x, y = xy[i], xy[i + _U1]
        next_x, next_y = xy[j] - x, xy[j + _U1] - y

        # Walk. Of an outer triangle, begin with the edge on the hull.
        h = start
        if np.uint64(rows[h + _U1]) == infinity:
            h += _U1
        elif np.uint64(rows[h + _U2]) == infinity:
            h += _U2
        apex = np.uint64(rows[h])
        a, b = _U2 * np.uint64(rows[_next(h)]), _U2 * np.uint64(rows[_previous(h)])
        side = orientation(xy[a], xy[a + _U1], xy[b], xy[b + _U1], x, y)
        if side < 0 or (side == 0 and apex == infinity):
            h = np.uint64(rows[h + _U4])
            apex = np.uint64(rows[h])
        while apex != infinity:  # the point is to the left of half-edge h, or on it
            after, before = _next(h), _previous(h)
            a, b = _U2 * np.uint64(rows[before]), _U2 * apex
            if orientation(xy[a], xy[a + _U1], xy[b], xy[b + _U1], x, y) < 0:
                h = np.uint64(rows[after + _U4])
            else:
                a = _U2 * np.uint64(rows[after])
                if orientation(xy[b], xy[b + _U1], xy[a], xy[a + _U1], x, y) >= 0:
                    break
                h = np.uint64(rows[before + _U4])
            apex = np.uint64(rows[h])

        # Dig, from the triangle (u, v, w).
        here = h & _ROW
        u, v, w = np.uint64(rows[here]), np.uint64(rows[here + _U1]), np.uint64(rows[here + _U2])
        ux, uy = xy[_U2 * u] - x, xy[_U2 * u + _U1] - y
        vx, vy = xy[_U2 * v] - x, xy[_U2 * v + _U1] - y
        wx, wy = xy[_U2 * w] - x, xy[_U2 * w + _U1] - y
        u_square, v_square, w_square = ux * ux + uy * uy, vx * vx + vy * vy, wx * wx + wy * wy
        if (u_square == 0.0) | (v_square == 0.0) | (w_square == 0.0):  # as far as floats tell
            same = u if ux == 0.0 and uy == 0.0 else infinity
            same = v if vx == 0.0 and vy == 0.0 else same
            same = w if wx == 0.0 and wy == 0.0 else same
            if same != infinity:
                if same != np.uint64(p):
                    repeats[p] = same
                    if order[p] < order[same]:
                        order[p], order[same] = order[same], order[p]
                p = next_p
                continue
        cavity[0] = here
        edges[0], edges[1] = here + _U1, u
        ends[0], ends[1], ends[2], ends[3] = ux, uy, u_square, wx * uy - wy * ux
        edges[2], edges[3] = here, w
        ends[4], ends[5], ends[6], ends[7] = wx, wy, w_square, vx * wy - vy * wx
        n_edges, n_sides, n_cavity = _U2, _U0, _U1
        h = here + _U2
        uv = ux * vy - uy * vx
        while n_cavity < full:
            # Across half-edge h, from u to v, is the triangle (w, v, u).
            h = np.uint64(rows[h + _U4])
            w = np.uint64(rows[h])
            wx, wy = xy[_U2 * w] - x, xy[_U2 * w + _U1] - y
            w_square = wx * wx + wy * wy
            uw = ux * wy - uy * wx
            wv = wx * vy - wy * vx
            determinant = v_square * uw + u_square * wv - w_square * uv
            size = u_square + v_square + w_square
            conflict = determinant > 0.0
            if not abs(determinant) > IN_CIRCLE_BOUND * (size * size) + UNDERFLOW:
                conflict = _in_conflict(
                    xy[_U2 * w], xy[_U2 * w + _U1], xy[_U2 * v], xy[_U2 * v + _U1],
                    xy[_U2 * u], xy[_U2 * u + _U1], x, y,
                )  # fmt: skip
            if conflict:
                cavity[n_cavity] = h & _ROW
                n_cavity += _U1
                edges[_U2 * n_edges], edges[_U2 * n_edges + _U1] = _previous(h), v
                k = _U4 * n_edges
                ends[k], ends[k + _U1], ends[k + _U2], ends[k + _U3] = vx, vy, v_square, wv
                n_edges += _U1
                h = _next(h)
                v, vx, vy, v_square, uv = w, wx, wy, w_square, uw
            else:
                sides[n_sides], corners[n_sides] = h, u
                offsets[_U2 * n_sides], offsets[_U2 * n_sides + _U1] = ux, uy
                n_sides += _U1
                if n_edges == _U0:
                    break
                n_edges -= _U1
                u, ux, uy, u_square = v, vx, vy, v_square
                h, v = np.uint64(edges[_U2 * n_edges]), np.uint64(edges[_U2 * n_edges + _U1])
                k = _U4 * n_edges
                vx, vy, v_square, uv = ends[k], ends[k + _U1], ends[k + _U2], ends[k + _U3]
        if n_cavity >= full:
            return p, n_rows, start

        # Fill, and start the next walk from the triangle in whose sector its point lies; from any
        # where rounding hides it.
        cavity[n_cavity], cavity[n_cavity + _U1] = _U8 * n_rows, _U8 * n_rows + _U8
        n_rows += _U2
        before, here = np.uint64(cavity[n_sides - _U1]), np.uint64(cavity[0])
        cavity[n_sides], corners[n_sides] = here, corners[0]
        offsets[_U2 * n_sides], offsets[_U2 * n_sides + _U1] = offsets[0], offsets[1]
        u = np.uint64(corners[0])
        turn = offsets[0] * next_y - offsets[1] * next_x
        start = here
        for i in range(n_sides):
            after, h = np.uint64(cavity[i + _U1]), np.uint64(sides[i])
            v = np.uint64(corners[i + _U1])
            next_turn = offsets[_U2 * i + _U2] * next_y - offsets[_U2 * i + _U3] * next_x
            rows[here], rows[here + _U1], rows[here + _U2] = p, u, v
            rows[here + _U4], rows[here + _U5], rows[here + _U6] = h, after + _U2, before + _U1
            rows[h + _U4] = here
            start = here if (turn >= 0.0) & (next_turn < 0.0) else start
            u, turn, before, here = v, next_turn, here, after
        p = next_p
    return p, n_rows, start


@kernel
def _room(n_cavity):
    """Return arrays for `_insert` to dig a cavity of some 16 triangles less than `n_cavity` in."""
    return (
        np.empty(n_cavity, np.uint32),
        np.empty(n_cavity, np.uint32),
        np.empty(n_cavity, np.uint32),
        np.empty(2 * n_cavity),
        np.empty(2 * n_cavity, np.uint32),
        np.empty(4 * n_cavity),
    )


@kernel
def _insert_all(xy, rows, n, order, repeats):
    """Insert all points into the first triangle, in rounds; return the number of rows."""
    infinity, n_rows, start = np.uint64(n), np.uint64(4), np.uint64(0)
    capacity = _FIRST_CAPACITY
    space = _room(capacity)
    shift = 0
    while n >> shift > 1 << _ROUND_SHIFT:
        shift += _ROUND_SHIFT
    p, coarse = 0, -1
    while shift >= 0:
        step = 1 << shift
        while p < n:
            p, n_rows, start = _insert(
                xy, rows, n_rows, infinity, (p, n, step, coarse), start, order, repeats, space
            )
            if p < n:
                capacity *= 2
                space = _room(capacity)
        coarse = step - 1
        shift -= _ROUND_SHIFT
        p = step >> _ROUND_SHIFT
    return np.int64(n_rows)


@kernel
def _drop_outer(rows, infinity):
    """Move the triangles with three finite vertices to the front; return their number.

    What was the twin of a half-edge of an outer triangle becomes a number beyond all of them.
    """
    n_rows = len(rows) // 8
    outer = np.empty(n_rows, np.bool_)
    n_finite = 0
    for t in range(n_rows):
        outer[t] = (
            (rows[8 * t] == infinity)
            | (rows[8 * t + 1] == infinity)
            | (rows[8 * t + 2] == infinity)
        )
        n_finite += not outer[t]
    beyond = 8 * n_rows
    last = n_rows
    for t in range(n_finite):
        if not outer[t]:
            continue
        for h in range(8 * t, 8 * t + 3):
            if rows[h] == infinity:
                rows[rows[h + 4] + 4] = beyond
        last -= 1
        while outer[last]:
            last -= 1
        for k in range(3):
            rows[8 * t + k] = rows[8 * last + k]
            twin = rows[8 * last + 4 + k]
            rows[8 * t + 4 + k] = twin
            if twin < beyond:
                rows[twin + 4] = 8 * t + k
    return n_finite


@kernel
def _arrays(rows, m, xy, order):
    """Return triangles (in the original numbers), neighbours, ranks; and if these are safe."""
    triangles, neighbors = np.empty((m, 3), np.int32), np.empty((m, 3), np.int32)
    ranks = np.empty(m, np.uint8)
    safe = True
    for t in range(m):
        u, v, w = np.uint64(rows[8 * t]), np.uint64(rows[8 * t + 1]), np.uint64(rows[8 * t + 2])
        a, b, c = np.int32(order[u]), np.int32(order[v]), np.int32(order[w])
        triangles[t, 0], triangles[t, 1], triangles[t, 2] = a, b, c
        for k in range(3):
            neighbor = np.int32(rows[8 * t + 4 + k] >> 3)
            neighbors[t, k] = neighbor if neighbor < m else -1
        ux, uy, vx, vy = xy[_U2 * u], xy[_U2 * u + _U1], xy[_U2 * v], xy[_U2 * v + _U1]
        wx, wy = xy[_U2 * w], xy[_U2 * w + _U1]
        across_a = (vx - wx) * (vx - wx) + (vy - wy) * (vy - wy)
        across_b = (wx - ux) * (wx - ux) + (wy - uy) * (wy - uy)
        across_c = (ux - vx) * (ux - vx) + (uy - vy) * (uy - vy)
        safe &= is_safe(across_a, across_b, across_c)
        ranks[t] = rank(a, b, c, across_a, across_b, across_c)
    return triangles, neighbors, ranks, safe
