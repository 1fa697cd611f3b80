"""Edges that differ by less than a small integer can say, and by less than a double can."""

from itertools import permutations

import numpy as np
import pytest

from lepp.geometry.lengths import LONGEST, SHORTEST_SHIFT, edge_ranks, is_certain

#: With edges of 5, differences are taken as multiples of this where all are.
UNIT = 2.0**-27


@pytest.mark.parametrize("offset", [0.0, UNIT / 4, -UNIT / 4, -3 * UNIT / 4, UNIT / 2, 8.0])
@pytest.mark.parametrize("more", [UNIT / 2, UNIT, -UNIT / 2, 3 * UNIT / 2])
@pytest.mark.parametrize("turn", [1, -1])
def test_half_a_unit_decides(offset, more, turn):
    # 3^2 + 4^2 < 5^2 + more^2, by less than 10^-16
    apex = [0.0, offset]
    points = np.array([apex, [3.0, 4.0 + offset], [5.0, offset + more]])[:, ::turn]
    assert points[2, ::turn][1] - offset == more  # nothing is lost
    for dim in (2, 3):
        places = np.column_stack((points, [7.0] * 3))[:, :dim]
        triangles = np.array(list(permutations(range(3))), np.int32)
        longest = edge_ranks(places, triangles) & LONGEST
        # the edge from the apex to vertex 2 is across from vertex 1
        assert longest.tolist() == [1 << t.index(1) for t in triangles.tolist()]


@pytest.mark.parametrize("offset", [0.0, UNIT / 4, -UNIT / 4, UNIT / 2])
@pytest.mark.parametrize("more", [UNIT / 2, -UNIT / 2])
@pytest.mark.parametrize("turn", [1, -1])
def test_half_a_unit_decides_which_is_shortest(offset, more, turn):
    points = np.array([[0.0, offset], [-3.0, 4.0 + offset], [5.0, offset + more]])[:, ::turn]
    triangles = np.array(list(permutations(range(3))), np.int32)
    for numbering in permutations(range(3)):  # equal edges go by the numbers of vertices
        triangles_now = np.array(numbering, np.int32)[triangles]
        places = points[np.argsort(numbering)]
        shortest = (edge_ranks(places, triangles_now) >> SHORTEST_SHIFT) & 3
        # the edge from the apex to vertex 1 is across from vertex 2
        assert shortest.tolist() == [t.index(2) for t in triangles.tolist()]


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
