"""Paths against a walk by the definition, in rational arithmetic; equal and nearly equal edges."""

import json
from dataclasses import replace
from pathlib import Path

import naive
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from point_sets import nasty_points, reference_points

import lepp

TIES = json.loads((Path(__file__).parents[1] / "ties_reference.json").read_text())


def check_against_twin(triangulation, within=0.0):
    twin = naive.Paths(triangulation.points.tolist(), triangulation.triangles.tolist(), within)
    paths = lepp.lepp_paths(triangulation, equal_within=within)
    walked = [twin.path(t) for t in range(len(triangulation))]
    assert paths.sizes.tolist() == [len(steps) for steps, _ in walked]
    sizes = lepp.lepp_sizes(triangulation, equal_within=within)
    assert sizes.tolist() == paths.sizes.tolist()
    types = [twin.neighbor_type(t) for t in range(len(triangulation))]
    assert paths.neighbor_types.tolist() == types
    n_by_type = [types.count(kind) for kind in range(4)]
    assert lepp.count_types(paths.neighbor_types).tolist() == n_by_type
    successors = [twin.successor(t) for t in range(len(triangulation))]
    assert paths.successors.tolist() == [-1 if s is None else s for s in successors]
    for t, (steps, terminal) in enumerate(walked):
        assert tuple(sorted(paths.terminal_edges[paths.regions[t]].tolist())) == terminal
        on = t
        for step in steps[1:]:
            on = paths.successors[on]
            assert on == step
    sizes_of_regions = np.bincount(paths.regions)
    assert paths.region_counts.tolist() == np.bincount(sizes_of_regions).tolist()
    ends = [tuple(sorted(edge)) for edge in paths.terminal_edges.tolist()]
    assert len(set(ends)) == len(ends)
    first = [min(t for t in twin.beside[edge]) for edge in ends]
    assert first == sorted(first)
    assert paths.n_equal == twin.n_equal()
    nearly = naive.Paths(twin.points, twin.triangles, lepp.NEARLY_EQUAL)
    assert paths.n_nearly_equal == nearly.n_equal()


@settings(max_examples=120, deadline=None)
@given(nasty_points(max_size=16))
def test_paths_are_those_of_a_walk(points):
    try:
        triangulation = lepp.triangulate(points)
    except lepp.InputError:
        return  # on one line
    check_against_twin(triangulation)


@pytest.mark.parametrize("case", TIES, ids=[case["name"] for case in TIES])
def test_ties_have_the_reference_sizes_however_the_mesh_is_numbered(case):
    points, triangles = np.array(case["points"]), np.array(case["triangles"])
    rng = np.random.default_rng(len(points))
    ends_at_once = set()
    for _ in range(4):
        mesh = lepp.Triangulation.from_arrays(points, triangles)
        paths = lepp.lepp_paths(mesh, equal_within=case["equal_within"])
        assert paths.sizes.tolist() == case["sizes"]
        ends_at_once.add(int(np.isin(paths.neighbor_types, (lepp.TYPE_NONE, lepp.TYPE_C)).sum()))
        check_against_twin(mesh, case["equal_within"])
        order = rng.permutation(len(points))
        points, triangles = points[order], np.argsort(order)[triangles]
    assert len(ends_at_once) == 1


@settings(max_examples=150, deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)), min_size=4, max_size=18),
    st.sampled_from([0.0, 1e-12, 0.1, 0.3]),
    st.sampled_from(["incremental", "delaunay"]),
)
def test_lattices_have_the_sizes_of_the_walk(points, within, method):
    try:
        mesh = lepp.triangulate(np.array(points, float), method)
    except lepp.InputError:
        return
    check_against_twin(mesh, within)


@pytest.mark.parametrize("n", [60, 97, 200])
def test_fans_in_rounded_coordinates(n):
    angle = 2 * np.pi * np.arange(n) / n
    circle = np.column_stack((np.cos(angle), np.sin(angle)))
    points = np.vstack(([0.0, 0.0], circle))
    triangles = [(0, 1 + k, 1 + (k + 1) % n) for k in range(n)]
    mesh = lepp.Triangulation.from_arrays(points, triangles)
    check_against_twin(mesh)
    assert lepp.lepp_sizes(mesh, equal_within=1e-9).tolist() == [2] * n
    assert lepp.lepp_paths(mesh).n_nearly_equal == n


