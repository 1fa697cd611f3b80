"""How far the edge reaches: whose a trend is, and whether the interior begins where it is said."""

from collections.abc import Iterator

import numpy as np
import pandas as pd
from scipy import stats

from lepp import INTERIOR_LAYER
from study.analysis.building import Population, Study, rows_by_population, rows_of
from study.analysis.measurements import triangulations_by_size
from study.analysis.parts import INTERIOR, INTERIOR_NOTE, INTERVAL, PART, PARTS
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row
from study.statistics.groups import best_repeated
from study.statistics.multiple_testing import holm
from study.statistics.tails import log10_t_tail
from study.statistics.thresholds import CONFIDENCE, SIGNIFICANCE
from study.statistics.verdicts import rejected

#: The last layers before the interior, which it is held against.
LAST_LAYERS_ARE = range(INTERIOR_LAYER - 6, INTERIOR_LAYER)

PART_CHANGES = Declaration(
    "part_changes",
    "How the means of the whole mesh and of its interior change",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        Column("from_points", "From", "points", "int"),
        Column("to_points", "To", "points", "int"),
        Column("change", "Change", "triangles", "fixed4"),
        *INTERVAL,
        Column("p", "p", "", "p"),
    ),
    note=f"{INTERIOR_NOTE} From the smallest number of points that has one to the "
    "largest. Welch's t test and interval, of the triangulations' means.",
)

LAST_LAYERS = Declaration(
    "last_layers",
    "Whether the edge ends where the interior begins",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        Column("triangulations", "Triangulations", "", "int"),
        Column("last_layers", f"Mean of layers {LAST_LAYERS_ARE[0]} to {LAST_LAYERS_ARE[-1]}",
               "triangles", "fixed4"),
        Column("interior", "Mean of the interior", "triangles", "fixed4"),
        Column("difference", "Difference", "triangles", "fixed4"),
        *INTERVAL,
        Column("p", "p", "", "p"),
        Column("log10_p", "log10 p", "", "log10p"),
        Column("same_mean", "Same mean", "", "verdict"),
    ),
    note=f"{INTERIOR_NOTE} The last layers before it, together, against it, at the largest number "
    "of points: a paired t test over triangulations. Rejected at "
    f"{SIGNIFICANCE} by Holm's correction over all rows.",
)  # fmt: skip


@rows_by_population(PART_CHANGES, "changes of the parts")
def part_changes(one: Population) -> Iterator[Row]:
    """Change of the means from the smallest number of points with an interior to the largest."""
    inside = one.data.groups(one.method, one.distribution, INTERIOR)
    if len(inside) < 2:
        return
    ends = inside.n_points[[0, -1]]
    for part in PARTS:
        groups = one.data.groups(one.method, one.distribution, part)
        by_size = dict(zip(groups.n_points.tolist(), groups.values, strict=True))
        first, last = (by_size.get(int(n), np.empty(0)) for n in ends)
        if min(len(first), len(last)) < 2 or np.ptp(first) == np.ptp(last) == 0:
            continue
        test = stats.ttest_ind(last, first, equal_var=False)
        interval = test.confidence_interval(CONFIDENCE)
        yield {
            "part": part,
            "from_points": int(ends[0]),
            "to_points": int(ends[1]),
            "change": float(last.mean() - first.mean()),
            "low": float(interval.low),
            "high": float(interval.high),
            "p": float(test.pvalue),
        }


@rows_of(LAST_LAYERS)
def last_layers(study: Study) -> Iterator[Row]:
    """Hold the last layers against the interior, for every method and distribution."""
    rows = [row for key in study.data.populations for row in _last_layers(study, *key)]
    if rows:
        adjusted = holm(np.array([row["p"] for row in rows], dtype=float))
        for row, p in zip(rows, adjusted, strict=True):
            yield row | {"same_mean": rejected(p < SIGNIFICANCE)}


def _last_layers(study: Study, method: str, distribution: str) -> Iterator[Row]:
    counts = study.data.by_layer(method, distribution)
    if counts.empty:
        return
    counts = counts[counts["n_points"] == best_repeated(triangulations_by_size(counts))]
    steps = counts.assign(steps=counts["lepp_size"] * counts["count"])
    last = _means(steps[steps["layer"].isin(LAST_LAYERS_ARE)])
    interior = _means(steps[steps["layer"] == INTERIOR_LAYER])
    both = last.index.intersection(interior.index)
    difference = (last[both] - interior[both]).to_numpy()
    if len(both) < 2 or np.ptp(difference) == 0:
        return
    test = stats.ttest_1samp(difference, 0.0)
    interval = test.confidence_interval(CONFIDENCE)
    yield {
        "method": method,
        "distribution": distribution,
        "n_points": int(counts["n_points"].iloc[0]),
        "triangulations": len(both),
        "last_layers": float(last[both].mean()),
        "interior": float(interior[both].mean()),
        "difference": float(difference.mean()),
        "low": float(interval.low),
        "high": float(interval.high),
        "p": float(test.pvalue),
        "log10_p": log10_t_tail(abs(float(test.statistic)), float(test.df)) + np.log10(2),
    }


def _means(steps: pd.DataFrame) -> pd.Series:
    """Mean LEPP size of each triangulation."""
    sums = steps.groupby("replicate")[["steps", "count"]].sum()
    return sums["steps"] / sums["count"]
