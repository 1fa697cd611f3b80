"""Table 6: tests of whether the mean LEPP size is below 4 and above 2."""

from collections.abc import Iterator

import numpy as np
from scipy import special

from study.analysis.building import Population, rows_by_population
from study.analysis.measurements import Measurements
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row
from study.analysis.theorems import LEAST_MEAN, MOST_MEAN
from study.statistics.groups import variance
from study.statistics.intervals import mean_interval
from study.statistics.tails import log10_t_tail
from study.statistics.thresholds import LEVEL, SIGNIFICANCE
from study.statistics.verdicts import rejected

#: Theorem 2's bounds of the mean, and on which side of each the mean is supposed to lie.
UPPER_BOUND, LOWER_BOUND = round(MOST_MEAN), round(LEAST_MEAN)
LESS, GREATER = "less", "greater"
_ALTERNATIVES = {UPPER_BOUND: LESS, LOWER_BOUND: GREATER}

BOUNDS = Declaration(
    "bounds",
    f"Mean LEPP size against {LOWER_BOUND} and {UPPER_BOUND}: t tests (Table 6)",
    (
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
        Column("verdict", "H0, mean equal to the bound", "", "verdict"),
        Column("mean_lepp", "Mean LEPP", "triangles", "fixed4"),
        Column("mean_low", f"{LEVEL} from", "triangles", "fixed4"),
        Column("mean_high", f"{LEVEL} to", "triangles", "fixed4"),
    ),
    note="One-sided one-sample t tests; they suppose independent triangulations and nearly normal "
    "means. log10 p is computed where p itself is too small for a double. Bonferroni's "
    "correction counts all {tests} tests of the design. The interval of the mean says more: "
    f"how far from the bounds the mean is. That it is above {LOWER_BOUND} follows by definition: "
    "a path in the interior has two triangles or more, and only the few at the boundary have one.",
)


def _n_tests(data: Measurements) -> int:
    groups = sum(len(data.design.sizes_of(method)) for method, _ in data.populations)
    return len(_ALTERNATIVES) * groups


@rows_by_population(
    BOUNDS,
    f"t tests against {LOWER_BOUND} and {UPPER_BOUND}",
    note=lambda data: {"tests": _n_tests(data)},
)
def bounds(one: Population) -> Iterator[Row]:
    """One-sided t tests of every group's mean against 4 and against 2, with its interval."""
    tests = _n_tests(one.data)
    single = one.data.design.single_sizes_of(one.method)
    for size, values in zip(one.groups.n_points.tolist(), one.groups.values, strict=True):
        if variance(values) > 0:
            yield from _tests(size, values, tests)
        elif size not in single:
            one.lacks(
                f"{size} points: two or more differing triangulations are needed, "
                f"there is {len(np.unique(values))}"
            )


def _tests(size: int, values: np.ndarray, tests: int) -> Iterator[Row]:
    mean, low, high = mean_interval(values)
    df = len(values) - 1
    standard_error = np.sqrt(variance(values) / len(values))
    for bound, alternative in _ALTERNATIVES.items():
        t = (mean - bound) / standard_error
        towards = -t if alternative == LESS else t
        log10_p = log10_t_tail(towards, df)
        corrected = min(0.0, log10_p + float(np.log10(tests)))
        yield {
            "n_points": size,
            "bound": bound,
            "alternative": alternative,
            "t": t,
            "df": df,
            "p": special.stdtr(df, -towards),
            "log10_p": log10_p,
            "log10_p_bonferroni": corrected,
            "verdict": rejected(corrected < np.log10(SIGNIFICANCE)),
            "mean_lepp": mean,
            "mean_low": low,
            "mean_high": high,
        }
