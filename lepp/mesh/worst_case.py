"""The worst case (equation 1): a strip of triangles whose first path covers all of it."""

import numpy as np

from lepp.errors import InputError
from lepp.mesh.triangulation import Triangulation


def worst_case_strip(n: int) -> Triangulation:
    """Return a strip of n triangles whose first LEPP holds all of them.

    The sizes are n, n - 1, ..., 1 and their mean is (n + 1) / 2 (equation 1). The strip is a zigzag
    between two almost parallel lines that open slowly: every edge across it is longer than the one
    before, and than the edges along the lines.

    Parameters
    ----------
    n : int
        Number of triangles, at least 1.

    Returns
    -------
    Triangulation
        Of n + 2 points; triangle t has the vertices t, t + 1, t + 2, and the next is its successor.
    """
    if n < 1:
        raise InputError(f"A strip of {n} triangles cannot be made: ask for at least 1.")
    k = np.arange(n + 2)
    # Vertices stand on alternate sides of a middle line, a quarter apart along it: the edge from k
    # to k + 1 has about the width there, which grows by half of its first value in all.
    half_width = 0.5 + 0.25 * k / (n + 2)
    points = np.column_stack((0.25 * k, np.where(k % 2, half_width, -half_width)))
    triangles = np.column_stack((k[:-2], k[1:-1], k[2:]))
    triangles[1::2] = triangles[1::2][:, [0, 2, 1]]
    return Triangulation.from_arrays(points, triangles[:, [0, 2, 1]])
