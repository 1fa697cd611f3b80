"""Table 1: tests of whether the points are random and of their distribution."""

from collections.abc import Iterator
from itertools import product

import numpy as np
from scipy import stats

from study.analysis.building import Study, rows_of
from study.analysis.measurements import Measurements
from study.analysis.table import DISTRIBUTION, Column, Declaration, Row
from study.statistics.multiple_testing import holm
from study.statistics.thresholds import CONFIDENCE, LEVEL, SIGNIFICANCE
from study.statistics.verdicts import rejected

TESTS = {"runs": "runs_p", "Kolmogorov-Smirnov": "ks_p"}
COORDINATES = ("x", "y")
#: Name of the family of all tests together.
ALL = "all"
#: Bars of the histogram of p-values.
BINS = 20

RANDOMNESS = Declaration(
    "randomness",
    "Randomness of the points (Table 1)",
    (
        DISTRIBUTION,
        Column("test", "Test"),
        Column("coordinate", "Coordinate"),
        Column("tests", "Tests", "", "int"),
        Column("below", f"p below {SIGNIFICANCE}", "tests", "int"),
        Column("expected_below", "Expected by chance", "tests", "fixed1"),
        Column("share_below", f"Share below {SIGNIFICANCE}", "", "percent2"),
        Column("share_low", f"{LEVEL} from", "", "percent2"),
        Column("share_high", f"{LEVEL} to", "", "percent2"),
        Column("share_p", "p of the share", "", "p"),
        Column("share_p_holm", "p of the share, Holm", "", "p"),
        Column("verdict", "Random", "", "verdict"),
        Column("rejected_holm", "Rejected after Holm", "tests", "int"),
        Column("lowest_p", "Lowest p", "", "p"),
        Column("uniform_d", "Distance from uniform", "", "fixed4"),
        Column("uniform_p", "p of uniformity", "", "p"),
    ),
    note="Runs test about the median and Kolmogorov-Smirnov test against the true distribution, of "
    f"both coordinates of every point set. Random points give p below {SIGNIFICANCE} in one test "
    "of twenty: that some do is expected, and only a share far from "
    f"{SIGNIFICANCE} speaks against them. "
    "Its interval is Clopper and Pearson's; one in twenty misses by chance, so the verdict is the "
    "exact binomial test's, after Holm's correction over the rows. "
    "Uniformity is a Kolmogorov-Smirnov test of the p-values; those of the runs test are "
    "discrete, coarsely so for small sets. x and y of the bivariate normal distribution are "
    "correlated, and so are, weakly, their tests. Point sets count once, whatever "
    "the number of methods.",
)

UNIFORMITY = Declaration(
    "uniformity",
    "p-values of the randomness tests: uniform if the points are random",
    (
        DISTRIBUTION,
        Column("test", "Test"),
        Column("coordinate", "Coordinate"),
        Column("p_from", "p from", "", "fixed2"),
        Column("p_to", "p to", "", "fixed2"),
        Column("count", "Tests", "tests", "int"),
        Column("expected", "Expected", "tests", "fixed1"),
    ),
)

Family = tuple[str, str, str, np.ndarray]
"""Distribution, test, coordinate, and the p-values of all point sets."""


@rows_of(RANDOMNESS)
def randomness(study: Study) -> Iterator[Row]:
    """How many of all runs and Kolmogorov-Smirnov tests reject, and whether p is uniform."""
    families: list[Family] = []
    for distribution, test, coordinate, values in _families(study.data):
        if len(values):
            families.append((distribution, test, coordinate, values))
        else:
            what = f"{test} test of {coordinate}"
            study.lacks("", distribution, what, "no point set has been tested")
    if families:
        families.append((ALL, ALL, ALL, np.concatenate([p for *_, p in families])))
    corrected = holm(np.array([_share_p(values) for *_, values in families]))
    for (distribution, test, coordinate, values), p in zip(families, corrected, strict=True):
        key: Row = {"distribution": distribution, "test": test, "coordinate": coordinate}
        yield key | _judge(values) | {"share_p_holm": p, "verdict": rejected(p < SIGNIFICANCE)}


@rows_of(UNIFORMITY)
def uniformity(study: Study) -> Iterator[Row]:
    """Histogram of the p-values, for a plot of their uniformity."""
    edges = np.linspace(0, 1, BINS + 1)
    for distribution, test, coordinate, values in _families(study.data):
        if not len(values):
            continue
        counts = np.histogram(values, edges)[0]
        for low, high, count in zip(edges[:-1], edges[1:], counts, strict=True):
            yield {
                "distribution": distribution,
                "test": test,
                "coordinate": coordinate,
                "p_from": low,
                "p_to": high,
                "count": count,
                "expected": len(values) / BINS,
            }


def _families(data: Measurements) -> Iterator[Family]:
    sets = data.point_sets
    for distribution, (test, prefix), coordinate in product(
        data.design.distributions, TESTS.items(), COORDINATES
    ):
        values = sets.loc[sets["distribution"] == distribution, f"{prefix}_{coordinate}"]
        yield distribution, test, coordinate, values.dropna().to_numpy()


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
