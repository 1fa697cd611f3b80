"""Insertion of a point into a Delaunay mesh: the cavity that it makes, and what fills it.

The mesh is that of `lepp.mesh.half_edges`, with the points numbered along the curve. The vertex at
infinity has the coordinates nan, so that every test of an outer triangle fails the floating filter
and takes the rare branch, where it is sorted out.
"""

import numpy as np

from lepp.geometry.predicates import IN_CIRCLE_BOUND, UNDERFLOW, orientation, uncertain_in_circle
from lepp.jit import inner, kernel
from lepp.mesh.half_edges import next_of, previous_of

_U0, _U1, _U2, _U3, _U4, _U5, _U6, _U8 = (np.uint64(k) for k in (0, 1, 2, 3, 4, 5, 6, 8))
_ROW = ~np.uint64(7)  # takes a half-edge to half-edge 0 of its triangle


@inner
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


@inner
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
def insert(xy, rows, n_rows, infinity, points, start, order, repeats, space):
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
        Room to work in, from `room`.

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
        a, b = _U2 * np.uint64(rows[next_of(h)]), _U2 * np.uint64(rows[previous_of(h)])
        turn = orientation(xy[a], xy[a + _U1], xy[b], xy[b + _U1], x, y)
        if turn < 0 or (turn == 0 and apex == infinity):
            h = np.uint64(rows[h + _U4])
            apex = np.uint64(rows[h])
        while apex != infinity:  # the point is to the left of half-edge h, or on it
            after, before = next_of(h), previous_of(h)
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
                edges[_U2 * n_edges], edges[_U2 * n_edges + _U1] = previous_of(h), v
                k = _U4 * n_edges
                ends[k], ends[k + _U1], ends[k + _U2], ends[k + _U3] = vx, vy, v_square, wv
                n_edges += _U1
                h = next_of(h)
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
        last_turn = offsets[0] * next_y - offsets[1] * next_x
        start = here
        for side in range(n_sides):
            after, h = np.uint64(cavity[side + _U1]), np.uint64(sides[side])
            v = np.uint64(corners[side + _U1])
            next_turn = offsets[_U2 * side + _U2] * next_y - offsets[_U2 * side + _U3] * next_x
            rows[here], rows[here + _U1], rows[here + _U2] = p, u, v
            rows[here + _U4], rows[here + _U5], rows[here + _U6] = h, after + _U2, before + _U1
            rows[h + _U4] = here
            start = here if (last_turn >= 0.0) & (next_turn < 0.0) else start
            u, last_turn, before, here = v, next_turn, here, after
        p = next_p
    return p, n_rows, start


@kernel
def room(n_cavity):
    """Return arrays for `_insert` to dig a cavity of some 16 triangles less than `n_cavity` in."""
    return (
        np.empty(n_cavity, np.uint32),
        np.empty(n_cavity, np.uint32),
        np.empty(n_cavity, np.uint32),
        np.empty(2 * n_cavity),
        np.empty(2 * n_cavity, np.uint32),
        np.empty(4 * n_cavity),
    )
