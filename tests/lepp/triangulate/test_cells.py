import naive
import numpy as np
import pytest
from hypothesis import given, settings
from point_sets import nasty_points, reference_points

from lepp.tiles.coarse import hull_of, outside
from lepp.triangulate.plain import hull
from lepp.triangulate.plain.cells import settle_by_cells
from lepp.triangulate.plain.hull import hull_roots
from lepp.triangulate.plain.waiting import INSIDE, ON_SIDE, nobody_placed

KINDS = ["uniform", "normal", "exponential", "thin", "offset", "clusters", "circle", "parabola"]


def assert_settled_rightly(points, corners, places):
    """Every point that is called inside a triangle is, strictly; return how many are."""
    exact = naive.exact(points)
    inside = np.flatnonzero(places.state == INSIDE)
    for i in inside:
        a, b, c = (exact[v] for v in corners[places.of[i]])
        assert naive.turn(a, b, exact[i]) > 0
        assert naive.turn(b, c, exact[i]) > 0
        assert naive.turn(c, a, exact[i]) > 0
    return len(inside)


def settled(points, corners, first):
    rows = np.zeros((len(corners), 6), np.int32)
    rows[:, :3] = corners
    places = nobody_placed(len(points))
    settle_by_cells(points, first, rows, places)
    assert (places.state[:first] != INSIDE).all()
    return assert_settled_rightly(points, corners, places)


def parted(low, side, high):
    """A square, parted by an upright side, and each part by a diagonal: corners and triangles."""
    points = np.array([(x, y) for x in (low, side, high) for y in (low, high)])
    return points, [(0, 2, 3), (0, 3, 1), (2, 4, 5), (2, 5, 3)]


@pytest.mark.parametrize("kind", KINDS)
def test_cells_settle_only_what_is_inside(kind):
    points = reference_points(kind, 6000, 1)
    roots = hull_roots(points[:100])
    n_settled = settled(points, roots.rows[:, :3], 100)
    if kind in ("uniform", "normal", "offset", "thin"):
        assert n_settled > 0.4 * len(points)


@pytest.mark.parametrize("kind", ["uniform", "normal", "exponential"])
def test_all_points_inside_the_first_hull_are_settled(kind):
    points = reference_points(kind, 100_000, 3)
    roots = hull_roots(points[:1500])
    places = nobody_placed(len(points))
    settle_by_cells(points, 1500, roots.rows, places)
    is_inside = ~outside(hull_of(points[:1500]), points[1500:])
    assert (places.state[1500:][is_inside] == INSIDE).mean() > 0.99


@pytest.mark.parametrize(
    ("low", "high"),
    [(0.0, 0.7), (1.0, 1.7), (-0.3, 0.4), (1e5, 1e5 + 0.7), (2.0**40, 2.0**40 + 0.7),
     (2.0**52, 2.0**52 + 52), (0.0, 1e-290), (1e300, 1.1e300), (-1.7e308, 5e306),
     (-1.7e308, 1.7e308), (0.0, 2.0**-1030), (0.0, 2.0**-1068), (0.0, 2.0**-1073)],
)  # fmt: skip
def test_a_side_at_the_rim_of_a_cell_has_nothing_inside(low, high):
    # Where a cell begins, and to which cell a point is counted, are rounded differently: each side
    # goes through doubles beside such a rim, and points on the sides are inside of nothing.
    n_cells = 13
    share = np.arange(1, n_cells) / n_cells
    for rim in low * (1 - share) + high * share:
        for nudge in range(-3, 4):
            side = rim + nudge * np.spacing(rim)
            corners, triangles = parted(low, side, high)
            triangles += [t[k:] + t[:k] for t in triangles for k in (1, 2)]
            share = np.linspace(0.01, 0.99, 2 * n_cells**2)
            y = low * (1 - share) + high * share
            points = np.vstack((corners, np.column_stack((np.full(len(y), side), y))))
            assert settled(points, triangles, len(corners)) == 0


def test_a_point_beside_a_slanting_side_is_in_no_wrong_root():
    rng = np.random.default_rng(6)
    for _ in range(50):
        corners = (
            np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]) + rng.random((4, 2)) / 4
        )
        on_diagonal = corners[0] + rng.random((200, 1)) * (corners[2] - corners[0])
        settled(np.vstack((corners, on_diagonal)), [(0, 1, 2), (0, 2, 3)], 4)


@settings(max_examples=300, deadline=None)
@given(nasty_points())
def test_roots_do_not_depend_on_who_goes_ahead(points):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hull, "_FEWEST", 1)
        patch.setattr(hull, "_OPENING", 3)
        ahead = hull_roots(points)
        patch.setattr(hull, "_FEWEST", len(points) + 1)
        assert_same(ahead, hull_roots(points))


@pytest.mark.parametrize("kind", KINDS)
def test_roots_of_many_points_do_not_depend_on_who_goes_ahead(kind, monkeypatch):
    points = reference_points(kind, 9000, 2)
    points[7000:7100] = points[:100]  # repeated
    points[7100:7200] = (points[:100] + points[100:200]) / 2
    ahead = hull_roots(points)
    monkeypatch.setattr(hull, "_FEWEST", len(points))
    assert_same(ahead, hull_roots(points))


def test_roots_of_a_lattice_do_not_depend_on_who_goes_ahead(monkeypatch):
    x, y = np.meshgrid(np.arange(90.0), np.arange(70.0))
    points = np.column_stack((x.ravel(), y.ravel()))
    np.random.default_rng(4).shuffle(points)
    points = np.concatenate((points, points[::7]))
    ahead = hull_roots(points)
    monkeypatch.setattr(hull, "_FEWEST", len(points))
    assert_same(ahead, hull_roots(points))


def test_points_on_a_line_at_first_go_ahead_in_vain(monkeypatch):
    points = reference_points("uniform", 6000, 5)
    points[:200, 1] = 0.0
    ahead = hull_roots(points)
    monkeypatch.setattr(hull, "_FEWEST", len(points))
    assert_same(ahead, hull_roots(points))
    points[:, 1] = 0.0
    monkeypatch.undo()
    assert len(hull_roots(points).rows) == 0


def assert_same(one, other):
    assert np.array_equal(one.rows, other.rows)
    assert one.n_edges == other.n_edges
    assert np.array_equal(one.split, other.split)
    assert np.array_equal(one.places.repeats, other.places.repeats)
    state = one.places.state
    assert np.array_equal(state, other.places.state)
    placed = (state == INSIDE) | (state == ON_SIDE)
    assert np.array_equal(one.places.of[placed], other.places.of[placed])
    on_side = state == ON_SIDE
    assert np.array_equal(one.places.beyond[on_side], other.places.beyond[on_side])
