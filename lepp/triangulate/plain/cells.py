"""Which root triangle a point lies in: a grid tells of most, and the way from there of the others.

Who is in a cell that lies in one root is in that root. From any other cell, the root of a cell near
it leads over some sides to the one that is sought.
"""

from math import ceil, floor, sqrt

import numpy as np

from lepp.geometry.predicates import orientation, turn_is_certain
from lepp.jit import inner, kernel
from lepp.triangulate.plain.edges import link
from lepp.triangulate.plain.waiting import INSIDE, Places

#: A cell is taken to be larger by this part of its width, on each side. That is more than the
#: rounding of the cell that a point is counted to, below 2**-40 of a width; and as no point lies
#: between a corner and the double next to it, the rounding of corners does no harm.
_MARGIN = 2.0**-10
_MOST = 1 << 10  # rows and columns
_NOWHERE = -1  # of a cell that no root touches; one that root r touches has _TOUCHED - r
_TOUCHED = -2
_STEPS = 16  # from root to root, before a point is left to be swept: few need more than 4


@kernel
def settle_by_cells(points: np.ndarray, first: int, roots: np.ndarray, places: Places) -> None:
    """Hand points over to the roots that certainly hold them.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
    first : int
        Points from here on are looked at; those before span the grid.
    roots : (r, 6) int32 ndarray
        Vertices of the root triangles, and their half-edges.
    places : Places
        Points that are found become `INSIDE`; the others stay as they are.
    """
    n_cells = min(int(sqrt((len(points) - first) / 2)), _MOST)
    x_low, x_width = _columns(points[:first, 0], n_cells)
    y_low, y_width = _columns(points[:first, 1], n_cells)
    if not (0.0 < x_width < np.inf and 0.0 < y_width < np.inf):
        return  # no doubles for them
    cells = np.full(n_cells * n_cells, _NOWHERE, np.int32)
    corners_of = np.empty((len(roots), 6))
    for root in range(len(roots)):
        a, b, c = roots[root, 0], roots[root, 1], roots[root, 2]
        corners = (
            points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
        )  # fmt: skip
        _fill(cells, n_cells, corners, root, (x_low, y_low, x_width, y_width))
        for k in range(6):
            corners_of[root, k] = corners[k]
    neighbors = _neighbors(roots)
    x_scale, y_scale = 1.0 / x_width, 1.0 / y_width
    of, state = places.of, places.state
    for i in range(first, len(points)):
        column, row = (points[i, 0] - x_low) * x_scale, (points[i, 1] - y_low) * y_scale
        is_there = (column >= 0.0) & (column < n_cells) & (row >= 0.0) & (row < n_cells)
        if not is_there:
            continue
        root = cells[int(row) * n_cells + int(column)]
        if root <= _TOUCHED:
            root = _root_from(_TOUCHED - root, corners_of, neighbors, points[i, 0], points[i, 1])
        of[i] = root
        state[i] = INSIDE if root >= 0 else state[i]


@inner
def _columns(along, n_cells):
    """Divide the range of some coordinates into columns.

    Returns
    -------
    low, width : float
        Where the first begins, and the width of each.
    """
    low = high = along[0]
    for value in along:
        low, high = min(low, value), max(high, value)
    return low, (high - low) / n_cells


