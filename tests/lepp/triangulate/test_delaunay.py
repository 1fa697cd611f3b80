import json
from pathlib import Path

import aimed
import naive
import naive_delaunay
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from point_sets import nasty_points, reference_points
from scipy.spatial import Delaunay
from validity import assert_valid

import lepp
from lepp.mesh import half_edges
from lepp.triangulate.delaunay import cavity as insertion
from lepp.triangulate.delaunay import delaunay as kernels

REFERENCE = json.loads((Path(__file__).parents[1] / "lepp_reference.json").read_text())


def triangulate(points):
    return lepp.triangulate(points, method="delaunay")


def as_set(triangles):
    return {naive.canonical(tuple(t)) for t in triangles.tolist()}


@pytest.mark.parametrize("case", REFERENCE, ids=lambda c: f"{c['points']}-{c['n']}-{c['seed']}")
def test_histograms_are_those_of_cgal(case):
    ours = triangulate(reference_points(case["points"], case["n"], case["seed"]))
    expected = case["delaunay"]
    paths = lepp.lepp_paths(ours)
    assert len(ours) == expected["n_triangles"]
    counts = lepp.LeppCounts.from_sizes(paths.sizes).counts
    assert {str(s): int(k) for s, k in enumerate(counts) if k} == expected["histogram"]
    assert (paths.neighbor_types == lepp.TYPE_C).sum() == expected["n_terminal"]
    assert (paths.successors >= 0).sum() == expected["n_interior_longest"]


@settings(max_examples=250, deadline=None)
@given(nasty_points())
def test_cells_are_those_of_one_by_one_insertion(points):
    triangles, repeated = naive_delaunay.delaunay(points)
    if not triangles:
        with pytest.raises(lepp.InputError, match="one line"):
            triangulate(points)
        return
    ours = triangulate(points)
    cells = naive_delaunay.cells(points, ours.triangles.tolist())
    assert cells == naive_delaunay.cells(points, triangles)
    assert ours.repeated.tolist() == [list(pair) for pair in sorted(repeated.items())]
    assert_valid(ours)


@settings(max_examples=60, deadline=None)
@given(
    kind=st.sampled_from(["uniform", "normal", "exponential", "clusters", "parabola"]),
    n=st.integers(4, 2000),
    seed=st.integers(0, 2**32 - 1),
)
@example("parabola", 600, 14361143)
def test_triangles_are_those_of_scipy_but_where_it_errs(kind, n, seed):
    points = reference_points(kind, n, seed)
    if kind == "clusters":  # SciPy joins points so near to each other
        points = np.round(points) + (points - np.round(points)) * 1e6
    theirs = {frozenset(t) for t in Delaunay(points).simplices.tolist()}
    ours = triangulate(points).triangles.tolist()
    others = [t for t in ours if frozenset(t) not in theirs]
    assert len(others) < 5  # SciPy rounds, and points of a parabola are nearly on a circle
    exact = naive.exact(points) if others else []
    for t in others:
        circle = [exact[v] for v in t]
        assert all(naive_delaunay.in_circle(*circle, p) <= 0 for p in exact)


def grid(width, height, step=1.0):
    x, y = np.meshgrid(step * np.arange(width), step * np.arange(height))
    return np.column_stack((x.ravel(), y.ravel()))


def lattice_circle(radius):
    x, y = np.mgrid[-radius : radius + 1, -radius : radius + 1]
    on = x * x + y * y == radius * radius
    return np.column_stack((x[on], y[on])).astype(float)


def line_and_point(n):
    return np.concatenate((np.column_stack((np.arange(n), 3.0 * np.arange(n))), [[1.0, 0.0]]))


def scales():
    """Points of all magnitudes, from the least to the greatest."""
    size = np.ldexp(1.0, np.arange(-1070, 1020, 70))
    return np.concatenate((np.column_stack((size, 0.3 * size)), np.column_stack((-size, size))))


