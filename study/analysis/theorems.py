"""Theorems 1 and 2 against the measurement.

Theorem 1 takes every step of a path to end with the same probability p, that of a neighbour of
type C, so that sizes have a geometric law; Theorem 2 adds p >= 1/3.
"""

from collections.abc import Iterator

import pandas as pd

from lepp import theory
from lepp.theory import LEAST_P, LEAST_P_TEXT
from study.analysis.building import Population, rows_by_population
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row
from study.statistics.intervals import at_least, mean_interval
from study.statistics.thresholds import LEVEL
from study.statistics.verdicts import yes

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
        Column("p_type_c", "Share p of type C", "", "fixed4"),
        Column("predicted", "Theorem 1", "", "fixed4"),
        Column("measured", "Measured", "", "fixed4"),
        Column("low", f"{LEVEL} from", "", "fixed4"),
        Column("high", f"{LEVEL} to", "", "fixed4"),
        Column("relative_difference", "Measured / Theorem 1 - 1", "", "percent1"),
    ),
    note="Theorem 1 with the mean share of type C neighbours for p. Measured are the means over "
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
        Column("p_type_c", "Share p of type C", "", "fixed4"),
        Column("p_low", f"{LEVEL} from", "", "fixed4"),
        Column("p_high", f"{LEVEL} to", "", "fixed4"),
        Column("premise", f"p at least {LEAST_P_TEXT}", "", "verdict"),
        Column("lowest_mean", "Lowest mean LEPP", "triangles", "fixed4"),
        Column("highest_mean", "Highest mean LEPP", "triangles", "fixed4"),
        Column("highest_sd", "Highest SD", "triangles", "fixed4"),
        Column("mean_inside", f"Mean in [{LEAST_MEAN:g}, {MOST_MEAN:g}]", "triangulations", "int"),
        Column("sd_inside", f"SD at most sqrt {MOST_SD**2:g}", "triangulations", "int"),
        Column("bounds", "Bounds hold", "", "verdict"),
    ),
    note=f"The premise holds where the whole interval of p is at least {LEAST_P_TEXT}, fails where "
    "all of it is below. The bounds hold where every single triangulation keeps them: they can, "
    "also where the premise fails.",
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
        for statistic, (column, formula) in _MOMENTS.items():
            measured, low, high = mean_interval(group[column].dropna().to_numpy())
            predicted = formula(p)
            yield {
                "n_points": size,
                "statistic": statistic,
                "p_type_c": p,
                "predicted": predicted,
                "measured": measured,
                "low": low,
                "high": high,
                "relative_difference": measured / predicted - 1,
            }


@rows_by_population(THEOREM_2, "Theorem 2")
def theorem_2(one: Population) -> Iterator[Row]:
    """Test whether the premise p >= 1/3 holds, and whether the bounds do."""
    for size, group in one.by_size():
        p, low, high = mean_interval(shares(group, TYPES["C"]).to_numpy())
        mean_inside = int(group["mean_lepp"].between(LEAST_MEAN, MOST_MEAN).sum())
        sd_inside = int(group["sd_lepp"].between(LEAST_SD, MOST_SD).sum())
        yield {
            "n_points": size,
            "triangulations": len(group),
            "p_type_c": p,
            "p_low": low,
            "p_high": high,
            "premise": at_least(LEAST_P, low, high),
            "lowest_mean": group["mean_lepp"].min(),
            "highest_mean": group["mean_lepp"].max(),
            "highest_sd": group["sd_lepp"].max(),
            "mean_inside": mean_inside,
            "sd_inside": sd_inside,
            "bounds": yes(mean_inside == sd_inside == len(group)),
        }
