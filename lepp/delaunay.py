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

from lepp.hilbert import hilbert_order
from lepp.jit import inlined, kernel
from lepp.predicates import (
    IN_CIRCLE_BOUND,
    UNDERFLOW,
    orientation,
    uncertain_in_circle,
)

_U0, _U1, _U2, _U3, _U4, _U5, _U6, _U8 = (np.uint64(k) for k in (0, 1, 2, 3, 4, 5, 6, 8))
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
    """
    n = len(points)
    order = hilbert_order(points)
    coordinates = _gather(points, order)
    first, second, third = _first_triangle(coordinates, n)
    if third == n:
        none = np.empty((0, 3), np.int32)
        return none, none, np.empty((0, 2), np.int32), None
    rows = np.empty(8 * (2 * n + 2), np.uint32)
    _write_first_triangle(rows, first, second, third, n)
    repeats = np.full(n, -1, np.int32)
    n_rows = _insert_all(coordinates, rows, n, order, repeats)
    triangles, neighbors = _finite_triangles(rows[: 8 * n_rows], n, order)
    left_out = np.flatnonzero(repeats >= 0)
    repeated = np.column_stack((order[left_out], order[repeats[left_out]])).astype(np.int32)
    return triangles, neighbors, repeated[np.argsort(repeated[:, 0])], None


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


@inlined
def _locate(xy, rows, infinity, start, x, y):
    """Walk from a triangle to one in conflict with a point, or with the point as its vertex.

    Parameters
    ----------
    start : uint64
        Half-edge 0 of the triangle from which to walk; its vertex 0 must be finite.

    Returns
    -------
    uint64
        A half-edge of the triangle that holds the point, or of an outer one that the point sees.
    """
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
    # The point is to the left of half-edge h, or on it.
    while apex != infinity:
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
    return h


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
def _insert_all(xy, rows, n, order, repeats):
    """Insert all points into the first triangle.

    Parameters
    ----------
    xy : (2 n + 2,) float64 ndarray
    rows : (16 n + 16,) uint32 ndarray
        Of the first triangle; output.
    n : int
    order : (n,) uint32 ndarray
        Where points coincide, the original number of the one kept becomes the lowest.
    repeats : (n,) int32 ndarray, output
        For a point left out, the one that it repeats.

    Returns
    -------
    int
        Number of rows.
    """
    infinity = np.uint64(n)
    capacity = _FIRST_CAPACITY
    # The triangles of the cavity (their half-edges 0), and its sides, counter-clockwise: the
    # half-edge outside, the corner where it begins and that corner's place relative to p.
    cavity = np.empty(capacity, np.uint32)
    outside = np.empty(capacity, np.uint32)
    corner = np.empty(capacity, np.uint32)
    corner_xy = np.empty(2 * capacity)
    # Edges still to be crossed: the half-edge inside, the corner where it ends, that corner's
    # place and squared distance, and the cross product of both ends.
    edge = np.empty(2 * capacity, np.uint32)
    edge_xy = np.empty(4 * capacity)
    n_rows = np.uint64(4)
    start = np.uint64(0)
    shift = 0
    while (n >> shift) > 16:
        shift += _ROUND_SHIFT
    coarse = -1
    while shift >= 0:
        stride = 1 << shift
        p = 0 if coarse < 0 else stride
        while p < n:
            next_p = p + stride
            if coarse > 0 and (next_p & coarse) == 0:
                next_p += stride
            q = np.uint64(min(next_p, n - 1))
            x, y = xy[_U2 * np.uint64(p)], xy[_U2 * np.uint64(p) + _U1]
            next_x, next_y = xy[_U2 * q] - x, xy[_U2 * q + _U1] - y
            h = _locate(xy, rows, infinity, start, x, y)
            # Dig: depth first, counter-clockwise.
            first = h & ~np.uint64(7)
            u, v, w = (
                np.uint64(rows[first]),
                np.uint64(rows[first + _U1]),
                np.uint64(rows[first + _U2]),
            )
            ux, uy = xy[_U2 * u] - x, xy[_U2 * u + _U1] - y
            vx, vy = xy[_U2 * v] - x, xy[_U2 * v + _U1] - y
            wx, wy = xy[_U2 * w] - x, xy[_U2 * w + _U1] - y
            at_u, at_v, at_w = (
                (ux == 0.0) & (uy == 0.0),
                (vx == 0.0) & (vy == 0.0),
                (wx == 0.0) & (wy == 0.0),
            )
            if at_u | at_v | at_w:
                same = u if at_u else (v if at_v else w)
                if same != np.uint64(p):
                    repeats[p] = same
                    if order[p] < order[same]:
                        order[p], order[same] = order[same], order[p]
                p = next_p
                continue
            u_square, v_square, w_square = ux * ux + uy * uy, vx * vx + vy * vy, wx * wx + wy * wy
            uv = ux * vy - uy * vx
            n_edges, n_sides, n_cavity = _U2, _U0, _U1
            cavity[0] = first
            edge[0], edge[1] = first + _U1, u
            edge_xy[0], edge_xy[1], edge_xy[2], edge_xy[3] = ux, uy, u_square, wx * uy - wy * ux
            edge[2], edge[3] = first, w
            edge_xy[4], edge_xy[5], edge_xy[6], edge_xy[7] = wx, wy, w_square, vx * wy - vy * wx
            h = first + _U2
            while True:
                g = np.uint64(rows[h + _U4])
                w = np.uint64(rows[g])
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
                    cavity[n_cavity] = g & ~np.uint64(7)
                    n_cavity += _U1
                    edge[_U2 * n_edges], edge[_U2 * n_edges + _U1] = _previous(g), v
                    place = _U4 * n_edges
                    edge_xy[place], edge_xy[place + _U1] = vx, vy
                    edge_xy[place + _U2], edge_xy[place + _U3] = v_square, wv
                    n_edges += _U1
                    h = _next(g)
                    v, vx, vy, v_square, uv = w, wx, wy, w_square, uw
                    if n_cavity + _U4 > np.uint64(capacity):
                        capacity *= 2
                        cavity, outside, corner = _grown(cavity), _grown(outside), _grown(corner)
                        corner_xy, edge, edge_xy = _grown(corner_xy), _grown(edge), _grown(edge_xy)
                else:
                    outside[n_sides], corner[n_sides] = g, u
                    corner_xy[_U2 * n_sides], corner_xy[_U2 * n_sides + _U1] = ux, uy
                    n_sides += _U1
                    if n_edges == _U0:
                        break
                    n_edges -= _U1
                    u, ux, uy, u_square = v, vx, vy, v_square
                    h, v = np.uint64(edge[_U2 * n_edges]), np.uint64(edge[_U2 * n_edges + _U1])
                    place = _U4 * n_edges
                    vx, vy = edge_xy[place], edge_xy[place + _U1]
                    v_square, uv = edge_xy[place + _U2], edge_xy[place + _U3]
            # Fill
            cavity[n_cavity] = _U8 * n_rows
            cavity[n_cavity + _U1] = _U8 * n_rows + _U8
            n_rows += _U2
            last = n_sides - _U1
            before, here = np.uint64(cavity[last]), np.uint64(cavity[_U0])
            b = np.uint64(corner[_U0])
            turn = corner_xy[_U0] * next_y - corner_xy[_U1] * next_x
            corner[n_sides] = b
            cavity[n_sides] = here
            start = here
            corner_xy[_U2 * n_sides], corner_xy[_U2 * n_sides + _U1] = corner_xy[0], corner_xy[1]
            for k in range(n_sides):
                after = np.uint64(cavity[k + _U1])
                a = b
                b = np.uint64(corner[k + _U1])
                g = np.uint64(outside[k])
                next_turn = corner_xy[_U2 * k + _U2] * next_y - corner_xy[_U2 * k + _U3] * next_x
                rows[here], rows[here + _U1], rows[here + _U2] = p, a, b
                rows[here + _U4], rows[here + _U5], rows[here + _U6] = g, after + _U2, before + _U1
                rows[g + _U4] = here
                start = here if (turn >= 0.0) & (next_turn < 0.0) else start
                turn = next_turn
                before, here = here, after
            p = next_p
        coarse = stride - 1
        shift -= _ROUND_SHIFT
    return np.int64(n_rows)


@kernel
def _grown(array):
    """Return an array of twice the length with the same beginning."""
    result = np.empty(2 * len(array), array.dtype)
    result[: len(array)] = array
    return result


@kernel
def _finite_triangles(rows, infinity, order):
    """Return the triangles with three finite vertices, in the original numbers, and neighbours."""
    n_rows = len(rows) // 8
    outer = np.empty(n_rows, np.bool_)
    m = 0
    for t in range(n_rows):
        outer[t] = (
            (rows[8 * t] == infinity)
            | (rows[8 * t + 1] == infinity)
            | (rows[8 * t + 2] == infinity)
        )
        m += not outer[t]
    # Finite triangles from the end take the rows of outer ones before row m.
    t = n_rows
    for s in range(m):
        if outer[s]:
            for k in range(3):
                if rows[8 * s + k] == infinity:
                    rows[rows[8 * s + 4 + k] + 4] = 8 * n_rows
            t -= 1
            while outer[t]:
                t -= 1
            for k in range(3):
                rows[8 * s + k] = rows[8 * t + k]
                twin = rows[8 * t + 4 + k]
                rows[8 * s + 4 + k] = twin
                if twin < 8 * n_rows:
                    rows[twin + 4] = 8 * s + k
    triangles = np.empty((m, 3), np.int32)
    neighbors = np.empty((m, 3), np.int32)
    for t in range(m):
        for k in range(3):
            triangles[t, k] = order[rows[8 * t + k]]
            neighbor = np.int32(rows[8 * t + 4 + k] >> 3)
            neighbors[t, k] = neighbor if neighbor < m else -1
    return triangles, neighbors
