import json
from pathlib import Path

import aimed
import naive
import numpy as np
import pytest
from hypothesis import given, settings
from point_sets import nasty_points, reference_points
from validity import assert_valid

import lepp

REFERENCE = json.loads((Path(__file__).parents[1] / "lepp_reference.json").read_text())


def as_set(triangles):
    return {naive.canonical(tuple(t)) for t in triangles.tolist()}


@pytest.mark.parametrize("case", REFERENCE, ids=lambda c: f"{c['points']}-{c['n']}-{c['seed']}")
def test_histograms_are_those_of_cgal(case):
    triangulation = lepp.triangulate(reference_points(case["points"], case["n"], case["seed"]))
    expected = case["incremental"]
    paths = lepp.lepp_paths(triangulation)
    assert len(triangulation) == expected["n_triangles"]
    counts = lepp.LeppCounts.from_sizes(lepp.lepp_sizes(triangulation)).counts
    assert {str(s): int(k) for s, k in enumerate(counts) if k} == expected["histogram"]
    assert np.array_equal(paths.sizes, lepp.lepp_sizes(triangulation))
    assert (paths.neighbor_types == lepp.TYPE_C).sum() == expected["n_terminal"]
    assert (paths.successors >= 0).sum() == expected["n_interior_longest"]


@settings(max_examples=250, deadline=None)
@given(nasty_points())
def test_triangles_are_those_of_one_by_one_insertion(points):
    triangles, repeated = naive.incremental(points)
    if not triangles:
        with pytest.raises(lepp.InputError, match="one line"):
            lepp.triangulate(points)
        return
    ours = lepp.triangulate(points)
    assert as_set(ours.triangles) == triangles
    assert dict(ours.repeated.tolist()) == repeated
    assert_valid(ours)


@pytest.mark.parametrize("n", [3, 4, 50, 120])
@pytest.mark.parametrize("kind", ["uniform", "exponential", "clusters", "circle"])
def test_larger_sets_agree_with_one_by_one_insertion(kind, n):
    points = reference_points(kind, n, 5)
    ours = lepp.triangulate(points)
    assert as_set(ours.triangles) == naive.incremental(points)[0]
    assert_valid(ours)


@pytest.mark.parametrize("name", aimed.PLAIN)
def test_triangles_are_right_where_rounding_is_worst(name):
    points = aimed.read(aimed.PLAIN[name])
    ours = lepp.triangulate(points)
    assert as_set(ours.triangles) == naive.incremental(points)[0]
    assert_valid(ours)


def test_points_on_edges_split_both_sides():
    points = np.array(
        [[0, 0], [4, 0], [4, 4], [0, 4], [2, 2], [1, 1], [2, 0], [3, 3], [1, 0]], float
    )
    ours = lepp.triangulate(points)
    assert as_set(ours.triangles) == naive.incremental(points)[0]
    assert_valid(ours)


def test_large_grid_in_random_order_is_valid():
    x, y = np.meshgrid(np.arange(80.0), np.arange(60.0))
    points = np.column_stack((x.ravel(), y.ravel()))
    np.random.default_rng(3).shuffle(points)
    ours = lepp.triangulate(np.concatenate((points, points[::7])))
    assert len(ours) == 2 * 79 * 59
    assert len(ours.repeated) == len(points[::7])
    assert_valid(ours)


def test_ranks_are_found_on_the_way_where_squares_can_be_trusted():
    points = reference_points("uniform", 100, 1)
    assert lepp.triangulate(points)._edge_ranks is not None
    assert lepp.triangulate(points * 2.0**700)._edge_ranks is None
    assert lepp.triangulate(points * 2.0**-700)._edge_ranks is None
    sizes = lepp.lepp_sizes(lepp.triangulate(points))
    for scale in (2.0**700, 2.0**-700):
        assert np.array_equal(lepp.lepp_sizes(lepp.triangulate(points * scale)), sizes)
