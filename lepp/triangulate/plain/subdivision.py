"""Incremental insertion, second part: the points inside the root triangles.

Each triangle is split by the first of its points, the others are partitioned among the parts, and
the parts are split in their turn, depth first.

The lists of points, each in the order of insertion, stand one behind the other in one (k, 3)
float64 array: x, y, and the index of the point, or the complement (~) of that for one on a side. A
point is written to three lists at once: in arrays of their own, x, y and index would be nine
streams of writing in place of three, and take half as much time again.
"""

from typing import NamedTuple

import numpy as np

from lepp.geometry.lengths import is_certain, rank, squared_length
from lepp.geometry.predicates import orient, same, turn_error
from lepp.jit import inlined, inner, kernel
from lepp.triangulate.plain.edges import parts_of
from lepp.triangulate.plain.waiting import INSIDE, ON_SIDE, Places


class Mesh(NamedTuple):
    """Triangles that are final, in the order in which they became so."""

    triangles: np.ndarray  # (2 n, 3) int32
    half_edges: np.ndarray  # (2 n, 3) int32, across from each vertex
    owners: np.ndarray  # (8 n,) int32, the triangle of each half-edge, plus one; else zero
    ranks: np.ndarray  # (2 n,) uint8


# A triangle to be split.
JOB = np.dtype(
    [
        # Vertices, and the half-edges across from them.
        *((name, np.int64) for name in ("a", "b", "c", "across_a", "across_b", "across_c")),
        # Bounds of the list of its points, and the tops of the other two stacks of lists.
        *((name, np.int64) for name in ("first", "stop", "top_2", "top_3")),
        # Coordinates of the vertices.
        *((name, np.float64) for name in ("a_x", "a_y", "b_x", "b_y", "c_x", "c_y")),
        # Squared lengths of the sides.
        *((name, np.float64) for name in ("b_c", "c_a", "a_b")),
    ]
)


def listed(
    points: np.ndarray, places: Places, n_roots: int
) -> tuple[np.ndarray, np.int64, np.ndarray]:
    """List the points that are left, by root triangle.

    Returns
    -------
    starts, room
        As from `_bounds`.
    lists : (k, 3) float64 ndarray
        With room behind them for three stacks of others.
    """
    starts, room = _bounds(places, n_roots)
    lists = np.empty((int(starts[-1]) + 3 * room, 3))
    _gather(points, places, starts, lists)
    return starts, room, lists


@kernel
def _bounds(places, n_roots):
    """Find how many points each root triangle has.

    Returns
    -------
    starts : (n_roots + 1,) int64 ndarray
        Bounds of the roots' lists.
    room : int
        More than the points and their repetitions that can be on the lists of one root's parts.
    """
    state, of, beyond = places.state, places.of, places.beyond
    count = np.zeros(n_roots, np.int64)
    for i in range(len(state)):
        if state[i] == INSIDE or state[i] == ON_SIDE:
            count[of[i]] += 1
            if state[i] == ON_SIDE and beyond[i] >= 0:
                count[beyond[i]] += 1
    starts = np.zeros(n_roots + 1, np.int64)
    room = np.int64(0)
    for root in range(n_roots):
        starts[root + 1] = starts[root] + count[root]
        room = max(room, 2 * count[root] + 8)  # on an inner edge a point is on two lists
    return starts, room


@kernel
def _gather(points, places, starts, lists):
    """List the points that are left by root triangle, in the order of insertion."""
    state, of, beyond = places.state, places.of, places.beyond
    end = starts[:-1].copy()
    for i in range(len(state)):
        if state[i] != INSIDE and state[i] != ON_SIDE:
            continue
        root = of[i]
        while root >= 0:
            k = end[root]
            end[root] = k + 1
            lists[k, 0], lists[k, 1] = points[i, 0], points[i, 1]
            lists[k, 2] = ~i if state[i] == ON_SIDE else i
            root = beyond[i] if state[i] == ON_SIDE and root == of[i] else np.int32(-1)


