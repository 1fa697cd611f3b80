import numpy as np
import pytest

import lepp

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


@pytest.mark.parametrize(
    ("points", "sentence"),
    [
        ([[0, 0], [1, 0], [np.nan, 1], [0, 1]], "Points 2 have coordinates that are not finite"),
        ([[0, 0], [1, 0], [np.inf, 1]], "Points 2 have coordinates that are not finite"),
        (np.full((9, 2), np.nan), r"0, 1, 2, 3, 4, … \(9 in all\)"),
        ([[0, 0], [1, 0]], "2 points make no triangle"),
        (np.empty((0, 2)), "0 points make no triangle"),
        ([[0, 0], [1, 1], [2, 2], [5, 5]], "one line"),
        ([[1, 1], [1, 1], [1, 1]], "one line"),
        ([0, 1, 2], r"shape \(3,\)"),
        (np.zeros((5, 3)), r"shape \(5, 3\)"),
        (np.zeros((5, 2), complex), "complex"),
        ([["a", "b"]] * 3, "real numbers"),
        ([[0, 0], [1], [2, 2]], "do not form an array"),
        (None, "real numbers"),
    ],
)
def test_points_that_cannot_be_triangulated(points, sentence):
    with pytest.raises(lepp.InputError, match=sentence):
        lepp.triangulate(points)


def test_unknown_method_names_the_known_ones():
    with pytest.raises(lepp.InputError, match="'voronoi': use one of incremental"):
        lepp.triangulate(SQUARE, method="voronoi")


def test_other_dtypes_and_layouts():
    expected = lepp.triangulate(SQUARE).triangles
    for points in (
        SQUARE.astype(int),
        SQUARE.astype(np.float32),
        np.asfortranarray(SQUARE),
        SQUARE.tolist(),
    ):
        ours = lepp.triangulate(points)
        assert np.array_equal(ours.triangles, expected)
        assert ours.points.dtype == np.float64
    assert expected.dtype == lepp.triangulate(SQUARE).neighbors.dtype == np.int32


def test_from_arrays_links_neighbours():
    mesh = lepp.Triangulation.from_arrays(SQUARE, [[0, 1, 2], [0, 2, 3]])
    assert mesh.neighbors.tolist() == [[-1, 1, -1], [-1, -1, 0]]
    assert mesh.n_hull == 4
    assert len(mesh) == 2


def test_clockwise_meshes_are_turned():
    mesh = lepp.Triangulation.from_arrays(SQUARE, [[0, 2, 1], [0, 3, 2]])
    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    ("triangles", "sentence"),
    [
        ([[0, 1, 2], [0, 2, 2]], "Triangles 1 have the same point twice, so no area"),
        ([[0, 1, 4]], "Triangles 0 have vertices that are not among the 4 points"),
        ([[0, 1, -1]], "indices run from 0 to 3"),
        ([[0, 1, 2], [0, 1, 2]], "Triangles 1 have the same three vertices as an earlier one"),
        ([[0, 1, 2], [0, 2, 3], [0, 1, 3]], "Triangles 0, 1, 2 lie over a neighbour"),
        (np.empty((0, 3), int), "no triangles"),
        ([[0, 1]], r"shape \(1, 2\)"),
        ([[0.5, 1, 2]], "integers"),
    ],
)
def test_meshes_that_cannot_be_used(triangles, sentence):
    with pytest.raises(lepp.InputError, match=sentence):
        lepp.Triangulation.from_arrays(SQUARE, triangles)


def test_surfaces_that_cannot_be_used():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0]], float)
    with pytest.raises(lepp.InputError, match="Triangles 0, 1, 2 share an edge with two or more"):
        lepp.Triangulation.from_arrays(points, [[0, 1, 2], [1, 0, 3], [0, 1, 4]])
    with pytest.raises(lepp.MeshError, match="Triangles 1 have the same three vertices"):
        lepp.Triangulation.from_arrays(points, [[0, 1, 2], [1, 0, 2]])
    with pytest.raises(lepp.InputError, match="no area"):
        lepp.Triangulation.from_arrays(np.array([[0, 0, 0], [1, 1, 1], [2, 2, 2.0]]), [[0, 1, 2]])


def test_closed_surface_has_no_boundary():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    mesh = lepp.Triangulation.from_arrays(points, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    assert mesh.n_hull == 0
    assert (lepp.lepp_sizes(mesh) >= 2).all()
