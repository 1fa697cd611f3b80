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
    n_cells = min(int(sqrt((len(points) - first) / 2)), _MOST)
    x_low, x_width = _columns(points[:first, 0], n_cells)
    y_low, y_width = _columns(points[:first, 1], n_cells)
    if not (0.0 < x_width < np.inf and 0.0 < y_width < np.inf):
        return  # no doubles for them
    cells = np.full(n_cells * n_cells, -1, np.int32)
    for root in range(len(roots)):
        a, b, c = roots[root, 0], roots[root, 1], roots[root, 2]
        corners = (
            points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
        )  # fmt: skip
        _fill(cells, n_cells, corners, root, (x_low, y_low, x_width, y_width))
    x_scale, y_scale = 1.0 / x_width, 1.0 / y_width
    of, state = places.of, places.state
    for i in range(first, len(points)):
        column, row = (points[i, 0] - x_low) * x_scale, (points[i, 1] - y_low) * y_scale
        is_there = (column >= 0.0) & (column < n_cells) & (row >= 0.0) & (row < n_cells)
        cell = int(row) * n_cells + int(column) if is_there else 0
        root = cells[cell] if is_there else -1
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
    """Mark the cells that lie in a root triangle, row of cells by row of cells.

    A run of cells is inside if its four corners are. Where it begins and ends is computed as it
    comes, and then proven by the exact predicate.
    """
    a_x, a_y, b_x, b_y, c_x, c_y = corners
    x_low, y_low, x_width, y_width = grid
    u = ((a_x - x_low) / x_width, (b_x - x_low) / x_width, (c_x - x_low) / x_width)
    v = ((a_y - y_low) / y_width, (b_y - y_low) / y_width, (c_y - y_low) / y_width)
    first, stop = max(ceil(min(v)), 0), min(floor(max(v)), n_cells)
    for k in range(first, stop):
        left, right = 0.0, float(n_cells)
        for j in range(3):
            next_u, next_v = u[j - 2], v[j - 2]
            slope = (next_u - u[j]) / (next_v - v[j])
            below, above = u[j] + slope * (k - v[j]), u[j] + slope * (k + 1 - v[j])
            if next_v < v[j]:
                left = max(left, below, above)
            elif next_v > v[j]:
                right = min(right, below, above)
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
def _is_left(a_x, a_y, b_x, b_y, box):
    """Tell whether a box lies to the left of an edge: whether its rightmost corner does."""
    left, below, right, above = box
    x, y = right if b_y > a_y else left, below if b_x > a_x else above
    return orientation(a_x, a_y, b_x, b_y, x, y) > 0
