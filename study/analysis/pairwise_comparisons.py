"""Which groups differ: Games-Howell comparisons of all pairs, for unequal variances."""

from collections.abc import Iterator

import numpy as np

from study.analysis.building import Population, rows_by_population
from study.analysis.table import DISTRIBUTION, METHOD, Column, Declaration, Row
from study.statistics.games_howell import games_howell
from study.statistics.thresholds import LEVEL, SIGNIFICANCE
from study.statistics.verdicts import NOT_SHOWN, YES

PAIRS = Declaration(
    "pairs",
    "Which groups differ? Games-Howell pairs",
    (
        METHOD,
        DISTRIBUTION,
        Column("n_points_1", "Points, first group", "points", "int"),
        Column("n_points_2", "Points, second group", "points", "int"),
        Column("difference", "Second mean - first", "triangles", "fixed4"),
        Column("low", f"{LEVEL} from", "triangles", "fixed4"),
        Column("high", f"{LEVEL} to", "triangles", "fixed4"),
        Column("p", "p", "", "p"),
        Column("different", "Different"),
    ),
    note="Games and Howell's test: every two sizes of one method and distribution, without equal "
    f"variances. The intervals hold together, all pairs at once, with {LEVEL} confidence, and p is "
    "adjusted for the number of groups; below 1e-8 it is only known to be that small.",
)


@rows_by_population(PAIRS, "Games-Howell comparisons")
def pairs(one: Population) -> Iterator[Row]:
    """Difference of the means of every two groups, with simultaneous intervals."""
    groups = one.groups.repeated()
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
            "different": YES if q < SIGNIFICANCE else NOT_SHOWN,
        }
