"""Triangulations: points, triangles and who borders on whom."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lepp.errors import InputError, listed
from lepp.geometry.lengths import edge_ranks
from lepp.jit.memory import for_kernels, read_only
from lepp.mesh.checks import (
    RepeatedPoints,
    SoundMesh,
    check_finite,
    check_indices,
    refuse_masked,
    sound_mesh,
)
from lepp.mesh.conversion import mesh_arrays

MAX_POINTS = (2**31 - 1) // 8
"""Points that one mesh can have: their up to 8 n half-edges are numbered in 32 bits."""


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

    Notes
    -----
    The arrays cannot be written through: a mesh does not change.
    """

    points: np.ndarray
    triangles: np.ndarray
    neighbors: np.ndarray
    repeated: np.ndarray = field(default_factory=_no_repeated)
    # Of exactly these points and triangles, where the method of triangulation has found them; not
    # an argument, so that no other mesh is ever made with them.
    _edge_ranks: np.ndarray | None = field(init=False, repr=False, default=None)

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", read_only(self.points, np.float64))
        for name in ("triangles", "neighbors", "repeated"):
            object.__setattr__(self, name, read_only(getattr(self, name), np.int32))

    def __len__(self) -> int:
        return len(self.triangles)

    def __repr__(self) -> str:
        return f"<Triangulation: {len(self.points)} points, {len(self)} triangles>"

    @property
    def n_hull(self) -> int:
        """Number of boundary edges: for a point set, of the points on its hull."""
        return int(np.count_nonzero(self.neighbors < 0))

    def edge_ranks(self, equal_within: float = 0.0) -> np.ndarray:
        """Return the longest and shortest edges of each triangle, (m,) uint8.

        As `lepp.geometry.lengths.edge_ranks`, which says what a byte holds.
        """
        if equal_within == 0.0 and self._edge_ranks is not None:
            return self._edge_ranks
        return edge_ranks(self.points, self.triangles, equal_within=equal_within)

    @classmethod
    def from_arrays(
        cls,
        points: np.ndarray,
        triangles: np.ndarray,
        *,
        repeated_points: RepeatedPoints = "refuse",
    ) -> "Triangulation":
        """Build the neighbours of given triangles, and check them.

        Parameters
        ----------
        points : (n, 2) or (n, 3) array_like of float
            Coordinates, of a mesh in the plane or of a surface in space; finite where they are in
            use.
        triangles : (m, 3) array_like of int
            Vertices of each triangle, in any order: in the plane all are made to turn
            counter-clockwise.
        repeated_points : {"refuse", "merge", "keep"}
            What to do about points in use with exactly the coordinates of another: raise an error,
            take the first of them for all (and list them in `repeated`), or leave the mesh cut
            there.

        Raises
        ------
        MeshError
            All that is wrong: indices out of range, coordinates that are not finite, repeated
            points, triangles that have no area, repeat another or lie over a neighbour, edges with
            more than two triangles.
        InputError
            Arrays of another shape or dtype, or with a mask.

        Notes
        -----
        Points that no triangle uses, holes and several pieces are all right. So are, in space,
        neighbours that are oriented differently: a path goes by lengths and neighbours only.
        """
        return linked(points, triangles, repeated_points)[0]

    @classmethod
    def from_object(
        cls,
        mesh: Any,  # noqa: ANN401 - whatever has the attributes
        *,
        split_quads: bool = False,
        ignore_volumes: bool = False,
        repeated_points: RepeatedPoints = "refuse",
    ) -> "Triangulation":
        """Take a mesh object of another library as it is.

        Parameters
        ----------
        mesh : object
            A Triangulation, scipy.spatial.Delaunay, matplotlib.tri.Triangulation, meshio.Mesh,
            pyvista.UnstructuredGrid or PolyData, trimesh.Trimesh, skfem.MeshTri, a dictionary of
            the package triangle, or a pair of points and triangles. Triangles of several blocks
            are joined, in order; those that matplotlib masks are left out; of curved ones the
            corners are taken. A third coordinate that is the same everywhere is dropped.
        split_quads : bool
            Split each quad in two, along its shorter diagonal that lies inside.
        ignore_volumes : bool
            Take the triangles of a mesh that has tetrahedra or other volumes as well.
        repeated_points : {"refuse", "merge", "keep"}
            As for `from_arrays`.

        Raises
        ------
        MeshError
            As `from_arrays`, and cells that are not triangles.
        InputError
            An object of another kind, without triangles, or with arrays that are masked.
        """
        given = mesh_arrays(mesh, split_quads=split_quads, ignore_volumes=ignore_volumes)
        return cls.from_arrays(given.points, given.triangles, repeated_points=repeated_points)


def linked(
    points: np.ndarray, triangles: np.ndarray, repeated_points: RepeatedPoints
) -> tuple[Triangulation, SoundMesh]:
    """Build the neighbours of triangles; return also what was found on the way.

    Parameters, errors : as `Triangulation.from_arrays`.
    """
    points = check_points(points, dimensions=(2, 3), all_finite=False)
    triangles = check_indices(triangles, len(points))
    check_finite(points, triangles)
    sound = sound_mesh(points, triangles, repeated_points)
    return Triangulation(points, sound.triangles, sound.neighbors, sound.repeated), sound


def check_points(
    points: np.ndarray, dimensions: Sequence[int] = (2,), *, all_finite: bool = True
) -> np.ndarray:
    """Return points as a float64 array for kernels, or say why they cannot be used.

    Raises
    ------
    InputError
        Wrong shape or dtype, a mask, fewer than three points, or, if all are to be, coordinates
        that are not finite.
    """
    refuse_masked(points, "Points")
    try:
        array = np.asarray(points)
    except (TypeError, ValueError) as error:
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
    if len(array) > MAX_POINTS:
        raise InputError(f"{len(array)} points are more than one mesh can hold ({MAX_POINTS}).")
    array = for_kernels(array, np.float64)
    if all_finite and not np.isfinite(array).all():
        bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
        raise InputError(f"Points {listed(bad)} have coordinates that are not finite: remove them.")
    return array
