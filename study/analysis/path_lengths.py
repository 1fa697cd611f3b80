"""How paths go on and end: step by step, and against two laws of their lengths."""

from collections.abc import Callable, Iterator

import numpy as np
import pandas as pd

from lepp import theory
from study.analysis.building import Population, Study, builds, rows_by_population
from study.analysis.parts import INTERIOR_NOTE, PART, PARTS
from study.analysis.table import (
    DISTRIBUTION,
    METHOD,
    N_POINTS,
    Column,
    Declaration,
    Row,
    Table,
    select,
)
from study.statistics.continuation import (
    SHORTEST,
    Continuation,
    LawFit,
    continuation,
    fit_constant,
    fit_power,
    longest_expected,
)
from study.statistics.groups import ENOUGH, NotEnough, best_repeated
from study.statistics.intervals import ratio_interval
from study.statistics.thresholds import FEW_PATHS, LEVEL, ROUGH_RATE, SIGNIFICANCE
from study.statistics.verdicts import rejected

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

#: Laws of the chance to go on: one that falls and one chance for all steps, both fitted; and what
#: Theorem 1 makes of the chance at the first step and of that of all steps together.
FALLING, CONSTANT = "λ / (k + b)ᵃ", "constant"
FIRST_STEP, ALL_STEPS = "Theorem 1, first step", "Theorem 1, all steps"

#: What is said to be missing where the chances to go on, or a law of them, cannot be had.
LAW_MISSING = "law of path lengths"

CONTINUATION = Declaration(
    "continuation",
    "Chance to go on after k triangles",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        N_POINTS,
        Column("lepp_size", "After k triangles", "triangles", "int"),
        Column("reached", "Paths that have k", "triangles", "int"),
        Column("went_on", "Paths that have more", "triangles", "int"),
        Column("rate", "Chance to go on", "", "fixed4"),
        Column("standard_error", "Standard error", "", "g2"),
        Column("low", f"{LEVEL} from", "", "fixed4"),
        Column("high", f"{LEVEL} to", "", "fixed4"),
        Column("fitted", f"Law {FALLING}", "", "fixed4"),
        Column("constant", "Theorem 1", "", "fixed4"),
    ),
    note=f"At the largest number of points with {ENOUGH} triangulations or more. Ratios of sums "
    "over triangulations, with the standard errors of such; where no number of points has as many, "
    "at the largest, with the residuals of all sizes, taken to grow with the number of paths. "
    f"Of fewer than {FEW_PATHS:,} paths they are not known. "
    f"Theorem 1 takes the chance at the first step, k = {SHORTEST}, for all. " + INTERIOR_NOTE,
)

PATH_LAWS = Declaration(
    "path_laws",
    "Laws of the chance to go on",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        N_POINTS,
        Column("law", "Law"),
        Column("upto_size", "Fitted up to k", "triangles", "int"),
        Column("scale", "λ, or the chance", "", "fixed4"),
        Column("scale_error", "± of λ", "", "g2"),
        Column("shift", "b", "", "fixed3"),
        Column("shift_error", "± of b", "", "g2"),
        Column("exponent", "a", "", "fixed4"),
        Column("exponent_error", "± of a", "", "g2"),
        Column("f", "F", "", "g3"),
        Column("df", "Df, law", "", "int"),
        Column("df_residual", "Df, covariance", "", "int"),
        Column("log10_p", "log10 p", "", "log10p"),
        Column("verdict", "The law"),
        Column("paths", "Paths that take a step", "triangles", "int"),
        Column("longest_expected", "Longest expected", "triangles", "int"),
        Column("longest_seen", "Longest seen", "triangles", "int"),
    ),
    note="Of the chances to go on at the largest number of points with "
    f"{ENOUGH} triangulations or more, as of fewer their covariance is not known. Fitted are those "
    f"from k = 2 on whose intervals are narrower than {ROUGH_RATE:g}, but no more sizes than a "
    "third "
    "of the degrees of freedom of the covariance, which is too rough to be inverted for more. "
    "Paths "
    "run through the same triangles, so that "
    "neighbouring rates are correlated: the laws are fitted to the rates by generalised least "
    "squares with their covariance, ± are standard errors. The weighted sum of squares is given as "
    f"an F, as the covariance is estimated. A law is rejected where p is below {SIGNIFICANCE}. "
    "Where a constant is rejected, "
    "none is given, and the falling law is fitted. The longest path expected is the size of which "
    "the law, beyond the sizes that it is fitted to, leaves fewer than one longer path; long paths "
    "come in bundles that share most of their triangles, so that the longest one seen scatters "
    "more widely around it "
    "than that of independent paths would. " + INTERIOR_NOTE,
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


