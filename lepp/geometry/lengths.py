"""Lengths of edges, compared exactly: which of a triangle's edges are longest, and which shortest.

Squared lengths are compared in floating point, and the comparison trusted where they differ by more
than their rounding errors; elsewhere their difference is summed exactly in fixed point. So edges
are equal only if they are, whatever the numbering of the mesh.

Edge k of a triangle is the one across from its vertex k. What is known of a triangle's edges fits a
byte, its *rank*:

- bits 0, 1, 2: edge 0, 1, 2 is a longest one (more than one bit where edges are equal);
- bits 3 and 4: the number of its shortest edge;
- bit 5: its two longest edges agree to `NEARLY_EQUAL`.
"""

import math

import numpy as np

from lepp.geometry.fixed_point import accumulator_sign, add_product, new_accumulator
from lepp.geometry.predicates import EPSILON, UNDERFLOW, difference_is_exact
from lepp.jit import inner, kernel
from lepp.jit.memory import for_kernels

LONGEST = 7
"""The bits of a rank that say which edges are longest."""
SHORTEST_SHIFT = 3
"""The bits of a rank above this say which edge is shortest."""
NEARLY_EQUAL_BIT = 32
"""The bit of a rank that says that the two longest edges nearly agree."""

NEARLY_EQUAL = 1e-6
"""Relative difference of lengths up to which they are said to be nearly equal: single precision."""

# A squared length has a relative rounding error of up to 4 EPSILON in the plane (differences,
# products, sum) and 5 in space. Two of them differ truly if they differ by more than this times
# their sum; the second term covers the rounding of the bound itself.
LENGTH_BOUND = (4.0 + 32.0 * EPSILON) * EPSILON
SPACE_LENGTH_BOUND = (5.0 + 64.0 * EPSILON) * EPSILON
# (1 + w)**2 and its product with a square add 4 EPSILON to the error of that one.
TOLERANCE_ERROR = 4.0 * EPSILON
# Integers of so many bits have squares, and sums of three of them, below 2**63.
_SQUARABLE_BITS = 30


def edge_ranks(
    points: np.ndarray, triangles: np.ndarray, *, equal_within: float = 0.0
) -> np.ndarray:
    """Find the longest and the shortest edges of each triangle.

    Parameters
    ----------
    points : (n, 2) or (n, 3) float64 ndarray
        Finite.
    triangles : (m, 3) int32 ndarray
    equal_within : float
        An edge is a longest one if the longest is not longer by more than this share of its length.

    Returns
    -------
    (m,) uint8 ndarray
        As described above.
    """
    ranks = np.empty(len(triangles), np.uint8)
    points, triangles = for_kernels(points, np.float64), for_kernels(triangles, np.int32)
    rank_edges = _rank_edges_in_space if points.shape[1] == 3 else _rank_edges
    rank_edges(points, triangles, float(equal_within), ranks)
    return ranks


@inner
def squared_length(dx, dy):
    """Return the rounded square of a length in the plane.

    The same bits from both sides of an edge.

    Parameters
    ----------
    dx, dy : float
        Differences of the coordinates of its ends.

    Returns
    -------
    float
        Off by up to 4 `EPSILON` of itself, where nothing over- or underflows.
    """
    return dx * dx + dy * dy


@inner
def squared_length_in_space(points, a, b):
    """Return the rounded square of the length of an edge of a surface.

    The same bits from both sides of the edge.

    Parameters
    ----------
    points : (n, 3) float64 ndarray
    a, b : int
        Ends of the edge.

    Returns
    -------
    float
        Off by up to 5 `EPSILON` of itself, where nothing over- or underflows.
    """
    dx, dy, dz = (
        points[a, 0] - points[b, 0],
        points[a, 1] - points[b, 1],
        points[a, 2] - points[b, 2],
    )
    return dx * dx + dy * dy + dz * dz


@kernel
def is_certain(across_a, across_b, across_c):
    """Tell whether rounded squared lengths in the plane certainly are in the order of the lengths.

    Parameters
    ----------
    across_a, across_b, across_c : float
        `squared_length` of the edges of a triangle.

    Returns
    -------
    bool
        False, too, where they have over- or underflowed.
    """
    gap = min(abs(across_a - across_b), abs(across_b - across_c), abs(across_c - across_a))
    return gap > LENGTH_BOUND * (across_a + across_b + across_c) + UNDERFLOW


@kernel
def rank(across_a, across_b, across_c):
    """Return the rank of a triangle from the squares of its edges, where these are certain.

    Parameters
    ----------
    across_a, across_b, across_c : float
        Squared lengths of edges 0, 1, 2.

    Returns
    -------
    int
        As the module describes it. Whether the longest two nearly agree is decided in rounded
        arithmetic: where they differ by `NEARLY_EQUAL` but for a last bit, either way.
    """
    a_b = across_a > across_b
    long, short = (across_a, across_b) if a_b else (across_b, across_a)
    longest, shortest = (1, 8) if a_b else (2, 0)
    is_longest, is_shortest = across_c > long, across_c < short
    first = across_c if is_longest else long
    second = long if is_longest else max(across_c, short)
    longest = 4 if is_longest else longest
    shortest = 16 if is_shortest else shortest
    nearly = 0 if first > second * ((1.0 + NEARLY_EQUAL) * (1.0 + NEARLY_EQUAL)) else 32
    return longest | shortest | nearly


@inner
def _add_square(accumulator, weight, x, y, w):
    """Add ``weight * (x - y)**2 * (1 + w)**2`` to a fixed-point number, exactly."""
    for u, v, k in ((x, x, weight), (x, y, -2 * weight), (y, y, weight)):
        add_product(accumulator, k, (u, v, 1.0, 1.0))
        add_product(accumulator, 2 * k, (u, v, w, 1.0))
        add_product(accumulator, k, (u, v, w, w))


