"""Table 4 and Figures 4 and 5: every group of triangulations in one row."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from study.analysis.building import Population, Study, rows_by_population, rows_of
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row, select
from study.statistics.groups import variance
from study.statistics.intervals import mean_interval
from study.statistics.thresholds import LEVEL

#: What is missing where tasks failed or have not been run.
TRIANGULATIONS_MISSING = "triangulations"

_INTERVALS = "The intervals are t intervals of the mean over independent triangulations."

GROUPS = Declaration(
    "groups",
    "Groups of triangulations (Table 4)",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        Column("triangulations", "Triangulations", "", "int"),
        Column("failed", "Failed", "tasks", "int"),
        Column("not_run", "Not run", "tasks", "int"),
        Column("mean_triangles", "Mean triangles", "triangles", "fixed2"),
        Column("mean_max_lepp", "Mean largest LEPP", "triangles", "fixed2"),
        Column("mean_max_lepp_rounded", "Mean largest LEPP, rounded", "triangles", "int"),
        Column("max_lepp", "Largest LEPP", "triangles", "int"),
        Column("mean_lepp", "Mean LEPP", "triangles", "fixed4"),
        Column("mean_low", f"{LEVEL} from", "triangles", "fixed4", _INTERVALS),
        Column("mean_high", f"{LEVEL} to", "triangles", "fixed4"),
        Column(
            "sd_between",
            "SD of the means",
            "triangles",
            "fixed4",
            "SD of the means is the standard deviation between the triangulations' mean LEPP "
            "sizes: what the last column of the published Table 4 holds.",
        ),
        Column(
            "sd_within",
            "Mean SD inside a triangulation",
            "triangles",
            "fixed4",
            "Mean SD inside a triangulation is what the published Table 4's text says that its "
            "last column holds.",
        ),
        Column("lowest", "Lowest mean", "triangles", "fixed4"),
        Column("q1", "Lower quartile", "triangles", "fixed4"),
        Column("median", "Median", "triangles", "fixed4"),
        Column("q3", "Upper quartile", "triangles", "fixed4"),
        Column("highest", "Highest mean", "triangles", "fixed4"),
    ),
    note="One row a number of points, over its triangulations.",
)

OVERVIEW = Declaration(
    "overview",
    "The study at a glance",
    (
        METHOD,
        DISTRIBUTION,
        Column("asked", "Asked for", "tasks", "int"),
        Column("triangulations", "Triangulations", "", "int"),
        Column("failed", "Failed", "tasks", "int"),
        Column("not_run", "Not run", "tasks", "int"),
        Column("points", "Points", "points", "int"),
        Column("repeated_points", "Repeated points left out", "points", "int"),
        Column("triangles", "Triangles", "triangles", "int"),
        Column("equal_longest", "With equal longest edges", "triangles", "int"),
        Column("nearly_equal_longest", "With nearly equal longest edges", "triangles", "int"),
        Column("lowest_group_mean", "Lowest group mean", "triangles", "fixed4"),
        Column("highest_group_mean", "Highest group mean", "triangles", "fixed4"),
        Column("max_lepp", "Largest LEPP", "triangles", "int"),
    ),
)


@rows_by_population(GROUPS, "groups of triangulations")
def groups(one: Population) -> Iterator[Row]:
    """Make Table 4 for all methods and distributions, with both meanings of its last column."""
    done = dict(list(one.triangulations.groupby("n_points")))
    failed = select(one.data.failures, one.key)["n_points"].value_counts()
    repetitions = one.data.design.repetitions_by_size
    for size in one.data.design.sizes_of(one.method):
        group = done.get(size, one.triangulations.iloc[:0])
        lost = int(failed.get(size, 0))
        counts: Row = {
            "n_points": size,
            "triangulations": len(group),
            "failed": lost,
            "not_run": repetitions[size] - len(group) - lost,
        }
        yield counts | (_summary(group) if len(group) else {})


def _summary(group: pd.DataFrame) -> Row:
    means = group["mean_lepp"].to_numpy()
    mean, low, high = mean_interval(means)
    lowest, q1, median, q3, highest = np.quantile(means, [0, 0.25, 0.5, 0.75, 1])
    mean_max = group["max_lepp"].mean()
    return {
        "mean_triangles": group["n_triangles"].mean(),
        "mean_max_lepp": mean_max,
        "mean_max_lepp_rounded": int(np.floor(mean_max + 0.5)),
        "max_lepp": int(group["max_lepp"].max()),
        "mean_lepp": mean,
        "mean_low": low,
        "mean_high": high,
        "sd_between": np.sqrt(variance(means)),
        "sd_within": group["sd_lepp"].mean(),
        "lowest": lowest,
        "q1": q1,
        "median": median,
        "q3": q3,
        "highest": highest,
    }


@rows_of(OVERVIEW, needs=(GROUPS,))
def overview(study: Study) -> Iterator[Row]:
    """Make one row a method and distribution: what was asked for, done, and measured."""
    data = study.data
    for method, distribution in data.populations:
        groups = study.tables.rows(GROUPS, method=method, distribution=distribution)
        done = data.triangulations(method, distribution)
        repetitions = data.design.repetitions_by_size
        asked = sum(repetitions[size] for size in data.design.sizes_of(method))
        failed, not_run = int(groups["failed"].sum()), int(groups["not_run"].sum())
        _name_missing_tasks(study, method, distribution, asked, failed, not_run)
        row: Row = {
            "method": method,
            "distribution": distribution,
            "asked": asked,
            "triangulations": int(groups["triangulations"].sum()),
            "failed": failed,
            "not_run": not_run,
            "points": int(done["n_points"].sum()),
            "repeated_points": int(done["n_repeated"].sum()),
            "triangles": int(done["n_triangles"].sum()),
            "equal_longest": int(done["n_equal_longest"].sum()),
            "nearly_equal_longest": int(done["n_nearly_equal_longest"].sum()),
        }
        if len(done):
            row |= {
                "lowest_group_mean": groups["mean_lepp"].min(),
                "highest_group_mean": groups["mean_lepp"].max(),
                "max_lepp": int(done["max_lepp"].max()),
            }
        yield row


def _name_missing_tasks(
    study: Study, method: str, distribution: str, asked: int, failed: int, not_run: int
) -> None:
    if failed:
        key = {"method": method, "distribution": distribution}
        first = select(study.data.failures, key).iloc[0]
        why = (
            f"{failed} of {asked} tasks failed, the first of them with "
            f"{first['n_points']} points: {first['error']}"
        )
        study.lacks(method, distribution, TRIANGULATIONS_MISSING, why)
    if not_run:
        why = f"{not_run} of {asked} tasks have not been run yet"
        study.lacks(method, distribution, TRIANGULATIONS_MISSING, why)
