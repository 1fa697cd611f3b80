"""The report's own tables, beside those of the analysis: what figures draw and comparisons show."""

import pandas as pd

from reports.page.views import METHOD_NAMES
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Table
from study.design.design import Design
from study.design.sampling import sample_points
from study.run.measures import columns_of
from study.run.point_checks import PointChecks
from study.run.triangulations import Measures

SCATTER_POINTS = 400

_REPLICATE = Column("replicate", "Repetition", "", "int")


def _described(measures: type, *names: str) -> tuple[Column, ...]:
    """Return measures as columns: those named, or all."""
    columns = columns_of(measures)
    return tuple(
        Column(column.name, column.label, column.unit, column.format)
        for column in columns
        if column.name in names or not names
    )


_TRIANGULATIONS = (
    METHOD,
    DISTRIBUTION,
    N_POINTS,
    _REPLICATE,
    *_described(Measures, "n_triangles", "mean_lepp", "sd_lepp", "max_lepp"),
)
_POINT_SETS = (DISTRIBUTION, N_POINTS, _REPLICATE, *_described(PointChecks))
_SAMPLE = (
    DISTRIBUTION,
    N_POINTS,
    Column("point", "Point", "", "int"),
    Column("x", "x", "", "fixed4"),
    Column("y", "y", "", "fixed4"),
)


_TABLE_4 = (
    METHOD,
    DISTRIBUTION,
    N_POINTS,
    Column("mean_triangles", "Mean triangles", "triangles", "fixed2"),
    Column("mean_max_lepp", "Mean largest LEPP", "triangles", "fixed2"),
    Column("mean_lepp", "Mean LEPP", "triangles", "fixed4"),
    Column("published_mean", "Paper's mean", "triangles", "fixed4"),
    Column("difference", "Difference", "standard errors", "fixed2"),
    Column("sd_between", "SD of the means", "triangles", "fixed4"),
    Column("published_sd", "Paper's SD", "triangles", "fixed4"),
    Column("sd_within", "SD inside a triangulation", "triangles", "fixed4"),
)
_FAILURES = (
    METHOD,
    DISTRIBUTION,
    N_POINTS,
    _REPLICATE,
    Column("error", "Error"),
)


def table_4(groups: Table, reproduction: Table) -> Table:
    """Table 4 of every view, with the published values where there are some."""
    keys = ["method", "distribution", "n_points"]
    ours = groups.frame[groups.frame["triangulations"] > 0]
    ours = ours[[c.name for c in _TABLE_4 if c.name in ours.columns]]
    printed = reproduction.frame[reproduction.frame["published_table"] == 4]
    mean = printed[printed["quantity"] == "mean LEPP"].set_index(keys)
    sd = printed[printed["quantity"] == "standard deviation"].set_index(keys)
    beside = pd.DataFrame(
        {
            "published_mean": mean["published"],
            "difference": mean["difference"],
            "published_sd": sd["published"],
        }
    )
    frame = ours.join(beside, on=keys)[[column.name for column in _TABLE_4]]
    note = (
        "The paper prints this table for the uniform distribution. Its last column is called the "
        "average of the standard deviations; its values are those of the SD of the means."
    )
    title = "Table 4, ours and the paper's"
    return Table("table_4", title, frame.reset_index(drop=True), _TABLE_4, note)


def statements_compared(statements: Table, methods: tuple[str, ...]) -> Table:
    """Whether each statement of the paper holds, a column a method."""
    rows = statements.frame.pivot(
        index=["distribution", "source", "statement"], columns="method", values="holds"
    )
    order = statements.frame[["distribution", "source", "statement"]].drop_duplicates()
    frame = order.join(rows[list(methods)], on=list(order.columns)).reset_index(drop=True)
    columns = (
        DISTRIBUTION,
        Column("source", "Where"),
        Column("statement", "The paper's statement"),
        *(Column(method, METHOD_NAMES[method]) for method in methods),
    )
    title = "Which of the paper's statements hold for which triangulation"
    return Table("statements_compared", title, frame, columns)


def triangulations(results: pd.DataFrame) -> Table:
    """Every triangulation that succeeded, a row each."""
    done = results[results["error"].isna()]
    frame = done[[column.name for column in _TRIANGULATIONS]].reset_index(drop=True)
    note = "One row a triangulation. results.parquet beside this page has more columns of each."
    return Table("triangulations", "Triangulations", frame, _TRIANGULATIONS, note)


def point_sets(checks: pd.DataFrame) -> Table:
    """Every point set with the p-values of its checks, a row each."""
    note = "One row a point set: every method triangulates the same points."
    return Table("point_sets", "Checks of the point sets", checks, _POINT_SETS, note)


def failures(results: pd.DataFrame) -> Table:
    """Every task that failed, with its error."""
    failed = results[results["error"].notna()]
    frame = failed[[column.name for column in _FAILURES]].reset_index(drop=True)
    note = "A failed task is tried again when the study is run again in the same directory."
    return Table("failures", "Tasks that failed", frame, _FAILURES, note)


def sampled_points(design: Design) -> Table:
    """Draw the first points of the first point set of each distribution (Figure 3)."""
    size = next((size for size in design.sizes if size >= SCATTER_POINTS), design.sizes[-1])
    frames = []
    for distribution in design.distributions:
        points = sample_points(
            distribution, size, 0, seed=design.seed, correlation=design.correlation
        )[:SCATTER_POINTS]
        frames.append(
            pd.DataFrame(
                {
                    "distribution": distribution,
                    "n_points": size,
                    "point": range(len(points)),
                    "x": points[:, 0],
                    "y": points[:, 1],
                }
            )
        )
    note = f"The first {min(size, SCATTER_POINTS)} of {size:,} points of repetition 0."
    return Table(
        "sampled_points", "Sampled points", pd.concat(frames, ignore_index=True), _SAMPLE, note
    )
