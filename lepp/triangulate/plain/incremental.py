"""Plain incremental triangulation: points inserted in the given order, no edge is ever flipped.

A point inside a triangle splits it in three, a point on an edge splits the triangles beside it in
two, a point outside the hull is joined to every hull vertex that it sees.

Without flips nothing outside a triangle ever changes its inside, so the insertion is built like
quicksort rather than point by point. `lepp.triangulate.plain.hull` inserts only the points that
were outside the hull, or on it, at their turn; every other point is handed to the hull triangle
that holds it, its root. `lepp.triangulate.plain.subdivision` splits each root by its first point,
partitions the others, stably, among the parts, and goes on depth first: no point location,
sequential memory, and neighbouring triangles get neighbouring numbers. The result is that of
one-by-one insertion, triangle for triangle.
"""

import numpy as np

from lepp.triangulate.plain.edges import link
from lepp.triangulate.plain.hull import Roots, hull_roots
from lepp.triangulate.plain.subdivision import Mesh, listed, subdivide


def incremental(
    points: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray | None]:
    """Triangulate by plain insertion in the given order.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
        Finite, C-contiguous.

    Returns
    -------
    triangles, neighbors : (m, 3) int32 ndarray
        As in `lepp.Triangulation`; m is 0 when all points lie on one line.
    repeated : (k, 2) int32 ndarray
        Points left out and the points that they repeat.
    ranks : (m,) uint8 ndarray or None
        As from `lepp.geometry.lengths.edge_ranks`: here the coordinates are at hand. None where
        lengths are so near, or so extreme, that only exact arithmetic can find them.
    """
    return subdivided(points, hull_roots(points))


def subdivided(
    points: np.ndarray, roots: Roots
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray | None]:
    """Insert the points that wait inside the roots, or on their sides.

    Returns
    -------
    triangles, neighbors, repeated, ranks
        As from `incremental`.
    """
    n = len(points)
    places, rows, n_edges, split = roots
    starts, room, lists = listed(points, places, len(rows))
    mesh = Mesh(
        np.empty((2 * n, 3), np.int32),
        np.empty((2 * n, 3), np.int32),
        np.zeros(8 * n, np.int32),
        np.empty(2 * n, np.uint8),
    )
    repeats = places.repeats
    m, certain = subdivide(points, rows, starts, room, lists, n_edges, split, repeats, mesh)
    neighbors = mesh.half_edges[:m]
    link(neighbors, mesh.owners)
    left_out = np.flatnonzero(repeats >= 0).astype(np.int32)
    repeated = np.column_stack((left_out, repeats[left_out]))
    return mesh.triangles[:m], neighbors, repeated, mesh.ranks[:m] if certain else None
