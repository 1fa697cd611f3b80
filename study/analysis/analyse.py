"""All tables of a study from its results."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

import pandas as pd

from study.analysis import (
    bound_tests,
    distribution_comparison,
    group_assumptions,
    group_summaries,
    limits,
    method_comparison,
    model_scores,
    pairwise_comparisons,
    part_changes,
    part_means,
    path_lengths,
    point_randomness,
    regressions,
    terminal_regions,
    theorems,
    variance_analysis,
    worst_case_strip,
)
from study.analysis.building import Builder, BuiltTables
from study.analysis.measurements import Measurements
from study.paper import consistency, reproduction, runs_lattice, scoreboard, statements

if TYPE_CHECKING:
    from study.design.design import Design

#: In the order in which what is missing is told; who needs whom, the builders say themselves.
BUILDERS = (
    group_summaries.groups,
    group_summaries.overview,
    point_randomness.randomness,
    point_randomness.uniformity,
    group_assumptions.levene,
    group_assumptions.shapiro,
    group_assumptions.qq,
    variance_analysis.anova,
    pairwise_comparisons.pairs,
    bound_tests.bounds,
    theorems.neighbor_types,
    theorems.theorem_1,
    theorems.theorem_2,
    path_lengths.termination,
    path_lengths.law,
    path_lengths.continuation_laws,
    terminal_regions.regions,
    terminal_regions.region_sizes,
    method_comparison.methods,
    method_comparison.growth,
    distribution_comparison.distributions,
    distribution_comparison.analogous,
    worst_case_strip.worst_case,
    part_means.part_means,
    part_means.layer_means,
    part_means.longest_paths,
    part_means.common_means,
    part_changes.part_changes,
    part_changes.last_layers,
    regressions.regressions,
    model_scores.model_scores,
    limits.limits,
    reproduction.reproduction,
    scoreboard.summary,
    scoreboard.overall,
    consistency.consistency,
    runs_lattice.runs_lattice,
    statements.statements,
)


def analyse(
    results: pd.DataFrame,
    histograms: pd.DataFrame,
    regions: pd.DataFrame,
    layers: pd.DataFrame,
    point_sets: pd.DataFrame,
    design: "Design",
    more: Iterable[Builder] = (),
) -> BuiltTables:
    """Return every table of a study.

    Parameters
    ----------
    results : pandas.DataFrame
        A row a task; measured columns are null and `error` is not where the task failed.
    histograms : pandas.DataFrame
        Counts of LEPP sizes: method, distribution, n_points, replicate, lepp_size, count.
    regions : pandas.DataFrame
        Counts of terminal-edge region sizes, with `region_size` in place of `lepp_size`.
    layers : pandas.DataFrame
        Counts of LEPP sizes by layer: the columns of `histograms`, and `layer`.
    point_sets : pandas.DataFrame
        A row a point set, with the p-values of its checks.
    design : Design
        What was asked for.
    more : iterable of Builder
        Further tables, of whoever asks.

    Returns
    -------
    BuiltTables
        By name; each is computed when it is first asked for. A table that the results do not
        suffice for has the rows that can be had; the table ``missing`` says what cannot, and why.
        The same results give the same tables.
    """
    data = Measurements.of(results, histograms, regions, layers, point_sets, design)
    return BuiltTables((*BUILDERS, *more), data)
