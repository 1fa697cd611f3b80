"""How paths end: the pooled histogram of LEPP sizes, step by step and against the geometric law."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from lepp import theory
from study.analysis.building import Population, rows_by_population
from study.analysis.table import DISTRIBUTION, METHOD, Column, Declaration, Row, select
from study.statistics.groups import NotEnough
from study.statistics.intervals import ratio_interval
from study.statistics.thresholds import LEVEL

_SIZE = Column("lepp_size", "LEPP size", "triangles", "int")

TERMINATION = Declaration(
    "termination",
    "Termination rate at each size of the path",
    (
        METHOD,
        DISTRIBUTION,
        _SIZE,
        Column("reached", "Paths that reach it", "triangles", "int"),
        Column("ended", "Paths that end there", "triangles", "int"),
        Column("rate", "Termination rate", "", "fixed4"),
        Column("standard_error", "Standard error", "", "g2"),
        Column("low", f"{LEVEL} from", "", "fixed4"),
        Column("high", f"{LEVEL} to", "", "fixed4"),
        Column("p_type_c", "Share p of type C", "", "fixed4"),
    ),
    note="All triangulations of a method and distribution together. Size 1 ends on the boundary. "
    "Theorem 1 takes the rate from size 2 on to be constant and equal to p. Paths of one "
    "triangulation share triangles and are not independent: the standard error is that of a "
    "ratio of sums over triangulations. Rates that only few paths reach are rough.",
)

LAW = Declaration(
    "law",
    "LEPP sizes against the geometric law",
    (
        METHOD,
        DISTRIBUTION,
        _SIZE,
        Column("count", "Triangles", "triangles", "int"),
        Column("share", "Share", "", "percent3"),
        Column("geometric_share", "Geometric law", "", "percent3"),
        Column("ratio", "Share / law", "", "g3"),
    ),
    note="All triangulations of a method and distribution together. The law of Theorem 1: "
    "P(size = k) = (1 - p)^(k - 2) p for k of 2 and more, p the share of type C neighbours; it "
    "has no triangles of size 1, whose longest edge is on the boundary.",
)


def counts_by_task(frame: pd.DataFrame, size: str) -> np.ndarray:
    """Lay out counts in a matrix.

    Parameters
    ----------
    frame : pandas.DataFrame
        With n_points, replicate, the column `size` and count, of one method and distribution.

    Returns
    -------
    (tasks, largest size + 1) int64 ndarray
        Column k counts size k.
    """
    tasks = frame.groupby(["n_points", "replicate"], sort=True).ngroup().to_numpy()
    sizes = frame[size].to_numpy(dtype=np.int64)
    shape = (tasks.max(initial=-1) + 1, sizes.max(initial=-1) + 1)
    counts = np.zeros(shape, dtype=np.int64)
    np.add.at(counts, (tasks, sizes), frame["count"].to_numpy(dtype=np.int64))
    return counts


def pooled_p(triangulations: pd.DataFrame) -> float:
    """Share of type C neighbours in all triangulations together; NaN without any."""
    inside = int(triangulations["n_interior_longest"].sum())
    return int(triangulations["n_type_c"].sum()) / inside if inside else np.nan


@rows_by_population(TERMINATION, "termination rates")
def termination(one: Population) -> Iterator[Row]:
    """At each size, the share of the paths that end there among those that reach it."""
    counts = _lepp_counts(one)
    p = pooled_p(one.triangulations)
    reached = counts[:, ::-1].cumsum(axis=1)[:, ::-1]
    for size in range(1, counts.shape[1]):
        rate, error, low, high = ratio_interval(counts[:, size], reached[:, size])
        yield {
            "lepp_size": size,
            "reached": int(reached[:, size].sum()),
            "ended": int(counts[:, size].sum()),
            "rate": rate,
            "standard_error": error,
            "low": low,
            "high": high,
            "p_type_c": p,
        }


@rows_by_population(LAW, "histogram of LEPP sizes")
def law(one: Population) -> Iterator[Row]:
    """Histogram of all LEPP sizes against the geometric law of the measured p."""
    counts = _lepp_counts(one).sum(axis=0)
    p = pooled_p(one.triangulations)
    for size in range(1, len(counts)):
        share = counts[size] / counts.sum()
        predicted = float(theory.probability(size, p)) if p > 0 else 0.0
        yield {
            "lepp_size": size,
            "count": int(counts[size]),
            "share": share,
            "geometric_share": predicted,
            "ratio": share / predicted if predicted > 0 else np.nan,
        }


def _lepp_counts(one: Population) -> np.ndarray:
    frame = select(one.data.histograms, one.key)
    if frame.empty:
        raise NotEnough("no triangulation has succeeded")
    return counts_by_task(frame, "lepp_size")
