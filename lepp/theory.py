"""What the published theory says of LEPP sizes.

Theorems 1 and 2 of "Study on the Average Size of the Longest-Edge Propagation Path
for Triangulations". Theorem 1 takes it that each longest-edge neighbour is of type C, and so ends
the path, with the same probability p: the sizes from 2 on then follow a geometric law. It leaves
out the triangles whose longest edge is on the boundary.
"""

from fractions import Fraction

import numpy as np

LEAST_P = 1.0 / 3.0
"""The least chance p that a step ends the path, which Theorem 2 supposes."""
LEAST_P_TEXT = str(Fraction(LEAST_P).limit_denominator(100))
"""The same as a reader sees it."""


def mean(p: float) -> float:
    """Return the mean LEPP size under Theorem 1, (p + 1) / p.

    Parameters
    ----------
    p : float
        Chance that a step ends the path; 0 < p <= 1.

    Returns
    -------
    float
        In triangles.
    """
    return (p + 1.0) / p


def sd(p: float) -> float:
    """Return the standard deviation of LEPP sizes under Theorem 1, sqrt(1 - p) / p.

    Parameters
    ----------
    p : float
        Chance that a step ends the path; 0 < p <= 1.

    Returns
    -------
    float
        In triangles.
    """
    return float(np.sqrt(1.0 - p)) / p


def skewness(p: float) -> float:
    """Return the skewness of LEPP sizes under Theorem 1, (2 - p) / sqrt(1 - p) (equation 5).

    Parameters
    ----------
    p : float
        Chance that a step ends the path; 0 < p < 1.

    Returns
    -------
    float
        Third central moment over the cube of the standard deviation.

    Raises
    ------
    ZeroDivisionError
        If p is 1: all sizes are 2.
    """
    return (2.0 - p) / float(np.sqrt(1.0 - p))


def kurtosis(p: float) -> float:
    """Return the excess kurtosis of LEPP sizes under Theorem 1, (p**2 - 6 p + 6) / (1 - p) (eq. 6).

    Parameters
    ----------
    p : float
        Chance that a step ends the path; 0 < p < 1.

    Returns
    -------
    float
        Fourth central moment over the squared variance, minus 3.

    Raises
    ------
    ZeroDivisionError
        If p is 1: all sizes are 2.
    """
    return (p * p - 6.0 * p + 6.0) / (1.0 - p)


def probability(size: np.ndarray | int, p: float) -> np.ndarray:
    """Return the probability of LEPP sizes under Theorem 1: (1 - p)**(size - 2) p, from 2 on.

    Parameters
    ----------
    size : int or ndarray of int
        In triangles, of any shape.
    p : float
        Chance that a step ends the path; 0 < p <= 1.

    Returns
    -------
    float64 ndarray like size
        0 below a size of 2: triangles whose longest edge is on the boundary are left out.
    """
    size = np.asarray(size)
    return np.where(size >= 2, (1.0 - p) ** np.maximum(size - 2.0, 0.0) * p, 0.0)


def bounds(p_min: float = LEAST_P) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the bounds of the mean and of the standard deviation for p_min <= p <= 1.

    Theorem 2: ((2, 4), (0, sqrt(6))) for p_min = 1/3.

    Parameters
    ----------
    p_min : float
        The least chance that a step ends the path; 0 < p_min <= 1.

    Returns
    -------
    of_mean, of_sd : (float, float)
        Lower and upper bound, in triangles.
    """
    return (2.0, mean(p_min)), (0.0, sd(p_min))
