"""Cells of a grid that lie in one root triangle: whoever is in such a cell is in that root."""

from math import ceil, floor, sqrt

import numpy as np

from lepp.geometry.predicates import orientation
from lepp.jit import inner, kernel
from lepp.triangulate.plain.waiting import INSIDE, Places

#: A cell is taken to be larger by this part of its width, on each side. That is more than the
#: rounding of the cell that a point is counted to, below 2**-40 of a width; and as no point lies
#: between a corner and the double next to it, the rounding of corners does no harm.
_MARGIN = 2.0**-10
_MOST = 1 << 10  # rows and columns


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
    n_cells = min(int(sqrt(len(points) - first)), _MOST)
    x_low, x_width = _columns(points[:first, 0], n_cells)
    y_low, y_width = _columns(points[:first, 1], n_cells)
    if not (0.0 < x_width < np.inf and 0.0 < y_width < np.inf):
        return  # no doubles for them
    cells = np.full(n_cells * n_cells, -1, np.int32)
    for root in range(len(roots)):
        _fill(cells, n_cells, points, roots[root], root, (x_low, y_low, x_width, y_width))
    x_scale, y_scale = 1.0 / x_width, 1.0 / y_width
    for i in range(first, len(points)):
        column, row = (points[i, 0] - x_low) * x_scale, (points[i, 1] - y_low) * y_scale
        if (column >= 0.0) & (column < n_cells) & (row >= 0.0) & (row < n_cells):
            root = cells[int(row) * n_cells + int(column)]
            places.of[i] = root
            if root >= 0:
                places.state[i] = INSIDE


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
def _fill(cells, n_cells, points, row, root, grid):
    """Mark the cells that lie in a root triangle, row of cells by row of cells.

    A run of cells is inside if its four corners are. Where it begins and ends is computed as it
    comes, and then proven by the exact predicate.
    """
    x_low, y_low, x_width, y_width = grid
    u, v = np.empty(4), np.empty(4)  # the vertices, in cells; the first once more
    for j in range(4):
        vertex = row[j % 3]
        u[j] = (points[vertex, 0] - x_low) / x_width
        v[j] = (points[vertex, 1] - y_low) / y_width
    first, stop = max(ceil(min(v)), 0), min(floor(max(v)), n_cells)
    for k in range(first, stop):
        left, right = 0.0, float(n_cells)
        for j in range(3):
            slope = (u[j + 1] - u[j]) / (v[j + 1] - v[j])
            below, above = u[j] + slope * (k - v[j]), u[j] + slope * (k + 1 - v[j])
            if v[j + 1] < v[j]:
                left = max(left, below, above)
            elif v[j + 1] > v[j]:
                right = min(right, below, above)
        begin, end = ceil(left), floor(right)
        if begin < end and _holds(
            points, row,
            (x_low + (begin - _MARGIN) * x_width, y_low + (k - _MARGIN) * y_width,
             x_low + (end + _MARGIN) * x_width, y_low + (k + 1 + _MARGIN) * y_width),
        ):  # fmt: skip
            cells[k * n_cells + begin : k * n_cells + end] = root


@inner
def _holds(points, row, box):
    """Tell whether a box lies inside a triangle."""
    left, below, right, above = box
    for j in range(3):
        a, b = row[j], row[(j + 1) % 3]
        a_x, a_y, b_x, b_y = points[a, 0], points[a, 1], points[b, 0], points[b, 1]
        if (
            orientation(a_x, a_y, b_x, b_y, left, below) <= 0
            or orientation(a_x, a_y, b_x, b_y, right, below) <= 0
            or orientation(a_x, a_y, b_x, b_y, right, above) <= 0
            or orientation(a_x, a_y, b_x, b_y, left, above) <= 0
        ):
            return False
    return True
