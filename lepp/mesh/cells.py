"""Cells of meshes: which are triangles, which can be made so, and which cannot."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from lepp.errors import InputError, MeshError, MeshProblem, Remedy, listed


class CellKind(Enum):
    """What a type of cells is to a mesh of triangles."""

    TRIANGLE = "triangle"
    QUAD = "quad"
    POLYGON = "polygon"
    LESS = "less than a surface"
    VOLUME = "volume"
    OTHER = "other"


# Names as meshio has them; a number is that of the nodes, the corners first.
_NAMES = {
    CellKind.TRIANGLE: r"triangle\d*",
    CellKind.QUAD: r"quad\d*",
    CellKind.POLYGON: r"polygon\d*",
    CellKind.LESS: r"vertex|line\d*|poly_?vertex|poly_?line",
    CellKind.VOLUME: r"(tetra|hexahedron|wedge|pyramid|polyhedron|penta_prism|hexa_prism|voxel).*",
}


def cell_kind(name: str) -> CellKind:
    """Classify a type of cells by its name.

    Parameters
    ----------
    name : str
        As meshio, VTK or Gmsh have it, in any case of letters.

    Returns
    -------
    CellKind
        `CellKind.OTHER` for a name that fits nothing.
    """
    for kind, pattern in _NAMES.items():
        if re.fullmatch(pattern, name, re.IGNORECASE):
            return kind
    return CellKind.OTHER


def is_curved(name: str) -> bool:
    """Tell whether a type of cells is that of triangles with more nodes than their corners.

    Parameters
    ----------
    name : str
        As for `cell_kind`.

    Returns
    -------
    bool
    """
    return cell_kind(name) is CellKind.TRIANGLE and name[len("triangle") :] not in ("", "3")


@dataclass(frozen=True, eq=False)
class Block:
    """Cells of one type.

    Attributes
    ----------
    name : str
        Of the type, as meshio has it; polygons of three or four corners are triangles or quads.
    vertices : (k, nodes) ndarray of int
        No columns where the cells have different numbers of nodes.
    """

    name: str
    vertices: np.ndarray

    @property
    def kind(self) -> CellKind:
        """What its cells are to a mesh of triangles."""
        kind = cell_kind(self.name)
        nodes = self.vertices.shape[1] if self.vertices.ndim == 2 else 0
        if kind is CellKind.POLYGON and nodes in (3, 4):
            return CellKind.TRIANGLE if nodes == 3 else CellKind.QUAD
        corners = {CellKind.TRIANGLE: 3, CellKind.QUAD: 4}.get(kind, 0)
        return kind if nodes >= corners else CellKind.OTHER

    @property
    def label(self) -> str:
        """What to call its type: polygons of three or four corners are triangles or quads."""
        is_polygon = cell_kind(self.name) is CellKind.POLYGON
        return self.kind.value if is_polygon else self.name

    def __len__(self) -> int:
        return len(self.vertices)


@dataclass(frozen=True, eq=False)
class BlockTriangles:
    """The triangles of one block.

    Attributes
    ----------
    block : int
        Its number.
    triangles : (m, 3) ndarray of int
    cells : (m,) ndarray of int
        The place in the block of each; the two halves of a quad have the same.
    """

    block: int
    triangles: np.ndarray
    cells: np.ndarray


def surface_triangles(
    points: np.ndarray, blocks: Sequence[Block], *, split_quads: bool, ignore_volumes: bool
) -> list[BlockTriangles]:
    """Take the triangles of blocks of cells.

    Parameters
    ----------
    points : (n, 2) or (n, 3) ndarray of float
    blocks : sequence of Block
    split_quads : bool
        Split each quad along its shorter diagonal that lies inside.
    ignore_volumes : bool
        Take the triangles of a mesh that has volumes as well.

    Raises
    ------
    MeshError
        Cells that are not triangles.
    InputError
        No triangles, or vertices that are not integers.
    """
    taken = []
    for number, block in enumerate(blocks):
        if not len(block) or block.kind not in (CellKind.TRIANGLE, CellKind.QUAD):
            continue
        if block.vertices.dtype.kind not in "iu":
            raise InputError(
                f"The cells of type {block.name} are an array of dtype {block.vertices.dtype}: "
                "give integers."
            )
        if block.kind is CellKind.TRIANGLE:
            every = np.arange(len(block))
            taken.append(BlockTriangles(number, block.vertices[:, :3], every))
        elif split_quads:
            halves = _halves(points, block.vertices[:, :4], number)
            taken.append(BlockTriangles(number, halves, np.repeat(np.arange(len(block)), 2)))
    _refuse_others(blocks, bool(taken), split_quads, ignore_volumes)
    return taken


def _refuse_others(
    blocks: Sequence[Block], any_triangles: bool, split_quads: bool, ignore_volumes: bool
) -> None:
    """Say which cells are not triangles."""
    extract = Remedy.IGNORE_VOLUMES if any_triangles else Remedy.EXTRACT_SURFACE
    problems = []
    for name, kinds, remedy, is_right in (
        ("quads", {CellKind.QUAD}, Remedy.SPLIT_QUADS, split_quads),
        ("volumes", {CellKind.VOLUME}, extract, ignore_volumes),
        ("polygons", {CellKind.POLYGON, CellKind.OTHER}, Remedy.TRIANGULATE, False),
    ):
        chosen = [k for k, block in enumerate(blocks) if len(block) and block.kind in kinds]
        if chosen and not is_right:
            problems.append(_problem(name, chosen, blocks, remedy))
    if problems:
        raise MeshError(problems)
    if not any_triangles:
        others = ", ".join(f"{len(block)} {block.name}" for block in blocks if len(block))
        raise InputError(
            f"The mesh has no triangles{f' (but {others})' if others else ''}: give a mesh of "
            "triangles, in the plane or on a surface."
        )


def _problem(kind: str, chosen: list[int], blocks: Sequence[Block], remedy: Remedy) -> MeshProblem:
    """Say how many cells of which types there are; its ids count through all blocks."""
    first = np.cumsum([0] + [len(block) for block in blocks])
    ids = np.concatenate([np.arange(first[k], first[k + 1]) for k in chosen])
    counts: dict[str, int] = {}
    for k in chosen:
        counts[blocks[k].label] = counts.get(blocks[k].label, 0) + len(blocks[k])
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
    bad = np.flatnonzero(((quads < 0) | (quads >= len(points))).any(axis=1))
    if len(bad):
        what = (
            f"Quads {listed(bad)} of block {block} have vertices that are not among the points, "
            f"whose indices run from 0 to {len(points) - 1}"
        )
        raise MeshError([MeshProblem("indices", bad, what, Remedy.CORRECT_INDICES)])
    corners = np.zeros((*quads.shape, 3))
    corners[..., : points.shape[1]] = points[quads]
    a, b, c, d = corners.transpose(1, 0, 2)
    inside_ac = _dot(np.cross(b - a, c - a), np.cross(c - a, d - a)) > 0
    inside_bd = _dot(np.cross(b - a, d - a), np.cross(c - b, d - b)) > 0
    neither = np.flatnonzero(~(inside_ac | inside_bd))
    if len(neither):
        what = f"Quads {listed(neither)} of block {block} have no diagonal inside"
        raise MeshError([MeshProblem("twisted quads", neither, what, Remedy.REPAIR_QUADS)])
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
