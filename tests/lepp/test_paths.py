import naive
import numpy as np
import pytest
from hypothesis import given, settings
from point_sets import nasty_points, reference_points

import lepp


def check_against_twin(triangulation):
    points = triangulation.points.tolist()
    triangles = [tuple(t) for t in triangulation.triangles.tolist()]
    paths = lepp.lepp_paths(triangulation)
    walked = [naive.path(points, triangles, t) for t in range(len(triangles))]
    assert paths.sizes.tolist() == [len(w) for w in walked]
    assert lepp.lepp_sizes(triangulation).tolist() == paths.sizes.tolist()
    types = [naive.neighbor_type(points, triangles, t) for t in range(len(triangles))]
    assert paths.neighbor_types.tolist() == types
    for t, w in enumerate(walked):
        terminal = naive.longest_edge(points, triangles[w[-1]])
        assert tuple(sorted(paths.terminal_edges[paths.regions[t]].tolist())) == terminal
    assert len({tuple(sorted(e)) for e in paths.terminal_edges.tolist()}) == len(
        paths.terminal_edges
    )


@settings(max_examples=120, deadline=None)
@given(nasty_points(max_size=16))
def test_paths_are_those_of_a_walk(points):
    try:
        triangulation = lepp.triangulate(points)
    except lepp.InputError:
        return  # on one line
    # The twin squares lengths as they are: where that over- or underflows, compare a scaled copy.
    extent = np.ptp(points / 4, axis=0).max()
    scaled = np.ldexp(points, -int(np.frexp(extent)[1]))
    check_against_twin(lepp.Triangulation(scaled, triangulation.triangles, triangulation.neighbors))
    ours = lepp.lepp_sizes(triangulation)
    assert np.array_equal(
        ours,
        lepp.lepp_sizes(
            lepp.Triangulation(scaled, triangulation.triangles, triangulation.neighbors)
        ),
    )


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
    sizes = lepp.lepp_sizes(lepp.theory.worst_case_strip(n))
    assert sizes.tolist() == list(range(n, 0, -1))
    assert sizes.mean() == (n + 1) / 2


def test_strip_agrees_with_a_walk():
    check_against_twin(lepp.theory.worst_case_strip(60))