@kernel
def subdivide(points, roots, starts, room, lists, n_edges, split, repeats, mesh):
    """Insert the points of each root triangle, depth first.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
    roots : (r, 6) int32 ndarray
        Vertices and half-edges.
    starts : (r + 1,) int64 ndarray
    room : int
    lists : (k, 3) float64 ndarray
        All from `listed`.
    n_edges : int
        Number of edges so far.
    split : (4 n,) int32 ndarray
        The first part of each edge that has been split, else 0.
    repeats : (n,) int32 ndarray
        Set for points left out.
    mesh : Mesh, output

    Returns
    -------
    n_triangles : int
    certain : bool
        Whether the ranks are those of the exact lengths.
    """
    # The lists of points are on three stacks, one after the other. A triangle's list is on top of
    # one of them, where the first of its parts keeps its points; the other parts put theirs on top
    # of the other two. The first stack begins with the lists of all roots.
    triangles, half_edges, owners, ranks = mesh
    second = starts[-1] + room
    third = second + room
    jobs = np.empty(room, JOB)
    t = 0  # triangles that are final
    certain = True
    for root in range(len(starts) - 2, -1, -1):
        row = roots[root]
        a, b, c = np.int64(row[0]), np.int64(row[1]), np.int64(row[2])
        across = (np.int64(row[3]), np.int64(row[4]), np.int64(row[5]))
        corners = (
            points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
        )  # fmt: skip
        squares = _squares(corners)
        first, stop = starts[root], starts[root + 1]
        if first == stop:
            certain &= is_certain(*squares)
            _write(triangles, half_edges, owners, ranks, t, (a, b, c), across, squares)
            t += 1
            continue
        _push(jobs, 0, (a, b, c), across, (first, stop, second, third), corners, squares)
        n_jobs = 1
        while n_jobs:
            # Take the triangle that was put down last, and split it by the first of its points.
            n_jobs -= 1
            job = jobs[n_jobs]
            first, stop, top_2, top_3 = job["first"], job["stop"], job["top_2"], job["top_3"]
            p_x, p_y, p = lists[first, 0], lists[first, 1], np.int64(lists[first, 2])
            on_side = p < 0
            if on_side:
                p = ~p
                while orient(points, job["a"], job["b"], p) != 0:
                    _turn(job)  # until p is on the side from a to b
            a, b, c = job["a"], job["b"], job["c"]
            across_a, across_b, across_c = job["across_a"], job["across_b"], job["across_c"]
            a_x, a_y, b_x, b_y, c_x, c_y = (
                job["a_x"], job["a_y"], job["b_x"], job["b_y"], job["c_x"], job["c_y"]
            )  # fmt: skip
            b_c, c_a, a_b = job["b_c"], job["c_a"], job["a_b"]

            # Partition the other points among the parts (a, b, p), (p, b, c) and (a, p, c); number
            # the half-edges from p.
            spans = (first, stop, top_2, top_3)
            if on_side:  # the first part is flat
                end_1 = first
                end_2, end_3 = partition_beside(points, lists, repeats, spans, p, c)
                edge = across_c >> 1
                if split[edge] == 0:  # else the triangle on the other side came first
                    split[edge] = n_edges
                    n_edges += 2
                a_to_p, to_b = parts_of(across_c, split[edge])
                to_a, to_c = a_to_p ^ 1, 2 * n_edges
                n_edges += 1
                first_part = 1
            else:
                end_1, end_2, end_3 = partition(
                    points, lists, repeats, spans, (p, a, b, c),
                    (a_x - p_x, a_y - p_y, b_x - p_x, b_y - p_y, c_x - p_x, c_y - p_y),
                )  # fmt: skip
                to_a, to_b, to_c = 2 * n_edges, 2 * n_edges + 2, 2 * n_edges + 4
                n_edges += 3
                first_part = 0

            # Put the parts down.
            p_a, p_b = squared_length(a_x - p_x, a_y - p_y), squared_length(b_x - p_x, b_y - p_y)
            p_c = squared_length(c_x - p_x, c_y - p_y)
            for part in range(first_part, 3):
                if part == 0:
                    vertices, across = (a, b, p), (to_b ^ 1, to_a, across_c)
                    corners = (a_x, a_y, b_x, b_y, p_x, p_y)
                    squares, spans = (p_b, p_a, a_b), (first, end_1, top_2, top_3)
                elif part == 1:
                    vertices, across = (p, b, c), (across_a, to_c ^ 1, to_b)
                    corners = (p_x, p_y, b_x, b_y, c_x, c_y)
                    squares, spans = (b_c, p_c, p_b), (top_2, end_2, top_3, end_1)
                else:
                    vertices, across = (a, p, c), (to_c, across_b, to_a ^ 1)
                    corners = (a_x, a_y, p_x, p_y, c_x, c_y)
                    squares, spans = (p_c, c_a, p_a), (top_3, end_3, end_1, end_2)
                k, last = spans[0], spans[1] - 1
                if k > last:
                    certain &= is_certain(*squares)
                    _write(triangles, half_edges, owners, ranks, t, vertices, across, squares)
                    t += 1
                elif k == last and lists[k, 2] >= 0.0:  # one point, inside
                    certain &= _write_three(
                        triangles, half_edges, owners, ranks, t, vertices, across, corners,
                        squares, (np.int64(lists[k, 2]), lists[k, 0], lists[k, 1]), 2 * n_edges,
                    )  # fmt: skip
                    n_edges += 3
                    t += 3
                else:
                    _push(jobs, n_jobs, vertices, across, spans, corners, squares)
                    n_jobs += 1
    return t, certain


