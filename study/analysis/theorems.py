"""Theorems 1 and 2 against the measurement.

Theorem 1 takes every step of a path to end with the same probability p, that of a neighbour of
type C, so that sizes have a geometric law; Theorem 2 adds p >= 1/3.

Theorem 2's bounds need less than that. Let X = N - 2 be the steps that a path of N >= 2 triangles
goes on after its first neighbour, let each step end it with a chance h(k) >= q, which may differ
from step to step, and let m(k) be the mean of X - k over the paths with X >= k. Then
P(X >= k) <= (1 - q)^k, so that m(0) <= (1 - q) / q, and likewise m(k) <= (1 - q) / q for every k:

- The mean of N is 2 + m(0) <= 1 + 1 / q: 4 for q = 1/3.
- The variance of N is the sum of what its steps add to it: at step k the expected size is k + m(k)
  beforehand, k afterwards if the path ends there (chance h(k)), k + 1 + m(k + 1) if it goes on. So
  it is the sum of P(X >= k) h(k) (1 - h(k)) (1 + m(k + 1))^2, and, as m(k) is
  (1 - h(k)) (1 + m(k + 1)), that of P(X = k) m(k) (1 + m(k + 1)). There P(X = k) adds up to 1 and
  the rest is at most (1 - q) / q times 1 / q: the standard deviation is at most sqrt(1 - q) / q,
  which is sqrt 6 for q = 1/3.

Both hold for any sizes from 2 on, dependent or not. Triangles of size 1, at the boundary, are
outside of them, as they are outside of Theorem 1. The lower bound of 2 is the smallest size.
"""

from collections.abc import Iterator

import pandas as pd

from lepp import theory
from lepp.theory import LEAST_P, LEAST_P_TEXT
from study.analysis.building import Population, rows_by_population
from study.analysis.path_lengths import counts_by_task
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row
from study.statistics.continuation import continuation
from study.statistics.groups import NotEnough
from study.statistics.intervals import at_least, mean_interval
from study.statistics.thresholds import LEVEL, ROUGH_RATE
from study.statistics.verdicts import UNDECIDED, all_of, yes

#: Theorem 2's bounds.
(LEAST_MEAN, MOST_MEAN), (LEAST_SD, MOST_SD) = theory.bounds(LEAST_P)

#: The moments of Theorem 1, in its order.
MEAN, SD, SKEWNESS, KURTOSIS = STATISTICS = (
    "mean",
    "standard deviation",
    "skewness",
    "excess kurtosis",
)

#: Types of a neighbour, by which of its edges is crossed: the shortest, middle, longest.
TYPES = {"A": "n_type_a", "B": "n_type_b", "C": "n_type_c"}
_MOMENTS = {
    MEAN: ("mean_lepp", theory.mean),
    SD: ("sd_lepp", theory.sd),
    SKEWNESS: ("skewness_lepp", theory.skewness),
    KURTOSIS: ("kurtosis_lepp", theory.kurtosis),
}

NEIGHBOR_TYPES = Declaration(
    "neighbor_types",
    "Types of longest-edge neighbours",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        Column("type", "Type of the neighbour"),
        Column("triangulations", "Triangulations", "", "int"),
        Column("share", "Share", "", "percent2"),
        Column("low", f"{LEVEL} from", "", "percent2"),
        Column("high", f"{LEVEL} to", "", "percent2"),
    ),
    note="Of all triangles whose longest edge is interior: the longest edge is the neighbour's "
    "shortest (A), middle (B) or longest (C). Mean share over the triangulations, with the t "
    "interval between them. Type C ends a path.",
)

THEOREM_1 = Declaration(
    "theorem_1",
    "Theorem 1: moments of the LEPP size predicted from p",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        Column("statistic", "Of the LEPP sizes"),
        Column("measured", "Measured", "", "fixed4"),
        Column("low", f"{LEVEL} from", "", "fixed4"),
        Column("high", f"{LEVEL} to", "", "fixed4"),
        Column("p_type_c", "p, first step", "", "fixed4"),
        Column("predicted", "Theorem 1 with p", "", "fixed4"),
        Column("relative_difference", "Measured / that − 1", "", "percent1"),
        Column("p_all_steps", "r, all steps", "", "fixed4"),
        Column("predicted_all_steps", "Theorem 1 with r", "", "fixed4"),
        Column("difference_all_steps", "Measured / that − 1", "", "percent1"),
    ),
    note="Theorem 1 with two estimates of the chance that a step ends the path: p, the mean share "
    "of type C neighbours, which is the chance at the first step; and r = 1 / (mean − 1), from all "
    "steps, with which the mean fits by construction. Measured are the means over "
    "the triangulations of the moments inside each, with t intervals. The theorem leaves out "
    "triangles whose longest edge is on the boundary (LEPP size 1); the measured moments "
    "have them.",
)

