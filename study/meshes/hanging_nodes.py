"""Hanging nodes: vertices that lie inside an edge of another triangle.

Meshes that are refined without regard to the neighbours have them, and T-junctions of surfaces.
The two sides share no edge there, so that both are boundary and no path crosses.
"""

import numpy as np
from scipy.spatial import cKDTree

import lepp
from lepp.geometry.predicates import orientations
from study.meshes.near_points import unit_coordinates

_CANDIDATES = 2_000_000  # looked at together, which bounds the memory


def hanging_nodes(triangulation: lepp.Triangulation) -> np.ndarray:
    """Find the boundary points that lie exactly inside a boundary edge.

    Parameters
    ----------
    triangulation : lepp.Triangulation
        In the plane or in space.

    Returns
    -------
    (k,) int64 ndarray
        Indices of points, ascending.

    Notes
    -----
    The edges are cut into pieces no longer than they are on average, and the points near each piece
    are looked up; so the time is about linear, however long some edges are.
    """
    row, side = np.nonzero(triangulation.neighbors < 0)
    triangles, points = triangulation.triangles, triangulation.points
    start, end = triangles[row, (side + 1) % 3], triangles[row, (side + 2) % 3]
    ids = np.unique(np.concatenate((start, end)))
    if len(ids) < 4:
        return np.empty(0, np.int64)
    places = unit_coordinates(points, triangulation)
    lengths = np.linalg.norm(places[end] - places[start], axis=1)
    n_pieces = np.maximum(np.ceil(lengths / max(lengths.mean(), np.finfo(float).tiny)), 1).astype(
        int
    )
    edge = np.repeat(np.arange(len(row)), n_pieces)
    first = np.cumsum(n_pieces) - n_pieces
    share = ((np.arange(len(edge)) - first[edge]) + 0.5) / n_pieces[edge]
    middle = places[start[edge]] + share[:, None] * (places[end[edge]] - places[start[edge]])
    # Up to the rounding of places and middles, of which all are below 1.
    radius = lengths[edge] / n_pieces[edge] / 2 * (1 + 1e-9) + 16 * np.finfo(float).eps
    tree = cKDTree(places[ids])
    counts = tree.query_ball_point(middle, radius, return_length=True)
    piece = np.arange(len(edge)) - first[edge]
    ends = (piece == 0).astype(int) + (piece == n_pieces[edge] - 1)  # of the edge, in the ball
    hanging = [np.empty(0, np.int64)]
    for count in np.unique(counts[counts > ends]):
        chosen = np.flatnonzero((counts == count) & (counts > ends))
        for part in np.array_split(chosen, len(chosen) * int(count) // _CANDIDATES + 1):
            near = tree.query(middle[part], k=[*range(1, count + 1)])[1]
            point = ids[near.ravel()]
            beside = np.repeat(edge[part], count)
            hanging.append(point[_inside(points, start[beside], end[beside], point)])
    return np.unique(np.concatenate(hanging)).astype(np.int64)


def _inside(points: np.ndarray, a: np.ndarray, b: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Tell which points p lie strictly between a and b on one line, exactly; (k,) bool."""
    inside = (p != a) & (p != b)
    low, high = np.minimum(points[a], points[b]), np.maximum(points[a], points[b])
    inside &= ((points[p] >= low) & (points[p] <= high)).all(axis=1)
    inside &= (points[p] != points[a]).any(axis=1) & (points[p] != points[b]).any(axis=1)
    rest = np.flatnonzero(inside)
    triples = np.column_stack((a[rest], b[rest], p[rest])).astype(np.int32)
    axes = ((0, 1),) if points.shape[1] == 2 else ((0, 1), (1, 2), (2, 0))
    for pair in axes:  # on one line in space: in each of the projections
        plane = np.ascontiguousarray(points[:, pair])
        inside[rest] &= orientations(plane, triples) == 0
    return inside
