"""Theorems 1 and 2 against the measurement.

Theorem 1 takes every step of a path to end with the same probability p, that of a neighbour of
type C, so that sizes have a geometric law; Theorem 2 adds p >= 1/3.
"""

from collections.abc import Iterator

import pandas as pd

from lepp import theory
from study.analysis.measurements import Measurements, Missing, NotEnough, Row, for_each_population
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Table
from study.statistics.intervals import at_least, mean_interval

#: Theorem 2's premise.
LEAST_P = 1 / 3
(LEAST_MEAN, MOST_MEAN), (LEAST_SD, MOST_SD) = theory.bounds(LEAST_P)

_TYPES = {"A": "n_type_a", "B": "n_type_b", "C": "n_type_c"}
_MOMENTS = {
    "mean": ("mean_lepp", theory.mean),
    "standard deviation": ("sd_lepp", theory.sd),
    "skewness": ("skewness_lepp", theory.skewness),
    "excess kurtosis": ("kurtosis_lepp", theory.kurtosis),
}

_NEIGHBOR_TYPES = (
    METHOD,
    DISTRIBUTION,
    N_POINTS,
    Column("type", "Type of the neighbour"),
    Column("triangulations", "Triangulations", "", "int"),
    Column("share", "Share", "", "percent2"),
    Column("low", "95 % from", "", "percent2"),
    Column("high", "95 % to", "", "percent2"),
)

_THEOREM_1 = (
    METHOD,
    DISTRIBUTION,
    N_POINTS,
    Column("statistic", "Of the LEPP sizes"),
    Column("p_type_c", "Share p of type C", "", "fixed4"),
    Column("predicted", "Theorem 1", "", "fixed4"),
    Column("measured", "Measured", "", "fixed4"),
    Column("low", "95 % from", "", "fixed4"),
    Column("high", "95 % to", "", "fixed4"),
    Column("relative_difference", "Measured / Theorem 1 - 1", "", "percent1"),
)

_THEOREM_2 = (
    METHOD,
    DISTRIBUTION,
    N_POINTS,
    Column("triangulations", "Triangulations", "", "int"),
    Column("p_type_c", "Share p of type C", "", "fixed4"),
    Column("p_low", "95 % from", "", "fixed4"),
    Column("p_high", "95 % to", "", "fixed4"),
    Column("premise", "p at least 1/3"),
    Column("lowest_mean", "Lowest mean LEPP", "triangles", "fixed4"),
    Column("highest_mean", "Highest mean LEPP", "triangles", "fixed4"),
    Column("highest_sd", "Highest SD", "triangles", "fixed4"),
    Column("mean_inside", "Mean in [2, 4]", "triangulations", "int"),
    Column("sd_inside", "SD at most sqrt 6", "triangulations", "int"),
    Column("bounds", "Bounds hold"),
)


def shares(triangulations: pd.DataFrame, column: str) -> pd.Series:
    """Divide a count of triangles by those whose longest edge is interior, row by row."""
    inside = triangulations["n_interior_longest"]
    return (triangulations[column] / inside)[inside > 0]


def _sizes(
    data: Measurements, method: str, distribution: str
) -> Iterator[tuple[int, pd.DataFrame]]:
    triangulations = data.triangulations(method, distribution)
    if triangulations.empty:
        raise NotEnough("no triangulation has succeeded")
    for size, group in triangulations.groupby("n_points", sort=True):
        yield int(size), group


def neighbor_types(data: Measurements) -> tuple[Table, list[Missing]]:
    """Shares of types A, B and C among the neighbours across longest edges."""

    def rows(method: str, distribution: str) -> Iterator[Row]:
        for size, group in _sizes(data, method, distribution):
            for name, column in _TYPES.items():
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

    found, missing = for_each_population(data, "types of neighbours", rows)
    note = (
        "Of all triangles whose longest edge is interior: the longest edge is the neighbour's "
        "shortest (A), middle (B) or longest (C). Mean share over the triangulations, with the t "
        "interval between them. Type C ends a path."
    )
    title = "Types of longest-edge neighbours"
    return Table.from_rows("neighbor_types", title, _NEIGHBOR_TYPES, found, note), missing


def theorem_1(data: Measurements) -> tuple[Table, list[Missing]]:
    """Put what Theorem 1 makes of the measured p beside the measured moments."""

    def rows(method: str, distribution: str) -> Iterator[Row | NotEnough]:
        for size, group in _sizes(data, method, distribution):
            p = shares(group, "n_type_c").mean()
            if not 0 < p < 1:
                yield NotEnough(f"{size} points: the share of type C neighbours is {p:g}")
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

    found, missing = for_each_population(data, "Theorem 1", rows)
    note = (
        "Theorem 1 with the mean share of type C neighbours for p. Measured are the means over the "
        "triangulations of the moments inside each, with t intervals. The theorem leaves out "
        "triangles whose longest edge is on the boundary (LEPP size 1); the measured moments "
        "have them."
    )
    title = "Theorem 1: moments of the LEPP size predicted from p"
    return Table.from_rows("theorem_1", title, _THEOREM_1, found, note), missing


def theorem_2(data: Measurements) -> tuple[Table, list[Missing]]:
    """Test whether the premise p >= 1/3 holds, and whether the bounds do."""

    def rows(method: str, distribution: str) -> Iterator[Row]:
        for size, group in _sizes(data, method, distribution):
            p, low, high = mean_interval(shares(group, "n_type_c").to_numpy())
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
                "bounds": "yes" if mean_inside == sd_inside == len(group) else "no",
            }

    found, missing = for_each_population(data, "Theorem 2", rows)
    note = (
        "The premise holds where the whole interval of p is at least 1/3, fails where all of it is "
        "below. The bounds hold where every single triangulation keeps them: they can, also where "
        "the premise fails."
    )
    title = "Theorem 2: its premise and its bounds"
    return Table.from_rows("theorem_2", title, _THEOREM_2, found, note), missing
