"""Points and triangles out of the mesh objects of other libraries, none of which is imported."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lepp.errors import InputError
from lepp.mesh.cells import Block, BlockTriangles, surface_triangles
from lepp.mesh.checks import refuse_masked

# Numbers of cell types in VTK, as meshio names them; a pixel is a quad in another order.
_PIXEL = 8
_VTK_NAMES = {
    1: "vertex", 2: "poly_vertex", 3: "line", 4: "poly_line", 5: "triangle", 6: "triangle_strip",
    7: "polygon", 9: "quad", 10: "tetra", 11: "voxel", 12: "hexahedron", 13: "wedge",
    14: "pyramid", 15: "penta_prism", 16: "hexa_prism", 21: "line3", 22: "triangle6", 23: "quad8",
    24: "tetra10", 25: "hexahedron20", 26: "wedge15", 27: "pyramid13", 28: "quad9",
    29: "hexahedron27", 30: "quad6", 34: "triangle7", 42: "polyhedron", 68: "line",
    69: "triangle", 70: "quad", 71: "tetra", 72: "hexahedron", 73: "wedge",
}  # fmt: skip

# scikit-fem's meshes by dimension and number of vertices of a cell.
_SKFEM_NAMES = {
    (2, 3): "triangle", (3, 3): "triangle", (2, 4): "quad", (3, 4): "tetra", (3, 6): "wedge",
    (3, 8): "hexahedron", (1, 2): "line", (2, 2): "line", (3, 2): "line",
}  # fmt: skip


Given = Any  # what another library holds: checked here


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

    def without(self, rows: np.ndarray) -> "MeshArrays":
        """Leave triangles out."""
        kept = np.setdiff1d(np.arange(len(self.triangles)), rows)
        return MeshArrays(self.points, self.triangles[kept], self.blocks[kept], self.cells[kept])


def mesh_arrays(
    mesh: Given,
    *,
    split_quads: bool = False,
    ignore_volumes: bool = False,
) -> MeshArrays:
    """Take the points and triangles of a mesh object.

    Parameters
    ----------
    mesh : object
        As for `lepp.Triangulation.from_object`, or what has the same attributes.
    split_quads : bool
        Split each quad along its shorter diagonal that lies inside.
    ignore_volumes : bool
        Take the triangles of a mesh that has volumes (tetrahedra and so on) as well.

    Raises
    ------
    InputError
        An object of another kind, or arrays that are masked.
    MeshError
        Cells that are not triangles.
    """
    points, blocks = _points_and_blocks(mesh)
    if not any(len(block) for block in blocks):
        points = np.empty((0, 2))  # of an empty file even the points have no shape
    if points.ndim != 2 or points.dtype.kind not in "fiu" or points.shape[1] not in (2, 3):
        raise InputError(
            f"The points have shape {points.shape} and dtype {points.dtype}: give real numbers, of "
            "shape (n, 2) or (n, 3)."
        )
    taken = surface_triangles(
        points.astype(float, copy=False),
        blocks,
        split_quads=split_quads,
        ignore_volumes=ignore_volumes,
    )
    shown = _shown(mesh)
    if shown is not None:
        taken = [BlockTriangles(0, taken[0].triangles[shown], np.flatnonzero(shown))]
    triangles = np.concatenate([part.triangles for part in taken])
    lengths = [len(part.triangles) for part in taken]
    return MeshArrays(
        _flattened(points, triangles),
        triangles,
        np.repeat([part.block for part in taken], lengths).astype(np.int32),
        np.concatenate([part.cells for part in taken]).astype(np.int64),
    )


def _points_and_blocks(mesh: Given) -> tuple[np.ndarray, list[Block]]:
    """Return the points of a mesh object and its cells."""
    if isinstance(mesh, Mapping):
        if {"vertices", "triangles"} <= mesh.keys():  # of the package triangle
            return _points(mesh["vertices"]), [_simplices("triangle", mesh["triangles"])]
    elif isinstance(mesh, (tuple, list)):
        if len(mesh) == 2:
            return _points(mesh[0]), [_simplices("triangle", mesh[1])]
    else:
        for names, take in _KINDS:
            if all(hasattr(mesh, name) for name in names):
                return take(*(getattr(mesh, name) for name in names))
    raise InputError(
        f"A {type(mesh).__name__} is no mesh that can be taken as it is: give a "
        "scipy.spatial.Delaunay, matplotlib.tri.Triangulation, meshio.Mesh, "
        "pyvista.UnstructuredGrid or PolyData, trimesh.Trimesh, skfem.MeshTri, a dictionary of the "
        "package triangle, or a pair of points and triangles."
    )


def _array(value: Given, what: str) -> np.ndarray:
    refuse_masked(value, what)
    try:
        return np.asarray(value)
    except (TypeError, ValueError) as error:
        raise InputError(f"{what} do not form an array ({error}).") from None


def _points(value: Given) -> np.ndarray:
    return _array(value, "Points")


def _simplices(name: str, value: Given) -> Block:
    """Return triangles, as scipy has them; simplices of other kinds are refused."""
    array = _array(value, "Triangles")
    if array.ndim != 2 or array.shape[1] != 3:
        vertices = f"{array.shape[-1]} vertices" if array.ndim == 2 else f"shape {array.shape}"
        what = "simplices" if name == "simplex" else "triangles"
        raise InputError(
            f"The {what} have {vertices}: only triangles are taken, in an array of shape (m, 3); "
            "triangulate points in the plane, or give the triangles of a surface."
        )
    return Block("triangle", array)


def _from_meshio(points: Given, cells: Given) -> tuple[np.ndarray, list[Block]]:
    """Take meshio's list of blocks, or a dictionary of types and cells."""
    try:
        blocks = list(cells.items() if isinstance(cells, Mapping) else cells)
    except TypeError:
        blocks = [cells]
    taken = []
    for block in blocks:
        pair = (block.type, block.data) if hasattr(block, "type") else block
        if not (isinstance(pair, (tuple, list)) and len(pair) == 2 and isinstance(pair[0], str)):
            raise InputError(
                f"The cells of the mesh hold a {type(pair).__name__}: give blocks of a type and "
                "its cells, as a meshio.Mesh has them."
            )
        taken.append(Block(pair[0], _vertices(pair[1])))
    return _points(points), taken


