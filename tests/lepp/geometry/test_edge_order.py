"""Edges that differ by less than a small integer can say, and by less than a double can."""

from itertools import permutations

import numpy as np
import pytest

from lepp.geometry.lengths import (
    LONGEST,
    NEARLY_EQUAL,
    NEARLY_EQUAL_BIT,
    SHORTEST_SHIFT,
    edge_ranks,
    is_certain,
)

#: With edges of 5, differences are taken as multiples of this where all are.
UNIT = 2.0**-27
#: All orders of a triangle's vertices.
ORDERS = np.array(list(permutations(range(3))), np.int32)


@pytest.mark.parametrize("offset", [0.0, UNIT / 4, -UNIT / 4, -3 * UNIT / 4, UNIT / 2, 8.0])
@pytest.mark.parametrize("more", [UNIT / 2, UNIT, -UNIT / 2, 3 * UNIT / 2])
@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("scale", [1.0, 2.0**40, 2.0**-40])
def test_half_a_unit_decides(offset, more, turn, scale):
    # 3^2 + 4^2 < 5^2 + more^2, by less than 10^-16
    apex = [0.0, offset]
    points = np.array([apex, [3.0, 4.0 + offset], [5.0, offset + more]])[:, ::turn]
    assert points[2, ::turn][1] - offset == more  # nothing is lost
    points = scale * points
    for dim in (2, 3):
        places = np.column_stack((points, [7.0] * 3))[:, :dim]
        longest = edge_ranks(places, ORDERS) & LONGEST
        # the edge from the apex to vertex 2 is across from vertex 1
        assert longest.tolist() == [1 << t.index(1) for t in ORDERS.tolist()]


@pytest.mark.parametrize("offset", [0.0, UNIT / 4, -UNIT / 4, UNIT / 2])
@pytest.mark.parametrize("more", [UNIT / 2, -UNIT / 2])
@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("scale", [1.0, 2.0**40])
def test_half_a_unit_decides_which_is_shortest(offset, more, turn, scale):
    points = np.array([[0.0, offset], [-3.0, 4.0 + offset], [5.0, offset + more]])[:, ::turn]
    points = scale * points
    for numbering in permutations(range(3)):  # equal edges go by the numbers of vertices
        triangles_now = np.array(numbering, np.int32)[ORDERS]
        places = points[np.argsort(numbering)]
        shortest = (edge_ranks(places, triangles_now) >> SHORTEST_SHIFT) & 3
        # the edge from the apex to vertex 1 is across from vertex 2
        assert shortest.tolist() == [t.index(2) for t in ORDERS.tolist()]


def test_equal_where_nothing_is_more():
    points = np.array([[0.0, UNIT / 4], [3.0, 4.0 + UNIT / 4], [5.0, UNIT / 4]])
    triangles = np.array([[0, 1, 2]], np.int32)
    assert edge_ranks(points, triangles)[0] & LONGEST == 0b110


@pytest.mark.parametrize("scale", [2.0**-20, 1.0, 2.0**20])
def test_certainty_does_not_depend_on_the_scale(scale):
    assert not is_certain(scale, scale * (1 + 1e-15), 2 * scale)
    assert is_certain(scale, scale * (1 + 4e-15), 2 * scale)


@pytest.mark.parametrize(("within", "longest"), [(0.25, 2), (np.nextafter(0.25, 0), 1)])
def test_an_edge_that_is_longer_by_just_the_tolerance_is_not_greater(within, longest):
    points = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])
    triangles = np.array([[0, 1, 2]], np.int32)
    (rank,) = edge_ranks(points, triangles, equal_within=within)
    assert int(rank & LONGEST).bit_count() == longest


@pytest.mark.parametrize("less", [2.0**-60, -(2.0**-60)])
@pytest.mark.parametrize("axis", [0, 1])
def test_a_difference_that_is_lost_in_rounding_decides(less, axis):
    """Edges of 1 and 1 - less: the rounded differences are the same integers."""
    points = np.array([[less, 0.0], [1.0, 0.0], [less, 1.0]])
    assert points[1, 0] - points[0, 0] == 1.0
    points = np.roll(points, axis, axis=1)
    for numbering in permutations(range(3)):
        triangles = np.array(numbering, np.int32)[ORDERS]
        shortest = (edge_ranks(points[np.argsort(numbering)], triangles) >> SHORTEST_SHIFT) & 3
        # from the apex along the axis: across from vertex 2; else across from vertex 1
        across = 2 if less > 0.0 else 1
        assert shortest.tolist() == [t.index(across) for t in ORDERS.tolist()]


@pytest.mark.parametrize("exponent", range(-40, 41))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_integers_of_thirty_bits_are_compared_at_any_scale(exponent, sign):
    """n^2 + n^2 and (n + 1)^2 + (n - 1)^2 differ by 2, of 2^59."""
    n = 2.0**29
    points = np.ldexp([[0.0, 0.0], [sign * n, n], [n + 1, sign * (n - 1)]], exponent)
    if sign < 0.0:  # the edge between the two is longer than both: the shortest one is asked for
        shortest = (edge_ranks(points, ORDERS) >> SHORTEST_SHIFT) & 3
        assert shortest.tolist() == [t.index(2) for t in ORDERS.tolist()]
    else:
        longest = edge_ranks(points, ORDERS) & LONGEST
        assert longest.tolist() == [1 << t.index(1) for t in ORDERS.tolist()]


@pytest.mark.parametrize(("dim", "within"), [(2, 2.0**-60), (3, 0.0)])
def test_an_edge_that_is_longer_by_just_the_limit_is_nearly_equal(dim, within):
    """From -w to 1, and from 0 to 1: lengths of 1 + w and 1, of which no double loses a bit."""
    for w, is_nearly in ((NEARLY_EQUAL, True), (np.nextafter(NEARLY_EQUAL, 1), False)):
        points = np.array([[-w, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])[:, :dim]
        ranks = edge_ranks(points, ORDERS, equal_within=within)
        assert ((ranks & NEARLY_EQUAL_BIT) > 0).tolist() == [is_nearly] * 6
        assert (ranks & LONGEST).tolist() == [1 << t.index(2) for t in ORDERS.tolist()]