def test_surface_of_equal_triangles_in_space():
    points = [(x, y, -x - y) for x in range(6) for y in range(6)]
    grid = np.arange(36).reshape(6, 6)
    corners = [c.ravel() for c in (grid[:-1, :-1], grid[1:, :-1], grid[:-1, 1:], grid[1:, 1:])]
    triangles = np.vstack((np.column_stack(corners[:3]), np.column_stack(corners[1:])))
    mesh = lepp.Triangulation.from_arrays(np.array(points, float), triangles)
    check_against_twin(mesh)
    sizes = lepp.lepp_sizes(mesh)
    boundary = (mesh.neighbors < 0).any(axis=1)
    assert sizes.tolist() == np.where(boundary, 1, 2).tolist()


@pytest.mark.parametrize("within", [-0.1, 1.0, np.nan, np.inf, "a", None, [0.1]])
def test_equal_within_is_a_share(within):
    mesh = lepp.worst_case_strip(3)
    for of in (lepp.lepp_sizes, lepp.lepp_paths):
        with pytest.raises(lepp.InputError, match="at least 0 and below 1"):
            of(mesh, equal_within=within)


def test_lengths_that_overflow_when_squared():
    turn = np.arange(6) * np.pi / 3
    rim = 1e-305 * np.column_stack((np.cos(turn), np.sin(turn)))
    flat = np.vstack(([0.0, 0.0], rim))
    triangles = [(0, 1 + k, 1 + (k + 1) % 6) for k in range(6)]
    far = np.column_stack((flat, np.full(7, 1e10)))
    lifted = lepp.Triangulation.from_arrays(far, triangles)
    check_against_twin(lifted)
    sizes = lepp.lepp_sizes(lepp.Triangulation.from_arrays(flat, triangles))
    assert np.array_equal(lepp.lepp_sizes(lifted), sizes)
    check_against_twin(lepp.triangulate(reference_points("uniform", 40, 2) * 2.0**1000))


def test_neighbours_that_lead_in_a_circle_are_told():
    mesh = lepp.worst_case_strip(60)
    neighbors = mesh.neighbors.copy()
    longest = (mesh.edge_ranks() & 7) >> 1
    neighbors[-1, longest[-1]] = 0  # the last goes back to the first
    with pytest.raises(lepp.InputError, match="does not end"):
        lepp.lepp_sizes(lepp.Triangulation(mesh.points, mesh.triangles, neighbors))


def test_sizes_follow_the_points_of_the_mesh():
    points = reference_points("uniform", 200, 3)
    mesh = lepp.triangulate(points, "delaunay")
    stretched = points * [100.0, 1.0]
    expected = lepp.lepp_sizes(lepp.Triangulation.from_arrays(stretched, mesh.triangles))
    assert not np.array_equal(lepp.lepp_sizes(mesh), expected)
    assert np.array_equal(lepp.lepp_sizes(replace(mesh, points=stretched)), expected)
    before = lepp.lepp_sizes(mesh)
    points *= [100.0, 1.0]
    assert np.array_equal(lepp.lepp_sizes(mesh), before)
    with pytest.raises(ValueError, match="read-only"):
        mesh.points[0] = 0.0


@pytest.mark.parametrize("kind", ["uniform", "thin", "circle", "parabola"])
def test_paths_of_larger_sets(kind):
    check_against_twin(lepp.triangulate(reference_points(kind, 120, 9)))


def test_equal_edges_do_not_send_a_path_round():
    x, y = np.meshgrid(np.arange(7.0), np.arange(7.0))
    check_against_twin(lepp.triangulate(np.column_stack((x.ravel(), y.ravel()))))
    rows = [(k + 0.5 * (j % 2), j * np.sqrt(0.75)) for j in range(6) for k in range(6)]
    check_against_twin(lepp.triangulate(np.array(rows)))


def test_surface_in_space():
    flat = lepp.triangulate(reference_points("uniform", 60, 4))
    lifted = np.column_stack((flat.points, np.sin(5 * flat.points[:, 0])))
    check_against_twin(lepp.Triangulation.from_arrays(lifted, flat.triangles))


@pytest.mark.parametrize("n", [1, 2, 3, 50, 100_000])
def test_worst_case_strip(n):
    sizes = lepp.lepp_sizes(lepp.worst_case_strip(n))
    assert sizes.tolist() == list(range(n, 0, -1))
    assert sizes.mean() == (n + 1) / 2


def test_strip_agrees_with_a_walk():
    check_against_twin(lepp.worst_case_strip(60))
