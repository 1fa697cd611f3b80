"""From a mesh file to a triangulation, and back from its triangles to the file's cells."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import lepp
from lepp.errors import listed
from lepp.mesh.cells import Block, CellKind, is_curved
from lepp.mesh.checks import RepeatedPoints, check_finite, check_indices
from lepp.mesh.conversion import MeshArrays, mesh_arrays
from lepp.mesh.triangulation import check_points, linked
from study.meshes.meshio_process import read_file
from study.meshes.near_points import moved_together

_DROPPABLE = {"copies", "collapsed triangles"}


@dataclass(frozen=True)
class ReadOptions:
    """How to go on where a mesh leaves a choice.

    Attributes
    ----------
    split_quads : bool
        Split quads into two triangles each.
    ignore_volumes : bool
        Take the triangles of a mesh that has volumes too.
    drop_duplicates : bool
        Leave out triangles that repeat another, or that have the same point twice.
    repeated_points : {"refuse", "merge", "keep"}
        As for `lepp.Triangulation.from_arrays`. In STL files, which have no other way to say that
        triangles meet, points are always merged.
    merge_within : float, optional
        Merge also points that are no farther than this from each other, as a share of the mesh's
        extent.
    read_limit : float, optional
        Seconds of processor time that the file's reader may take.
    """

    split_quads: bool = False
    ignore_volumes: bool = False
    drop_duplicates: bool = False
    repeated_points: RepeatedPoints = "refuse"
    merge_within: float | None = None
    read_limit: float | None = None


@dataclass(frozen=True, eq=False)
class ReadMesh:
    """A mesh out of a file.

    Attributes
    ----------
    path : Path
    contents : meshio.Mesh
        All that the file has.
    triangulation : lepp.Triangulation
    blocks, cells : (m,) int ndarrays
        For each triangle the file's block of cells, and its place in there.
    notes : tuple of str
        What was done to the mesh on the way: a sentence each.
    """

    path: Path
    contents: Any
    triangulation: lepp.Triangulation
    blocks: np.ndarray
    cells: np.ndarray
    notes: tuple[str, ...]


def read_mesh(path: Path, options: ReadOptions = ReadOptions()) -> ReadMesh:
    """Read a mesh file.

    Parameters
    ----------
    path : Path
        Of a format that meshio knows by its extension.
    options : ReadOptions

    Raises
    ------
    lepp.InputError
        No such file, a format that is not known, a file that cannot be read, or a distance to
        merge points within that is none.
    lepp.MeshError
        Everything that is wrong with the mesh in it.
    """
    contents = read_file(path, options.read_limit)
    given = mesh_arrays(
        contents, split_quads=options.split_quads, ignore_volumes=options.ignore_volumes
    )
    stl = path.suffix.lower() == ".stl"
    notes = _cell_notes(contents)
    if stl:
        notes.insert(
            0,
            "An STL file repeats every point for each triangle: points that are equal are joined.",
        )
    merge = options.repeated_points
    if options.merge_within is not None:
        given = _near_joined(given, options.merge_within)
    if stl or options.merge_within is not None:
        merge = "merge"
    given, triangulation, dropped, turned = _triangulated(
        given, merge, options.drop_duplicates or stl
    )
    notes += [*_point_notes(triangulation, options.merge_within), *dropped, *turned]
    return ReadMesh(path, contents, triangulation, given.blocks, given.cells, tuple(notes))


def _near_joined(given: MeshArrays, within: float) -> MeshArrays:
    """Give points that nearly agree the same coordinates, so that they are merged."""
    points = check_points(given.points, dimensions=(2, 3), all_finite=False)
    check_finite(points, check_indices(given.triangles, len(points)))
    points = moved_together(points, given.triangles, within)
    return MeshArrays(points, given.triangles, given.blocks, given.cells)


def _triangulated(
    given: MeshArrays, repeated_points: RepeatedPoints, drop: bool
) -> tuple[MeshArrays, lepp.Triangulation, list[str], list[str]]:
    """Link the triangles; if asked to, without those that repeat another or are a mere edge.

    Returns
    -------
    given : MeshArrays
        Of the triangles that are left.
    triangulation : lepp.Triangulation
    dropped, turned : list of str
        What was left out, and what stood the other way round: sentences.

    Raises
    ------
    lepp.MeshError
        What is wrong besides what can be left out.
    """
    dropped: list[str] = []
    while True:
        try:
            triangulation, sound = linked(given.points, given.triangles, repeated_points)
        except lepp.MeshError as error:
            rest = [problem for problem in error.problems if problem.kind not in _DROPPABLE]
            if not drop:
                raise
            if rest:
                raise lepp.MeshError(rest) from None
            dropped += [f"{problem.what}; they were left out." for problem in error.problems]
            given = given.without(np.concatenate([problem.ids for problem in error.problems]))
        else:
            return given, triangulation, dropped, _turned(sound.clockwise)


def _cell_notes(contents: Any) -> list[str]:  # noqa: ANN401 - a meshio.Mesh
    """Say what became of the cells that are not plain triangles."""
    counts: dict[tuple[str, CellKind], int] = {}
    for block in contents.cells:
        if len(block.data):
            key = block.type, Block(block.type, np.asarray(block.data)).kind
            counts[key] = counts.get(key, 0) + len(block.data)
    notes = []
    for (name, kind), count in counts.items():
        cells = f"{count:,} cell{'s' if count > 1 else ''} of type {name}"
        if kind is CellKind.QUAD:
            notes.append(f"Split into two triangles each: {cells}.")
        elif kind is not CellKind.TRIANGLE:
            notes.append(f"Left out, being no triangles: {cells}.")
        elif is_curved(name):
            notes.append(f"Taken with straight edges: {cells}.")
    return notes


def _point_notes(triangulation: lepp.Triangulation, within: float | None) -> list[str]:
    notes = []
    merged = triangulation.repeated[:, 0]
    if len(merged):
        place = "at the same place" if within is None else f"within {within:g} of the mesh's extent"
        notes.append(f"Merged with another point {place}: points {listed(merged)}.")
    unused = unused_points(triangulation)
    if len(unused):
        notes.append(f"Left out, being in no triangle: points {listed(unused)}.")
    return notes


def unused_points(triangulation: lepp.Triangulation) -> np.ndarray:
    """Return the points that no triangle uses.

    Parameters
    ----------
    triangulation : lepp.Triangulation

    Returns
    -------
    (k,) int64 ndarray
        Indices of points, ascending; without those merged with another.
    """
    used = np.zeros(len(triangulation.points), bool)
    used[triangulation.triangles] = True
    used[triangulation.repeated[:, 0]] = True
    return np.flatnonzero(~used)


def _turned(clockwise: np.ndarray) -> list[str]:
    """Say which triangles of a plane mesh stood the other way round than the rest."""
    if clockwise.all() or not clockwise.any():
        return []
    fewer = np.flatnonzero(clockwise if 2 * clockwise.sum() <= len(clockwise) else ~clockwise)
    return [
        f"Triangles {listed(fewer)} list their points the other way round than the rest; that "
        "changes no path."
    ]
