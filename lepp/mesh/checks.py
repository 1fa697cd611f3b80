"""Whether triangles that are given make a mesh on which paths can be followed.

All that is wrong is found and said at once. What cannot change a path is no problem: points that
no triangle uses, the order of a triangle's vertices, pieces that meet in a point.
"""

from typing import Literal, get_args

import numpy as np

from lepp.errors import InputError, MeshError, MeshProblem, listed
from lepp.geometry.predicates import orientations
from lepp.jit.memory import for_kernels
from lepp.mesh.adjacency import FOLDED, NON_MANIFOLD, TWINNED, link_triangles

RepeatedPoints = Literal["refuse", "merge", "keep"]


def check_indices(triangles: np.ndarray, n_points: int) -> np.ndarray:
    """Return triangles as an int32 array for kernels, or say why they cannot be used.

    Raises
    ------
    InputError
        Wrong shape or dtype, no triangles.
    MeshError
        Indices of points that do not exist.
    """
    array = np.asarray(triangles)
    if array.dtype.kind not in "iu" or array.ndim != 2 or array.shape[1] != 3:
        raise InputError(
            f"The triangles are an array of shape {array.shape} and dtype {array.dtype}: "
            "give integers, in an array of shape (m, 3)."
        )
    if len(array) == 0:
        raise InputError("There are no triangles: give at least one.")
    bad = np.flatnonzero(((array < 0) | (array >= n_points)).any(axis=1))
    if len(bad):
        what = f"Triangles {listed(bad)} have vertices that are not among the {n_points} points"
        raise MeshError(
            [MeshProblem("indices", bad, what, f"indices run from 0 to {n_points - 1}")]
        )
    return for_kernels(array, np.int32)