NASTY = {
    "grid": grid(9, 7),
    "grid in tenths": grid(9, 7, 0.1) - 0.35,
    "grid at 2**1000": grid(6, 6, 2.0**1000),
    "grid at 2**-1074": grid(6, 6, 2.0**-1074),
    "grid at 1e300": grid(6, 6, 1e300),
    "grid at 1e-300": grid(6, 6, 1e-300),
    "cocircular": lattice_circle(5 * 13),
    "cocircular and its centre": np.concatenate((lattice_circle(5 * 13), [[0.0, 0.0]])),
    "almost cocircular": lattice_circle(5 * 13) / 65.0,
    "repeated": np.tile(grid(4, 3), (3, 1)),
    "collinear, then not": line_and_point(60),
    "almost collinear": np.column_stack((np.arange(40.0), np.arange(40) * 0.1 + 0.7)),
    "two lines": np.concatenate((grid(30, 1), grid(30, 1) + np.array([0.5, 1e-3]))),
    "all magnitudes": scales(),
    "greatest doubles": np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, 0]]) * 1.7e308,
    "cross": np.concatenate((grid(31, 1) - [15, 0], grid(1, 31) - [0, 15])),
}


@pytest.mark.parametrize("name", NASTY)
def test_circles_of_nasty_sets_are_empty(name):
    points = NASTY[name]
    ours = triangulate(points)
    assert_valid(ours)
    assert naive_delaunay.is_delaunay(points, ours.triangles.tolist())
    again = triangulate(points.copy())
    assert np.array_equal(again.triangles, ours.triangles)
    assert np.array_equal(again.neighbors, ours.neighbors)


@pytest.mark.parametrize("name", aimed.DELAUNAY)
def test_circles_are_empty_where_rounding_is_worst(name):
    points = aimed.read(aimed.DELAUNAY[name])
    ours = triangulate(points)
    assert_valid(ours)
    assert naive_delaunay.is_delaunay(points, ours.triangles.tolist())


def test_large_cavities_are_filled():
    points = reference_points("circle", 3000, 1)
    inside = np.array([[0.1, 0.2], [0.1001, 0.2]])
    ours = triangulate(np.concatenate((points, inside)))
    assert np.bincount(ours.triangles.ravel()).max() > 1000
    assert_valid(ours)


def test_large_grid_in_random_order_is_valid():
    points = grid(80, 60)
    np.random.default_rng(3).shuffle(points)
    ours = triangulate(np.concatenate((points, points[::7])))
    assert len(ours) == 2 * 79 * 59
    assert ours.repeated.tolist() == [[len(points) + k, 7 * k] for k in range(len(points[::7]))]
    assert_valid(ours)
    corners = points[ours.triangles % len(points)]
    extents = np.ptp(corners, axis=1)
    assert (extents == 1).all()  # half of a unit square


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_order_of_points_does_not_matter(seed):
    points = reference_points("normal", 300, seed)
    order = np.random.default_rng(seed).permutation(len(points))
    shuffled = order[triangulate(points[order]).triangles]
    assert as_set(shuffled) == as_set(triangulate(points).triangles)


def test_of_repeated_points_the_first_stays():
    points = np.random.default_rng(1).permutation(np.tile(grid(5, 5), (20, 1)))
    ours = triangulate(points)
    first = {tuple(p): i for i, p in reversed(list(enumerate(points.tolist())))}
    expected = [[i, first[tuple(p)]] for i, p in enumerate(points.tolist())]
    assert ours.repeated.tolist() == [pair for pair in expected if pair[0] != pair[1]]


def test_points_can_be_inserted_one_at_a_time():
    points = reference_points("normal", 200, 3)
    n = np.uint64(len(points))
    order = np.arange(len(points), dtype=np.uint32)
    xy = np.empty(2 * len(points) + 2)
    kernels._gather(points, order, xy)
    rows = np.zeros(16 * len(points) + 16, np.uint32)
    half_edges.write_first_triangle(rows, *kernels._first_triangle(xy, len(points)), len(points))
    n_rows, start = 4, 0
    repeats = np.full(len(points), -1, np.int32)
    space = insertion.room(1000)
    for p in range(len(points)):
        after, n_rows, start = insertion.insert(
            xy,
            rows,
            np.uint64(n_rows),
            n,
            (p, p + 1, 1, -1),
            np.uint64(start),
            order,
            repeats,
            space,
        )
        assert after == p + 1
    rows = rows[: 8 * n_rows]
    m = kernels._drop_outer(rows, len(points))
    triangles = order[rows.reshape(-1, 8)[:m, :3]]
    assert as_set(triangles) == as_set(triangulate(points).triangles)