def _vertices(data: Given) -> np.ndarray:
    refuse_masked(data, "Cells")
    try:
        vertices = np.asarray(data)
    except ValueError:  # cells of different lengths
        return np.empty((len(data), 0), int)
    if vertices.ndim == 0:
        raise InputError(f"The cells of a block are a {type(data).__name__}: give an array.")
    return vertices if vertices.size else np.empty((len(vertices), 0), int)


def _from_grid(points: Given, cells: Given, types: Given) -> tuple[np.ndarray, list[Block]]:
    """Take VTK's cells: for each its number of nodes and these, one cell after the other."""
    nodes, starts = _split(cells)
    types = _array(types, "Cell types").ravel()
    if len(types) != len(starts):
        raise InputError(f"The mesh has {len(starts)} cells, but {len(types)} types of cells.")
    return _points(points), _runs(nodes, starts, types)


def _from_faces(points: Given, faces: Given) -> tuple[np.ndarray, list[Block]]:
    """Take the polygons of a surface: pyvista's in one row, or others' as an array of rows."""
    array = _array(faces, "Faces")
    if array.ndim == 2:
        return _points(points), [Block("polygon", array)]
    nodes, starts = _split(array)
    return _points(points), _runs(nodes, starts, np.full(len(starts), 7))


def _from_polydata(points: Given, faces: Given, strips: Given) -> tuple[np.ndarray, list[Block]]:
    """Take the polygons of VTK's surfaces, and see to it that strips of triangles are refused."""
    array, blocks = _from_faces(points, faces)
    row, starts = _split(strips)
    return array, blocks + _runs(row, starts, np.full(len(starts), 6))


