"""Points, edges, boundary, pieces and holes of a mesh."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

import lepp
from study.meshes.read import unused_points


@dataclass(frozen=True)
class Topology:
    """Numbers that no change of coordinates changes.

    Attributes
    ----------
    dimensions : int
        2 or 3.
    n_points : int
        Those in use.
    n_unused_points, n_merged_points, n_triangles, n_edges, n_boundary_edges : int
    n_boundary_loops : int
        Connected parts of the boundary.
    n_pieces : int
        Parts of the mesh that are joined across edges.
    euler_number : int
    n_holes : int or None
        None in space.
    """

    dimensions: int
    n_points: int
    n_unused_points: int
    n_merged_points: int
    n_triangles: int
    n_edges: int
    n_boundary_edges: int
    n_boundary_loops: int
    n_pieces: int
    euler_number: int
    n_holes: int | None


def topology(triangulation: lepp.Triangulation) -> Topology:
    """Count what a mesh consists of.

    Parameters
    ----------
    triangulation : lepp.Triangulation

    Returns
    -------
    Topology
        As the triangles are joined: two sides of a hanging node are boundary, not joined.
    """
    triangles, neighbors = triangulation.triangles, triangulation.neighbors
    m, n = len(triangles), len(triangulation.points)
    unused, merged = len(unused_points(triangulation)), len(triangulation.repeated)
    used = n - unused - merged
    n_boundary = triangulation.n_hull
    n_edges = (3 * m + n_boundary) // 2
    euler = used - n_edges + m
    row, side = np.nonzero(neighbors >= 0)
    n_pieces = _n_groups(row, neighbors[row, side], m)
    row, side = np.nonzero(neighbors < 0)
    start, end = triangles[row, (side + 1) % 3], triangles[row, (side + 2) % 3]
    loops = _n_groups(start, end, n) - (n - len(np.unique(np.concatenate((start, end)))))
    touching = _n_groups(triangles[:, [0, 1]].ravel(), triangles[:, [1, 2]].ravel(), n)
    dimensions = triangulation.points.shape[1]
    # In the plane, b0 - b1 is the Euler number, and b1 counts the holes.
    n_holes = touching - (n - used) - euler if dimensions == 2 else None
    return Topology(
        dimensions, used, unused, merged, m, n_edges, n_boundary, loops, n_pieces, euler, n_holes
    )


def _n_groups(start: np.ndarray, end: np.ndarray, n: int) -> int:
    """Return into how many connected groups some edges join n nodes."""
    graph = coo_array((np.ones(len(start), bool), (start, end)), shape=(n, n))
    return int(connected_components(graph, directed=False, return_labels=False))
