"""The stated rules by which a published number is judged beside ours."""

from dataclasses import dataclass

import numpy as np
from scipy import special, stats

from study.paper.published import Number
from study.statistics.thresholds import AGREES_UP_TO, CLOSE_UP_TO

AGREES, CLOSE, DIFFERS = "agrees", "close", "differs"
PLAUSIBLE, IMPLAUSIBLE = "plausible draw", "implausible draw"
MISPRINT, NOT_COMPARABLE, NOT_RUN = "misprint", "not comparable", "not run"
VERDICTS = (
    AGREES, CLOSE, DIFFERS, PLAUSIBLE, IMPLAUSIBLE, MISPRINT, NOT_COMPARABLE, NOT_RUN,
)  # fmt: skip

RULE = (
    f"agrees: within {AGREES_UP_TO:g} standard errors (19 of 20 numbers do by chance); close: "
    f"within {CLOSE_UP_TO:g} (all but one in 370); differs: beyond. The standard error is that of "
    "the difference: ours, the paper's and the rounding of what it prints, together"
)


@dataclass(frozen=True)
class Judgement:
    """A published number beside ours; the fields are columns of the scoreboard."""

    ours: float
    standard_error: float
    difference: float
    verdict: str
    rule: str
    log10_ratio: float = np.nan


def within(difference: float) -> str:
    """Verdict on a difference in standard errors."""
    if np.isnan(difference):
        return NOT_COMPARABLE
    size = abs(difference)
    return AGREES if size <= AGREES_UP_TO else CLOSE if size <= CLOSE_UP_TO else DIFFERS


def _judgement(
    ours: float, published: Number, error: float, rule: str, log10_ratio: float = np.nan
) -> Judgement:
    # A rounded number is off by up to half a unit, evenly: a variance of unit^2 / 12.
    error = float(np.hypot(error, published.unit / np.sqrt(12)))
    z = (ours - published.value) / error
    return Judgement(ours, error, z, within(z), rule, log10_ratio)


def of_mean(
    ours: float, sd: float, count: int, published: Number, published_sd: float, repetitions: int
) -> Judgement:
    """Judge means of independent triangulations; standard deviations between them."""
    error = np.sqrt(sd**2 / count + published_sd**2 / repetitions)
    return _judgement(ours, published, error, "difference of means")


def of_sd(ours: float, count: int, published: Number, repetitions: int) -> Judgement:
    """Judge standard deviations by their logarithms and the normal theory's 1 / (2 df)."""
    rule = "logarithm of the ratio of standard deviations"
    relative = np.sqrt(1 / (2 * (count - 1)) + 1 / (2 * (repetitions - 1)))
    relative = np.hypot(relative, published.unit / np.sqrt(12) / published.value)
    z = float(np.log(ours / published.value) / relative)
    return Judgement(ours, float(relative * published.value), z, within(z), rule)


def f_error(f: float, df1: float, df2: float) -> float:
    """Find the standard deviation of an F statistic, with the noncentrality that it shows.

    NaN for four or fewer residual degrees of freedom, where F has no variance.
    """
    if df2 <= 4:
        return np.nan
    return float(stats.ncf.std(df1, df2, max(df1 * (f - 1), 0.0)))


def of_f(ours: float, published: Number, df1: float, df2: float) -> Judgement:
    """Judge F statistics of the same design, by noncentral F distributions."""
    error = np.hypot(f_error(ours, df1, df2), f_error(published.value, df1, df2))
    return _judgement(ours, published, error, "difference of F, noncentral F distributions")


def of_rounded_p(ours: float, published: Number) -> Judgement:
    """Judge a p-value printed as zero: ours must print the same."""
    same = abs(ours - published.value) <= published.unit / 2
    rule = f"rounded to {published.places} decimals, ours must print the same"
    return Judgement(ours, np.nan, np.nan, AGREES if same else DIFFERS, rule)


def f_of_p(p: float, df1: float, df2: float) -> float:
    """Find the F statistic with the upper tail p, however small p is."""
    # P(F > f) = I_x(df2 / 2, df1 / 2), x = df2 / (df2 + df1 f); F's own inverse gives infinity.
    x = special.betaincinv(df2 / 2, df1 / 2, p)
    return float(df2 / df1 * (1 / x - 1))


def of_regression_p(
    ours: float, log10_ours: float, f: float, published: Number, df1: float, df2: float
) -> Judgement:
    """Judge p-values of regressions of the same design, by the F that they stand for."""
    published_f = f_of_p(published.value, df1, df2)
    error = np.hypot(f_error(f, df1, df2), f_error(published_f, df1, df2))
    z = (f - published_f) / error
    ratio = log10_ours - float(np.log10(published.value))
    return Judgement(ours, np.nan, z, within(z), "F from p, then as F; the ratio on log10", ratio)


def of_adjusted_r2(ours: float, f: float, published: Number, df1: float, df2: float) -> Judgement:
    """Judge adjusted R squared of the same design, by the spread of F."""
    slope = (df1 + df2) * df1 / (df2 + df1 * f) ** 2
    error = np.sqrt(2) * slope * f_error(f, df1, df2)
    return _judgement(ours, published, error, "difference, its error from the spread of F")


def of_coefficient(ours: float, error: float, published: Number) -> Judgement:
    """Judge regression coefficients of the same design."""
    rule = "difference of coefficients, the paper's error as ours"
    return _judgement(ours, published, error * np.sqrt(2), rule)


def of_t_test(
    ours: float, log10_ours: float, t: float, count: int, published: Number, repetitions: int
) -> Judgement:
    """Judge p-values of t tests far in the tail, by the t that they stand for.

    The mean is hundreds of standard errors from the bound, so that t varies as the reciprocal of
    the standard deviation does.
    """
    published_t = stats.t.isf(published.value, repetitions - 1) / np.sqrt(repetitions)
    error = np.sqrt(1 / (2 * (count - 1)) + 1 / (2 * (repetitions - 1)))
    z = float(np.log(abs(t) / np.sqrt(count) / published_t) / error)
    ratio = log10_ours - np.log10(published.value) if count == repetitions else np.nan
    rule = "t / sqrt(repetitions) from p, logarithm of the ratio; the ratio of p on log10"
    return Judgement(ours, np.nan, z, within(z), rule, float(ratio))


def of_null_p(ours: float, published_p: float, our_p: float) -> Judgement:
    """Judge statistics of two samples of a true null hypothesis, by normal scores of p."""
    z = float((special.ndtri(our_p) - special.ndtri(published_p)) / np.sqrt(2))
    verdict = PLAUSIBLE if abs(z) <= CLOSE_UP_TO else IMPLAUSIBLE
    rule = f"two draws of a true hypothesis: normal scores of p within {CLOSE_UP_TO:g} sqrt 2"
    return Judgement(ours, np.nan, z, verdict, rule)


def of_unnamed_p(rank: float, published: Number, family: int, level: float) -> Judgement:
    """Judge a p-value of an unnamed point set, one of `family` printed ones."""
    verdict = PLAUSIBLE if published.value >= level / family else IMPLAUSIBLE
    rule = (
        f"of an unnamed point set, no number of ours belongs to it: plausible unless below {level} "
        f"/ {family}; ours is the share of our p-values that are at most as large"
    )
    return Judgement(rank, np.nan, np.nan, verdict, rule)
