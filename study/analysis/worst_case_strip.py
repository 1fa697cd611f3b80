"""Figure 2 and equation 1: the strip whose first path covers all of it."""

from collections.abc import Iterator
from functools import cache

import lepp
from study.analysis.building import Study, rows_of
from study.analysis.table import Column, Declaration, Row
from study.statistics.verdicts import yes

_SIZES = (1, 2, 3, 10, 100, 1000, 10_000, 100_000, 1_000_000)

WORST_CASE = Declaration(
    "worst_case",
    "The worst case (equation 1)",
    (
        Column("n_triangles", "Triangles", "triangles", "int"),
        Column("mean_lepp", "Mean LEPP", "triangles", "fixed1"),
        Column("equation_1", "(n + 1) / 2", "triangles", "fixed1"),
        Column("max_lepp", "Largest LEPP", "triangles", "int"),
        Column("equal", "Equal", "", "verdict"),
    ),
    note="The mean grows with n here: no bound holds for all triangulations.",
)


@rows_of(WORST_CASE)
def worst_case(_: Study) -> Iterator[Row]:
    """Measure the worst-case strip, up to a million triangles, by the kernels of the study."""
    for n in _SIZES:
        total, longest = _measured(n)
        yield {
            "n_triangles": n,
            "mean_lepp": total / n,
            "equation_1": (n + 1) / 2,
            "max_lepp": longest,
            "equal": yes(2 * total == n * (n + 1) and longest == n),
        }


@cache  # it hangs on no run
def _measured(n: int) -> tuple[int, int]:
    """Return the sum of all sizes in a strip of n triangles, and the largest."""
    sizes = lepp.lepp_sizes(lepp.worst_case_strip(n))
    return int(sizes.sum(dtype="int64")), int(sizes.max())