@inlined
def partition(points, lists, repeats, spans, vertices, arms):
    """Partition the points of a triangle (a, b, c) among the three parts that point p makes of it.

    Parameters
    ----------
    spans : (int, int, int, int)
        Bounds of the list, on which p is the first, and tops of the other stacks.
    vertices : (int, int, int, int)
        p, a, b, c.
    arms : (float, ...)
        Coordinates of a, b, c relative to p.

    Returns
    -------
    end_1, end_2, end_3 : int
        Ends of the lists of (a, b, p), (p, b, c) and (a, p, c).
    """
    first, stop, end_2, end_3 = spans
    end_1 = first
    p, a, b, c = vertices
    p_x, p_y = lists[first, 0], lists[first, 1]
    ax, ay, bx, by, cx, cy = arms
    # No point of the triangle is farther from p.
    width = max(max(abs(ax), abs(bx)), abs(cx))
    height = max(max(abs(ay), abs(by)), abs(cy))
    error = turn_error(width, height)
    for k in range(first + 1, stop):
        x_k, y_k, i = lists[k, 0], lists[k, 1], lists[k, 2]
        dx, dy = x_k - p_x, y_k - p_y
        left_of_a = ax * dy - ay * dx
        left_of_b = bx * dy - by * dx
        left_of_c = cx * dy - cy * dx
        in_1 = (left_of_a > 0.0) & (left_of_b < 0.0)
        in_2 = (left_of_b > 0.0) & (left_of_c < 0.0)
        in_3 = (left_of_c > 0.0) & (left_of_a < 0.0)
        if not ((abs(left_of_a) > error) & (abs(left_of_b) > error) & (abs(left_of_c) > error)):
            q = _index(i)
            in_1, in_2, in_3 = _exact_parts(points, p, a, b, c, q)
            n_parts = in_1 + in_2 + in_3
            if n_parts == 0:
                repeats[q] = p
            elif n_parts == 2:
                i = np.float64(~q)
        # Written to all three lists, of which one grows: no branch to mispredict.
        lists[end_1, 0], lists[end_1, 1], lists[end_1, 2] = x_k, y_k, i
        lists[end_2, 0], lists[end_2, 1], lists[end_2, 2] = x_k, y_k, i
        lists[end_3, 0], lists[end_3, 1], lists[end_3, 2] = x_k, y_k, i
        end_1 += in_1
        end_2 += in_2
        end_3 += in_3
    return end_1, end_2, end_3


@inlined
def partition_beside(points, lists, repeats, spans, p, c):
    """Do the same where p is on the side ab, and the first part is flat.

    Returns
    -------
    end_2, end_3 : int
    """
    first, stop, end_2, end_3 = spans
    for k in range(first + 1, stop):
        x_k, y_k, i = lists[k, 0], lists[k, 1], lists[k, 2]
        q = _index(i)
        side = orient(points, p, c, q)
        if side == 0:
            if same(points, p, q):
                repeats[q] = p
                continue
            i = np.float64(~q)
        if side <= 0:
            lists[end_2, 0], lists[end_2, 1], lists[end_2, 2] = x_k, y_k, i
            end_2 += 1
        if side >= 0:
            lists[end_3, 0], lists[end_3, 1], lists[end_3, 2] = x_k, y_k, i
            end_3 += 1
    return end_2, end_3


