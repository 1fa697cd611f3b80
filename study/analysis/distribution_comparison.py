"""The distributions of the points compared: the same method and number of points, other points."""

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from scipy import special

from study.analysis.building import Study, builds
from study.analysis.parts import INTERIOR_NOTE, PART, PARTS
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row, Table
from study.statistics.groups import Groups
from study.statistics.intervals import t_quantile
from study.statistics.multiple_testing import holm
from study.statistics.tails import log10_t_tail
from study.statistics.thresholds import EQUIVALENT_WITHIN, LEVEL, SIGNIFICANCE
from study.statistics.verdicts import NO, UNDECIDED, YES
from study.text.notation import SPACE

#: Verdicts on the means of two distributions. The first two are equivalent: the difference is
#: shown to be small, not only not shown to be there.
ALIKE, LITTLE, DIFFER = "alike", "differ little", "differ"
VERDICTS = (ALIKE, LITTLE, DIFFER, UNDECIDED)

#: The margin of equivalence as a table shows it.
MARGIN = f"{100 * EQUIVALENT_WITHIN:g}{SPACE}%"

DISTRIBUTIONS_COMPARED = Declaration(
    "distributions",
    "Mean LEPP sizes of the distributions compared",
    (
        METHOD,
        PART,
        N_POINTS,
        Column("distribution_1", "First distribution", "", "name"),
        Column("distribution_2", "Second distribution", "", "name"),
        Column("mean_1", "First mean", "triangles", "fixed4"),
        Column("mean_2", "Second mean", "triangles", "fixed4"),
        Column("difference", "Second less first", "triangles", "fixed4"),
        Column("relative", "Relative difference", "", "percent3"),
        Column("low", f"{LEVEL} from", "", "percent3"),
        Column("high", f"{LEVEL} to", "", "percent3"),
        Column("t", "t", "", "fixed2"),
        Column("df", "Df", "", "fixed1"),
        Column("p", "p", "", "p"),
        Column("log10_p", "log10 p", "", "log10p"),
        Column("p_holm", "p, Holm", "", "p"),
        Column("verdict", "Verdict", "", "verdict"),
    ),
    note="All pairs of distributions at each number of points; the first distribution of the "
    "design is the first of its pairs. Means of independent triangulations with unequal variances: "
    "Welch's t test, its p corrected by Holm over all pairs and sizes of a method and part. The "
    "relative difference is (second - first) / first, its interval by the delta method. "
    f"Verdicts: {ALIKE}: the interval lies within {MARGIN} and no difference is detected "
    f"at {SIGNIFICANCE}; {LITTLE}: a difference is detected, and the interval lies within "
    f"{MARGIN}; {DIFFER}: a difference is detected, and the interval reaches beyond; {UNDECIDED}: "
    f"none is detected, but the interval reaches beyond. {INTERIOR_NOTE}",
)

ANALOGOUS = Declaration(
    "analogous",
    "Does each distribution agree with the others?",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        Column("comparisons", "Comparisons", "", "int"),
        *(Column(v.replace(" ", "_"), v.capitalize(), "", "int") for v in VERDICTS),
        Column("furthest", "Largest relative difference", "", "percent3"),
        Column("furthest_n", "At points", "points", "int"),
        Column("furthest_from", "From", "", "name"),
        Column("equivalent", f"All within {MARGIN}", "", "verdict"),
    ),
    note="Each distribution with every other, at every number of points. All are within "
    f"{MARGIN}: {YES} if every interval of the relative difference lies within, {NO} if one lies "
    f"wholly beyond, else {UNDECIDED}. Not to detect a difference is no proof that there is none: "
    "it is the intervals that decide.",
)


@builds(DISTRIBUTIONS_COMPARED)
def distributions(study: Study) -> Iterator[Table]:
    """Compare all pairs of distributions, of the whole mesh and of its interior."""
    rows: list[Row] = []
    for method in study.data.design.methods:
        for part in PARTS:
            rows += _corrected(list(_pairs(study, method, part)))
    yield DISTRIBUTIONS_COMPARED.table(rows)


def _pairs(study: Study, method: str, part: str) -> Iterator[Row]:
    names = study.data.design.distributions
    groups = {name: _by_size(study.data.groups(method, name, part).repeated()) for name in names}
    sizes = sorted(set().union(*groups.values()))
    for size in sizes:
        for first, second in combinations(names, 2):
            if size in groups[first] and size in groups[second]:
                yield {
                    "method": method,
                    "part": part,
                    "n_points": size,
                    "distribution_1": first,
                    "distribution_2": second,
                } | compared(groups[first][size], groups[second][size])


