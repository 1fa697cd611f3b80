"""What the published theory says of LEPP sizes, and the worst case.

Theorems 1 and 2 and equation 1 of "Study on the Average Size of the Longest-Edge Propagation Path
for Triangulations". Theorem 1 takes it that each longest-edge neighbour is of type C, and so ends
the path, with the same probability p: the sizes from 2 on then follow a geometric law. It leaves
out the triangles whose longest edge is on the boundary.
"""

import numpy as np

from lepp.errors import InputError
from lepp.triangulation import Triangulation


def mean(p: float) -> float:
    """Return the mean LEPP size (p + 1) / p (Theorem 1)."""
    return (p + 1.0) / p


def sd(p: float) -> float:
    """Return the standard deviation of LEPP sizes, sqrt(1 - p) / p (Theorem 1)."""
    return float(np.sqrt(1.0 - p)) / p


def skewness(p: float) -> float:
    """Return the skewness of LEPP sizes, (2 - p) / sqrt(1 - p) (Theorem 1, equation 5)."""
    return (2.0 - p) / float(np.sqrt(1.0 - p))


def kurtosis(p: float) -> float:
    """Return the excess kurtosis of LEPP sizes, (p**2 - 6 p + 6) / (1 - p) (Theorem 1, eq. 6)."""
    return (p * p - 6.0 * p + 6.0) / (1.0 - p)


def probability(size: np.ndarray | int, p: float) -> np.ndarray:
    """Return the probability of LEPP sizes under Theorem 1: (1 - p)**(size - 2) p, from 2 on."""
    size = np.asarray(size)
    return np.where(size >= 2, (1.0 - p) ** np.maximum(size - 2.0, 0.0) * p, 0.0)


def bounds(p_min: float = 1.0 / 3.0) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the bounds of the mean and of the standard deviation for p_min <= p <= 1.

    Theorem 2: ((2, 4), (0, sqrt(6))) for p_min = 1/3.
    """
    return (2.0, mean(p_min)), (0.0, sd(p_min))


def worst_case_strip(n: int) -> Triangulation:
    """Return a strip of n triangles whose first LEPP holds all of them.

    The sizes are n, n - 1, ..., 1 and their mean is (n + 1) / 2 (equation 1). The strip is a zigzag
    between two almost parallel lines that open slowly: every edge across it is longer than the one
    before, and than the two edges along the lines beside it.

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
    # Vertex k is half a step along and on alternate sides: edges k - 1, k then have the length of
    # about the width there, which grows by half of its first value in all.
    width = 1.0 + 0.5 * k / (n + 2)
    points = np.column_stack((0.25 * k, np.where(k % 2, width, 0.0)))
    triangles = np.column_stack((k[:-2], k[1:-1], k[2:]))
    triangles[1::2] = triangles[1::2][:, [0, 2, 1]]
    return Triangulation.from_arrays(points, triangles[:, [0, 2, 1]])
