"""The report's own tables, beside those of the analysis: what figures draw and comparisons show."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from lepp import METHODS
from study.analysis.building import Study, builds
from study.analysis.group_summaries import GROUPS
from study.analysis.table import (
    DISTRIBUTION,
    METHOD,
    N_POINTS,
    Column,
    Declaration,
    Row,
    Table,
)
from study.design.sampling import sample_block
from study.paper.published import MEAN_LEPP, SD_BETWEEN
from study.paper.reproduction import REPRODUCTION
from study.paper.statements import STATEMENTS
from study.run.measures import columns_of
from study.run.point_checks import PointChecks
from study.run.triangulations import Measures

SCATTER_POINTS = 400

_REPLICATE = Column("replicate", "Repetition", "", "int")


def _described(measures: type, *names: str) -> tuple[Column, ...]:
    """Return measures as columns: those named, or all."""
    return tuple(
        Column(column.name, column.label, column.unit, column.format)
        for column in columns_of(measures)
        if column.name in names or not names
    )


TRIANGULATIONS = Declaration(
    "triangulations",
    "Triangulations",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        _REPLICATE,
        *_described(Measures, "n_triangles", "mean_lepp", "sd_lepp", "max_lepp"),
    ),
    note="One row a triangulation. results.parquet, written with this page, has more columns of "
    "each.",
)

POINT_SETS = Declaration(
    "point_sets",
    "Checks of the point sets",
    (DISTRIBUTION, N_POINTS, _REPLICATE, *_described(PointChecks)),
    note="One row a point set: every method triangulates the same points.",
)

SAMPLED_POINTS = Declaration(
    "sampled_points",
    "Sampled points",
    (
        DISTRIBUTION,
        N_POINTS,
        Column("point", "Point", "", "int"),
        Column("x", "x", "", "fixed4"),
        Column("y", "y", "", "fixed4"),
    ),
    note="The first {shown} of {size:,} points of repetition 0.",
)

TABLE_4 = Declaration(
    "table_4",
    "Table 4, ours and the paper's",
    (
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
    ),
    note="The paper prints this table for the uniform distribution. Its last column is called the "
    "average of the standard deviations; its values are those of the SD of the means.",
)

FAILURES = Declaration(
    "failures",
    "Tasks that failed",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        _REPLICATE,
        Column("error", "Error"),
    ),
    note="A failed task is tried again when the study is run again in the same directory.",
)

#: What its rows have in common; each method has a column of its own beside.
_STATEMENT = (
    DISTRIBUTION,
    Column("source", "Where"),
    Column("statement", "The paper's statement"),
)
STATEMENTS_COMPARED = Declaration(
    "statements_compared",
    "Which of the paper's statements hold for which triangulation",
    _STATEMENT,
)


def statements_compared_by(methods: Sequence[str]) -> Declaration:
    """Declare the table of the paper's statements with a column a method."""
    verdicts = [Column(name, METHODS[name].title, "", "verdict") for name in methods]
    return replace(STATEMENTS_COMPARED, columns=(*_STATEMENT[:-1], *verdicts, _STATEMENT[-1]))


@builds(TABLE_4, needs=(GROUPS, REPRODUCTION))
def table_4(study: Study) -> Iterator[Table]:
    """Table 4 of every view, with the published values where there are some."""
    keys = ["method", "distribution", "n_points"]
    groups = study.tables.rows(GROUPS).frame
    ours = groups[groups["triangulations"] > 0]
    ours = ours[[name for name in TABLE_4.column_names if name in GROUPS.column_names]]

    def printed(quantity: str) -> pd.DataFrame:
        rows = study.tables.rows(REPRODUCTION, published_table=4, quantity=quantity)
        return rows.frame.set_index(keys)

    mean, sd = printed(MEAN_LEPP), printed(SD_BETWEEN)
    beside = pd.DataFrame(
        {
            "published_mean": mean["published"],
            "difference": mean["difference"],
            "published_sd": sd["published"],
        }
    )
    yield _of_columns(TABLE_4, ours.join(beside, on=keys))


@builds(STATEMENTS_COMPARED, needs=(STATEMENTS,))
def statements_compared(study: Study) -> Iterator[Table]:
    """Whether each statement of the paper holds, a column a method."""
    statements = study.tables.rows(STATEMENTS).frame
    methods = study.data.design.methods
    shared = [column.name for column in _STATEMENT]
    rows = statements.pivot(index=shared, columns="method", values="holds")
    order = statements[shared].drop_duplicates()
    yield _of_columns(statements_compared_by(methods), order.join(rows[list(methods)], on=shared))


@builds(TRIANGULATIONS, POINT_SETS, FAILURES)
def measurements(study: Study) -> Iterator[Table]:
    """Give what was measured of each triangulation and point set, and what failed."""
    yield _of_columns(TRIANGULATIONS, study.data.results)
    yield _of_columns(POINT_SETS, study.data.point_sets)
    yield _of_columns(FAILURES, study.data.failures)


def _of_columns(declared: Declaration, frame: pd.DataFrame) -> Table:
    return declared.of_frame(frame[declared.column_names].reset_index(drop=True))


@builds(SAMPLED_POINTS)
def sampled_points(study: Study) -> Iterator[Table]:
    """Draw the first points of the first point set of each distribution (Figure 3)."""
    design = study.data.design
    size = next((size for size in design.sizes if size >= SCATTER_POINTS), design.sizes[-1])

    def rows() -> Iterator[Row]:
        for distribution in design.distributions:
            # Of its first block only: a set may be larger than memory.
            points = sample_block(
                distribution, size, 0, 0, seed=design.seed, correlation=design.correlation
            )[:SCATTER_POINTS]
            key: Row = {"distribution": distribution, "n_points": size}
            for point, (x, y) in zip(np.arange(len(points)), points, strict=True):
                yield key | {"point": point, "x": x, "y": y}

    yield SAMPLED_POINTS.table(rows(), shown=min(size, SCATTER_POINTS), size=size)


REPORT_TABLES = (table_4, statements_compared, measurements, sampled_points)
