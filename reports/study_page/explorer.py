"""Figure 1 as an explorer: a small real triangulation for each view, and the paths in it."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

import lepp
from study.analysis.building import Study, builds
from study.analysis.table import DISTRIBUTION, METHOD, Column, Declaration, Table
from study.design.design import Design
from study.design.sampling import sample_points

N_POINTS = 60

_VIEW = (METHOD, DISTRIBUTION)

EXPLORER_POINTS = Declaration(
    "explorer_points",
    "Points of the explorer",
    (
        *_VIEW,
        Column("point", "Point", "", "int"),
        Column("x", "x", "", "fixed4"),
        Column("y", "y", "", "fixed4"),
    ),
)

EXPLORER_TRIANGLES = Declaration(
    "explorer_triangles",
    "Triangles of the explorer",
    (
        *_VIEW,
        Column("triangle", "Triangle", "", "int"),
        Column("lepp_size", "LEPP size", "triangles", "int"),
        Column("successor", "Next on its path", "triangle", "int"),
        Column("a", "Vertex a", "point", "int"),
        Column("b", "Vertex b", "point", "int"),
        Column("c", "Vertex c", "point", "int"),
        Column("terminal_edge", "Terminal edge"),
        Column("terminal_a", "from", "point", "int"),
        Column("terminal_b", "to", "point", "int"),
    ),
    note=f"{N_POINTS} points drawn with the study's seed; a triangle's path goes on to the next "
    "until two triangles share the longest edge of both, or the boundary is reached (no next).",
)


@builds(EXPLORER_POINTS, EXPLORER_TRIANGLES)
def explorer(study: Study) -> Iterator[Table]:
    """Triangulate one small point set for each view, drawn as those of the study are."""
    points, triangles = [], []
    for method, distribution in study.data.populations:
        triangulation = _triangulation(study.data.design, method, distribution)
        points.append(_with_view(method, distribution, _points(triangulation)))
        triangles.append(_with_view(method, distribution, _triangles(triangulation)))
    yield EXPLORER_POINTS.of_frame(pd.concat(points))
    yield EXPLORER_TRIANGLES.of_frame(pd.concat(triangles))


def _triangulation(design: Design, method: str, distribution: str) -> lepp.Triangulation:
    points = sample_points(
        distribution, N_POINTS, 0, seed=design.seed, correlation=design.correlation
    )
    return lepp.triangulate(points, method=method)


def _points(triangulation: lepp.Triangulation) -> pd.DataFrame:
    x, y = triangulation.points.T
    return pd.DataFrame({"point": np.arange(len(x)), "x": x, "y": y})


def _triangles(triangulation: lepp.Triangulation) -> pd.DataFrame:
    paths = lepp.lepp_paths(triangulation)
    a, b, c = triangulation.triangles.T
    ends = paths.terminal_edges[paths.regions]
    on_boundary = np.zeros(len(paths.terminal_edges), dtype=bool)
    on_boundary[paths.regions[paths.successors < 0]] = True
    successor = pd.array(paths.successors, dtype="Int64")
    successor[paths.successors < 0] = pd.NA
    return pd.DataFrame(
        {
            "triangle": np.arange(len(triangulation)),
            "lepp_size": paths.sizes,
            "successor": successor,
            "a": a,
            "b": b,
            "c": c,
            "terminal_edge": np.where(on_boundary[paths.regions], "boundary", "interior"),
            "terminal_a": ends[:, 0],
            "terminal_b": ends[:, 1],
        }
    )


def _with_view(method: str, distribution: str, frame: pd.DataFrame) -> pd.DataFrame:
    frame.insert(0, "distribution", distribution)
    frame.insert(0, "method", method)
    return frame
