"""Table 1: tests of whether the points are random and of their distribution."""

from itertools import product

import numpy as np
from scipy import stats

from study.analysis.measurements import CONFIDENCE, SIGNIFICANCE, Measurements, Missing, Row
from study.analysis.table import DISTRIBUTION, Column, Table
from study.statistics.multiple_testing import holm

TESTS = {"runs": "runs_p", "Kolmogorov-Smirnov": "ks_p"}
COORDINATES = ("x", "y")
_BINS = 20

_RANDOMNESS = (
    DISTRIBUTION,
    Column("test", "Test"),
    Column("coordinate", "Coordinate"),
    Column("tests", "Tests", "", "int"),
    Column("below", "p below 0.05", "tests", "int"),
    Column("expected_below", "Expected by chance", "tests", "fixed1"),
    Column("share_below", "Share below 0.05", "", "percent2"),
    Column("share_low", "95 % from", "", "percent2"),
    Column("share_high", "95 % to", "", "percent2"),
    Column("share_p", "p of the share", "", "p"),
    Column("share_p_holm", "p of the share, Holm", "", "p"),
    Column("verdict", "Random"),
    Column("rejected_holm", "Rejected after Holm", "tests", "int"),
    Column("lowest_p", "Lowest p", "", "p"),
    Column("uniform_d", "Distance from uniform", "", "fixed4"),
    Column("uniform_p", "p of uniformity", "", "p"),
)

_UNIFORMITY = (
    DISTRIBUTION,
    Column("test", "Test"),
    Column("coordinate", "Coordinate"),
    Column("p_from", "p from", "", "fixed2"),
    Column("p_to", "p to", "", "fixed2"),
    Column("count", "Tests", "tests", "int"),
    Column("expected", "Expected", "tests", "fixed1"),
)


def randomness(data: Measurements) -> tuple[Table, list[Missing]]:
    """How many of all runs and Kolmogorov-Smirnov tests reject, and whether p is uniform."""
    families, missing = _families(data)
    if families:
        families.append(("all", "all", "all", np.concatenate([p for *_, p in families])))
    corrected = holm(np.array([_share_p(values) for *_, values in families]))
    rows = [
        {"distribution": distribution, "test": test, "coordinate": coordinate}
        | _judge(values)
        | {"share_p_holm": p, "verdict": "rejected" if p < SIGNIFICANCE else "not rejected"}
        for (distribution, test, coordinate, values), p in zip(families, corrected, strict=True)
    ]
    note = (
        "Runs test about the median and Kolmogorov-Smirnov test against the true distribution, of "
        "both coordinates of every point set. Random points give p below 0.05 in one test of "
        "twenty: that some do is expected, and only a share far from 0.05 speaks against them. "
        "Its interval is Clopper and Pearson's, its p the exact binomial test's; one interval in "
        "twenty misses by chance, so the verdict is after Holm's correction over the rows. "
        "Rejected after Holm counts single point sets, corrected for the tests of the row. "
        "Uniformity is a Kolmogorov-Smirnov test of the p-values; those of the runs test are "
        "discrete, coarsely so for small sets. x and y of the bivariate normal distribution are "
        "correlated, and so are, weakly, their tests. Point sets count once, whatever "
        "the number of methods."
    )
    title = "Randomness of the points (Table 1)"
    return Table.from_rows("randomness", title, _RANDOMNESS, rows, note), missing


def uniformity(data: Measurements) -> Table:
    """Histogram of the p-values, for a plot of their uniformity."""
    rows: list[Row] = []
    edges = np.linspace(0, 1, _BINS + 1)
    for distribution, test, coordinate, values in _families(data)[0]:
        counts = np.histogram(values, edges)[0]
        rows += [
            {
                "distribution": distribution,
                "test": test,
                "coordinate": coordinate,
                "p_from": low,
                "p_to": high,
                "count": count,
                "expected": len(values) / _BINS,
            }
            for low, high, count in zip(edges[:-1], edges[1:], counts, strict=True)
        ]
    title = "p-values of the randomness tests: uniform if the points are random"
    return Table.from_rows("uniformity", title, _UNIFORMITY, rows)


def _families(
    data: Measurements,
) -> tuple[list[tuple[str, str, str, np.ndarray]], list[Missing]]:
    families, missing = [], []
    sets = data.point_sets
    for distribution, (test, prefix), coordinate in product(
        data.design.distributions, TESTS.items(), COORDINATES
    ):
        values = sets.loc[sets["distribution"] == distribution, f"{prefix}_{coordinate}"]
        values = values.dropna().to_numpy()
        if len(values):
            families.append((distribution, test, coordinate, values))
        else:
            what = f"{test} test of {coordinate}"
            missing.append(Missing("", distribution, what, "no point set has been tested"))
    return families, missing


def _judge(values: np.ndarray) -> Row:
    from statsmodels.stats.proportion import proportion_confint

    below, tests = int((values < SIGNIFICANCE).sum()), len(values)
    low, high = proportion_confint(below, tests, alpha=1 - CONFIDENCE, method="beta")
    uniform = stats.kstest(values, "uniform")
    return {
        "tests": tests,
        "below": below,
        "expected_below": tests * SIGNIFICANCE,
        "share_below": below / tests,
        "share_low": low,
        "share_high": high,
        "share_p": _share_p(values),
        "rejected_holm": int((holm(values) < SIGNIFICANCE).sum()),
        "lowest_p": values.min(),
        "uniform_d": uniform.statistic,
        "uniform_p": uniform.pvalue,
    }


def _share_p(values: np.ndarray) -> float:
    below = int((values < SIGNIFICANCE).sum())
    return float(stats.binomtest(below, len(values), SIGNIFICANCE).pvalue)