@builds(CONTINUATION, PATH_LAWS)
def continuation_laws(study: Study) -> Iterator[Table]:
    """Measure the chance to go on after each size, and fit laws to it, in each part of a mesh."""
    rates: list[Row] = []
    laws: list[Row] = []
    for method, distribution in study.data.populations:
        one = Population(study, method, distribution, LAW_MISSING)
        for part in PARTS:
            try:
                n_points, measured = _continuation(one, part)
            except NotEnough as lack:
                one.lacks(f"{part}: {lack}")
                continue
            fits = _fits(one, part, measured)
            key = one.key | {"part": part, "n_points": n_points}
            rates += [key | row for row in _rates(measured, fits.get(FALLING))]
            laws += [key | row for row in _laws(measured, fits)]
    yield CONTINUATION.table(rates)
    yield PATH_LAWS.table(laws)


def _fits(one: Population, part: str, measured: Continuation) -> dict[str, LawFit]:
    """Fit the constant, and, where that is rejected, the falling law."""
    fits = {}
    try:
        fits[CONSTANT] = fit_constant(measured)
        if _rejected(fits[CONSTANT]):
            fits[FALLING] = fit_power(measured)
    except NotEnough as lack:
        one.lacks(f"{part}: {lack}")
    return fits


def _rejected(fit: LawFit) -> bool:
    return fit.log10_p < np.log10(SIGNIFICANCE)


def _rates(measured: Continuation, falling: LawFit | None) -> Iterator[Row]:
    for k, size in enumerate(measured.sizes.tolist()):
        rate, half = measured.rates[k], measured.half_widths[k]
        known = half > 0
        yield {
            "lepp_size": size,
            "reached": measured.reached[k],
            "went_on": round(rate * measured.reached[k]),
            "rate": rate,
            "standard_error": measured.standard_errors[k] if known else np.nan,
            "low": max(rate - half, 0.0) if known else np.nan,
            "high": min(rate + half, 1.0) if known else np.nan,
            "fitted": falling.curve(measured.sizes[k]) if falling else np.nan,
            "constant": measured.rates[0],
        }


def _laws(measured: Continuation, fits: dict[str, LawFit]) -> Iterator[Row]:
    common: Row = {"paths": measured.paths, "longest_seen": measured.sizes[-1]}
    for law, fit in fits.items():
        row = common | {
            "law": law,
            "upto_size": fit.sizes[-1],
            "f": fit.f,
            "df": fit.df,
            "df_residual": fit.df_residual,
            "log10_p": fit.log10_p,
            "verdict": rejected(_rejected(fit)),
        }
        if law != CONSTANT or not _rejected(fit):
            row["longest_expected"] = longest_expected(fit.curve, measured.paths)
            names = ("scale", "shift", "exponent")
            values = zip(names, fit.coefficients, fit.standard_errors, strict=False)
            for name, value, error in values:
                row |= {name: value, f"{name}_error": error}
        yield row
    all_steps = float(measured.rates @ measured.reached / measured.reached.sum())
    for law, chance in ((FIRST_STEP, float(measured.rates[0])), (ALL_STEPS, all_steps)):
        yield common | {
            "law": law,
            "scale": chance,
            "longest_expected": longest_expected(_level(chance), measured.paths),
        }


def _level(chance: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda sizes: np.full(np.shape(sizes), chance)


def _continuation(one: Population, part: str) -> tuple[int, Continuation]:
    """Return the number of points that the rates are of, `best_repeated`, and the rates."""
    frame = one.data.histogram(one.method, one.distribution, part)
    if frame.empty:
        raise NotEnough("no triangulation has it")
    groups = {
        int(size): counts_by_task(group, "lepp_size")
        for size, group in frame.groupby("n_points", sort=True)
    }
    n_points = best_repeated({size: len(counts) for size, counts in groups.items()})
    upto = [counts for size, counts in groups.items() if size <= n_points]
    return n_points, continuation(upto)


def _lepp_counts(one: Population) -> np.ndarray:
    frame = select(one.data.histograms, one.key)
    if frame.empty:
        raise NotEnough("no triangulation has succeeded")
    return counts_by_task(frame, "lepp_size")
