"""Points that lie inside an edge of another triangle: found exactly, and only these."""

from fractions import Fraction
from pathlib import Path

import meshio
import numpy as np
import pytest
from shipped_meshes import MESHES

import lepp
from study.meshes import hanging_nodes as module
from study.meshes.as_json import as_json
from study.meshes.hanging_nodes import hanging_nodes
from study.meshes.read import ReadOptions, read_mesh
from study.meshes.survey import survey

INPUTS = Path(__file__).parent / "inputs"


def twin(mesh):
    """Every boundary point against every boundary edge, in rational arithmetic."""
    points = [[Fraction(x) for x in point] for point in mesh.points.tolist()]
    edges = [
        [mesh.triangles[t][(k + 1) % 3], mesh.triangles[t][(k + 2) % 3]]
        for t, k in zip(*np.nonzero(mesh.neighbors < 0), strict=True)
    ]
    hanging = set()
    for a, b in edges:
        u = [y - x for x, y in zip(points[a], points[b], strict=True)]
        for p in {vertex for edge in edges for vertex in edge}:
            v = [y - x for x, y in zip(points[a], points[p], strict=True)]
            along = sum(x * y for x, y in zip(u, v, strict=True))
            square = sum(x * x for x in u)
            if 0 < along < square and all(
                square * y == along * x for x, y in zip(u, v, strict=True)
            ):
                hanging.add(int(p))
    return sorted(hanging)


def test_a_hanging_node_in_a_file():
    surveyed = survey(read_mesh(INPUTS / "hanging_node.off"))
    assert surveyed.hanging_nodes.tolist() == [3]
    assert as_json(surveyed)["warnings"] == [
        {"kind": "hanging nodes", "n_points": 1, "points": [3]}
    ]


def _quads(tmp_path, lift):
    """A square of two by two, and on its right a strip of small ones: every second node hangs."""
    points, quads = [], []

    def vertex(x, y):
        point = [x, y, lift * (x + 2 * y)]
        if point not in points:
            points.append(point)
        return points.index(point)

    for x, y, h in [(0, 0, 2), (0, 2, 2), *((2 + i, j, 1) for i in range(2) for j in range(4))]:
        quads.append([vertex(x, y), vertex(x + h, y), vertex(x + h, y + h), vertex(x, y + h)])
    path = tmp_path / "quads.vtu"
    meshio.write(path, meshio.Mesh(np.array(points, float), [("quad", quads)]))
    return path, sorted(points.index([2, y, lift * (2 + 2 * y)]) for y in (1, 3))


@pytest.mark.parametrize("lift", [0, 1])
def test_a_mesh_of_quads_of_two_sizes(tmp_path, lift):
    path, expected = _quads(tmp_path, lift)
    surveyed = survey(read_mesh(path, ReadOptions(split_quads=True)))
    assert surveyed.triangulation.points.shape[1] == 2 + lift
    assert surveyed.hanging_nodes.tolist() == expected


@pytest.mark.parametrize("name", MESHES)
def test_conforming_meshes_have_none(name):
    assert len(hanging_nodes(lepp.Triangulation.from_arrays(*MESHES[name]))) == 0


@pytest.mark.parametrize("lift", [False, True])
@pytest.mark.parametrize("candidates", [5, 2_000_000])
def test_random_slits_are_the_twins(monkeypatch, lift, candidates):
    monkeypatch.setattr(module, "_CANDIDATES", candidates)
    n_hanging = 0
    for seed in range(12):
        rng = np.random.default_rng(seed)
        # Rows of triangles between lines at multiples of a third, that meet at random places.
        rows, points, triangles = 4, [], []
        for row in range(rows):
            low = np.unique(rng.integers(0, 30, 6))
            high = np.unique(rng.integers(0, 30, 6))
            first = len(points)
            points += [[x / 3, row / 3] for x in low] + [[x / 3, (row + 1) / 3] for x in high]
            n = min(len(low), len(high)) - 1
            triangles += [[first + k, first + k + 1, first + len(low) + k] for k in range(n)]
        points = np.array(points)
        if lift:
            points = np.column_stack((points, points[:, 1] / 8))
        mesh = lepp.Triangulation.from_arrays(points, triangles, repeated_points="merge")
        expected = twin(mesh)
        assert hanging_nodes(mesh).tolist() == expected
        n_hanging += len(expected)
    assert n_hanging > 20


def test_a_point_beside_an_edge_does_not_hang():
    points = np.array([[0, 0], [2, 0], [1, 1.5], [1, -(2.0**-50)], [1, -1.5]])
    triangles = [[0, 1, 2], [0, 4, 3], [3, 4, 1]]
    assert len(hanging_nodes(lepp.Triangulation.from_arrays(points, triangles))) == 0
    points[3, 1] = 0.0
    assert hanging_nodes(lepp.Triangulation.from_arrays(points, triangles)).tolist() == [3]


def test_a_point_above_an_edge_does_not_hang():
    points = np.array([[0, 0, 0], [2, 0, 2], [1, 1.5, 1], [1, 0, 1 + 2.0**-50], [1, -1.5, 1]])
    mesh = lepp.Triangulation.from_arrays(points, [[0, 1, 2], [0, 4, 3], [3, 4, 1]])
    assert len(hanging_nodes(mesh)) == 0
    points[3, 2] = 1.0
    mesh = lepp.Triangulation.from_arrays(points, [[0, 1, 2], [0, 4, 3], [3, 4, 1]])
    assert hanging_nodes(mesh).tolist() == [3]


def test_a_point_on_the_line_beyond_an_edge_does_not_hang():
    points = np.array([[0, 0], [1, 0], [0, 1], [1 + 2.0**-40, 0], [2, 0], [2, 1]])
    mesh = lepp.Triangulation.from_arrays(points, [[0, 1, 2], [3, 4, 5]])
    assert len(hanging_nodes(mesh)) == 0


@pytest.mark.parametrize("scale", [1e-300, 1e300])
def test_at_every_magnitude(scale):
    points = scale * np.array([[0, 0], [2, 0], [1, 1.5], [1, 0], [1, -1.5]])
    mesh = lepp.Triangulation.from_arrays(points, [[0, 1, 2], [0, 4, 3], [3, 4, 1]])
    assert hanging_nodes(mesh).tolist() == [3]


def test_a_long_edge_beside_thousands_of_short_ones():
    n = 4096
    x = np.arange(n + 1.0)
    low = np.column_stack((x, np.zeros(n + 1)))
    points = np.vstack((low, low + np.array([0.5, -1.0]), [[0.0, n], [n, n]]))
    k = np.arange(n)
    fine = np.column_stack((k, k + 1, n + 1 + k))
    coarse = [[0, n, 2 * n + 2], [n, 2 * n + 3, 2 * n + 2]]
    mesh = lepp.Triangulation.from_arrays(points, np.vstack((fine, coarse)))
    assert hanging_nodes(mesh).tolist() == list(range(1, n))
