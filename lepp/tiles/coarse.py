"""A coarse mesh: the first points of a set, and those that extend its hull, by plain insertion.

No edge is ever removed, so every triangle of the whole set's triangulation lies in one triangle of
the coarse mesh, a *tile*, and what goes on in a tile is decided by the points in it and on its
sides. The coarse mesh is small: of n random points, about log(n)**2 extend the hull.
"""

from dataclasses import dataclass

import numpy as np

from lepp.errors import InputError
from lepp.geometry.predicates import turn_is_certain
from lepp.jit import inner, kernel
from lepp.jit.memory import for_kernels
from lepp.triangulate.plain.hull import hull_roots
from lepp.triangulate.plain.incremental import incremental


@dataclass(frozen=True, eq=False)
class CoarseMesh:
    """The plain insertion of some points of a set; its triangles are the tiles of the whole.

    Attributes
    ----------
    points : (k, 2) float64 ndarray
    indices : (k,) int64 ndarray
        Of these points in the set, ascending.
    triangles, neighbors : (c, 3) int32 ndarray
        As of `lepp.Triangulation`.
    n_repeated : int
        Points among them that are left out, because they repeat another.
    """

    points: np.ndarray
    indices: np.ndarray
    triangles: np.ndarray
    neighbors: np.ndarray
    n_repeated: int

    def __len__(self) -> int:
        return len(self.triangles)


def coarse_mesh(points: np.ndarray, indices: np.ndarray, n_first: int) -> CoarseMesh:
    """Triangulate the first points of a set, and those later ones that extend its hull.

    Parameters
    ----------
    points : (k, 2) float64 ndarray
        Points of the set in the order of insertion: an opening, of `n_first` points at least, and
        of the others all that `outside` does not exclude.
    indices : (k,) int64 ndarray
        Their indices in the set, ascending.
    n_first : int
        Points that the coarse mesh begins with.

    Returns
    -------
    CoarseMesh

    Raises
    ------
    InputError
        If the first points lie on one line.
    """
    points = for_kernels(points, np.float64)
    rows = hull_roots(points).rows
    if len(rows) == 0 or rows[0, 0] >= n_first:  # the first turn
        raise InputError(f"The first {n_first} points lie on one line.")
    # A point that lies on the hull at its turn need not be among them: the tile beside it has it.
    chosen = np.union1d(np.arange(min(n_first, len(points))), rows[:, 0])
    triangles, neighbors, repeated, _ = incremental(np.ascontiguousarray(points[chosen]))
    return CoarseMesh(points[chosen], indices[chosen], triangles, neighbors, len(repeated))


def hull_of(points: np.ndarray) -> np.ndarray:
    """Return the vertices of the hull of a point set, counter-clockwise.

    Parameters
    ----------
    points : (n, 2) float64 ndarray

    Returns
    -------
    (h, 2) float64 ndarray

    Raises
    ------
    InputError
        If all points lie on one line.
    """
    triangles, neighbors, _, _ = incremental(for_kernels(points, np.float64))
    if len(triangles) == 0:
        raise InputError(f"The first {len(points)} points lie on one line.")
    t, k = np.nonzero(neighbors < 0)
    start, stop = triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
    following = dict(zip(start.tolist(), stop.tolist(), strict=True))
    vertices = [int(start[0])]
    while following[vertices[-1]] != vertices[0]:
        vertices.append(following[vertices[-1]])
    return points[vertices]


def outside(hull: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Tell which points may lie outside a convex polygon, or on it.

    Parameters
    ----------
    hull : (h, 2) float64 ndarray
        The vertices of the polygon, counter-clockwise.
    points : (n, 2) float64 ndarray

    Returns
    -------
    (n,) bool ndarray
        False only for points that lie strictly inside.
    """
    order = np.lexsort((hull[:, 1], hull[:, 0]))
    ring = np.roll(hull, -order[0], axis=0)
    right = int(np.flatnonzero((ring == hull[order[-1]]).all(axis=1))[0])
    below, above = ring[: right + 1], np.vstack((ring[right:], ring[:1]))[::-1]
    return _outside(
        _without_uprights(below), _without_uprights(above), for_kernels(points, np.float64)
    )


def _without_uprights(chain: np.ndarray) -> np.ndarray:
    """Leave out the second of two vertices with one abscissa."""
    first = np.append(True, np.diff(chain[:, 0]) > 0)
    return np.ascontiguousarray(chain[first])


@kernel
def _outside(below, above, points):
    """Tell which points are not certainly above one chain and below the other."""
    result = np.empty(len(points), np.bool_)
    for i in range(len(points)):
        x, y = points[i, 0], points[i, 1]
        result[i] = not (_is_beside(below, x, y, 1.0) and _is_beside(above, x, y, -1.0))
    return result


@inner
def _is_beside(chain, x, y, side):
    """Tell whether a point certainly is to the left (1) or right (-1) of a chain."""
    low, high = 0, len(chain) - 1
    if not chain[low, 0] < x < chain[high, 0]:
        return False
    while high - low > 1:
        middle = (low + high) // 2
        if chain[middle, 0] <= x:
            low = middle
        else:
            high = middle
    left = (chain[high, 0] - chain[low, 0]) * (y - chain[low, 1])
    right = (chain[high, 1] - chain[low, 1]) * (x - chain[low, 0])
    return turn_is_certain(left, right) and (left - right) * side > 0.0
