"""Plain incremental triangulation: points inserted in the given order, no edge is ever flipped.

A point inside a triangle splits it in three, a point on an edge splits the triangles beside it in
two, a point outside the hull is joined to every hull vertex that it sees.

Without flips nothing outside a triangle ever changes its inside, so the insertion is built like
quicksort rather than point by point. `lepp.hull` inserts only the points that were outside the
hull, or on it, at their turn; every other point is handed to the hull triangle that holds it.
`_subdivide` then splits each of these by its first point, partitions the others, stably, among the
parts, and goes on depth first: no point location, sequential memory, and neighbouring triangles get
neighbouring numbers. The result is that of one-by-one insertion, triangle for triangle.

Edges carry the adjacency. Edge e has the half-edges 2e and 2e + 1, one for each side, so the twin
of half-edge h is h ^ 1. The half-edge of a triangle (a, b, c) across from a runs from b to c.
"""

import numpy as np

from lepp.hull import empty_hull, orient, parts_of, same, sweep_hull
from lepp.jit import inlined, kernel
from lepp.predicates import ORIENTATION_BOUND, UNDERFLOW

_A_B, _B_C, _C_A = 1, 2, 4


def incremental(points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Triangulate by plain insertion in the given order.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
        Finite, C-contiguous.

    Returns
    -------
    triangles, neighbors : (m, 3) int32 ndarray
        As in `lepp.Triangulation`; m is 0 when all points lie on one line.
    repeated : (k, 2) int32 ndarray
        Points left out and the points that they repeat.
    """
    n = len(points)
    hull = empty_hull(n)
    roots = np.empty((2 * n, 6), np.int32)
    split = np.zeros(4 * n, np.int32)
    n_roots, n_edges = sweep_hull(points, hull, roots, split)
    starts, xs, ys, ids = _gather(points, hull.place, hull.also, hull.on_edge, n_roots)
    triangles = np.empty((2 * n, 3), np.int32)
    half_edges = np.empty((2 * n, 3), np.int32)
    owners = np.zeros(8 * n, np.int32)
    n_triangles = _subdivide(
        points, roots, starts, xs, ys, ids, n_edges, split, hull.repeats,
        triangles, half_edges, owners,
    )  # fmt: skip
    neighbors = half_edges[:n_triangles]
    _link(neighbors, owners)
    left_out = np.flatnonzero(hull.repeats >= 0).astype(np.int32)
    return triangles[:n_triangles], neighbors, np.column_stack((left_out, hull.repeats[left_out]))


@kernel
def _gather(points, place, also, on_edge, n_roots):
    """Sort the points that are left by root triangle, in the order of insertion.

    Returns
    -------
    starts : (n_roots + 1,) int64 ndarray
    xs, ys : (k,) float64 ndarray
    ids : (k,) int32 ndarray
        Index of the point; its complement (~) for a point on an edge.
    """
    end = np.zeros(n_roots + 1, np.int64)
    for i in range(len(place)):
        if place[i] >= 0:
            end[place[i]] += 1
            if also[i]:
                end[also[i] - 1] += 1
    starts = np.zeros(n_roots + 1, np.int64)
    for root in range(n_roots):
        starts[root + 1] = starts[root] + end[root]
        end[root] = starts[root]
    xs = np.empty(starts[n_roots])
    ys = np.empty(starts[n_roots])
    ids = np.empty(starts[n_roots], np.int32)
    for i in range(len(place)):
        root = place[i]
        while root >= 0:
            k = end[root]
            end[root] = k + 1
            xs[k] = points[i, 0]
            ys[k] = points[i, 1]
            ids[k] = ~i if on_edge[i] else i
            root = also[i] - 1 if root == place[i] else -1
    return starts, xs, ys, ids


@kernel
def _exact_parts(points, p, a, b, c, i):
    """Tell which of the parts that p makes of (a, b, c) hold point i.

    Returns
    -------
    int
        Sum of _A_B (triangle a, b, p), _B_C, _C_A: two for a point between p and a vertex, none
        for a point that repeats p.
    """
    to_a, to_b, to_c = orient(points, p, a, i), orient(points, p, b, i), orient(points, p, c, i)
    parts = 0
    if to_a >= 0 and to_b <= 0:
        parts |= _A_B
    if to_b >= 0 and to_c <= 0:
        parts |= _B_C
    if to_c >= 0 and to_a <= 0:
        parts |= _C_A
    return parts if to_a != 0 or to_b != 0 or to_c != 0 else 0


@kernel
def _subdivide(
    points, roots, starts, xs, ys, ids, n_edges, split, repeats, triangles, half_edges, owners
):
    """Insert the points of each root triangle, depth first.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
    roots : (r, 6) int32 ndarray
        Vertices and half-edges.
    starts, xs, ys, ids
        The points of each root, from `_gather`.
    n_edges : int
        Number of edges so far.
    split : (4 n,) int32 ndarray
        The first part of each edge that has been split, else 0.
    repeats : (n,) int32 ndarray
        Set for points left out.
    triangles, half_edges : (2 n, 3) int32 ndarray, output
    owners : (8 n,) int32 ndarray, output
        The triangle of each half-edge, plus one; zero at the boundary.

    Returns
    -------
    int
        Number of triangles.
    """
    longest = 0
    for root in range(len(starts) - 1):
        longest = max(longest, starts[root + 1] - starts[root])
    # A stack of lists of points, the last job's on top. A point is on at most two lists at a time.
    x, y, ident = (
        np.empty(2 * longest + 8),
        np.empty(2 * longest + 8),
        np.empty(2 * longest + 8, np.int32),
    )
    x2, y2, ident2 = np.empty(longest + 1), np.empty(longest + 1), np.empty(longest + 1, np.int32)
    x3, y3, ident3 = np.empty(longest + 1), np.empty(longest + 1), np.empty(longest + 1, np.int32)
    # The parts of a triangle: vertices, half-edges, bounds of the list; jobs are those not final.
    part = np.empty((3, 8), np.int32)
    jobs = np.empty((2 * longest + 8, 8), np.int32)
    n_triangles = 0
    for root in range(len(starts) - 1):
        begin = starts[root]
        n_points = starts[root + 1] - begin
        for k in range(n_points):
            x[k], y[k], ident[k] = xs[begin + k], ys[begin + k], ids[begin + k]
        for k in range(6):
            part[0, k] = roots[root, k]
        part[0, 6], part[0, 7] = 0, n_points
        n_parts, n_jobs = 1, 0
        while True:
            for k in range(n_parts):
                low, high = part[k, 6], part[k, 7]
                if low == high:
                    for m in range(3):
                        triangles[n_triangles, m] = part[k, m]
                        half_edges[n_triangles, m] = part[k, 3 + m]
                        owners[part[k, 3 + m]] = n_triangles + 1
                    n_triangles += 1
                else:
                    for m in range(8):
                        jobs[n_jobs, m] = part[k, m]
                    n_jobs += 1
            if n_jobs == 0:
                break
            n_jobs -= 1
            a, b, c = jobs[n_jobs, 0], jobs[n_jobs, 1], jobs[n_jobs, 2]
            across_a, across_b, across_c = jobs[n_jobs, 3], jobs[n_jobs, 4], jobs[n_jobs, 5]
            low, high = jobs[n_jobs, 6], jobs[n_jobs, 7]
            p = ident[low]
            px, py = x[low], y[low]
            if p < 0:  # p lies on a side, which is to be ab
                p = ~p
                while orient(points, a, b, p) != 0:
                    a, b, c = b, c, a
                    across_a, across_b, across_c = across_b, across_c, across_a
                edge = across_c >> 1
                if split[edge] == 0:  # else the triangle on the other side came first
                    split[edge] = n_edges
                    n_edges += 2
                a_p, p_b = parts_of(across_c, split[edge])
                end1, n2 = low, 0
                for k in range(low + 1, high):
                    xk, yk, i = x[k], y[k], ident[k]
                    q = i if i >= 0 else ~i
                    side = orient(points, p, c, q)
                    if side == 0:
                        if same(points, p, q):
                            repeats[q] = p
                            continue
                        i = ~q
                    if side >= 0:
                        x[end1], y[end1], ident[end1] = xk, yk, i
                        end1 += 1
                    if side <= 0:
                        x2[n2], y2[n2], ident2[n2] = xk, yk, i
                        n2 += 1
                for k in range(n2):
                    x[end1 + k], y[end1 + k], ident[end1 + k] = x2[k], y2[k], ident2[k]
                p_c = 2 * n_edges
                n_edges += 1
                _set(part, 0, a, p, c, p_c, across_b, a_p, low, end1)
                _set(part, 1, p, b, c, across_a, p_c + 1, p_b, end1, end1 + n2)
                n_parts = 2
                continue
            ax, ay = points[a, 0] - px, points[a, 1] - py
            bx, by = points[b, 0] - px, points[b, 1] - py
            cx, cy = points[c, 0] - px, points[c, 1] - py
            # No point of the triangle is farther from p: this bounds the error of every determinant.
            width = max(abs(ax), abs(bx), abs(cx))
            height = max(abs(ay), abs(by), abs(cy))
            bound = 2.0 * ORIENTATION_BOUND * (width * height) + UNDERFLOW
            end1, n2, n3 = low, 0, 0
            for k in range(low + 1, high):
                xk, yk, i = x[k], y[k], ident[k]
                dx, dy = xk - px, yk - py
                to_a = ax * dy - ay * dx
                to_b = bx * dy - by * dx
                to_c = cx * dy - cy * dx
                in1 = (to_a > 0.0) & (to_b < 0.0)
                in2 = (to_b > 0.0) & (to_c < 0.0)
                in3 = (to_c > 0.0) & (to_a < 0.0)
                if not min(abs(to_a), abs(to_b), abs(to_c)) > bound:
                    q = i if i >= 0 else ~i
                    found = _exact_parts(points, p, a, b, c, q)
                    in1, in2, in3 = (found & _A_B) != 0, (found & _B_C) != 0, (found & _C_A) != 0
                    if found == 0:
                        repeats[q] = p
                    elif found & (found - 1):
                        i = ~q
                # Each point is written to all three lists and one of them grows: no branch to
                # mispredict.
                x[end1], y[end1], ident[end1] = xk, yk, i
                x2[n2], y2[n2], ident2[n2] = xk, yk, i
                x3[n3], y3[n3], ident3[n3] = xk, yk, i
                end1 += in1
                n2 += in2
                n3 += in3
            end2 = end1 + n2
            for k in range(n2):
                x[end1 + k], y[end1 + k], ident[end1 + k] = x2[k], y2[k], ident2[k]
            for k in range(n3):
                x[end2 + k], y[end2 + k], ident[end2 + k] = x3[k], y3[k], ident3[k]
            p_a, p_b, p_c = 2 * n_edges, 2 * n_edges + 2, 2 * n_edges + 4
            n_edges += 3
            _set(part, 0, a, b, p, p_b + 1, p_a, across_c, low, end1)
            _set(part, 1, p, b, c, across_a, p_c + 1, p_b, end1, end2)
            _set(part, 2, a, p, c, p_c, across_b, p_a + 1, end2, end2 + n3)
            n_parts = 3
    return n_triangles


@inlined
def _set(part, k, a, b, c, across_a, across_b, across_c, low, high):
    """Write down a part of a triangle."""
    part[k, 0], part[k, 1], part[k, 2] = a, b, c
    part[k, 3], part[k, 4], part[k, 5] = across_a, across_b, across_c
    part[k, 6], part[k, 7] = low, high


@kernel
def _link(half_edges, owners):
    """Replace each half-edge by the triangle on its other side, -1 at the boundary."""
    for t in range(len(half_edges)):
        for k in range(3):
            half_edges[t, k] = owners[half_edges[t, k] ^ 1] - 1
