"""A mesh written back with what its paths say, as data of its cells."""

import contextlib
import io
from pathlib import Path

import numpy as np

import lepp
from study.meshes.survey import Survey
from study.results.files import replacing

FORMATS = {".vtu": "vtu", ".vtk": "vtk", ".xdmf": "xdmf", ".xmf": "xdmf", ".msh": "gmsh22"}
"""The formats that keep data of cells, by extension."""


def check_output(output: Path, mesh_file: Path) -> None:
    """Refuse an output of a format that keeps no cell data, or that is the mesh's own file.

    Raises
    ------
    lepp.InputError
    """
    if output.suffix.lower() not in FORMATS:
        raise lepp.InputError(
            f"A {output.suffix or 'nameless'} file cannot keep data of cells: name the output "
            f"{', '.join(FORMATS)}."
        )
    check_not_same(output, mesh_file)


def check_not_same(output: Path, mesh_file: Path) -> None:
    """Refuse to write over the mesh's own file, or where there is no directory.

    Raises
    ------
    lepp.InputError
    """
    if output.exists() and mesh_file.exists() and output.samefile(mesh_file):
        raise lepp.InputError(f"{output} is the mesh itself: give the output another name.")
    if output.is_dir():
        raise lepp.InputError(f"{output} is a directory: name a file in it.")
    if not output.parent.is_dir():
        raise lepp.InputError(f"There is no directory {output.parent} to write {output.name} to.")


def write_mesh(survey: Survey, output: Path) -> None:
    """Write the mesh with its own data and that of its paths.

    The new data of each cell: lepp_triangle (its index in the survey), lepp_size, lepp_successor
    (number of the next cell on its path, through all blocks; -1 at the boundary), lepp_region,
    lepp_neighbor_type (0 none, 1 A, 2 B, 3 C) and lepp_worst_path (its place on the longest path,
    from 1, or 0). Cells that are no triangles have -1, or 0 where -1 means something else. Quads
    are written as the triangles into which they were split.

    Parameters
    ----------
    survey : Survey
    output : Path
        Of one of `FORMATS`; replaced as a whole if it exists.

    Raises
    ------
    lepp.InputError
        An output that cannot be written.
    """
    import meshio

    check_output(output, survey.mesh.path)
    contents = survey.mesh.contents
    split = [
        block.type.startswith("quad") and bool((survey.mesh.blocks == k).any())
        for k, block in enumerate(contents.cells)
    ]
    cells = _cells(survey, split)
    mesh = meshio.Mesh(
        contents.points,
        cells,
        point_data={name: np.asarray(data) for name, data in contents.point_data.items()},
        cell_data=_file_data(survey, split) | _path_data(survey, split, [len(c) for _, c in cells]),
        field_data={
            name: np.asarray(data)
            for name, data in contents.field_data.items()
            if np.asarray(data).dtype.kind in "iuf"  # names alone can be written by no format
        },
    )
    kind = FORMATS[output.suffix.lower()]
    settings = {"data_format": "XML"} if kind == "xdmf" else {}  # one file, and no need of HDF5
    with replacing(output) as whole:
        try:
            with (
                contextlib.redirect_stdout(io.StringIO()),
                contextlib.redirect_stderr(io.StringIO()),
            ):
                meshio.write(whole, mesh, file_format=kind, **settings)
        except OSError:  # of the disk; whatever else is of the format
            raise
        except (Exception, SystemExit) as error:
            raise lepp.InputError(
                f"{output} could not be written ({type(error).__name__}: {error}): try another "
                f"format ({', '.join(FORMATS)}) or place."
            ) from None


def _cells(survey: Survey, split: list[bool]) -> list[tuple[str, np.ndarray]]:
    """Return the file's blocks of cells, those of quads as their triangles."""
    return [
        ("triangle", survey.triangulation.triangles[survey.mesh.blocks == k])
        if split[k]
        else (block.type, block.data)
        for k, block in enumerate(survey.mesh.contents.cells)
    ]


def _file_data(survey: Survey, split: list[bool]) -> dict[str, list[np.ndarray]]:
    """Return the file's own data of its cells, that of a quad for each of its triangles."""
    return {
        name: [
            np.asarray(block)[survey.mesh.cells[survey.mesh.blocks == k]]
            if split[k]
            else np.asarray(block)
            for k, block in enumerate(data)
        ]
        for name, data in survey.mesh.contents.cell_data.items()
    }


def _path_data(
    survey: Survey, split: list[bool], lengths: list[int]
) -> dict[str, list[np.ndarray]]:
    """Return the new data, an array a block."""
    paths, m = survey.paths, len(survey.triangulation)
    first = np.concatenate(([0], np.cumsum(lengths)))
    place = first[survey.mesh.blocks] + survey.mesh.cells  # number of the cell in the output
    for k in np.flatnonzero(split):
        place[survey.mesh.blocks == k] = np.arange(first[k], first[k + 1])
    successors = np.where(paths.successors < 0, -1, place[paths.successors])
    worst = np.zeros(m, np.int32)
    worst[survey.worst_path] = np.arange(1, len(survey.worst_path) + 1)
    data = {}
    for name, values, none in (
        ("lepp_triangle", np.arange(m), -1),
        ("lepp_size", paths.sizes, 0),
        ("lepp_successor", successors, -1),
        ("lepp_region", paths.regions, -1),
        ("lepp_neighbor_type", paths.neighbor_types, 0),
        ("lepp_worst_path", worst, 0),
    ):
        column = np.full(first[-1], none, np.int32)
        column[place] = values
        data[name] = np.split(column, first[1:-1])
    return data
