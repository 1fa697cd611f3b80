"""Plain insertion in tiles gives the counts of the whole, number for number."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from naive import exact, turn
from point_sets import nasty_points, reference_points
from tiled import assert_same, at_once, coarse_of, in_tiles

import lepp
from lepp.tiles.coarse import coarse_mesh, hull_of, outside
from lepp.tiles.location import locate


@pytest.mark.parametrize("kind", ["uniform", "normal", "exponential", "clusters", "parabola"])
@pytest.mark.parametrize(
    ("n_first", "block", "together"), [(20, 700, 7), (60, 4000, 1), (4, 999, 400)]
)
def test_tiles_add_up_to_the_whole(kind, n_first, block, together):
    points = reference_points(kind, 4000, 3)
    cut = {"n_first": n_first, "opening": 100, "block": block, "together": together}
    assert_same(in_tiles(points, **cut), at_once(points))


@pytest.mark.parametrize("width", [4, 12, 40])
def test_points_on_sides_repeated_points_and_equal_lengths_as_in_memory(width):
    points = np.random.default_rng(width).integers(0, width, (1500, 2)) / 4.0
    for n_first in (5, 40):
        cut = {"n_first": n_first, "opening": 60, "block": 333, "together": 3}
        assert_same(in_tiles(points, **cut), at_once(points))


@settings(max_examples=150, deadline=None)
@given(
    nasty_points(max_size=60),
    st.integers(3, 20),
    st.integers(3, 30),
    st.integers(1, 40),
    st.integers(1, 9),
)
def test_any_points_in_any_tiles(points, n_first, opening, block, together):
    cut = {"n_first": n_first, "opening": opening, "block": block, "together": together}
    try:
        counts = in_tiles(points, **cut)
    except lepp.InputError:
        assume(False)
    assert_same(counts, at_once(points))


def test_a_point_on_the_hull_is_split_from_a_side_that_was_covered_later():
    # The fourth lies on the hull at its turn, the fifth covers that side of it.
    points = np.array([[0.0, 0], [4, 0], [0, 4], [2, 0], [2, -3], [1, 1], [1.5, -0.5], [0.5, 2]])
    cut = {"n_first": 3, "opening": 3, "block": 3, "together": 1}
    assert coarse_of(points, 3, 3).indices.tolist() == [0, 1, 2, 4]
    assert_same(in_tiles(points, **cut), at_once(points))


@pytest.mark.parametrize("kind", ["uniform", "normal", "clusters"])
def test_a_point_is_in_the_tile_that_it_is_sent_to(kind):
    points = np.round(reference_points(kind, 900, 8) * 16) / 16  # many on sides
    coarse = coarse_of(points, 30, 60)
    placed, counts, n_repeated = locate(coarse, points[300:], 300)
    tiles = np.repeat(np.arange(len(coarse)), counts)
    corners = [exact(coarse.points[triangle]) for triangle in coarse.triangles]
    numbers = np.where(placed["ident"] < 0, ~placed["ident"], placed["ident"])
    for row, tile, number in zip(placed, tiles, numbers, strict=True):
        assert (row["x"], row["y"]) == tuple(points[300 + number])
        (point,) = exact(np.array([[row["x"], row["y"]]]))
        a, b, c = corners[tile]
        turns = [turn(a, b, point), turn(b, c, point), turn(c, a, point)]
        assert min(turns) >= 0
        assert (min(turns) == 0) == (row["ident"] < 0)
    # None is lost: inside once, on a side in both tiles beside it, or on the hull once.
    ours = np.isin(np.arange(300, 900), coarse.indices)
    assert len(np.unique(numbers)) + n_repeated == 600 - ours.sum()
    assert (np.bincount(numbers[placed["ident"] >= 0]) <= 1).all()


@settings(max_examples=200, deadline=None)
@given(nasty_points(max_size=40), st.integers(3, 10))
def test_what_is_excluded_lies_strictly_inside(points, opening):
    try:
        hull = hull_of(points[:opening])
    except lepp.InputError:
        assume(False)
    may_be = outside(hull, points)
    corners, inside = exact(hull), exact(points)
    for point, free in zip(inside, may_be, strict=True):
        turns = [turn(a, b, point) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
        assert free or min(turns) > 0


def test_most_points_are_excluded():
    points = reference_points("uniform", 20000, 1)
    assert outside(hull_of(points[:5000]), points).mean() < 0.02


def test_first_points_on_one_line_are_refused():
    points = np.column_stack((np.arange(10.0), np.arange(10.0)))
    points[8] = [3.0, 9.0]
    with pytest.raises(lepp.InputError, match="lie on one line"):
        coarse_mesh(points, np.arange(10), 8)
    assert len(coarse_mesh(points, np.arange(10), 9)) == 8
