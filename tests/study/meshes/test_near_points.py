"""Meshes that fall apart because coordinates nearly agree, and how they are joined."""

from pathlib import Path

import numpy as np
import pytest

import lepp
from study.meshes.as_json import as_json
from study.meshes.near_points import moved_together
from study.meshes.read import ReadMesh, ReadOptions, read_mesh
from study.meshes.survey import survey

INPUTS = Path(__file__).parent / "inputs"
SURFACE = INPUTS / "stl_nearly_equal.stl"


def test_single_precision_falls_apart_and_is_joined():
    apart = survey(read_mesh(SURFACE))
    assert apart.falls_apart
    assert apart.n_isolated == len(apart.triangulation) == 320
    isolated, near = as_json(apart)["warnings"]
    assert isolated == {"kind": "isolated triangles", "n_triangles": 320}
    assert near == {"kind": "near points", "n_points": 960, "within": 1e-5, "merge_within": 1e-6}

    joined = survey(read_mesh(SURFACE, ReadOptions(merge_within=near["merge_within"])))
    assert joined.counts.mean == 2.425
    assert joined.counts.max == 6
    assert joined.topology.n_pieces == 1
    assert joined.topology.n_boundary_edges == 0
    assert joined.topology.n_points == 162
    assert joined.near_points.count == 0
    assert not joined.falls_apart
    assert any("within 1e-06 of the mesh's extent" in note for note in joined.mesh.notes)


def _soup(size):
    """Triangles that do not touch, an extent of 10 apart, in space."""
    corners = np.array([[0.0, 0, 0], [1, 0, 0.5], [0, 1, 0]])
    points = np.concatenate([size * corners + [10.0 * k, k, 0] for k in range(4)])
    return lepp.Triangulation.from_arrays(points, np.arange(12).reshape(4, 3))


def _surveyed(mesh):
    m = len(mesh)
    return survey(ReadMesh(Path("a.off"), None, mesh, np.zeros(m, int), np.arange(m), ()))


def test_of_a_soup_nothing_is_near():
    surveyed = _surveyed(_soup(1.0))
    assert surveyed.falls_apart
    assert surveyed.near_points.count == 0
    assert [entry["kind"] for entry in as_json(surveyed)["warnings"]] == ["isolated triangles"]


def test_corners_of_small_triangles_are_not_near_each_other():
    surveyed = _surveyed(_soup(1e-5))
    assert surveyed.near_points.count == 0


def test_half_of_the_triangles_isolated_is_not_more_than_half():
    points = np.array([[0.0, 0], [1, 0], [0, 1], [1, 1], [5, 0], [6, 0], [5, 1], [9, 0], [9, 1],
                       [8, 0]])  # fmt: skip
    triangles = np.array([[0, 1, 2], [1, 3, 2], [4, 5, 6], [7, 8, 9]])
    surveyed = _surveyed(lepp.Triangulation.from_arrays(points, triangles))
    assert (surveyed.n_isolated, surveyed.falls_apart) == (2, False)
    three = _surveyed(lepp.Triangulation.from_arrays(points, triangles[[0, 2, 3]]))
    assert three.falls_apart
    assert not _surveyed(lepp.Triangulation.from_arrays(points, triangles[:1])).falls_apart


def test_chains_of_near_points_go_to_the_lowest_index():
    line = np.array([5.0, 0.0, 0.9e-3, 1.8e-3, 3.5e-3, 10.0])  # the extent is 10
    points = np.column_stack((line, np.zeros(6)))
    triangles = np.array([[3, 2, 5], [0, 1, 4]])
    moved = moved_together(points, triangles, 1e-4)
    assert moved[:, 0].tolist() == [5.0, 0.0, 0.0, 0.0, 3.5e-3, 10.0]
    order = np.array([3, 2, 1, 0, 4, 5])
    place = np.argsort(order)
    moved = moved_together(points[order], place[triangles], 1e-4)
    assert moved[:3, 0].tolist() == [1.8e-3] * 3


def test_points_that_no_triangle_uses_join_nothing():
    points = np.array([[0.0, 0], [1, 0], [0, 1], [1.5e-4, 0], [0.8e-4, 0]])
    triangles = np.array([[0, 1, 2], [3, 1, 2]])
    assert np.array_equal(moved_together(points, triangles, 1e-4), points)
    every = np.array([[0, 1, 2], [3, 4, 2]])
    assert moved_together(points, every, 1e-4)[[3, 4]].tolist() == [[0.0, 0.0]] * 2


@pytest.mark.parametrize("within", [0.0, -1e-6, 0.5, float("nan")])
def test_other_distances_are_refused(within):
    with pytest.raises(lepp.InputError, match="give a share above 0 and at most"):
        read_mesh(SURFACE, ReadOptions(merge_within=within))


def test_too_many_near_points_are_refused():
    points = np.random.default_rng(1).random((30_000, 2)) * 1e-3
    points[0] = 1.0
    triangles = np.arange(30_000).reshape(-1, 3)
    with pytest.raises(lepp.InputError, match="merge within less"):
        moved_together(points, triangles, 0.01)
