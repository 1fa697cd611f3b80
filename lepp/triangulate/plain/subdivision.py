"""Plain incremental triangulation: points inserted in the given order, no edge is ever flipped.

A point inside a triangle splits it in three, a point on an edge splits the triangles beside it in
two, a point outside the hull is joined to every hull vertex that it sees.

Without flips nothing outside a triangle ever changes its inside, so the insertion is built like
quicksort rather than point by point. `lepp.triangulate.plain.hull` inserts only the points that
were outside the hull, or on it, at their turn; every other point is handed to the hull triangle
that holds it.
`_subdivide` then splits each of these by its first point, partitions the others, stably, among the
parts, and goes on depth first: no point location, sequential memory, and neighbouring triangles get
neighbouring numbers. The result is that of one-by-one insertion, triangle for triangle.

Edges carry the adjacency. Edge e has the half-edges 2e and 2e + 1, one for each side, so the twin
of half-edge h is h ^ 1. The half-edge of a triangle (a, b, c) across from a runs from b to c.
"""

import numpy as np

from lepp.geometry.lengths import is_certain, rank, squared_length
from lepp.geometry.predicates import ORIENTATION_BOUND, UNDERFLOW
from lepp.jit import kernel
from lepp.jit.memory import in_one_block
from lepp.triangulate.plain.hull import empty_hull, orient, parts_of, same, sweep_hull