def _by_size(groups: Groups) -> dict[int, np.ndarray]:
    return dict(zip(groups.n_points.tolist(), groups.values, strict=True))


def compared(one: np.ndarray, two: np.ndarray) -> Row:
    """Compare the means of two independent samples with unequal variances.

    Parameters
    ----------
    one, two : (r,) float64 ndarray
        Two or more values each, not all equal.

    Notes
    -----
    Welch (1947), Biometrika 34, 28-35. The variance of the ratio of the means is, by the delta
    method, (v2 + ratio^2 v1) / mean1^2, with v the variances of the means.
    """
    m1, m2 = float(one.mean()), float(two.mean())
    v1, v2 = float(one.var(ddof=1)) / len(one), float(two.var(ddof=1)) / len(two)
    df = (v1 + v2) ** 2 / (v1**2 / (len(one) - 1) + v2**2 / (len(two) - 1))
    t = (m2 - m1) / np.sqrt(v1 + v2)
    relative = m2 / m1 - 1
    half = t_quantile(df) * np.sqrt(v2 + (m2 / m1) ** 2 * v1) / abs(m1)
    return {
        "mean_1": m1,
        "mean_2": m2,
        "difference": m2 - m1,
        "relative": relative,
        "low": relative - half,
        "high": relative + half,
        "t": t,
        "df": df,
        "p": 2 * special.stdtr(df, -abs(t)),
        "log10_p": log10_t_tail(abs(t), df) + float(np.log10(2)),
    }


def _corrected(rows: list[Row]) -> list[Row]:
    """Add what hangs on all tests together: p by Holm, and the verdicts."""
    corrected = holm(np.array([row["p"] for row in rows], dtype=np.float64))
    low, high = (np.array([row[end] for row in rows], dtype=np.float64) for end in ("low", "high"))
    return [
        row | {"p_holm": p, "verdict": verdict(a, b, p)}
        for row, a, b, p in zip(rows, low, high, corrected, strict=True)
    ]


def verdict(low: float, high: float, p: float) -> str:
    """Judge a relative difference with the interval [low, high] and a corrected p."""
    within = low > -EQUIVALENT_WITHIN and high < EQUIVALENT_WITHIN
    if p < SIGNIFICANCE:
        return LITTLE if within else DIFFER
    return ALIKE if within else UNDECIDED


@builds(ANALOGOUS, needs=(DISTRIBUTIONS_COMPARED,))
def analogous(study: Study) -> Iterator[Table]:
    """Sum up how each distribution compares with all others."""
    yield ANALOGOUS.table(_summaries(study))


def _summaries(study: Study) -> Iterator[Row]:
    for method, distribution in study.data.populations:
        for part in PARTS:
            frame = study.tables.rows(DISTRIBUTIONS_COMPARED, method=method, part=part).frame
            first, second = frame["distribution_1"], frame["distribution_2"]
            frame = frame[(first == distribution) | (second == distribution)]
            if frame.empty:
                continue
            counts = frame["verdict"].value_counts()
            furthest = frame.loc[frame["relative"].abs().idxmax()]
            pair = {furthest["distribution_1"], furthest["distribution_2"]}
            yield {
                "method": method,
                "distribution": distribution,
                "part": part,
                "comparisons": len(frame),
                **{v.replace(" ", "_"): int(counts.get(v, 0)) for v in VERDICTS},
                "furthest": abs(furthest["relative"]),
                "furthest_n": furthest["n_points"],
                "furthest_from": (pair - {distribution}).pop(),
                "equivalent": equivalent(frame["low"].to_numpy(), frame["high"].to_numpy()),
            }


def equivalent(low: np.ndarray, high: np.ndarray) -> str:
    """Say whether all of several relative differences are within the margin.

    Parameters
    ----------
    low, high : (k,) float64 ndarray
        Ends of their intervals.
    """
    if np.any(low > EQUIVALENT_WITHIN) or np.any(high < -EQUIVALENT_WITHIN):
        return NO
    inside = np.all(low > -EQUIVALENT_WITHIN) and np.all(high < EQUIVALENT_WITHIN)
    return YES if inside else UNDECIDED
