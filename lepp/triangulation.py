"""Triangulations: points, triangles and who borders on whom."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from lepp.adjacency import (
    DUPLICATE_EDGE,
    INCONSISTENT,
    NON_MANIFOLD,
    link_triangles,
)
from lepp.delaunay import delaunay
from lepp.errors import InputError
from lepp.incremental import incremental
from lepp.predicates import orientations

METHODS = ("incremental", "delaunay")
"""The ways to triangulate a point set, for `triangulate`."""

_MAX_POINTS = (2**31 - 1) // 8  # half-edges are numbered in 32 bits


def _no_repeated() -> np.ndarray:
    return np.empty((0, 2), np.int32)


@dataclass(frozen=True, eq=False)
class Triangulation:
    """A triangulated surface in the conventions of `scipy.spatial.Delaunay`.

    Attributes
    ----------
    points : (n, 2) or (n, 3) float64 ndarray
        Coordinates, in the caller's unit of length.
    triangles : (m, 3) int32 ndarray
        Indices of each triangle's vertices; counter-clockwise in the plane.
    neighbors : (m, 3) int32 ndarray
        Neighbour k of a triangle is across from its vertex k; -1 at the boundary.
    repeated : (k, 2) int32 ndarray
        For each point that was left out because it repeats another: its index, and the other's.
    ranks : (m,) uint8 ndarray or None
        What `lepp.edges.edge_ranks` would find, where the method of triangulation has found it.
    """

    points: np.ndarray
    triangles: np.ndarray
    neighbors: np.ndarray
    repeated: np.ndarray = field(default_factory=_no_repeated)
    ranks: np.ndarray | None = None

    def __len__(self) -> int:
        return len(self.triangles)

    def __repr__(self) -> str:
        return f"<Triangulation: {len(self.points)} points, {len(self)} triangles>"

    @property
    def n_hull(self) -> int:
        """Number of boundary edges: for a point set, of the points on its hull."""
        return int(np.count_nonzero(self.neighbors < 0))

    @classmethod
    def from_arrays(cls, points: np.ndarray, triangles: np.ndarray) -> "Triangulation":
        """Build the neighbours of given triangles, and check them.

        Parameters
        ----------
        points : (n, 2) or (n, 3) array_like of float
            Finite coordinates, of a mesh in the plane or of a surface in space.
        triangles : (m, 3) array_like of int
            Vertices of each triangle. In the plane all must turn the same way round (if clockwise,
            they are turned); in space, neighbours must be oriented alike.

        Raises
        ------
        InputError
            Indices out of range, a triangle of no area or turned over, an edge with more than two
            triangles: says which.
        """
        points = check_points(points, dimensions=(2, 3))
        triangles = _check_indices(triangles, len(points))
        if points.shape[1] == 2:
            triangles = _counter_clockwise(points, triangles)
        else:
            _check_not_flat(points, triangles)
        neighbors = np.empty_like(triangles)
        problem, bad = link_triangles(triangles, len(points), neighbors)
        if problem:
            raise InputError(_PROBLEMS[problem].format(_listed(bad)))
        return cls(points, triangles, neighbors)


_PROBLEMS = {
    NON_MANIFOLD: "Triangles {} share an edge with two or more others, so that a path across it "
    "has no single next triangle: take them out or split the mesh there.",
    INCONSISTENT: "Triangles {} run along an edge in the same direction as their neighbour, so one "
    "of the two is turned over: orient all triangles alike.",
    DUPLICATE_EDGE: "Triangles {} share all their vertices with another: remove the duplicates.",
}


def check_points(points: np.ndarray, dimensions: Sequence[int] = (2,)) -> np.ndarray:
    """Return points as a C-contiguous float64 array, or say why they cannot be used.

    Raises
    ------
    InputError
        Wrong shape or dtype, fewer than three points, or coordinates that are not finite.
    """
    try:
        array = np.asarray(points)
    except ValueError as error:
        raise InputError(f"The points do not form an array ({error}).") from None
    wanted = " or ".join(f"(n, {d})" for d in dimensions)
    if array.dtype.kind not in "fiu":
        raise InputError(
            f"The points are of dtype {array.dtype}: give real numbers, of shape {wanted}."
        )
    if array.ndim != 2 or array.shape[1] not in dimensions:
        raise InputError(f"The points have shape {array.shape}: give an array of shape {wanted}.")
    if len(array) < 3:
        raise InputError(f"{len(array)} points make no triangle: give at least three.")
    if len(array) > _MAX_POINTS:
        raise InputError(f"{len(array)} points are more than one mesh can hold ({_MAX_POINTS}).")
    array = np.ascontiguousarray(array, np.float64)
    if not np.isfinite(array).all():
        bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
        raise InputError(
            f"Points {_listed(bad)} have coordinates that are not finite: remove them."
        )
    return array


def triangulate(points: np.ndarray, method: str = "incremental") -> Triangulation:
    """Triangulate a set of points in the plane.

    Parameters
    ----------
    points : (n, 2) array_like of float
        Finite; at least three that are not on one line. A point that repeats an earlier one is left
        out and listed in `Triangulation.repeated`.
    method : {"incremental", "delaunay"}
        "incremental" inserts the points in the given order and flips no edge: a point in a triangle
        splits it in three, one on an edge splits the triangles beside it, one outside the hull is
        joined to every hull vertex that it sees. "delaunay" is the Delaunay triangulation.

    Returns
    -------
    Triangulation
        Of the convex hull: m = 2 n - 2 - h triangles for n distinct points, h of them on the hull.
        The same for the same points, always.

    Raises
    ------
    InputError
        Points that cannot be triangulated, or an unknown method.
    """
    points = check_points(points)
    if method not in METHODS:
        raise InputError(f"There is no method {method!r}: use one of {', '.join(METHODS)}.")
    build = incremental if method == "incremental" else delaunay
    triangles, neighbors, repeated, ranks = build(points)
    if len(triangles) == 0:
        raise InputError("All points lie on one line: no triangle has an area.")
    return Triangulation(points, triangles, neighbors, repeated, ranks)


def _check_indices(triangles: np.ndarray, n_points: int) -> np.ndarray:
    array = np.asarray(triangles)
    if array.dtype.kind not in "iu" or array.ndim != 2 or array.shape[1] != 3:
        raise InputError(
            f"The triangles are an array of shape {array.shape} and dtype {array.dtype}: "
            "give integers, in an array of shape (m, 3)."
        )
    if len(array) == 0:
        raise InputError("There are no triangles: give at least one.")
    outside = ((array < 0) | (array >= n_points)).any(axis=1)
    if outside.any():
        raise InputError(
            f"Triangles {_listed(np.flatnonzero(outside))} have vertices that are not among the "
            f"{n_points} points: indices run from 0 to {n_points - 1}."
        )
    return np.ascontiguousarray(array, np.int32)


def _counter_clockwise(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the triangles all counter-clockwise, or say which are flat or turned over."""
    turns = orientations(points, triangles)
    if (turns == 0).any():
        raise InputError(_flat(np.flatnonzero(turns == 0)))
    clockwise = turns < 0
    if clockwise.all():
        return np.ascontiguousarray(triangles[:, [0, 2, 1]])
    if clockwise.any():
        fewer = clockwise if 2 * clockwise.sum() <= len(turns) else ~clockwise
        raise InputError(
            f"Triangles {_listed(np.flatnonzero(fewer))} turn the other way round than the rest: "
            "the mesh is folded there, or their vertices are in the wrong order."
        )
    return triangles


def _check_not_flat(points: np.ndarray, triangles: np.ndarray) -> None:
    """Refuse triangles of no area in space: those that are flat in all three projections."""
    flat = np.ones(len(triangles), bool)
    for axes in ((0, 1), (1, 2), (2, 0)):
        plane = np.ascontiguousarray(points[:, axes])
        flat &= orientations(plane, triangles) == 0
    if flat.any():
        raise InputError(_flat(np.flatnonzero(flat)))


def _flat(bad: np.ndarray) -> str:
    return f"Triangles {_listed(bad)} have no area: remove them."


def _listed(indices: np.ndarray, most: int = 5) -> str:
    """Return the first few of some indices, and how many there are."""
    first = ", ".join(str(i) for i in indices[:most])
    return first if len(indices) <= most else f"{first}, … ({len(indices)} in all)"
