"""Which groups differ: Games-Howell comparisons of all pairs, for unequal variances."""

from collections.abc import Iterator

import numpy as np
from numpy.polynomial import Chebyshev

from study.analysis.measurements import (
    CONFIDENCE,
    SIGNIFICANCE,
    Groups,
    Measurements,
    Missing,
    Row,
    for_each_population,
)
from study.analysis.table import DISTRIBUTION, METHOD, Column, Table
from study.statistics.studentized_range import studentized_range_critical, studentized_range_tail

#: The critical value is smooth in 1 / df: a polynomial of this degree is exact to 1e-8.
_DEGREE = 16

_PAIRS = (
    METHOD,
    DISTRIBUTION,
    Column("n_points_1", "Points, first group", "points", "int"),
    Column("n_points_2", "Points, second group", "points", "int"),
    Column("difference", "Second mean - first", "triangles", "fixed4"),
    Column("low", "95 % from", "triangles", "fixed4"),
    Column("high", "95 % to", "triangles", "fixed4"),
    Column("p", "p", "", "p"),
    Column("different", "Different"),
)


def pairs(data: Measurements) -> tuple[Table, list[Missing]]:
    """Difference of the means of every two groups, with simultaneous intervals."""

    def rows(method: str, distribution: str) -> Iterator[Row]:
        groups = data.groups(method, distribution).repeated()
        groups.need(2)
        first, second = np.triu_indices(len(groups), 1)
        difference, half, p = games_howell(groups, first, second)
        for i, j, d, h, q in zip(first, second, difference, half, p, strict=True):
            yield {
                "n_points_1": groups.n_points[i],
                "n_points_2": groups.n_points[j],
                "difference": d,
                "low": d - h,
                "high": d + h,
                "p": q,
                "different": "yes" if q < SIGNIFICANCE else "not shown",
            }

    found, missing = for_each_population(data, "Games-Howell comparisons", rows)
    note = (
        "Games and Howell's test: every two sizes of one method and distribution, without equal "
        "variances. The intervals hold together, all pairs at once, with 95 % confidence, and p is "
        "adjusted for the number of groups; below 1e-8 it is only known to be that small."
    )
    title = "Which groups differ? Games-Howell pairs"
    return Table.from_rows("pairs", title, _PAIRS, found, note), missing


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