def sound_mesh(
    points: np.ndarray, triangles: np.ndarray, repeated_points: RepeatedPoints
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Orient and link triangles, or say everything that is wrong with them.

    Parameters
    ----------
    points : (n, 2) or (n, 3) float64 ndarray
        Finite.
    triangles : (m, 3) int32 ndarray
        Indices of points.
    repeated_points : {"refuse", "merge", "keep"}
        What to do about points with the coordinates of another.

    Returns
    -------
    triangles : (m, 3) int32 ndarray
        Counter-clockwise in the plane, as given in space.
    neighbors : (m, 3) int32 ndarray
    repeated : (k, 2) int32 ndarray
        The points that were merged, and those that they repeat.

    Raises
    ------
    MeshError
        All that is wrong.
    InputError
        An unknown word in place of "refuse", "merge" or "keep".
    """
    if repeated_points not in get_args(RepeatedPoints):
        known = ", ".join(map(repr, get_args(RepeatedPoints)))
        raise InputError(f"repeated_points is {repeated_points!r}: use one of {known}.")
    problems = []
    repeated = np.empty((0, 2), np.int32)
    if repeated_points != "keep":
        repeated = _repeated_points(points, triangles)
    if len(repeated) and repeated_points == "refuse":
        problems.append(_not_joined(repeated))
    elif len(repeated):
        first = np.arange(len(points), dtype=np.int32)
        first[repeated[:, 0]] = repeated[:, 1]
        triangles = first[triangles]
    a, b, c = triangles.T
    collapsed = (a == b) | (b == c) | (c == a)
    flat, clockwise = _turns(points, triangles)
    good = ~(flat | collapsed)
    problems += _areas(collapsed, flat & ~collapsed)
    if clockwise.any():
        triangles = np.where(clockwise[:, None], triangles[:, [0, 2, 1]], triangles)
    neighbors, links = _linked(points, triangles, good, clockwise)
    problems += links
    if problems:
        raise MeshError(problems)
    return triangles, neighbors, repeated


def _repeated_points(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the used points that have the coordinates of an earlier one, and that one."""
    used = np.zeros(len(points), bool)
    used[triangles] = True
    ids = np.flatnonzero(used)
    order = ids[np.lexsort(points[ids].T)]  # stable: equal points stay in the order of their ids
    repeats = np.zeros(len(order), bool)
    repeats[1:] = (points[order[1:]] == points[order[:-1]]).all(axis=1)
    first = order[np.maximum.accumulate(np.where(repeats, 0, np.arange(len(order))))]
    pairs = np.column_stack((order, first))[repeats]
    return pairs[np.argsort(pairs[:, 0])].astype(np.int32)


def _turns(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which triangles have no area, and which turn clockwise (in space: none)."""
    if points.shape[1] == 2:
        turns = orientations(points, triangles)
        return turns == 0, turns < 0
    flat = np.ones(len(triangles), bool)
    for axes in ((0, 1), (1, 2), (2, 0)):  # no area in space: none in any of the projections
        plane = np.ascontiguousarray(points[:, axes])
        flat &= orientations(plane, triangles) == 0
    return flat, np.zeros(len(triangles), bool)


def _linked(
    points: np.ndarray, triangles: np.ndarray, good: np.ndarray, clockwise: np.ndarray
) -> tuple[np.ndarray, list[MeshProblem]]:
    """Return the neighbours of the good triangles, and what is wrong between them."""
    problems = []
    ids = np.flatnonzero(good)
    neighbors, flags = _link(points, triangles, ids)
    if (flags & (NON_MANIFOLD | TWINNED)).any():
        copies = ids[_copies(triangles[ids])]
        if len(copies):
            what = f"Triangles {listed(copies)} have the same three vertices as an earlier one"
            problems.append(MeshProblem("copies", copies, what, "leave them out"))
            ids = np.setdiff1d(ids, copies)
            neighbors, flags = _link(points, triangles, ids)
    bad = ids[(flags & NON_MANIFOLD) > 0]
    if len(bad):
        what = (
            f"Triangles {listed(bad)} share an edge with two or more others, so that a path across "
            "it has no single next triangle"
        )
        remedy = "take triangles away until each edge has at most two, or split the mesh there"
        problems.append(MeshProblem("non-manifold edges", bad, what, remedy))
    if points.shape[1] == 2:
        problems += _folds(ids[(flags & FOLDED) > 0], clockwise)
    return neighbors, problems


def _link(
    points: np.ndarray, triangles: np.ndarray, ids: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    chosen = triangles if len(ids) == len(triangles) else triangles[ids]
    chosen = np.ascontiguousarray(chosen)
    neighbors = np.empty_like(chosen)
    return neighbors, link_triangles(chosen, len(points), neighbors)


def _copies(triangles: np.ndarray) -> np.ndarray:
    """Return which triangles have the vertices of an earlier one."""
    vertices = np.sort(triangles, axis=1)
    order = np.lexsort(vertices.T)
    same = (vertices[order[1:]] == vertices[order[:-1]]).all(axis=1)
    return np.sort(order[1:][same])


def _not_joined(repeated: np.ndarray) -> MeshProblem:
    points = repeated[:, 0]
    what = (
        f"Points {listed(points)} have exactly the coordinates of another point (the first those "
        f"of point {repeated[0, 1]}), so that the triangles that meet there are not joined"
    )
    remedy = 'give repeated_points="merge" to join them, or "keep" if the mesh is cut there'
    return MeshProblem("repeated points", points, what, remedy)


def _areas(collapsed: np.ndarray, flat: np.ndarray) -> list[MeshProblem]:
    problems = []
    if collapsed.any():
        ids = np.flatnonzero(collapsed)
        what = f"Triangles {listed(ids)} have the same point twice, so no area"
        problems.append(MeshProblem("collapsed triangles", ids, what, "leave them out"))
    if flat.any():
        ids = np.flatnonzero(flat)
        what = f"Triangles {listed(ids)} have no area: their vertices lie on one line"
        remedy = (
            "move a vertex; leaving them out would cut the mesh, as their neighbours on the long "
            "side and on the two short sides do not meet"
        )
        problems.append(MeshProblem("flat triangles", ids, what, remedy))
    return problems


def _folds(folded: np.ndarray, clockwise: np.ndarray) -> list[MeshProblem]:
    """Say which triangles lie over their neighbours in the plane, as one turned over does."""
    if len(folded) == 0:
        return []
    fewer = np.flatnonzero(clockwise if 2 * clockwise.sum() <= len(clockwise) else ~clockwise)
    # Where triangles list their vertices in mixed orders, the order does not tell which is wrong.
    if len(fewer) and np.isin(fewer, folded).all():
        what = (
            f"Triangles {listed(fewer)} are inverted: they turn the other way round than the "
            "rest and lie over their neighbours"
        )
        return [MeshProblem("inverted triangles", fewer, what, "move their vertices back")]
    what = f"Triangles {listed(folded)} lie over a neighbour, on the same side of their common edge"
    return [MeshProblem("folded triangles", folded, what, "unfold the mesh there")]
