"""Table 6: tests of whether the mean LEPP size is below 4 and above 2."""

from collections.abc import Iterator

import numpy as np
from scipy import special

from study.analysis.measurements import (
    SIGNIFICANCE,
    Measurements,
    Missing,
    NotEnough,
    Row,
    for_each_population,
    variance,
)
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Table
from study.statistics.intervals import mean_interval
from study.statistics.tails import log10_t_tail

#: Theorem 2's bounds, and on which side of each the mean is supposed to lie.
_BOUNDS = ((4.0, "less"), (2.0, "greater"))

_TESTS = (
    METHOD,
    DISTRIBUTION,
    N_POINTS,
    Column("bound", "Bound", "triangles", "int"),
    Column("alternative", "Alternative: the mean is"),
    Column("t", "t", "", "fixed1"),
    Column("df", "Df", "", "int"),
    Column("p", "p", "", "p"),
    Column("log10_p", "log10 p", "", "log10p"),
    Column("log10_p_bonferroni", "log10 p, Bonferroni", "", "log10p"),
    Column("verdict", "H0, mean equal to the bound"),
    Column("mean_lepp", "Mean LEPP", "triangles", "fixed4"),
    Column("mean_low", "95 % from", "triangles", "fixed4"),
    Column("mean_high", "95 % to", "triangles", "fixed4"),
)


def bounds(data: Measurements) -> tuple[Table, list[Missing]]:
    """One-sided t tests of every group's mean against 4 and against 2, with its interval."""
    tests = len(_BOUNDS) * len(data.design.sizes) * len(list(data.populations))

    def rows(method: str, distribution: str) -> Iterator[Row | NotEnough]:
        groups = data.groups(method, distribution)
        for size, values in zip(groups.n_points.tolist(), groups.values, strict=True):
            if variance(values) > 0:
                yield from _tests(size, values, tests)
            else:
                yield NotEnough(
                    f"{size} points: two or more differing triangulations are needed, "
                    f"there is {len(np.unique(values))}"
                )

    found, missing = for_each_population(data, "t tests against 2 and 4", rows)
    note = (
        "One-sided one-sample t tests; they suppose independent triangulations and nearly normal "
        "means. log10 p is computed where p itself is too small for a double. Bonferroni's "
        f"correction counts all {tests} tests of the design. The interval of the mean says more: "
        "how far from the bounds the mean is."
    )
    title = "Mean LEPP size against 2 and 4: t tests (Table 6)"
    return Table.from_rows("bounds", title, _TESTS, found, note), missing


def _tests(size: int, values: np.ndarray, tests: int) -> Iterator[Row]:
    mean, low, high = mean_interval(values)
    df = len(values) - 1
    standard_error = np.sqrt(variance(values) / len(values))
    for bound, alternative in _BOUNDS:
        t = (mean - bound) / standard_error
        towards = -t if alternative == "less" else t
        log10_p = log10_t_tail(towards, df)
        corrected = min(0.0, log10_p + float(np.log10(tests)))
        yield {
            "n_points": size,
            "bound": int(bound),
            "alternative": alternative,
            "t": t,
            "df": df,
            "p": special.stdtr(df, -towards),
            "log10_p": log10_p,
            "log10_p_bonferroni": corrected,
            "verdict": "rejected" if corrected < np.log10(SIGNIFICANCE) else "not rejected",
            "mean_lepp": mean,
            "mean_low": low,
            "mean_high": high,
        }
