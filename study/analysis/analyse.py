"""All tables of a study from its results."""

from collections.abc import Iterable
from dataclasses import asdict
from typing import TYPE_CHECKING

import pandas as pd

from study.analysis import (
    assumptions,
    bounds,
    comparison,
    games_howell,
    groups,
    paths,
    randomness,
    regression,
    theory,
    variance,
    worst_case,
)
from study.analysis import (
    regions as terminal_regions,
)
from study.analysis.measurements import Measurements, Missing
from study.analysis.table import DISTRIBUTION, METHOD, Column, Table
from study.paper import reproduction, statements

if TYPE_CHECKING:
    from study.design.design import Design

_BUILDERS = (
    randomness.randomness,
    assumptions.levene,
    assumptions.shapiro,
    assumptions.qq,
    variance.anova,
    games_howell.pairs,
    bounds.bounds,
    theory.neighbor_types,
    theory.theorem_1,
    theory.theorem_2,
    paths.termination,
    paths.law,
    terminal_regions.regions,
    terminal_regions.region_sizes,
    comparison.methods,
    comparison.growth,
)

_MISSING = (METHOD, DISTRIBUTION, Column("what", "Not computed"), Column("why", "Why"))


def analyse(
    results: pd.DataFrame,
    histograms: pd.DataFrame,
    regions: pd.DataFrame,
    point_sets: pd.DataFrame,
    design: "Design",
) -> dict[str, Table]:
    """Compute every table of a study.

    Parameters
    ----------
    results : pandas.DataFrame
        A row a triangulation; measured columns are null and `error` is not where it failed.
    histograms : pandas.DataFrame
        Counts of LEPP sizes: method, distribution, n_points, replicate, lepp_size, count.
    regions : pandas.DataFrame
        Counts of terminal-edge region sizes, with `region_size` in place of `lepp_size`.
    point_sets : pandas.DataFrame
        A row a point set, with the p-values of its checks.
    design : Design
        What was asked for.

    Returns
    -------
    dict of str to Table
        By name. A table that the results do not suffice for has the rows that can be had; the
        table ``missing`` says what cannot, and why. The same results give the same tables.
    """
    data = Measurements.of(results, histograms, regions, point_sets, design)
    missing: list[Missing] = []
    tables: dict[str, Table] = {}

    def add(*made: Table, lacking: Iterable[Missing] = ()) -> None:
        tables.update({table.name: table for table in made})
        missing.extend(lacking)

    by_group = groups.groups(data)
    overview = groups.overview(by_group, data)
    add(overview, by_group, lacking=groups.missing_tasks(overview, data))
    for build in _BUILDERS:
        table, lacking = build(data)
        add(table, lacking=lacking)
    add(randomness.uniformity(data), worst_case.worst_case())

    fits, lacking = regression.fit_all(data)
    add(lacking=lacking)
    table, lacking = regression.regressions(fits)
    add(table, regression.coefficients(fits), regression.projections(fits), lacking=lacking)
    add(regression.limits(fits), regression.curves(fits))

    scoreboard, lacking = reproduction.reproduction(data, tables)
    add(scoreboard, reproduction.summary(scoreboard), lacking=lacking)
    add(reproduction.overall(scoreboard), statements.statements(data, tables))

    rows = [asdict(entry) for entry in missing]
    add(Table.from_rows("missing", "What could not be computed", _MISSING, rows))
    return tables