def incremental(
    points: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray | None]:
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
    ranks : (m,) uint8 ndarray or None
        As from `lepp.geometry.lengths.edge_ranks`: here the coordinates are at hand. None where
        lengths are so near, or so extreme, that only exact arithmetic can find them.
    """
    n = len(points)
    hull = empty_hull(n)
    roots = np.empty((2 * n, 6), np.int32)
    split = np.zeros(4 * n, np.int32)
    n_roots, n_edges = sweep_hull(points, hull, roots, split)
    starts, room = _bounds(hull.place, hull.also, n_roots)
    size = int(starts[-1]) + 3 * room  # the lists, and room behind them for three stacks of others
    x, y, ident = in_one_block((size, np.float64), (size, np.float64), (size, np.int32))
    _gather(points, hull.place, hull.also, hull.on_edge, starts, x, y, ident)
    triangles = np.empty((2 * n, 3), np.int32)
    half_edges = np.empty((2 * n, 3), np.int32)
    owners = np.zeros(8 * n, np.int32)
    ranks = np.empty(2 * n, np.uint8)
    n_triangles, certain = _subdivide(
        points, roots, starts, room, x, y, ident, n_edges, split, hull.repeats,
        triangles, half_edges, owners, ranks,
    )  # fmt: skip
    neighbors = half_edges[:n_triangles]
    _link(neighbors, owners)
    left_out = np.flatnonzero(hull.repeats >= 0).astype(np.int32)
    repeated = np.column_stack((left_out, hull.repeats[left_out]))
    return triangles[:n_triangles], neighbors, repeated, ranks[:n_triangles] if certain else None


@kernel
def _bounds(place, also, n_roots):
    """Find how many points each root triangle has.

    Returns
    -------
    starts : (n_roots + 1,) int64 ndarray
        Bounds of the roots' lists.
    room : int
        More than the points and their repetitions that can be on the lists of one root's parts.
    """
    count = np.zeros(n_roots, np.int64)
    for i in range(len(place)):
        if place[i] >= 0:
            count[place[i]] += 1
            if also[i]:
                count[also[i] - 1] += 1
    starts = np.zeros(n_roots + 1, np.int64)
    room = 0
    for root in range(n_roots):
        starts[root + 1] = starts[root] + count[root]
        room = max(room, 2 * count[root] + 8)  # on an inner edge a point is on two lists
    return starts, room


@kernel
def _gather(points, place, also, on_edge, starts, x, y, ident):
    """Sort the points that are left by root triangle, in the order of insertion.

    Parameters
    ----------
    x, y : (k,) float64 ndarray, output
    ident : (k,) int32 ndarray, output
        Index of the point; its complement (~) for a point on an edge.
    """
    end = starts[:-1].copy()
    for i in range(len(place)):
        root = place[i]
        while root >= 0:
            k = end[root]
            end[root] = k + 1
            x[k] = points[i, 0]
            y[k] = points[i, 1]
            ident[k] = ~i if on_edge[i] else i
            root = also[i] - 1 if root == place[i] else -1


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
    points, roots, starts, room, x, y, ident, n_edges, split, repeats,
    triangles, half_edges, owners, ranks,
):  # fmt: skip
    """Insert the points of each root triangle, depth first.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
    roots : (r, 6) int32 ndarray
        Vertices and half-edges.
    starts, room, x, y, ident
        The points of each root, from `_bounds` and `_gather`.
    n_edges : int
        Number of edges so far.
    split : (4 n,) int32 ndarray
        The first part of each edge that has been split, else 0.
    repeats : (n,) int32 ndarray
        Set for points left out.
    triangles, half_edges : (2 n, 3) int32 ndarray, output
    owners : (8 n,) int32 ndarray, output
        The triangle of each half-edge, plus one; zero at the boundary.
    ranks : (2 n,) uint8 ndarray, output

    Returns
    -------
    n_triangles : int
    certain : bool
        Whether the ranks are those of the exact lengths.
    """
    # The lists of points are on three stacks, one after the other in x, y and ident. A triangle's
    # list is on top of one of them, where the first of its parts keeps its points; the other parts
    # put theirs on top of the other two. The first stack begins with the lists of all roots.
    n_roots = len(starts) - 1
    second = starts[n_roots] + room
    third = second + room
    # Triangles to be split: vertices, half-edges, bounds of the list, tops of the other stacks;
    # coordinates of the vertices, squared lengths of the sides across from them.
    jobs = np.empty((room, 10), np.int64)
    shapes = np.empty((room, 9))
    n_triangles = 0
    certain = True
    for root in range(n_roots - 1, -1, -1):
        a, b, c = roots[root, 0], roots[root, 1], roots[root, 2]
        across_a, across_b, across_c = roots[root, 3], roots[root, 4], roots[root, 5]
        low, high = starts[root], starts[root + 1]
        a_x, a_y = points[a, 0], points[a, 1]
        b_x, b_y = points[b, 0], points[b, 1]
        c_x, c_y = points[c, 0], points[c, 1]
        b_c, c_a = squared_length(b_x - c_x, b_y - c_y), squared_length(c_x - a_x, c_y - a_y)
        a_b = squared_length(a_x - b_x, a_y - b_y)
        if low == high:
            certain &= is_certain(b_c, c_a, a_b)
            ranks[n_triangles] = rank(b_c, c_a, a_b)
            _write(
                triangles, half_edges, owners, n_triangles, a, b, c, across_a, across_b, across_c
            )
            n_triangles += 1
            continue
        _set(jobs, 0, a, b, c, across_a, across_b, across_c, low, high, second, third)
        _shape(shapes, 0, a_x, a_y, b_x, b_y, c_x, c_y, b_c, c_a, a_b)
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
            a_x, a_y = shapes[n_jobs, 0], shapes[n_jobs, 1]
            b_x, b_y = shapes[n_jobs, 2], shapes[n_jobs, 3]
            c_x, c_y = shapes[n_jobs, 4], shapes[n_jobs, 5]
            b_c, c_a, a_b = shapes[n_jobs, 6], shapes[n_jobs, 7], shapes[n_jobs, 8]
            p = np.int64(ident[low])
            p_x, p_y = x[low], y[low]
            end1, end2, end3 = low, low2, low3
            if p < 0:  # p lies on a side, which is to be ab
                p = ~p
                while orient(points, a, b, p) != 0:
                    a, b, c = b, c, a
                    a_x, a_y, b_x, b_y, c_x, c_y = b_x, b_y, c_x, c_y, a_x, a_y
                    across_a, across_b, across_c = across_b, across_c, across_a
                    b_c, c_a, a_b = c_a, a_b, b_c
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
                    x_k, y_k = x[k], y[k]
                    if side <= 0:
                        x[end2], y[end2], ident[end2] = x_k, y_k, i
                        end2 += 1
                    if side >= 0:
                        x[end3], y[end3], ident[end3] = x_k, y_k, i
                        end3 += 1
                a_to_p, to_b = parts_of(across_c, split[edge])
                to_a = a_to_p ^ 1
                to_c = 2 * n_edges
                n_edges += 1
                first_part = 1
            else:
                ax, ay = a_x - p_x, a_y - p_y
                bx, by = b_x - p_x, b_y - p_y
                cx, cy = c_x - p_x, c_y - p_y
                # No point of the triangle is farther from p: this bounds the error of all signs.
                width = max(max(abs(ax), abs(bx)), abs(cx))
                height = max(max(abs(ay), abs(by)), abs(cy))
                bound = 2.0 * ORIENTATION_BOUND * (width * height) + UNDERFLOW
                for k in range(low + 1, high):
                    x_k, y_k, i = x[k], y[k], ident[k]
                    dx, dy = x_k - p_x, y_k - p_y
                    left_of_a = ax * dy - ay * dx
                    left_of_b = bx * dy - by * dx
                    left_of_c = cx * dy - cy * dx
                    in1 = (left_of_a > 0.0) & (left_of_b < 0.0)
                    in2 = (left_of_b > 0.0) & (left_of_c < 0.0)
                    in3 = (left_of_c > 0.0) & (left_of_a < 0.0)
                    if not (
                        (abs(left_of_a) > bound)
                        & (abs(left_of_b) > bound)
                        & (abs(left_of_c) > bound)
                    ):
                        q = i if i >= 0 else ~i
                        found = _exact_parts(points, p, a, b, c, q)
                        in1, in2, in3 = (found & 1) != 0, (found & 2) != 0, (found & 4) != 0
                        if found == 0:
                            repeats[q] = p
                        elif found & (found - 1):
                            i = ~q
                    # Written to all three lists, of which one grows: no branch to mispredict.
                    x[end1], y[end1], ident[end1] = x_k, y_k, i
                    x[end2], y[end2], ident[end2] = x_k, y_k, i
                    x[end3], y[end3], ident[end3] = x_k, y_k, i
                    end1 += in1
                    end2 += in2
                    end3 += in3
                to_a, to_b, to_c = 2 * n_edges, 2 * n_edges + 2, 2 * n_edges + 4  # from p
                n_edges += 3
                first_part = 0
            p_a, p_b = squared_length(a_x - p_x, a_y - p_y), squared_length(b_x - p_x, b_y - p_y)
            p_c = squared_length(c_x - p_x, c_y - p_y)
            for part in range(first_part, 3):
                u, v, w, across_u, across_v, across_w = a, b, c, across_a, across_b, across_c
                u_x, u_y, v_x, v_y, w_x, w_y = a_x, a_y, b_x, b_y, c_x, c_y
                v_w, w_u, u_v = b_c, c_a, a_b
                if part == 0:
                    w, w_x, w_y, v_w, w_u = p, p_x, p_y, p_b, p_a
                    across_u, across_v = to_b ^ 1, to_a
                    first, last, top2, top3 = low, end1, low2, low3
                elif part == 1:
                    u, u_x, u_y, w_u, u_v = p, p_x, p_y, p_c, p_b
                    across_v, across_w = to_c ^ 1, to_b
                    first, last, top2, top3 = low2, end2, low3, end1
                else:
                    v, v_x, v_y, u_v, v_w = p, p_x, p_y, p_a, p_c
                    across_w, across_u = to_a ^ 1, to_c
                    first, last, top2, top3 = low3, end3, end1, end2
                t = n_triangles
                if first == last:
                    certain &= is_certain(v_w, w_u, u_v)
                    ranks[t] = rank(v_w, w_u, u_v)
                    _write(triangles, half_edges, owners, t, u, v, w, across_u, across_v, across_w)
                    n_triangles += 1
                elif first + 1 == last and ident[first] >= 0:
                    q = np.int64(ident[first])
                    q_u = squared_length(u_x - x[first], u_y - y[first])
                    q_v = squared_length(v_x - x[first], v_y - y[first])
                    q_w = squared_length(w_x - x[first], w_y - y[first])
                    certain &= is_certain(q_v, q_u, u_v)
                    certain &= is_certain(v_w, q_w, q_v) & is_certain(q_w, w_u, q_u)
                    ranks[t] = rank(q_v, q_u, u_v)
                    ranks[t + 1] = rank(v_w, q_w, q_v)
                    ranks[t + 2] = rank(q_w, w_u, q_u)
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
                    _shape(shapes, n_jobs, u_x, u_y, v_x, v_y, w_x, w_y, v_w, w_u, u_v)
                    n_jobs += 1
    return n_triangles, certain


@kernel
def _set(jobs, k, a, b, c, across_a, across_b, across_c, low, high, top2, top3):
    """Write down a triangle to be split."""
    jobs[k, 0], jobs[k, 1], jobs[k, 2] = a, b, c
    jobs[k, 3], jobs[k, 4], jobs[k, 5] = across_a, across_b, across_c
    jobs[k, 6], jobs[k, 7], jobs[k, 8], jobs[k, 9] = low, high, top2, top3


@kernel
def _shape(shapes, k, a_x, a_y, b_x, b_y, c_x, c_y, b_c, c_a, a_b):
    """Write down the shape of a triangle to be split."""
    shapes[k, 0], shapes[k, 1], shapes[k, 2] = a_x, a_y, b_x
    shapes[k, 3], shapes[k, 4], shapes[k, 5] = b_y, c_x, c_y
    shapes[k, 6], shapes[k, 7], shapes[k, 8] = b_c, c_a, a_b


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