@inner
def _compare_exactly(points, a, b, c, d, within):
    """Return the sign of |ab| - |cd| (1 + within), from the coordinates as they are."""
    if within == 0.0:
        scale, are_integers = _common_scale(points, a, b, c, d)
        if are_integers:
            total = np.int64(0)
            for k in range(points.shape[1]):
                one = np.int64((points[a, k] - points[b, k]) * scale)
                other = np.int64((points[c, k] - points[d, k]) * scale)
                total += one * one - other * other
            return int(total > 0) - int(total < 0)
    accumulator = new_accumulator()
    for k in range(points.shape[1]):
        _add_square(accumulator, 1, points[a, k], points[b, k], 0.0)
        _add_square(accumulator, -1, points[c, k], points[d, k], within)
    return accumulator_sign(accumulator)


@inner
def _common_scale(points, a, b, c, d):
    """Return a power of two that makes small integers of two edges, as lattices have them.

    Returns
    -------
    scale : float
        0 where there is none.
    are_integers : bool
        Whether there is one.
    """
    largest = 0.0
    for k in range(points.shape[1]):
        one, other = points[a, k] - points[b, k], points[c, k] - points[d, k]
        if not (
            difference_is_exact(points[a, k], points[b, k], one)
            and difference_is_exact(points[c, k], points[d, k], other)
        ):
            return 0.0, False
        largest = max(largest, abs(one), abs(other))
    scale = math.ldexp(1.0, _SQUARABLE_BITS - math.frexp(largest)[1])
    for k in range(points.shape[1]):
        one = (points[a, k] - points[b, k]) * scale
        other = (points[c, k] - points[d, k]) * scale
        if one != np.int64(one) or other != np.int64(other):
            return 0.0, False
    return scale, True


@inner
def _compare(points, a, b, c, d, square_1, square_2, within, bound):
    """Return the sign of |ab| - |cd| (1 + within), given the rounded squares of both lengths."""
    error = bound * (square_1 + square_2)
    if within > 0.0:
        square_2 *= (1.0 + within) * (1.0 + within)
        error = bound * (square_1 + square_2) + TOLERANCE_ERROR * square_2
    difference = square_1 - square_2
    if abs(difference) > error + UNDERFLOW:
        return 1 if difference > 0.0 else -1
    return _compare_exactly(points, a, b, c, d, within)


@inner
def _precedes(a, b, c, d):
    """Tell whether edge ab comes before edge cd by the numbers of their vertices."""
    low_1, low_2 = min(a, b), min(c, d)
    return low_1 < low_2 or (low_1 == low_2 and max(a, b) < max(c, d))


@inner
def _exact_rank(points, vertices, squares, within, bound):
    """Return the rank of a triangle, whatever its lengths.

    Parameters
    ----------
    points : (n, 2) or (n, 3) float64 ndarray
    vertices : (int, int, int)
    squares : (float, float, float)
        Rounded squares of the lengths of edges 0, 1, 2.
    within : float
        As `equal_within` of `edge_ranks`.
    bound : float
        `LENGTH_BOUND` or `SPACE_LENGTH_BOUND`.
    """
    longest = shortest = 0
    for k in range(1, 3):
        a, b = vertices[(k + 1) % 3], vertices[(k + 2) % 3]
        c, d = vertices[(longest + 1) % 3], vertices[(longest + 2) % 3]
        if _compare(points, a, b, c, d, squares[k], squares[longest], 0.0, bound) > 0:
            longest = k
        c, d = vertices[(shortest + 1) % 3], vertices[(shortest + 2) % 3]
        order = _compare(points, a, b, c, d, squares[k], squares[shortest], 0.0, bound)
        if order < 0 or (order == 0 and _precedes(a, b, c, d)):
            shortest = k
    result = (1 << longest) | (shortest << SHORTEST_SHIFT)
    a, b = vertices[(longest + 1) % 3], vertices[(longest + 2) % 3]
    for k in range(3):
        if k != longest:
            c, d = vertices[(k + 1) % 3], vertices[(k + 2) % 3]
            if _compare(points, a, b, c, d, squares[longest], squares[k], within, bound) <= 0:
                result |= 1 << k
            if _compare(points, a, b, c, d, squares[longest], squares[k], NEARLY_EQUAL, bound) <= 0:
                result |= NEARLY_EQUAL_BIT
    return result


@kernel
def _rank_edges(points, triangles, within, ranks):
    """Write the rank of each triangle in the plane."""
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ax, ay = points[a, 0], points[a, 1]
        bx, by = points[b, 0], points[b, 1]
        cx, cy = points[c, 0], points[c, 1]
        across_a = squared_length(bx - cx, by - cy)
        across_b = squared_length(cx - ax, cy - ay)
        across_c = squared_length(ax - bx, ay - by)
        if within == 0.0 and is_certain(across_a, across_b, across_c):
            ranks[t] = rank(across_a, across_b, across_c)
        else:
            squares = (across_a, across_b, across_c)
            ranks[t] = _exact_rank(points, (a, b, c), squares, within, LENGTH_BOUND)


@kernel
def _rank_edges_in_space(points, triangles, within, ranks):
    """Do the same as `_rank_edges` for points with three coordinates."""
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        squares = (
            squared_length_in_space(points, b, c),
            squared_length_in_space(points, c, a),
            squared_length_in_space(points, a, b),
        )
        ranks[t] = _exact_rank(points, (a, b, c), squares, within, SPACE_LENGTH_BOUND)
