"""Sentences about a mesh, held against numbers counted anew."""

from pathlib import Path

import numpy as np
import pytest

import lepp
from reports.mesh_page import findings
from study.meshes.read import ReadMesh
from study.meshes.survey import Survey, survey


def _survey(mesh: lepp.Triangulation, **options: float) -> Survey:
    m = len(mesh)
    read = ReadMesh(Path("a.vtu"), None, mesh, np.zeros(m, int), np.arange(m), ())
    return survey(read, **options)


def _random(n: int, method: str) -> Survey:
    points = np.random.default_rng(n).random((n, 2))
    return _survey(lepp.triangulate(points, method=method))  # type: ignore[arg-type] # a name


def _values(surveyed: Survey) -> dict[str, tuple[str, str]]:
    return {tile.label: (tile.value, tile.context) for tile in findings.tiles(surveyed)}


@pytest.mark.parametrize("n", [30, 100])
def test_the_share_that_ends_at_once_is_counted(n: int) -> None:
    surveyed = _random(n, "delaunay")
    paths = surveyed.paths
    at_once = 0
    for t, size in enumerate(paths.sizes):
        s = paths.successors[t]
        at_once += s < 0 or (size == 2 and paths.successors[s] == t)
    share = f"{100 * at_once / len(paths.sizes):.1f}\u00a0%"
    assert f" {share} of the paths end at once" in findings.spread(surveyed)
    assert _values(surveyed)["Paths that end at once"][0] == share


def test_random_delaunay_is_mentioned_where_it_helps() -> None:
    large, small = _random(2000, "delaunay"), _random(200, "delaunay")
    sentence = (
        "In Delaunay triangulations of 200,000 uniform random points, which this project's study "
        "measures, the share is 30.1\u00a0% and the region has 6.65 triangles."
    )
    assert sentence in findings.regions(large)
    assert "Delaunay" not in findings.regions(small)
    label = "Triangles in terminal pairs"
    assert _values(large)[label][1] == "30.1\u00a0% in Delaunay meshes of random points"
    assert "Delaunay" not in str(_values(small))


def test_theorem_2_by_its_premise_and_by_its_bounds() -> None:
    below = _random(2000, "delaunay")
    assert below.p is not None
    assert below.p < 1 / 3
    assert findings.theory(below).endswith(
        "is not met, but its bounds (a mean from 2 to 4, a standard deviation of at most 2.45) "
        "hold all the same."
    )
    above = _random(2000, "incremental")
    assert findings.theory(above).endswith("is met, and its bounds (a mean from 2 to 4, a "
                                           "standard deviation of at most 2.45) hold.")  # fmt: skip
    assert findings._theorem_2(lepp.LeppCounts.from_sizes(np.array([2, 9, 9])), 0.2).endswith(
        "is not met, and its bounds (a mean from 2 to 4, a standard deviation of at most 2.45) do "
        "not hold."
    )
    assert ", but its bounds" in findings._theorem_2(
        lepp.LeppCounts.from_sizes(np.array([1, 1])), 0.5
    )


def test_ties_are_counted_in_words() -> None:
    square = lepp.Triangulation.from_arrays(
        np.array([[0, 0], [2, 0], [2, 1], [0, 1.0], [4, 0.5]]), [[0, 1, 2], [0, 2, 3], [1, 4, 2]]
    )
    one = findings.ties(_survey(square))
    assert one.startswith("1 triangle has more than one longest edge; the two longest edges of 1 ")
    assert findings.ties(_random(100, "delaunay")) == (
        "No triangle has two equal longest edges, or nearly equal ones."
    )


def test_numbers_that_hanging_nodes_falsify_say_so() -> None:
    points = np.array([[0, 0], [2, 0], [2, 2], [0, 2], [4, 0], [4, 2], [2, 1.0]])
    left, right = [[0, 1, 2], [0, 2, 3]], [[1, 4, 6], [4, 5, 6], [6, 5, 2]]
    hanging = dict(findings.facts(_survey(lepp.Triangulation.from_arrays(points, left + right))))
    cut = " (as cut at the hanging nodes)"
    assert hanging["Pieces"] == f"2, between which no path goes{cut}"
    assert hanging["Holes"] == f"1{cut}"
    assert hanging["Boundary"].endswith(cut)
    assert "hanging" not in hanging["Triangles"]
    whole = findings.facts(_survey(lepp.Triangulation.from_arrays(points[:4], left)))
    assert "hanging" not in str(whole)
    assert dict(whole)["Holes"] == "0"