def _split(cells: Given) -> tuple[np.ndarray, np.ndarray]:
    """Return VTK's row of cells, and where in it each begins."""
    row = _array(cells, "Cells")
    if row.ndim != 1 or row.dtype.kind not in "iu":
        raise InputError(
            f"The cells are an array of shape {row.shape} and dtype {row.dtype}: give integers in "
            "one row, for each cell its number of points and these, as pyvista has them."
        )
    if len(row) and row[0] > 0 and len(row) % (row[0] + 1) == 0:
        table = row.reshape(-1, row[0] + 1)
        if (table[:, 0] == row[0]).all():
            return row, np.arange(0, len(row), row[0] + 1)
    starts, values, place = [], row.tolist(), 0
    while place < len(values):
        starts.append(place)
        if values[place] < 0 or place + values[place] >= len(values):
            raise InputError(f"The cells end within cell {len(starts) - 1}: give them whole.")
        place += values[place] + 1
    return row, np.array(starts, int)


def _runs(row: np.ndarray, starts: np.ndarray, types: np.ndarray) -> list[Block]:
    """Return cells of one type and length that follow each other as blocks."""
    lengths = row[starts]
    change = np.flatnonzero((types[1:] != types[:-1]) | (lengths[1:] != lengths[:-1])) + 1
    blocks = []
    for run in np.split(np.arange(len(starts)), change):
        if len(run) == 0:
            continue
        number, length = int(types[run[0]]), int(lengths[run[0]])
        vertices = row[starts[run][:, None] + 1 + np.arange(length)]
        if number == _PIXEL and length == 4:
            number, vertices = 9, vertices[:, [0, 1, 3, 2]]
        blocks.append(Block(_VTK_NAMES.get(number, f"VTK type {number}"), vertices))
    return blocks


def _from_skfem(points: Given, cells: Given) -> tuple[np.ndarray, list[Block]]:
    """Take scikit-fem's arrays, which have a column a point and a cell."""
    points, cells = _points(points).T, _array(cells, "Cells").T
    if points.ndim != 2 or cells.ndim != 2:
        raise InputError(
            "p and t are not the arrays of a mesh: give them a column a point, a cell."
        )
    shape = (points.shape[1], cells.shape[1])
    return points, [Block(_SKFEM_NAMES.get(shape, f"of {shape[1]} points"), cells)]


def _from_coordinates(x: Given, y: Given, triangles: Given) -> tuple[np.ndarray, list[Block]]:
    """Take matplotlib's arrays."""
    columns = [_points(x), _points(y)]
    if columns[0].ndim != 1 or columns[0].shape != columns[1].shape:
        raise InputError("x and y are not the coordinates of points: give two rows of one length.")
    return np.column_stack(columns), [_simplices("triangle", triangles)]


def _from_triangles(points: Given, triangles: Given) -> tuple[np.ndarray, list[Block]]:
    return _points(points), [_simplices("triangle", triangles)]


def _from_simplices(points: Given, simplices: Given) -> tuple[np.ndarray, list[Block]]:
    return _points(points), [_simplices("simplex", simplices)]


_KINDS: Sequence[tuple[tuple[str, ...], Callable[..., tuple[np.ndarray, list[Block]]]]] = (
    (("points", "cells", "celltypes"), _from_grid),  # pyvista.UnstructuredGrid
    (("points", "cells"), _from_meshio),
    (("points", "simplices"), _from_simplices),  # scipy
    (("points", "triangles"), _from_triangles),  # lepp
    (("points", "faces", "strips"), _from_polydata),  # pyvista.PolyData
    (("points", "faces"), _from_faces),
    (("x", "y", "triangles"), _from_coordinates),  # matplotlib
    (("vertices", "faces"), _from_faces),  # trimesh
    (("p", "t"), _from_skfem),
)


def _shown(mesh: Given) -> np.ndarray | None:
    """Return which triangles a matplotlib.tri.Triangulation does not mask, if it masks some."""
    mask = getattr(mesh, "mask", None)
    if mask is None or not all(hasattr(mesh, name) for name in ("x", "y", "triangles")):
        return None
    shown = ~np.asarray(mask, bool)
    if shown.shape != (len(mesh.triangles),) or not shown.any():
        raise InputError("The mask of the triangles leaves none, or is not one value a triangle.")
    return shown


def _flattened(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Leave out a third coordinate that is the same at all points in use."""
    if points.shape[1] != 3 or triangles.size == 0:
        return points
    if triangles.min() < 0 or triangles.max() >= len(points):
        return points
    heights = points[triangles, 2]
    return points[:, :2] if (heights == heights[0, 0]).all() else points
