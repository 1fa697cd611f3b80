"""A mesh of half-edges that can be changed: what Delaunay insertion works on.

The mesh is one array of rows, a row a triangle, of 8 unsigned 32-bit lanes:

- lane k, for k = 0, 1, 2: vertex k, counter-clockwise;
- lane 4 + k: the twin of half-edge k, which is across from vertex k;
- lanes 3 and 7: not used.

Half-edge k of the triangle in row t has the number 8 t + k, so that ``rows[h]`` is the vertex
across from half-edge h, and ``rows[h + 4]`` its twin. One more vertex, at infinity, makes an outer
triangle with each edge of the hull.
"""

import numpy as np

from lepp.jit import inner, kernel

_U0, _U1, _U2, _U3 = (np.uint64(k) for k in (0, 1, 2, 3))


@inner
def next_of(h):
    """Return the half-edge after h, counter-clockwise, in its triangle.

    Parameters
    ----------
    h : uint64
        Number of a half-edge.

    Returns
    -------
    uint64
    """
    return h - _U2 if h & _U3 == _U2 else h + _U1


@inner
def previous_of(h):
    """Return the half-edge before h in its triangle.

    Parameters
    ----------
    h : uint64
        Number of a half-edge.

    Returns
    -------
    uint64
    """
    return h + _U2 if h & _U3 == _U0 else h - _U1


@kernel
def write_first_triangle(rows, first, second, third, infinity):
    """Write a triangle into row 0, and the three outside it into the next.

    Parameters
    ----------
    rows : (32,) or longer uint32 ndarray, output
        Rows of 8 lanes, one after the other.
    first, second, third : int
        Vertices, counter-clockwise.
    infinity : int
        The vertex of the outer triangles.
    """
    corners = (first, second, third)
    for k in range(3):
        after, before = (k + 1) % 3, (k + 2) % 3
        outer = 8 * (1 + k)
        rows[k], rows[4 + k] = corners[k], outer
        rows[outer], rows[outer + 1], rows[outer + 2] = infinity, corners[before], corners[after]
        rows[outer + 4] = k
        rows[outer + 5] = 8 * (1 + before) + 2
        rows[outer + 6] = 8 * (1 + after) + 1
