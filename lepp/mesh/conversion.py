"""Points and triangles out of the mesh objects of other libraries, none of which is imported."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lepp.errors import InputError, MeshError, MeshProblem, listed

# Names of cell types as meshio has them; a number is that of the nodes, the corners first.
_TRIANGLES = re.compile(r"triangle\d*")
_QUADS = re.compile(r"quad\d*")
_LESS = re.compile(r"(vertex|line\d*|poly_?vertex|poly_?line)", re.IGNORECASE)
_VOLUMES = re.compile(
    r"(tetra|hexahedron|wedge|pyramid|polyhedron|penta_prism|hexa_prism|voxel).*", re.IGNORECASE
)


@dataclass(frozen=True, eq=False)
class MeshArrays:
    """Triangles taken from a mesh object, and where in it they stood.

    Attributes
    ----------
    points : (n, 2) or (n, 3) ndarray of float
        Two coordinates if the third is the same at every point in use.
    triangles : (m, 3) ndarray of int
        Vertices; not checked.
    blocks : (m,) int32 ndarray
        The object's block of cells that each triangle is from.
    cells : (m,) int64 ndarray
        Its place in that block; the two halves of a quad have the same.
    """

    points: np.ndarray
    triangles: np.ndarray
    blocks: np.ndarray
    cells: np.ndarray


def mesh_arrays(
    mesh: Any,  # noqa: ANN401 - whatever has the attributes
    *,
    split_quads: bool = False,
    ignore_volumes: bool = False,
) -> MeshArrays:
    """Take the points and triangles of a mesh object.

    Parameters
    ----------
    mesh : scipy.spatial.Delaunay, matplotlib.tri.Triangulation or meshio.Mesh
        Or what has the same attributes.
    split_quads : bool
        Split each quad along its shorter diagonal that lies inside.
    ignore_volumes : bool
        Take the triangles of a mesh that has volumes (tetrahedra and so on) as well.

    Raises
    ------
    InputError
        An object of another kind.
    MeshError
        Cells that are not triangles.
    """
    if hasattr(mesh, "points") and hasattr(mesh, "cells"):
        blocks = [_typed(cells) for cells in mesh.cells]
        points, taken = np.asarray(mesh.points), _surface(mesh.points, blocks, split_quads)
        _refuse_others(blocks, taken, split_quads, ignore_volumes)
    elif hasattr(mesh, "points") and hasattr(mesh, "simplices"):
        points, blocks = np.asarray(mesh.points), [("simplex", np.asarray(mesh.simplices))]
        if blocks[0][1].ndim != 2 or blocks[0][1].shape[1] != 3:
            raise InputError(
                f"The simplices have {blocks[0][1].shape[-1]} vertices: only triangles are taken; "
                "triangulate points in the plane, or give the triangles of a surface."
            )
        taken = [_whole(0, blocks[0][1])]
    elif all(hasattr(mesh, name) for name in ("x", "y", "triangles")):
        points = np.column_stack((mesh.x, mesh.y))
        shown = np.ones(len(mesh.triangles), bool)
        if getattr(mesh, "mask", None) is not None:
            shown = ~np.asarray(mesh.mask, bool)
        taken = [(0, np.asarray(mesh.triangles)[shown], np.flatnonzero(shown))]
    else:
        raise InputError(
            f"A {type(mesh).__name__} is no mesh that can be taken as it is: give a "
            "scipy.spatial.Delaunay, a matplotlib.tri.Triangulation or a meshio.Mesh, or its "
            "points and triangles as arrays."
        )
    triangles = np.concatenate([rows for _, rows, _ in taken])
    return MeshArrays(
        _flattened(points, triangles),
        triangles,
        np.repeat([block for block, _, _ in taken], [len(rows) for _, rows, _ in taken]).astype(
            np.int32
        ),
        np.concatenate([cells for _, _, cells in taken]).astype(np.int64),
    )


_Taken = tuple[int, np.ndarray, np.ndarray]  # block, triangles, and the cell of each
_Blocks = Sequence[tuple[str, np.ndarray]]


def _typed(cells: Any) -> tuple[str, np.ndarray]:  # noqa: ANN401 - a meshio.CellBlock, or a pair
    """Return the type and the vertices of a block of cells; polygons by their number of corners."""
    kind, data = (cells.type, cells.data) if hasattr(cells, "type") else cells
    try:
        data = np.asarray(data)
    except ValueError:  # cells of different lengths
        data = np.empty((len(data), 0), int)
    if kind.startswith("polygon") and data.ndim == 2 and data.shape[1] in (3, 4):
        kind = "triangle" if data.shape[1] == 3 else "quad"
    return kind, data


def _whole(block: int, triangles: np.ndarray) -> _Taken:
    return block, triangles, np.arange(len(triangles))


def _surface(points: np.ndarray, blocks: _Blocks, split_quads: bool) -> list[_Taken]:
    taken: list[_Taken] = []
    for block, (kind, data) in enumerate(blocks):
        if _TRIANGLES.fullmatch(kind) and data.ndim == 2:
            taken.append(_whole(block, data[:, :3]))
        elif split_quads and _QUADS.fullmatch(kind) and data.ndim == 2:
            halves = _halves(np.asarray(points, float), data[:, :4], block)
            taken.append((block, halves, np.repeat(np.arange(len(data)), 2)))
    return [part for part in taken if len(part[1])]


def _refuse_others(
    blocks: _Blocks, taken: list[_Taken], split_quads: bool, ignore_volumes: bool
) -> None:
    """Say which cells are not triangles."""
    problems = []
    quads = _of_type(blocks, _QUADS)
    if quads and not split_quads:
        remedy = "give split_quads=True to split each into two triangles"
        problems.append(_cells("quads", quads, blocks, remedy))
    volumes = _of_type(blocks, _VOLUMES)
    if volumes and not ignore_volumes:
        remedy = "only triangles in the plane or on a surface are taken; " + (
            "give ignore_volumes=True to take the triangles that the mesh also has"
            if taken
            else "extract the surface of the volume first"
        )
        problems.append(_cells("volumes", volumes, blocks, remedy))
    known = (_TRIANGLES, _QUADS, _LESS, _VOLUMES)
    others = [
        block
        for block, (kind, data) in enumerate(blocks)
        if len(data) and not any(pattern.fullmatch(kind) for pattern in known)
    ]
    if others:
        problems.append(_cells("polygons", others, blocks, "triangulate them first"))
    if problems:
        raise MeshError(problems)
    if not taken:
        found = ", ".join(f"{len(data)} {kind}" for kind, data in blocks if len(data))
        raise InputError(
            f"The mesh has no triangles{f' (but {found})' if found else ''}: give a mesh of "
            "triangles, in the plane or on a surface."
        )


def _of_type(blocks: _Blocks, pattern: re.Pattern) -> list[int]:
    return [k for k, (kind, data) in enumerate(blocks) if len(data) and pattern.fullmatch(kind)]


def _cells(kind: str, chosen: list[int], blocks: _Blocks, remedy: str) -> MeshProblem:
    """Say how many cells of which types there are; its ids count through all blocks."""
    first = np.cumsum([0] + [len(data) for _, data in blocks])
    ids = np.concatenate([np.arange(first[k], first[k + 1]) for k in chosen])
    counts: dict[str, int] = {}
    for k in chosen:
        counts[blocks[k][0]] = counts.get(blocks[k][0], 0) + len(blocks[k][1])
    types = " and ".join(
        f"{count} cell{'s' if count > 1 else ''} of type {name}" for name, count in counts.items()
    )
    first_ids = ", ".join(map(str, ids[:5]))
    what = f"The mesh has {types} (numbers {first_ids}{', …' if len(ids) > 5 else ''})"
    return MeshProblem(kind, ids, what, remedy)


def _halves(points: np.ndarray, quads: np.ndarray, block: int) -> np.ndarray:
    """Split quads into two triangles each, (2 k, 3), that turn as the quad does.

    Of the diagonals that lie inside (both do, if the quad is convex) the shorter is taken; of two
    of one length, that from the vertex with the smallest index.
    """
    if ((quads < 0) | (quads >= len(points))).any():
        bad = np.flatnonzero(((quads < 0) | (quads >= len(points))).any(axis=1))
        what = f"Quads {listed(bad)} of block {block} have vertices that are not among the points"
        raise MeshError(
            [MeshProblem("indices", bad, what, f"indices run from 0 to {len(points) - 1}")]
        )
    corners = np.zeros((*quads.shape, 3))
    corners[..., : points.shape[1]] = points[quads]
    a, b, c, d = corners.transpose(1, 0, 2)
    inside_ac = _dot(np.cross(b - a, c - a), np.cross(c - a, d - a)) > 0
    inside_bd = _dot(np.cross(b - a, d - a), np.cross(c - b, d - b)) > 0
    neither = np.flatnonzero(~(inside_ac | inside_bd))
    if len(neither):
        what = f"Quads {listed(neither)} of block {block} have no diagonal inside"
        remedy = "they cross themselves, are flat or have a corner twice; repair or remove them"
        raise MeshError([MeshProblem("twisted quads", neither, what, remedy)])
    square_ac, square_bd = _dot(c - a, c - a), _dot(d - b, d - b)
    tie = np.minimum(quads[:, 0], quads[:, 2]) < np.minimum(quads[:, 1], quads[:, 3])
    shorter = (square_ac < square_bd) | ((square_ac == square_bd) & tie)
    along_ac = np.where(inside_ac & inside_bd, shorter, inside_ac)
    halves = np.where(
        along_ac[:, None, None],
        quads[:, [[0, 1, 2], [0, 2, 3]]],
        quads[:, [[0, 1, 3], [1, 2, 3]]],
    )
    return halves.reshape(-1, 3)


def _dot(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    return (u * v).sum(axis=1)


def _flattened(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Leave out a third coordinate that is the same at all points in use."""
    if points.ndim != 2 or points.shape[1] != 3 or triangles.size == 0:
        return points
    if triangles.min() < 0 or triangles.max() >= len(points):
        return points
    heights = points[triangles, 2]
    return points[:, :2] if (heights == heights[0, 0]).all() else points
