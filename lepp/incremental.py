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
from lepp.jit import kernel
from lepp.predicates import ORIENTATION_BOUND, UNDERFLOW


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
    starts, room, x, y, ident = _gather(points, hull.place, hull.also, hull.on_edge, n_roots)
    triangles = np.empty((2 * n, 3), np.int32)
    half_edges = np.empty((2 * n, 3), np.int32)
    owners = np.zeros(8 * n, np.int32)
    n_triangles = _subdivide(
        points, roots, starts, room, x, y, ident, n_edges, split, hull.repeats,
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
        Bounds of the roots' lists.
    room : int
        More than the points and their repetitions that can be on the lists of one root's parts.
    x, y : (k,) float64 ndarray
    ident : (k,) int32 ndarray
        Index of the point; its complement (~) for a point on an edge. All three have three times
        the room behind the lists.
    """
    end = np.zeros(n_roots + 1, np.int64)
    for i in range(len(place)):
        if place[i] >= 0:
            end[place[i]] += 1
            if also[i]:
                end[also[i] - 1] += 1
    starts = np.zeros(n_roots + 1, np.int64)
    room = 0
    for root in range(n_roots):
        starts[root + 1] = starts[root] + end[root]
        room = max(room, 2 * end[root] + 8)  # on an inner edge a point is on two lists
        end[root] = starts[root]
    size = starts[n_roots] + 3 * room
    x, y, ident = np.empty(size), np.empty(size), np.empty(size, np.int32)
    for i in range(len(place)):
        root = place[i]
        while root >= 0:
            k = end[root]
            end[root] = k + 1
            x[k] = points[i, 0]
            y[k] = points[i, 1]
            ident[k] = ~i if on_edge[i] else i
            root = also[i] - 1 if root == place[i] else -1
    return starts, room, x, y, ident


@kernel
def _exact_parts(points, p, a, b, c, i):
    """Tell which of the parts that p makes of (a, b, c) hold point i.

    Returns
    -------
    int
        Sum of 1 for (a, b, p), 2 for (p, b, c) and 4 for (a, p, c): two for a point between p and
        a vertex, none for a point that repeats p.
    """
    to_a, to_b, to_c = orient(points, p, a, i), orient(points, p, b, i), orient(points, p, c, i)
    parts = 0
    if to_a >= 0 and to_b <= 0:
        parts |= 1
    if to_b >= 0 and to_c <= 0:
        parts |= 2
    if to_c >= 0 and to_a <= 0:
        parts |= 4
    return parts if to_a != 0 or to_b != 0 or to_c != 0 else 0


@kernel
def _subdivide(
    points, roots, starts, room, x, y, ident, n_edges, split, repeats, triangles, half_edges, owners
):
    """Insert the points of each root triangle, depth first.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
    roots : (r, 6) int32 ndarray
        Vertices and half-edges.
    starts, room, x, y, ident
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
    # The lists of points are on three stacks, one after the other in x, y and ident. A triangle's
    # list is on top of one of them, where the first of its parts keeps its points; the other parts
    # put theirs on top of the other two. The first stack holds the lists of all roots to begin with.
    n_roots = len(starts) - 1
    second = starts[n_roots] + room
    third = second + room
    # Triangles to be split: vertices, half-edges, bounds of the list, tops of the other stacks.
    jobs = np.empty((room, 10), np.int64)
    corners = np.empty((room, 6))
    n_triangles = 0
    for root in range(n_roots - 1, -1, -1):
        low, high = starts[root], starts[root + 1]
        a, b, c = roots[root, 0], roots[root, 1], roots[root, 2]
        across_a, across_b, across_c = roots[root, 3], roots[root, 4], roots[root, 5]
        if low == high:
            _write(
                triangles, half_edges, owners, n_triangles, a, b, c, across_a, across_b, across_c
            )
            n_triangles += 1
            continue
        _set(jobs, 0, a, b, c, across_a, across_b, across_c, low, high, second, third)
        for k in range(6):
            corners[0, k] = points[roots[root, k // 2], k % 2]
        n_jobs = 1
        while n_jobs:
            n_jobs -= 1
            a, b, c = jobs[n_jobs, 0], jobs[n_jobs, 1], jobs[n_jobs, 2]
            across_a, across_b, across_c = jobs[n_jobs, 3], jobs[n_jobs, 4], jobs[n_jobs, 5]
            low, high, low2, low3 = (
                jobs[n_jobs, 6],
                jobs[n_jobs, 7],
                jobs[n_jobs, 8],
                jobs[n_jobs, 9],
            )
            a_x, a_y = corners[n_jobs, 0], corners[n_jobs, 1]
            b_x, b_y = corners[n_jobs, 2], corners[n_jobs, 3]
            c_x, c_y = corners[n_jobs, 4], corners[n_jobs, 5]
            p = np.int64(ident[low])
            px, py = x[low], y[low]
            end1, end2, end3 = low, low2, low3
            if p >= 0:
                ax, ay = a_x - px, a_y - py
                bx, by = b_x - px, b_y - py
                cx, cy = c_x - px, c_y - py
                # No point of the triangle is farther from p: this bounds the error of all signs.
                width = max(max(abs(ax), abs(bx)), abs(cx))
                height = max(max(abs(ay), abs(by)), abs(cy))
                bound = 2.0 * ORIENTATION_BOUND * (width * height) + UNDERFLOW
                for k in range(low + 1, high):
                    xk, yk, i = x[k], y[k], ident[k]
                    dx, dy = xk - px, yk - py
                    to_a = ax * dy - ay * dx
                    to_b = bx * dy - by * dx
                    to_c = cx * dy - cy * dx
                    in1 = (to_a > 0.0) & (to_b < 0.0)
                    in2 = (to_b > 0.0) & (to_c < 0.0)
                    in3 = (to_c > 0.0) & (to_a < 0.0)
                    if not ((abs(to_a) > bound) & (abs(to_b) > bound) & (abs(to_c) > bound)):
                        q = i if i >= 0 else ~i
                        found = _exact_parts(points, p, a, b, c, q)
                        in1, in2, in3 = (found & 1) != 0, (found & 2) != 0, (found & 4) != 0
                        if found == 0:
                            repeats[q] = p
                        elif found & (found - 1):
                            i = ~q
                    # Written to all three lists, of which one grows: no branch to mispredict.
                    x[end1], y[end1], ident[end1] = xk, yk, i
                    x[end2], y[end2], ident[end2] = xk, yk, i
                    x[end3], y[end3], ident[end3] = xk, yk, i
                    end1 += in1
                    end2 += in2
                    end3 += in3
                p_a, p_b, p_c = 2 * n_edges, 2 * n_edges + 2, 2 * n_edges + 4
                n_edges += 3
                n_parts = 3
            else:  # p lies on a side, which is to be ab
                p = ~p
                while orient(points, a, b, p) != 0:
                    a, b, c = b, c, a
                    a_x, a_y, b_x, b_y, c_x, c_y = b_x, b_y, c_x, c_y, a_x, a_y
                    across_a, across_b, across_c = across_b, across_c, across_a
                edge = across_c >> 1
                if split[edge] == 0:  # else the triangle on the other side came first
                    split[edge] = n_edges
                    n_edges += 2
                for k in range(low + 1, high):
                    i = ident[k]
                    q = i if i >= 0 else ~i
                    side = orient(points, p, c, q)
                    if side == 0:
                        if same(points, p, q):
                            repeats[q] = p
                            continue
                        i = ~q
                    xk, yk = x[k], y[k]
                    if side <= 0:
                        x[end2], y[end2], ident[end2] = xk, yk, i
                        end2 += 1
                    if side >= 0:
                        x[end3], y[end3], ident[end3] = xk, yk, i
                        end3 += 1
                p_a, p_b = parts_of(across_c, split[edge])
                p_a ^= 1
                p_c = 2 * n_edges
                n_edges += 1
                n_parts = 2
            for part in range(3 - n_parts, 3):
                u, v, w, across_u, across_v, across_w = a, b, c, across_a, across_b, across_c
                u_x, u_y, v_x, v_y, w_x, w_y = a_x, a_y, b_x, b_y, c_x, c_y
                if part == 0:
                    w, w_x, w_y, across_u, across_v = p, px, py, p_b ^ 1, p_a
                    first, last, top2, top3 = low, end1, low2, low3
                elif part == 1:
                    u, u_x, u_y, across_v, across_w = p, px, py, p_c ^ 1, p_b
                    first, last, top2, top3 = low2, end2, low3, end1
                else:
                    v, v_x, v_y, across_w, across_u = p, px, py, p_a ^ 1, p_c
                    first, last, top2, top3 = low3, end3, end1, end2
                t = n_triangles
                if first == last:
                    _write(triangles, half_edges, owners, t, u, v, w, across_u, across_v, across_w)
                    n_triangles += 1
                elif first + 1 == last and ident[first] >= 0:
                    q = ident[first]
                    h = 2 * n_edges  # from q to u; + 2, + 4: to v, w
                    n_edges += 3
                    _write(triangles, half_edges, owners, t, u, v, q, h + 3, h, across_w)
                    _write(triangles, half_edges, owners, t + 1, q, v, w, across_u, h + 5, h + 2)
                    _write(triangles, half_edges, owners, t + 2, u, q, w, h + 4, across_v, h + 1)
                    n_triangles += 3
                else:
                    _set(
                        jobs, n_jobs, u, v, w, across_u, across_v, across_w, first, last, top2, top3
                    )
                    corners[n_jobs, 0], corners[n_jobs, 1] = u_x, u_y
                    corners[n_jobs, 2], corners[n_jobs, 3] = v_x, v_y
                    corners[n_jobs, 4], corners[n_jobs, 5] = w_x, w_y
                    n_jobs += 1
    return n_triangles


@kernel
def _set(jobs, k, a, b, c, across_a, across_b, across_c, low, high, top2, top3):
    """Write down a triangle to be split."""
    jobs[k, 0], jobs[k, 1], jobs[k, 2] = a, b, c
    jobs[k, 3], jobs[k, 4], jobs[k, 5] = across_a, across_b, across_c
    jobs[k, 6], jobs[k, 7], jobs[k, 8], jobs[k, 9] = low, high, top2, top3


@kernel
def _write(triangles, half_edges, owners, t, a, b, c, across_a, across_b, across_c):
    """Write down a triangle that is final."""
    triangles[t, 0], triangles[t, 1], triangles[t, 2] = a, b, c
    half_edges[t, 0], half_edges[t, 1], half_edges[t, 2] = across_a, across_b, across_c
    owners[across_a] = t + 1
    owners[across_b] = t + 1
    owners[across_c] = t + 1


@kernel
def _link(half_edges, owners):
    """Replace each half-edge by the triangle on its other side, -1 at the boundary."""
    for t in range(len(half_edges)):
        for k in range(3):
            half_edges[t, k] = owners[half_edges[t, k] ^ 1] - 1
