"""Whether triangles that are given make a mesh on which paths can be followed.

All that is wrong is reported at once. What cannot change a path is no problem: points that
no triangle uses, the order of a triangle's vertices, pieces that meet in a point.
"""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from lepp.errors import InputError, MeshError, MeshProblem, Remedy, listed
from lepp.geometry.predicates import orientations
from lepp.jit.memory import for_kernels
from lepp.mesh.adjacency import FOLDED, NON_MANIFOLD, TWINNED, link_triangles

RepeatedPoints = Literal["refuse", "merge", "keep"]


@dataclass(frozen=True, eq=False)
class SoundMesh:
    """Triangles on which paths can be followed.

    Attributes
    ----------
    triangles : (m, 3) int32 ndarray
        Counter-clockwise in the plane, as given in space.
    neighbors : (m, 3) int32 ndarray
    repeated : (k, 2) int32 ndarray
        The points that were merged, and those that they repeat.
    clockwise : (m,) bool ndarray
        The triangles of the plane that were given clockwise.
    """

    triangles: np.ndarray
    neighbors: np.ndarray
    repeated: np.ndarray
    clockwise: np.ndarray


def refuse_masked(array: np.ndarray, what: str) -> None:
    """Refuse an array of which some is masked: NumPy would drop the mask in silence.

    Parameters
    ----------
    array : ndarray
    what : str
        What its rows are, as a message begins: "Points".

    Raises
    ------
    InputError
    """
    if np.ma.is_masked(array):
        mask = np.atleast_1d(np.ma.getmaskarray(array))
        rows = np.flatnonzero(mask.reshape(len(mask), -1).any(axis=1))
        raise InputError(
            f"{what} {listed(rows)} are masked: leave them out, or give an array without a mask."
        )


def check_indices(triangles: np.ndarray, n_points: int) -> np.ndarray:
    """Return triangles as an int32 array for kernels, or say why they cannot be used.

    Raises
    ------
    InputError
        Wrong shape or dtype, a mask, no triangles.
    MeshError
        Indices of points that do not exist.
    """
    refuse_masked(triangles, "Triangles")
    try:
        array = np.asarray(triangles)
    except (TypeError, ValueError) as error:
        raise InputError(f"The triangles do not form an array ({error}).") from None
    if array.dtype.kind not in "iu" or array.ndim != 2 or array.shape[1] != 3:
        raise InputError(
            f"The triangles are an array of shape {array.shape} and dtype {array.dtype}: "
            "give integers, in an array of shape (m, 3)."
        )
    if len(array) == 0:
        raise InputError("There are no triangles: give at least one.")
    bad = np.flatnonzero(((array < 0) | (array >= n_points)).any(axis=1))
    if len(bad):
        what = (
            f"Triangles {listed(bad)} have vertices that are not among the {n_points} points, "
            f"whose indices run from 0 to {n_points - 1}"
        )
        raise MeshError([MeshProblem("indices", bad, what, Remedy.CORRECT_INDICES)])
    return for_kernels(array, np.int32)


def check_finite(points: np.ndarray, triangles: np.ndarray) -> None:
    """Refuse triangles whose points have coordinates that are not finite.

    Raises
    ------
    MeshError
        Where such points are in use; others change no path.
    """
    finite = np.isfinite(points).all(axis=1)
    if finite.all():
        return
    bad = np.unique(triangles[~finite[triangles]])
    if len(bad):
        of_them = np.flatnonzero(~finite[triangles].all(axis=1))
        what = (
            f"Points {listed(bad)} have coordinates that are not finite, and are used by triangles "
            f"{listed(of_them)}"
        )
        raise MeshError([MeshProblem("infinite points", bad, what, Remedy.GIVE_COORDINATES)])


def sound_mesh(
    points: np.ndarray, triangles: np.ndarray, repeated_points: RepeatedPoints
) -> SoundMesh:
    """Orient and link triangles, or say everything that is wrong with them.

    Parameters
    ----------
    points : (n, 2) or (n, 3) float64 ndarray
        Finite where they are in use.
    triangles : (m, 3) int32 ndarray
        Indices of points.
    repeated_points : {"refuse", "merge", "keep"}
        What to do about points with the coordinates of another.

    Raises
    ------
    MeshError
        All that is wrong.
    InputError
        An unknown word in place of "refuse", "merge" or "keep".
    """
    if repeated_points not in get_args(RepeatedPoints):
        choices = ", ".join(map(repr, get_args(RepeatedPoints)))
        raise InputError(f"repeated_points is {repeated_points!r}: use one of {choices}.")
    problems = []
    repeated = _repeated_points(points, triangles)
    merged = triangles
    if len(repeated):
        first = np.arange(len(points), dtype=np.int32)
        first[repeated[:, 0]] = repeated[:, 1]
        merged = first[triangles]
        if repeated_points == "refuse":
            problems.append(_not_joined(repeated))
    on_seam = _is_collapsed(merged) & ~_is_collapsed(triangles)
    if repeated_points == "merge":
        triangles = merged
        on_seam[:] = False
    else:
        repeated = repeated[:0]
    collapsed = _is_collapsed(triangles)
    flat, clockwise = _turns(points, triangles)
    good = ~(flat | collapsed)
    problems += _areas(collapsed, on_seam, flat & ~collapsed & ~on_seam)
    if clockwise.any():
        triangles = np.where(clockwise[:, None], triangles[:, [0, 2, 1]], triangles)
    neighbors, links = _linked(points, triangles, good, clockwise)
    problems += links
    if problems:
        raise MeshError(problems)
    return SoundMesh(triangles, neighbors, repeated, clockwise)


def _is_collapsed(triangles: np.ndarray) -> np.ndarray:
    """Return which triangles have the same vertex twice."""
    a, b, c = triangles.T
    return (a == b) | (b == c) | (c == a)


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
            problems.append(MeshProblem("copies", copies, what, Remedy.LEAVE_OUT))
            ids = np.setdiff1d(ids, copies)
            neighbors, flags = _link(points, triangles, ids)
    bad = ids[(flags & NON_MANIFOLD) > 0]
    if len(bad):
        what = (
            f"Triangles {listed(bad)} share an edge with two or more others, so that a path across "
            "it has no single next triangle"
        )
        problems.append(MeshProblem("non-manifold edges", bad, what, Remedy.SPLIT_EDGES))
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
    return MeshProblem("repeated points", points, what, Remedy.MERGE_OR_KEEP)


def _areas(collapsed: np.ndarray, on_seam: np.ndarray, flat: np.ndarray) -> list[MeshProblem]:
    problems = []
    for kind, chosen, why, remedy in (
        ("collapsed triangles", collapsed, "have the same point twice, so no area",
         Remedy.LEAVE_OUT),
        ("seam triangles", on_seam, "have two points at the same place, so no area",
         Remedy.MERGE_AND_LEAVE_OUT),
        ("flat triangles", flat, "have no area: their vertices lie on one line",
         Remedy.MOVE_VERTEX),
    ):  # fmt: skip
        ids = np.flatnonzero(chosen)
        if len(ids):
            problems.append(MeshProblem(kind, ids, f"Triangles {listed(ids)} {why}", remedy))
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
        return [MeshProblem("inverted triangles", fewer, what, Remedy.MOVE_BACK)]
    what = f"Triangles {listed(folded)} lie over a neighbour, on the same side of their common edge"
    return [MeshProblem("folded triangles", folded, what, Remedy.UNFOLD)]