@inlined
def _index(ident):
    """Return the index of a point from what stands in a list."""
    i = np.int64(ident)
    return i if i >= 0 else ~i


@inner
def _exact_parts(points, p, a, b, c, i):
    """Tell which of the parts (a, b, p), (p, b, c), (a, p, c) hold point i.

    Two do for a point between p and a vertex, none for a point that repeats p.

    Returns
    -------
    in_1, in_2, in_3 : bool
    """
    to_a, to_b, to_c = orient(points, p, a, i), orient(points, p, b, i), orient(points, p, c, i)
    if to_a == 0 and to_b == 0 and to_c == 0:
        return False, False, False
    return to_a >= 0 >= to_b, to_b >= 0 >= to_c, to_c >= 0 >= to_a


@inlined
def _squares(corners):
    """Return the squared lengths of the sides across from three vertices."""
    a_x, a_y, b_x, b_y, c_x, c_y = corners
    return (
        squared_length(b_x - c_x, b_y - c_y),
        squared_length(c_x - a_x, c_y - a_y),
        squared_length(a_x - b_x, a_y - b_y),
    )


@inlined
def _push(jobs, k, vertices, across, spans, corners, squares):
    """Write down a triangle to be split."""
    job = jobs[k]
    job["a"], job["b"], job["c"] = vertices
    job["across_a"], job["across_b"], job["across_c"] = across
    job["first"], job["stop"], job["top_2"], job["top_3"] = spans
    job["a_x"], job["a_y"], job["b_x"], job["b_y"], job["c_x"], job["c_y"] = corners
    job["b_c"], job["c_a"], job["a_b"] = squares


@inlined
def _turn(job):
    """Let the vertices of a triangle to be split change places, each for the next."""
    job["a"], job["b"], job["c"] = job["b"], job["c"], job["a"]
    job["across_a"], job["across_b"], job["across_c"] = (
        job["across_b"], job["across_c"], job["across_a"]
    )  # fmt: skip
    job["a_x"], job["b_x"], job["c_x"] = job["b_x"], job["c_x"], job["a_x"]
    job["a_y"], job["b_y"], job["c_y"] = job["b_y"], job["c_y"], job["a_y"]
    job["b_c"], job["c_a"], job["a_b"] = job["c_a"], job["a_b"], job["b_c"]


@inlined
def _write(triangles, half_edges, owners, ranks, t, vertices, across, squares):
    """Write down a triangle that is final."""
    triangles[t, 0], triangles[t, 1], triangles[t, 2] = vertices
    half_edges[t, 0], half_edges[t, 1], half_edges[t, 2] = across
    owners[across[0]] = owners[across[1]] = owners[across[2]] = t + 1
    ranks[t] = rank(squares[0], squares[1], squares[2])


@inlined
def _write_three(
    triangles, half_edges, owners, ranks, t, vertices, across, corners, squares, point, h
):
    """Write down the three final triangles that one point inside makes of (u, v, w).

    Parameters
    ----------
    point : (int, float, float)
        Its index and coordinates.
    h : int
        The half-edge from the point to u; h + 2 and h + 4 lead to v and w.

    Returns
    -------
    bool
        Whether the ranks are those of the exact lengths.
    """
    u, v, w = vertices
    u_x, u_y, v_x, v_y, w_x, w_y = corners
    v_w, w_u, u_v = squares
    q, x, y = point
    q_u, q_v = squared_length(u_x - x, u_y - y), squared_length(v_x - x, v_y - y)
    q_w = squared_length(w_x - x, w_y - y)
    across_u, across_v, across_w = across
    _write(
        triangles, half_edges, owners, ranks, t,
        (u, v, q), (h + 3, h, across_w), (q_v, q_u, u_v),
    )  # fmt: skip
    _write(
        triangles, half_edges, owners, ranks, t + 1,
        (q, v, w), (across_u, h + 5, h + 2), (v_w, q_w, q_v),
    )  # fmt: skip
    _write(
        triangles, half_edges, owners, ranks, t + 2,
        (u, q, w), (h + 4, across_v, h + 1), (q_w, w_u, q_u),
    )  # fmt: skip
    return is_certain(q_v, q_u, u_v) & is_certain(v_w, q_w, q_v) & is_certain(q_w, w_u, q_u)
