"""Delaunay triangulation: points inserted along a Hilbert curve, each into a cavity made for it.

The triangles whose circle holds a new point (those *in conflict* with it) form a polygon about it,
the cavity, which is then triangulated anew by joining the point to its corners. The points come in
rounds: every 16**k-th along the curve, then every 16**(k - 1)-th, ..., then all; so each round
refines the mesh of the last evenly, and a point is near the one before it.

`lepp.triangulate.delaunay.cavity` holds the mesh and inserts a point.
"""

from typing import NamedTuple

import numpy as np

from lepp.geometry.hilbert import hilbert_order
from lepp.geometry.lengths import is_certain, rank, squared_length
from lepp.geometry.predicates import orientation
from lepp.jit import inner, kernel
from lepp.jit.memory import in_one_block
from lepp.mesh.half_edges import next_of, write_first_triangle
from lepp.triangulate.delaunay.cavity import insert, room

_U1, _U2, _U3, _U4 = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)
_ROUND_SHIFT = 4  # the points of a round are every 2**4-th of the next
_FIRST_CAPACITY = 64
_MODERATE = 100  # binary exponents that leave room for products of four differences


class Space(NamedTuple):
    """Room for the mesh of n points along the curve, in one block of memory."""

    rows: np.ndarray  # (16 n + 16,) uint32, the mesh of `lepp.mesh.half_edges`
    coordinates: np.ndarray  # (2 n + 2,) float64, x and y in turn
    order: np.ndarray  # (n,) uint32, the original number of each
    repeats: np.ndarray  # (n,) int32, for a point left out the one that it repeats, or -1


