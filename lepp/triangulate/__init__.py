"""The ways to triangulate a point set."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lepp.errors import InputError
from lepp.mesh.triangulation import Triangulation, check_points
from lepp.triangulate.delaunay.delaunay import delaunay
from lepp.triangulate.plain.incremental import incremental

Built = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray | None]
"""Triangles, neighbors and repeated points as `Triangulation` has them; and, or None, the ranks of
`lepp.geometry.lengths`."""


@dataclass(frozen=True)
class Method:
    """A way to triangulate a point set.

    Attributes
    ----------
    name : str
        For `triangulate`, and in designs and tables.
    title : str
        As a heading has it.
    word : str
        As an adjective in a sentence: "the … triangulation".
    description : str
        What it does, as a clause.
    build : callable
        Takes an (n, 2) float64 array of finite points, C-contiguous; returns `Built`, with no
        triangles where all points lie on one line.
    bytes_per_point : int
        Memory that the mesh and its paths take at a time, as measured for 4 million points.
    """

    name: str
    title: str
    word: str
    description: str
    build: Callable[[np.ndarray], Built]
    bytes_per_point: int = 160


METHODS: dict[str, Method] = {
    method.name: method
    for method in (
        Method(
            "incremental",
            "Plain insertion",
            "plain insertion",
            "inserts the points as they come and never flips an edge",
            incremental,
            145,
        ),
        Method(
            "delaunay",
            "Delaunay",
            "Delaunay",
            "makes triangles that are as far from thin as the points allow",
            delaunay,
            162,
        ),
    )
}
"""The ways to triangulate a point set, by name."""


def triangulate(points: np.ndarray, method: str = "incremental") -> Triangulation:
    """Triangulate a set of points in the plane.

    Parameters
    ----------
    points : (n, 2) array_like of float
        Finite; at least three that are not on one line. A point that repeats an earlier one is left
        out and listed in `Triangulation.repeated`.
    method : str
        One of `METHODS`. "incremental" inserts the points in the given order and flips no edge: a
        point in a triangle splits it in three, one on an edge splits the triangles beside it, one
        outside the hull is joined to every hull vertex that it sees. "delaunay" is the Delaunay
        triangulation.

    Returns
    -------
    Triangulation
        Of the convex hull: m = 2 n - 2 - h triangles for n distinct points, h of them on the hull.
        The same for the same points, always. It has a copy of the points.

    Raises
    ------
    InputError
        Points that cannot be triangulated, or an unknown method.
    """
    if method not in METHODS:
        raise InputError(f"There is no method {method!r}: use one of {', '.join(METHODS)}.")
    given, points = points, check_points(points)
    triangles, neighbors, repeated, ranks = METHODS[method].build(points)
    if len(triangles) == 0:
        raise InputError("All points lie on one line: no triangle has an area.")
    if isinstance(given, np.ndarray) and np.may_share_memory(given, points):
        points = points.copy()  # the ranks are those of these coordinates, whatever becomes of them
    mesh = Triangulation(points, triangles, neighbors, repeated)
    object.__setattr__(mesh, "_edge_ranks", ranks)
    return mesh
