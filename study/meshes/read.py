"""From a mesh file to a triangulation, and back from its triangles to the file's cells."""

import os
import pickle
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import lepp
from lepp.errors import listed
from lepp.mesh.checks import RepeatedPoints
from lepp.mesh.conversion import MeshArrays, mesh_arrays

# The slowest of meshio's readers takes a second for about a megabyte.
_SECONDS = 15.0
_BYTES_A_SECOND = 100_000
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
    """

    split_quads: bool = False
    ignore_volumes: bool = False
    drop_duplicates: bool = False
    repeated_points: RepeatedPoints = "refuse"


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
        No such file, a format that is not known, or a file that cannot be read.
    lepp.MeshError
        Everything that is wrong with the mesh in it.
    """
    contents = _read_file(path)
    given = mesh_arrays(
        contents, split_quads=options.split_quads, ignore_volumes=options.ignore_volumes
    )
    stl = path.suffix.lower() == ".stl"
    repeated_points: RepeatedPoints = "merge" if stl else options.repeated_points
    given, triangulation, dropped = _triangulated(
        given, repeated_points, options.drop_duplicates or stl
    )
    notes = [*_cell_notes(contents), *_point_notes(triangulation), *dropped]
    if stl:
        notes.insert(
            0, "An STL file repeats every point for each triangle: equal ones were joined."
        )
    notes += _turned(given, triangulation)
    return ReadMesh(path, contents, triangulation, given.blocks, given.cells, tuple(notes))


def _triangulated(
    given: MeshArrays, repeated_points: RepeatedPoints, drop: bool
) -> tuple[MeshArrays, lepp.Triangulation, list[str]]:
    """Link the triangles; if asked to, without those that repeat another or are a mere edge."""
    dropped: list[str] = []
    while True:
        try:
            triangulation = lepp.Triangulation.from_arrays(
                given.points, given.triangles, repeated_points=repeated_points
            )
        except lepp.MeshError as error:
            if not drop or not {problem.kind for problem in error.problems} <= _DROPPABLE:
                raise
            dropped += [f"{problem.what}; they were left out." for problem in error.problems]
            bad = np.concatenate([problem.ids for problem in error.problems])
            kept = np.setdiff1d(np.arange(len(given.triangles)), bad)
            given = MeshArrays(
                given.points, given.triangles[kept], given.blocks[kept], given.cells[kept]
            )
        else:
            return given, triangulation, dropped


def _read_file(path: Path) -> Any:  # noqa: ANN401 - a meshio.Mesh; meshio has no annotations
    if not path.exists():
        raise lepp.InputError(f"There is no file {path}.")
    if not path.is_file():
        raise lepp.InputError(f"{path} is not a file: give a mesh file.")
    if path.stat().st_size == 0:
        raise lepp.InputError(f"{path} is empty: give a mesh file.")
    try:
        with path.open("rb"):
            pass
    except OSError as error:
        raise lepp.InputError(f"{path} cannot be read: {error.strerror}.") from None
    limit = _SECONDS + path.stat().st_size / _BYTES_A_SECOND
    # Without the current directory on the path (-P), in which a file might be called numpy.py.
    command = [sys.executable, "-P", "-m", "study.meshes.meshio_process", str(path)]
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            timeout=limit,
            check=False,
            env=os.environ | {"COLUMNS": "1000"},  # what is printed is not to be wrapped
        )
    except subprocess.TimeoutExpired:
        raise lepp.InputError(
            f"{path} could not be read: meshio's reader was not done after {limit:.0f} s, which "
            "happens on files that are cut short or of another format than their name says."
        ) from None
    mesh, reason = pickle.loads(done.stdout) if done.returncode == 0 else (None, "")
    if mesh is None:
        raise lepp.InputError(_unreadable(path, reason or _printed(done.stderr)))
    return mesh


def _unreadable(path: Path, reason: str) -> str:
    if "deduce file format" in reason:
        from meshio import extension_to_filetypes

        return (
            f"{path} does not say by its name which format it has: the extensions known are "
            f"{', '.join(sorted(extension_to_filetypes))}."
        )
    reason = " ".join(reason.split())
    because = f" ({reason[:200].rstrip('.')})" if reason else ""
    return (
        f"{path} could not be read as a {path.suffix} file{because}: it may be cut short, damaged, "
        "or of a variant that meshio does not read; save it again, or in another format."
    )


def _printed(stderr: bytes) -> str:
    """Return what a reader printed before it gave up, in a few words."""
    text = re.sub(r"\x1b\[[0-9;]*m", "", stderr.decode(errors="replace"))
    lines = [line for line in text.splitlines() if line.strip() and "Couldn't read" not in line]
    return lines[-1] if lines else ""


def _cell_notes(contents: Any) -> list[str]:  # noqa: ANN401 - a meshio.Mesh
    """Say what became of the cells that are not plain triangles."""
    counts: dict[str, int] = {}
    for block in contents.cells:
        if len(block.data):
            counts[block.type] = counts.get(block.type, 0) + len(block.data)
    notes = []
    for kind, count in counts.items():
        cells = f"{count:,} cell{'s' if count > 1 else ''} of type {kind}"
        if re.fullmatch(r"quad\d*", kind):
            notes.append(f"Split into two triangles each: {cells}.")
        elif re.fullmatch(r"triangle\d+", kind):
            notes.append(f"Taken with straight edges: {cells}.")
        elif not re.fullmatch(r"triangle|polygon\d*", kind):
            notes.append(f"Left out, being no triangles: {cells}.")
    return notes


def _point_notes(triangulation: lepp.Triangulation) -> list[str]:
    notes = []
    merged = triangulation.repeated[:, 0]
    if len(merged):
        notes.append(f"Merged with another point at the same place: points {listed(merged)}.")
    unused = unused_points(triangulation)
    if len(unused):
        notes.append(f"Left out, being in no triangle: points {listed(unused)}.")
    return notes


def unused_points(triangulation: lepp.Triangulation) -> np.ndarray:
    """Return the points that no triangle uses, those merged with another not counted."""
    used = np.zeros(len(triangulation.points), bool)
    used[triangulation.triangles] = True
    used[triangulation.repeated[:, 0]] = True
    return np.flatnonzero(~used)


def _turned(given: MeshArrays, triangulation: lepp.Triangulation) -> list[str]:
    """Say which triangles of a plane mesh stood the other way round than the rest."""
    first = np.arange(len(triangulation.points))
    first[triangulation.repeated[:, 0]] = triangulation.repeated[:, 1]
    turned = (first[given.triangles] != triangulation.triangles).any(axis=1)
    if turned.all() or not turned.any():
        return []
    fewer = np.flatnonzero(turned if 2 * turned.sum() <= len(turned) else ~turned)
    return [
        f"Triangles {listed(fewer)} list their points the other way round than the rest; that "
        "changes no path."
    ]
