"""All tables of a study from its results."""

from dataclasses import asdict
from typing import TYPE_CHECKING

import pandas as pd

from study.analysis import assumptions, bounds, games_howell, groups, randomness, variance
from study.analysis.measurements import Measurements, Missing
from study.analysis.table import DISTRIBUTION, METHOD, Column, Table

if TYPE_CHECKING:
    from study.design import Design

_MISSING = (METHOD, DISTRIBUTION, Column("what", "Not computed"), Column("why", "Why"))


def analyse(
    results: pd.DataFrame, histograms: pd.DataFrame, regions: pd.DataFrame, design: "Design"
) -> dict[str, Table]:
    """Compute every table of a study.

    Parameters
    ----------
    results : pandas.DataFrame
        A row a task; measured columns are null and `error` is not where the task failed.
    histograms : pandas.DataFrame
        Counts of LEPP sizes: method, distribution, n_points, replicate, lepp_size, count.
    regions : pandas.DataFrame
        Counts of terminal-edge region sizes, with `region_size` in place of `lepp_size`.
    design : Design
        What was asked for.

    Returns
    -------
    dict of str to Table
        By name. A table that the results do not suffice for has the rows that can be had; the
        table ``missing`` says what cannot, and why. The same results give the same tables.
    """
    data = Measurements.of(results, histograms, regions, design)
    tables: list[Table] = []
    missing: list[Missing] = []

    by_group = groups.groups(data)
    overview = groups.overview(by_group, data)
    tables += [overview, by_group, randomness.uniformity(data)]
    missing += groups.missing_tasks(overview, data)
    for build in (
        randomness.randomness,
        assumptions.levene,
        assumptions.shapiro,
        assumptions.qq,
        variance.anova,
        games_howell.pairs,
        bounds.bounds,
    ):
        table, lacking = build(data)
        tables.append(table)
        missing += lacking
    rows = [asdict(entry) for entry in missing]
    tables.append(Table.from_rows("missing", "What could not be computed", _MISSING, rows))
    return {table.name: table for table in tables}