def space_for(n: int) -> Space:
    """Return room for n points."""
    return Space(
        *in_one_block(
            (16 * n + 16, np.uint32), (2 * n + 2, np.float64), (n, np.uint32), (n, np.int32)
        )
    )


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
        As in `lepp.Triangulation`; m is 0 when all points lie on one line. Where four or more
        points are on an empty circle, any diagonals may come out, but always the same.
    repeated : (k, 2) int32 ndarray
        Points left out and the points that they repeat.
    ranks : (m,) uint8 ndarray or None
        As from `lepp.geometry.lengths.edge_ranks`: here the coordinates are at hand. None where
        lengths are so near, or so extreme, that only exact arithmetic can find them.
    """
    n = len(points)
    points = _to_moderate_scale(points)
    space = space_for(n)
    hilbert_order(points, space.order, space.rows.view(np.uint64)[: 2 * n])  # not in use yet
    return inserted(points, space)


def inserted(
    points: np.ndarray, space: Space
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray | None]:
    """Return the Delaunay triangulation of points whose order is known.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
        As for `delaunay`, but with exponents that leave room.
    space : Space
        The order, and room.

    Returns
    -------
    triangles, neighbors, repeated, ranks
        As from `delaunay`.
    """
    n = len(points)
    rows, coordinates, order, repeats = space
    _gather(points, order, coordinates)
    first, second, third = _first_triangle(coordinates, n)
    if third == n:
        none = np.empty((0, 3), np.int32)
        return none, none, np.empty((0, 2), np.int32), None
    write_first_triangle(rows, first, second, third, n)
    repeats.fill(-1)
    n_rows = _insert_all(coordinates, rows, n, order, repeats)
    rows = rows[: 8 * n_rows]
    m = _drop_outer(rows, n)
    triangles, neighbors = np.empty((m, 3), np.int32), np.empty((m, 3), np.int32)
    ranks = np.empty(m, np.uint8)
    certain = _write_arrays(rows, coordinates, order, triangles, neighbors, ranks)
    left_out = np.flatnonzero(repeats >= 0)
    repeated = np.column_stack((order[left_out], order[repeats[left_out]])).astype(np.int32)
    repeated = repeated[np.argsort(repeated[:, 0])]
    return triangles, neighbors, repeated, ranks if certain else None


def _to_moderate_scale(points: np.ndarray) -> np.ndarray:
    """Return points near 1 where they are so far from it that products over- or underflow.

    A power of two changes no bit of a coordinate, and so nothing in the triangulation, but only
    exact arithmetic could go on with such numbers. Where a bit would change, points stay.
    """
    exponent = int(np.frexp(max(points.max(), -points.min()))[1])
    if -_MODERATE < exponent < _MODERATE:
        return points
    scaled = np.ldexp(points, -exponent)
    return scaled if np.array_equal(np.ldexp(scaled, exponent), points) else points


@kernel
def _gather(points, order, coordinates):
    """Write the coordinates in the given order, x and y in turn, then those of infinity (nan)."""
    n = len(order)
    for k in range(n):
        i = np.uint64(order[k])
        coordinates[2 * k], coordinates[2 * k + 1] = points[i, 0], points[i, 1]
    coordinates[2 * n] = coordinates[2 * n + 1] = np.nan


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
def _insert_all(xy, rows, n, order, repeats):
    """Insert all points into the first triangle, in rounds; return the number of rows."""
    infinity, n_rows, start = np.uint64(n), np.uint64(4), np.uint64(0)
    capacity = _FIRST_CAPACITY
    space = room(capacity)
    shift = 0
    while n >> shift > 1 << _ROUND_SHIFT:
        shift += _ROUND_SHIFT
    p, coarse = 0, -1
    while shift >= 0:
        step = 1 << shift
        while p < n:
            p, n_rows, start = insert(
                xy, rows, n_rows, infinity, (p, n, step, coarse), start, order, repeats, space
            )
            if p < n:
                capacity *= 2
                space = room(capacity)
        coarse = step - 1
        shift -= _ROUND_SHIFT
        p = step >> _ROUND_SHIFT
    return np.int64(n_rows)


@inner
def _is_outer(rows, t, infinity):
    """Tell whether the triangle in row t has the vertex at infinity."""
    h = 8 * t
    return rows[h] == infinity or rows[h + 1] == infinity or rows[h + 2] == infinity


@kernel
def _drop_outer(rows, infinity):
    """Move the triangles with three finite vertices to the front; return their number.

    What was the twin of a half-edge of an outer triangle becomes a number beyond all of them.
    """
    n_rows = len(rows) // 8
    t = 0
    while not _is_outer(rows, t, infinity):
        t += 1
    h = np.uint64(8 * t)
    while rows[h] != infinity:
        h += _U1
    # Round the hull, along the half-edges across from infinity.
    first, n_finite = h, n_rows
    while True:
        rows[rows[h + _U4] + _U4] = 8 * n_rows
        n_finite -= 1
        h = next_of(np.uint64(rows[next_of(h) + _U4]))
        if h == first:
            break
    last = n_rows
    for _ in range(n_rows - n_finite):
        t, h = int(h >> _U3), next_of(np.uint64(rows[next_of(h) + _U4]))
        if t < n_finite:
            last -= 1
            while _is_outer(rows, last, infinity):
                last -= 1
            for k in range(3):
                rows[8 * t + k] = rows[8 * last + k]
                twin = rows[8 * last + 4 + k]
                rows[8 * t + 4 + k] = twin
                if twin < 8 * n_rows:
                    rows[twin + 4] = 8 * t + k
    return n_finite


@kernel
def _write_arrays(rows, xy, order, triangles, neighbors, ranks):
    """Write triangles, in the original numbers, neighbours and ranks; tell if these are certain."""
    m = len(triangles)
    certain = True
    for t in range(m):
        u, v, w = np.uint64(rows[8 * t]), np.uint64(rows[8 * t + 1]), np.uint64(rows[8 * t + 2])
        a, b, c = np.int32(order[u]), np.int32(order[v]), np.int32(order[w])
        triangles[t, 0], triangles[t, 1], triangles[t, 2] = a, b, c
        for k in range(3):
            neighbor = np.int32(rows[8 * t + 4 + k] >> 3)
            neighbors[t, k] = neighbor if neighbor < m else -1
        ux, uy, vx, vy = xy[_U2 * u], xy[_U2 * u + _U1], xy[_U2 * v], xy[_U2 * v + _U1]
        wx, wy = xy[_U2 * w], xy[_U2 * w + _U1]
        across_a = squared_length(vx - wx, vy - wy)
        across_b = squared_length(wx - ux, wy - uy)
        across_c = squared_length(ux - vx, uy - vy)
        certain &= is_certain(across_a, across_b, across_c)
        ranks[t] = rank(across_a, across_b, across_c)
    return certain
