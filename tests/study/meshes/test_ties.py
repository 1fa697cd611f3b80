"""Edges of equal and of nearly equal length: the numbers do not depend on rounding or numbering."""

from pathlib import Path

import meshio
import naive
import numpy as np
import pytest

import lepp
from study.meshes.as_json import as_json
from study.meshes.read import ReadMesh, read_mesh
from study.meshes.survey import survey

INPUTS = Path(__file__).parent / "inputs"


def test_a_fan_whose_edges_are_rounded():
    mesh = read_mesh(INPUTS / "disk_fan_200.off")
    exact = survey(mesh)
    assert (exact.counts.mean, exact.counts.max) == (2.45, 5)
    assert as_json(exact)["ties"] == {
        "n_equal": 0,
        "n_nearly_equal": 200,
        "equal_within": 0.0,
        "nearly_equal_within": 1e-6,
        "mean_if_equal": 2.0,
    }
    assert exact.ties_matter
    equal = survey(mesh, equal_within=1e-6)
    assert (equal.counts.mean, equal.counts.max) == (2.0, 2)
    assert not equal.ties_matter
    ties = as_json(equal)["ties"]
    assert (ties["n_equal"], ties["equal_within"], ties["mean_if_equal"]) == (200, 1e-6, 2.0)


def test_an_equilateral_lattice_however_it_is_numbered():
    histograms = []
    for name in ("rowmajor", "shuffled"):
        surveyed = survey(read_mesh(INPUTS / f"equilateral_{name}.vtu"))
        told = as_json(surveyed)
        histograms.append(told["lepp"]["histogram"])
        on_boundary = (surveyed.triangulation.neighbors < 0).any(axis=1)
        assert np.array_equal(surveyed.paths.sizes, np.where(on_boundary, 1, 2))
        assert told["ties"]["n_equal"] == told["ties"]["n_nearly_equal"] == 1682
        assert told["ties"]["mean_if_equal"] == told["lepp"]["mean"]
        assert told["warnings"] == []
        assert told["lepp"]["end_at_once"] == 1.0
    assert histograms[0] == histograms[1]


def test_a_cylinder_with_fans_at_its_ends():
    exact = survey(read_mesh(INPUTS / "cylinder_500.off"))
    assert (round(exact.counts.mean, 3), exact.counts.max) == (2.287, 6)


def test_meshes_without_ties_are_computed_once(monkeypatch):
    surveyed = _survey_of_random(100)
    monkeypatch.setattr(lepp, "lepp_sizes", None)
    assert surveyed.paths.n_nearly_equal == 0
    assert surveyed.mean_if_equal == surveyed.counts.mean
    assert not surveyed.ties_matter


def _survey_of_random(n, method="delaunay"):
    mesh = lepp.triangulate(np.random.default_rng(n).random((n, 2)), method=method)
    contents = meshio.Mesh(mesh.points, [("triangle", mesh.triangles)])
    m = len(mesh)
    read = ReadMesh(Path("random.vtu"), contents, mesh, np.zeros(m, int), np.arange(m), ())
    return survey(read)


@pytest.mark.parametrize("n", [30, 100])
def test_paths_end_at_once_where_a_longest_edge_is_terminal(n):
    surveyed = _survey_of_random(n)
    mesh = surveyed.triangulation
    paths = naive.Paths(mesh.points.tolist(), mesh.triangles.tolist())
    at_once = [paths.path(t)[1] in paths.longest(t) for t in range(len(mesh))]
    # Where a path leads over two triangles to the boundary, it does not end at once.
    assert sum(at_once) < (surveyed.paths.sizes <= 2).sum()
    assert surveyed.share_at_once == sum(at_once) / len(mesh)
    assert as_json(surveyed)["lepp"]["end_at_once"] == sum(at_once) / len(mesh)


def test_random_meshes_are_compared_only_with_what_is_like_them():
    assert _survey_of_random(1000).is_like_random
    assert not _survey_of_random(100).is_like_random
    assert not survey(read_mesh(INPUTS / "cylinder_500.off")).is_like_random
    assert as_json(_survey_of_random(1000))["random_delaunay"]["pair_share"] == 0.301
    assert as_json(_survey_of_random(100))["random_delaunay"] is None