THEOREM_2 = Declaration(
    "theorem_2",
    "Theorem 2: its premise and its bounds",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        Column("triangulations", "Triangulations", "", "int"),
        Column("p_type_c", "p, first step", "", "fixed4"),
        Column("p_low", f"{LEVEL} from", "", "fixed4"),
        Column("p_high", f"{LEVEL} to", "", "fixed4"),
        Column("upto_size", "Steps known up to size", "triangles", "int"),
        Column("lowest_size", "Least chance to end is at size", "triangles", "int"),
        Column("lowest_rate", "Least chance to end", "", "fixed4"),
        Column("lowest_low", f"{LEVEL} from", "", "fixed4"),
        Column("lowest_high", f"{LEVEL} to", "", "fixed4"),
        Column("premise", f"Every step at least {LEAST_P_TEXT}", "", "verdict"),
        Column("lowest_mean", "Lowest mean LEPP", "triangles", "fixed4"),
        Column("highest_mean", "Highest mean LEPP", "triangles", "fixed4"),
        Column("highest_sd", "Highest SD", "triangles", "fixed4"),
        Column("mean_inside", f"Mean in [{LEAST_MEAN:g}, {MOST_MEAN:g}]", "triangulations", "int"),
        Column("sd_inside", f"SD at most √{MOST_SD**2:g}", "triangulations", "int"),
        Column("bounds", "Bounds hold", "", "verdict"),
    ),
    note="The premise is that every step ends the path with a chance of at least "
    f"{LEAST_P_TEXT}; the bounds follow from that alone, without Theorem 1's one chance for all "
    "steps. It is judged by the rates of all triangulations of a size together, from size 2 on, as "
    f"far as their intervals are narrower than {ROUGH_RATE:g}: it holds where all of each interval "
    f"is at least {LEAST_P_TEXT}, fails where all of one is below. The bounds hold where every "
    "single triangulation keeps them: they can, also where the premise fails.",
)


def shares(triangulations: pd.DataFrame, column: str) -> pd.Series:
    """Divide a count of triangles by those whose longest edge is interior, row by row."""
    inside = triangulations["n_interior_longest"]
    return (triangulations[column] / inside)[inside > 0]


@rows_by_population(NEIGHBOR_TYPES, "types of neighbours")
def neighbor_types(one: Population) -> Iterator[Row]:
    """Shares of types A, B and C among the neighbours across longest edges."""
    for size, group in one.by_size():
        for name, column in TYPES.items():
            values = shares(group, column).to_numpy()
            share, low, high = mean_interval(values)
            yield {
                "n_points": size,
                "type": name,
                "triangulations": len(values),
                "share": share,
                "low": low,
                "high": high,
            }


@rows_by_population(THEOREM_1, "Theorem 1")
def theorem_1(one: Population) -> Iterator[Row]:
    """Put what Theorem 1 makes of the measured p beside the measured moments."""
    for size, group in one.by_size():
        p = shares(group, TYPES["C"]).mean()
        if not 0 < p < 1:
            one.lacks(f"{size} points: the share of type C neighbours is {p:g}")
            continue
        r = 1 / (group["mean_lepp"].mean() - 1)
        for statistic, (column, formula) in _MOMENTS.items():
            measured, low, high = mean_interval(group[column].dropna().to_numpy())
            predicted = formula(p)
            row: Row = {
                "n_points": size,
                "statistic": statistic,
                "measured": measured,
                "low": low,
                "high": high,
                "p_type_c": p,
                "predicted": predicted,
                "relative_difference": measured / predicted - 1,
            }
            if 0 < r < 1:
                fitted = formula(r)
                row |= {
                    "p_all_steps": r,
                    "predicted_all_steps": fitted,
                    "difference_all_steps": measured / fitted - 1,
                }
            yield row


@rows_by_population(THEOREM_2, "Theorem 2")
def theorem_2(one: Population) -> Iterator[Row]:
    """Test whether every step ends a path with a chance of 1/3 or more, and the bounds."""
    histogram = one.data.histogram(one.method, one.distribution)
    single = one.data.design.single_sizes_of(one.method)
    for size, group in one.by_size():
        every_step = {} if size in single else _every_step(histogram[histogram["n_points"] == size])
        p, low, high = mean_interval(shares(group, TYPES["C"]).to_numpy())
        mean_inside = int(group["mean_lepp"].between(LEAST_MEAN, MOST_MEAN).sum())
        sd_inside = int(group["sd_lepp"].between(LEAST_SD, MOST_SD).sum())
        yield {
            "n_points": size,
            "triangulations": len(group),
            "p_type_c": p,
            "p_low": low,
            "p_high": high,
            **every_step,
            "lowest_mean": group["mean_lepp"].min(),
            "highest_mean": group["mean_lepp"].max(),
            "highest_sd": group["sd_lepp"].max(),
            "mean_inside": mean_inside,
            "sd_inside": sd_inside,
            "bounds": yes(mean_inside == sd_inside == len(group)),
        }


def _every_step(histogram: pd.DataFrame) -> Row:
    """Judge whether every step of the paths ends with a chance of at least 1/3."""
    try:
        measured = continuation([counts_by_task(histogram, "lepp_size")]).sure()
    except NotEnough:  # no path takes a step
        return {"premise": UNDECIDED}
    if not len(measured.sizes):
        return {"premise": UNDECIDED}
    ended, half = 1 - measured.rates, measured.half_widths
    lowest = int(ended.argmin())
    return {
        "upto_size": measured.sizes[-1],
        "lowest_size": measured.sizes[lowest],
        "lowest_rate": ended[lowest],
        "lowest_low": ended[lowest] - half[lowest],
        "lowest_high": ended[lowest] + half[lowest],
        "premise": all_of(
            at_least(LEAST_P, rate - width, rate + width)
            for rate, width in zip(ended, half, strict=True)
        ),
    }
