"""Table 4 and Figures 4 and 5: every group of triangulations in one row."""

import numpy as np
import pandas as pd

from study.analysis.measurements import Measurements, Missing, Row, select, variance
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Table
from study.statistics.intervals import mean_interval

_GROUPS = (
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
    Column("mean_low", "95 % from", "triangles", "fixed4"),
    Column("mean_high", "95 % to", "triangles", "fixed4"),
    Column("sd_between", "SD of the means", "triangles", "fixed4"),
    Column("sd_within", "Mean SD inside a triangulation", "triangles", "fixed4"),
    Column("lowest", "Lowest mean", "triangles", "fixed4"),
    Column("q1", "Lower quartile", "triangles", "fixed4"),
    Column("median", "Median", "triangles", "fixed4"),
    Column("q3", "Upper quartile", "triangles", "fixed4"),
    Column("highest", "Highest mean", "triangles", "fixed4"),
)

_OVERVIEW = (
    METHOD,
    DISTRIBUTION,
    Column("asked", "Asked for", "tasks", "int"),
    Column("triangulations", "Triangulations", "", "int"),
    Column("failed", "Failed", "tasks", "int"),
    Column("not_run", "Not run", "tasks", "int"),
    Column("points", "Points", "points", "int"),
    Column("repeated_points", "Repeated points left out", "points", "int"),
    Column("triangles", "Triangles", "triangles", "int"),
    Column("lowest_group_mean", "Lowest group mean", "triangles", "fixed4"),
    Column("highest_group_mean", "Highest group mean", "triangles", "fixed4"),
    Column("max_lepp", "Largest LEPP", "triangles", "int"),
)


def groups(data: Measurements) -> Table:
    """Make Table 4 for all methods and distributions, with both meanings of its last column."""
    rows = [
        {"method": method, "distribution": distribution} | row
        for method, distribution in data.populations
        for row in _group_rows(data, method, distribution)
    ]
    note = (
        "SD of the means is the standard deviation between the triangulations' mean LEPP sizes: "
        "what the last column of the published Table 4 holds. Mean SD inside a triangulation is "
        "what its text says that it holds. The intervals are t intervals of the mean over "
        "independent triangulations."
    )
    return Table.from_rows("groups", "Groups of triangulations (Table 4)", _GROUPS, rows, note)


def _group_rows(data: Measurements, method: str, distribution: str) -> list[Row]:
    done = dict(list(data.triangulations(method, distribution).groupby("n_points")))
    failed = select(data.failures, method, distribution)["n_points"].value_counts()
    rows = []
    for size in data.design.sizes:
        row = _summary(done[size]) if size in done else {"triangulations": 0}
        lost = int(failed.get(size, 0))
        absent = data.design.repetitions - int(row["triangulations"]) - lost  # type: ignore[call-overload]  # a row's cells are of any type
        rows.append({"n_points": size, "failed": lost, "not_run": absent} | row)
    return rows


def _summary(group: pd.DataFrame) -> Row:
    means = group["mean_lepp"].to_numpy()
    mean, low, high = mean_interval(means)
    lowest, q1, median, q3, highest = np.quantile(means, [0, 0.25, 0.5, 0.75, 1])
    mean_max = group["max_lepp"].mean()
    return {
        "triangulations": len(group),
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


def overview(groups: Table, data: Measurements) -> Table:
    """Make one row a method and distribution: what was asked for, done, and found."""
    rows: list[Row] = []
    for method, distribution in data.populations:
        table = select(groups.frame, method, distribution)
        done = data.triangulations(method, distribution)
        row: Row = {
            "method": method,
            "distribution": distribution,
            "asked": len(data.design.sizes) * data.design.repetitions,
            "points": int(done["n_points"].sum()),
            "repeated_points": int(done["n_repeated"].sum()),
            "triangles": int(done["n_triangles"].sum()),
        }
        row |= {name: int(table[name].sum()) for name in ("triangulations", "failed", "not_run")}
        if len(done):
            row |= {
                "lowest_group_mean": table["mean_lepp"].min(),
                "highest_group_mean": table["mean_lepp"].max(),
                "max_lepp": int(done["max_lepp"].max()),
            }
        rows.append(row)
    return Table.from_rows("overview", "The study at a glance", _OVERVIEW, rows)


def missing_tasks(overview: Table, data: Measurements) -> list[Missing]:
    """Name what of the design has no result, one entry a method, distribution and reason."""
    missing = []
    for row in overview.frame.to_dict("records"):
        method, distribution = str(row["method"]), str(row["distribution"])
        if row["failed"]:
            first = select(data.failures, method, distribution).iloc[0]
            why = (
                f"{row['failed']} of {row['asked']} tasks failed, the first of them with "
                f"{first['n_points']} points: {first['error']}"
            )
            missing.append(Missing(method, distribution, "triangulations", why))
        if row["not_run"]:
            why = f"{row['not_run']} of {row['asked']} tasks have not been run yet"
            missing.append(Missing(method, distribution, "triangulations", why))
    return missing
