"""Points that nearly agree: counted where a mesh falls apart between them, and joined.

Distances are relative to the extent of the mesh: the longest side of its bounding box.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

import lepp

NEAR = 1e-5
"""Distance up to which boundary points are said to nearly agree."""

MOST_MERGED = 0.01
"""The largest distance within which points can be joined."""

_SHARE_OF_EDGE = 0.1  # points nearer than this to the length of an edge there are no corners of one
_MOST_PAIRS = 20_000_000


@dataclass(frozen=True)
class NearPoints:
    """Boundary points that nearly agree with another, but not exactly.

    Attributes
    ----------
    count : int
        Points no farther than `NEAR` from another, and than a tenth of the shortest edge there.
    merge_within : float or None
        A distance that joins all of them: the first power of ten from twice the largest on.
    """

    count: int
    merge_within: float | None


def near_points(triangulation: lepp.Triangulation) -> NearPoints:
    """Count the boundary points of a mesh that nearly agree with another.

    Parameters
    ----------
    triangulation : lepp.Triangulation

    Returns
    -------
    NearPoints
        Points at the very same place are not counted.
    """
    triangles = triangulation.triangles
    row, side = np.nonzero(triangulation.neighbors < 0)
    ends = np.stack((triangles[row, (side + 1) % 3], triangles[row, (side + 2) % 3]))
    ids, place = np.unique(ends, return_inverse=True)
    if len(ids) < 2:
        return NearPoints(0, None)
    points = unit_coordinates(triangulation.points[ids], triangulation)
    start, end = place.reshape(ends.shape)
    lengths = np.linalg.norm(points[start] - points[end], axis=1)
    shortest = np.full(len(ids), np.inf)
    np.minimum.at(shortest, start, lengths)
    np.minimum.at(shortest, end, lengths)
    places, same = _distinct(points)
    if len(places) < 2:
        return NearPoints(0, None)
    distances = cKDTree(places).query(places, k=2)[0][:, 1][same]
    near = distances <= np.minimum(NEAR, _SHARE_OF_EDGE * shortest)
    if not near.any():
        return NearPoints(0, None)
    exponent = int(np.ceil(np.log10(max(2.0 * distances[near].max(), 1e-300))))
    return NearPoints(int(near.sum()), float(f"1e{exponent}"))


def moved_together(points: np.ndarray, triangles: np.ndarray, within: float) -> np.ndarray:
    """Give points that nearly agree the same coordinates.

    Points are joined that are no farther than `within` from each other, directly or by way of
    further points; all of them get the coordinates of the one with the lowest index.

    Parameters
    ----------
    points : (n, 2) or (n, 3) ndarray of float
    triangles : (m, 3) ndarray of int
        Only points that these use are joined.
    within : float
        Relative to the extent of the points in use; above 0, at most `MOST_MERGED`.

    Returns
    -------
    ndarray like points

    Raises
    ------
    lepp.InputError
        Another distance, or one that joins too many points.
    """
    if not 0.0 < within <= MOST_MERGED:
        raise lepp.InputError(
            f"Points cannot be merged within {within:g} of the mesh's extent: give a share above 0 "
            f"and at most {MOST_MERGED:g}."
        )
    used = _used(triangles, len(points))
    low, high = points[used].min(axis=0), points[used].max(axis=0)
    places, same = _distinct(points[used])
    tree = cKDTree(_scaled(places, low, high))
    if tree.count_neighbors(tree, within) > 2 * _MOST_PAIRS:
        raise lepp.InputError(
            f"Too many points lie within {within:g} of the mesh's extent from each other: merge "
            "within less."
        )
    pairs = tree.query_pairs(within, output_type="ndarray")
    graph = coo_array(
        (np.ones(len(pairs), bool), (pairs[:, 0], pairs[:, 1])), shape=(len(places), len(places))
    )
    cluster = connected_components(graph, directed=False)[1][same]
    _, lowest = np.unique(cluster, return_index=True)  # used is ascending
    moved = points.copy()
    moved[used] = points[used[lowest[cluster]]]
    return moved


def unit_coordinates(points: np.ndarray, triangulation: lepp.Triangulation) -> np.ndarray:
    """Return points in units of the extent of a mesh, from its middle.

    Parameters
    ----------
    points : (k, 2) or (k, 3) float64 ndarray
    triangulation : lepp.Triangulation
        With as many coordinates.

    Returns
    -------
    float64 ndarray like points
        Between -1/2 and 1/2 for the points that the mesh uses.
    """
    used = triangulation.points[_used(triangulation.triangles, len(triangulation.points))]
    return _scaled(points, used.min(axis=0), used.max(axis=0))


def _used(triangles: np.ndarray, n_points: int) -> np.ndarray:
    """Return the points that triangles use, ascending."""
    used = np.zeros(n_points, bool)
    used[triangles] = True
    return np.flatnonzero(used)


def _distinct(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the points that differ, and for each of the given ones which of them it is."""
    order = np.lexsort(points.T)
    new = np.ones(len(points), bool)
    new[1:] = (points[order[1:]] != points[order[:-1]]).any(axis=1)
    same = np.empty(len(points), np.int64)
    same[order] = np.cumsum(new) - 1
    return points[order[new]], same


def _scaled(points: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    half = max(float((high / 2 - low / 2).max()), np.finfo(float).tiny)
    return (points - (low / 2 + high / 2)) / half / 2