@inner
def _fill(cells, n_cells, corners, root, grid):
    """Mark the cells that lie in a root triangle, and those that it touches, row by row.

    A run of cells is inside if its four corners are. Where it begins and ends is computed as it
    comes, and then proven by the exact predicate. Of the others nothing has to be proven.
    """
    a_x, a_y, b_x, b_y, c_x, c_y = corners
    x_low, y_low, x_width, y_width = grid
    u = ((a_x - x_low) / x_width, (b_x - x_low) / x_width, (c_x - x_low) / x_width)
    v = ((a_y - y_low) / y_width, (b_y - y_low) / y_width, (c_y - y_low) / y_width)
    for k in range(max(floor(min(v)), 0), min(ceil(max(v)), n_cells)):
        left, right = 0.0, float(n_cells)
        west, east = right, left
        for j in range(3):
            next_u, next_v = u[j - 2], v[j - 2]
            if next_v == v[j]:
                continue
            slope = (next_u - u[j]) / (next_v - v[j])
            below, above = u[j] + slope * (k - v[j]), u[j] + slope * (k + 1 - v[j])
            if next_v < v[j]:
                left = max(left, below, above)
            else:
                right = min(right, below, above)
            low, high = max(min(v[j], next_v), k), min(max(v[j], next_v), k + 1)
            if low <= high:
                one, other = u[j] + slope * (low - v[j]), u[j] + slope * (high - v[j])
                west, east = min(west, one, other), max(east, one, other)
        for column in range(max(floor(west), 0), min(ceil(east), n_cells)):
            if cells[k * n_cells + column] < 0:
                cells[k * n_cells + column] = _TOUCHED - root
        begin, end = ceil(left), floor(right)
        box = (
            x_low + (begin - _MARGIN) * x_width, y_low + (k - _MARGIN) * y_width,
            x_low + (end + _MARGIN) * x_width, y_low + (k + 1 + _MARGIN) * y_width,
        )  # fmt: skip
        if (
            begin < end
            and _is_left(a_x, a_y, b_x, b_y, box)
            and _is_left(b_x, b_y, c_x, c_y, box)
            and _is_left(c_x, c_y, a_x, a_y, box)
        ):
            for cell in range(k * n_cells + begin, k * n_cells + end):
                cells[cell] = root


@inner
def _neighbors(roots):
    """Return the root beyond each side, (r, 3) int32; -1 at the hull and at a side in parts."""
    most = 0
    for root in range(len(roots)):
        most = max(most, roots[root, 3], roots[root, 4], roots[root, 5])
    owners = np.zeros(most + 2, np.int32)
    neighbors = np.empty((len(roots), 3), np.int32)
    for root in range(len(roots)):
        for k in range(3):
            neighbors[root, k] = roots[root, 3 + k]
            owners[neighbors[root, k]] = root + 1
    link(neighbors, owners)
    return neighbors


@inner
def _root_from(root, corners_of, neighbors, x, y):
    """Go from a root towards a point, and return the root that certainly holds it, or -1.

    Parameters
    ----------
    root : int
        Where to begin.
    corners_of : (r, 6) float64 ndarray
        Coordinates of the vertices of each root.
    neighbors : (r, 3) int32 ndarray
        From `_neighbors`.
    x, y : float
        Of the point.
    """
    for _ in range(_STEPS):
        a_x, a_y = corners_of[root, 0] - x, corners_of[root, 1] - y
        b_x, b_y = corners_of[root, 2] - x, corners_of[root, 3] - y
        c_x, c_y = corners_of[root, 4] - x, corners_of[root, 5] - y
        b_c, c_b = b_x * c_y, b_y * c_x
        c_a, a_c = c_x * a_y, c_y * a_x
        a_b, b_a = a_x * b_y, a_y * b_x
        if (b_c > c_b) & (c_a > a_c) & (a_b > b_a):
            certain = (
                turn_is_certain(b_c, c_b) & turn_is_certain(c_a, a_c) & turn_is_certain(a_b, b_a)
            )
            return root if certain else -1
        beyond = 0 if b_c < c_b else (1 if c_a < a_c else 2)
        root = neighbors[root, beyond]
        if root < 0:
            return -1
    return -1


@inner
def _is_left(a_x, a_y, b_x, b_y, box):
    """Tell whether a box lies to the left of an edge: whether its rightmost corner does."""
    left, below, right, above = box
    x, y = right if b_y > a_y else left, below if b_x > a_x else above
    return orientation(a_x, a_y, b_x, b_y, x, y) > 0
