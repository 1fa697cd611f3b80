"""Games and Howell's comparison of all pairs of groups, for unequal variances."""

import numpy as np
from numpy.polynomial import Chebyshev

from study.statistics.groups import Groups
from study.statistics.studentized_range import studentized_range_critical, studentized_range_tail
from study.statistics.thresholds import CONFIDENCE

#: The critical value is smooth in 1 / df: a polynomial of this degree is exact to 1e-8.
_DEGREE = 16


def games_howell(
    groups: Groups, first: np.ndarray, second: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compare pairs of groups.

    Parameters
    ----------
    groups : Groups
        All groups of the family; each with a positive variance.
    first, second : (m,) integer ndarray
        Indices of the groups of each pair.

    Returns
    -------
    difference, half, p : (m,) float64 ndarray
        Second mean less first, half the length of its simultaneous interval, adjusted p-value.

    Notes
    -----
    Games and Howell (1976), Journal of Educational Statistics 1, 113-125.
    """
    k = len(groups)
    error = groups.variances / groups.counts
    both = error[first] + error[second]
    df = both**2 / (
        error[first] ** 2 / (groups.counts[first] - 1)
        + error[second] ** 2 / (groups.counts[second] - 1)
    )
    scale = np.sqrt(both / 2)
    difference = groups.means[second] - groups.means[first]
    p = studentized_range_tail(np.abs(difference) / scale, k, df)
    return difference, _critical(k, df) * scale, p


def _critical(k: int, df: np.ndarray) -> np.ndarray:
    level = 1 - CONFIDENCE
    domain = [1 / df.max(), 1 / df.min()]
    if np.isclose(*domain):
        return studentized_range_critical(level, k, df)
    curve = Chebyshev.interpolate(
        lambda inverse: studentized_range_critical(level, k, 1 / inverse), _DEGREE, domain
    )
    return curve(1 / df)
