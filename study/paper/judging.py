"""The stated rules by which a published number is judged beside ours."""

from dataclasses import dataclass

import numpy as np
from scipy import special, stats

from study.paper.published import Number
from study.statistics.thresholds import AGREES_UP_TO, CLOSE_UP_TO, TABLE_DIFFERS_BELOW

AGREES, CLOSE, DIFFERS = "agrees", "close", "differs"
PLAUSIBLE, IMPLAUSIBLE = "plausible draw", "implausible draw"
MISPRINT, NOT_COMPARABLE, NOT_RUN = "misprint", "not comparable", "not run"
#: Of a number that its own paper's other numbers allow.
CONSISTENT = "consistent"
VERDICTS = (
    AGREES, CLOSE, DIFFERS, PLAUSIBLE, IMPLAUSIBLE, MISPRINT, NOT_COMPARABLE, NOT_RUN,
)  # fmt: skip

#: Below this part of the error, half a unit of rounding does not count.
_NO_ROUNDING = 1e-3

RULE = (
    f"agrees: within {AGREES_UP_TO:g} standard errors (19 of 20 numbers do by chance); close: "
    f"within {CLOSE_UP_TO:g} (all but one in 370); differs: beyond. Standard errors are those of "
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
    chance_beyond: float = np.nan


def within(difference: float) -> str:
    """Verdict on a difference in standard errors."""
    if np.isnan(difference):
        return NOT_COMPARABLE
    size = abs(difference)
    return AGREES if size <= AGREES_UP_TO else CLOSE if size <= CLOSE_UP_TO else DIFFERS


def chance_beyond(error: float, unit: float) -> float:
    """Chance that an honest number is further off than what agrees.

    A normal error and, beside it, the rounding: off by up to half a unit, evenly, which is a
    variance of unit^2 / 12. Where the rounding is the larger, less lies beyond than of a normal.

    Parameters
    ----------
    error : float
        Standard deviation of the difference before rounding.
    unit : float
        One unit of the last printed digit, on the same scale.
    """
    if not error > 0:
        return 0.0  # no rounding is off by two of its own standard deviations
    limit = AGREES_UP_TO * np.hypot(error, unit / np.sqrt(12)) / error
    half = unit / (2 * error)
    if half < _NO_ROUNDING:
        return float(2 * stats.norm.sf(limit))

    def integral(x: float) -> float:  # of the normal's upper tail
        return float(x * stats.norm.sf(x) - stats.norm.pdf(x))

    return (integral(limit + half) - integral(limit - half)) / half


def _judgement(ours: float, published: Number, error: float, rule: str) -> Judgement:
    total = float(np.hypot(error, published.unit / np.sqrt(12)))
    z = (ours - published.value) / total
    chance = chance_beyond(error, published.unit)
    return Judgement(ours, total, z, within(z), rule, chance_beyond=chance)


def of_mean(
    ours: float, sd: float, count: int, published: Number, published_sd: float, repetitions: int
) -> Judgement:
    """Judge means of independent triangulations; standard deviations between them."""
    error = np.sqrt(sd**2 / count + published_sd**2 / repetitions)
    return _judgement(ours, published, error, "difference of means")


def of_sd(ours: float, count: int, published: Number, repetitions: int) -> Judgement:
    """Judge standard deviations by their logarithms and the normal theory's 1 / (2 df)."""
    rule = "logarithm of the ratio of standard deviations"
    relative = float(np.sqrt(1 / (2 * (count - 1)) + 1 / (2 * (repetitions - 1))))
    return _by_logarithm(ours, published, relative, rule)


def _by_logarithm(ours: float, published: Number, error: float, rule: str) -> Judgement:
    unit = published.unit / published.value
    relative = float(np.hypot(error, unit / np.sqrt(12)))
    z = float(np.log(ours / published.value)) / relative
    chance = chance_beyond(error, unit)
    return Judgement(ours, relative * published.value, z, within(z), rule, chance_beyond=chance)


def of_f(ours: float, published: Number, error: float) -> Judgement:
    """Judge F statistics of the same design; `error` is that of the logarithm of their ratio."""
    return _by_logarithm(ours, published, error, "logarithm of the ratio of F, error by bootstrap")


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
    ours: float,
    log10_ours: float,
    f: float,
    published: Number,
    df: tuple[float, float],
    error: float,
) -> Judgement:
    """Judge p-values of regressions of the same design, by the F that they stand for.

    The error is that of the logarithm of the ratio of F.
    """
    z = float(np.log(f / f_of_p(published.value, *df))) / error
    ratio = log10_ours - float(np.log10(published.value))
    rule = "F from p, then as F; the ratio on log10"
    return Judgement(ours, np.nan, z, within(z), rule, ratio)


def of_adjusted_r2(ours: float, published: Number, error: float) -> Judgement:
    """Judge adjusted R squared of the same design."""
    return _judgement(ours, published, error, "difference, error by bootstrap")


def of_coefficient(ours: float, published: Number, error: float) -> Judgement:
    """Judge regression coefficients of the same design."""
    return _judgement(ours, published, error, "difference of coefficients, error by bootstrap")


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
    chance = chance_beyond(float(error), 0.0)
    return Judgement(ours, np.nan, z, within(z), rule, float(ratio), chance)


def of_null_p(ours: float, published_p: float, our_p: float) -> Judgement:
    """Judge statistics of two samples of a true null hypothesis, by normal scores of p."""
    z = float((special.ndtri(our_p) - special.ndtri(published_p)) / np.sqrt(2))
    verdict = PLAUSIBLE if abs(z) <= CLOSE_UP_TO else IMPLAUSIBLE
    rule = f"two draws of a true hypothesis: normal scores of p within {CLOSE_UP_TO:g} sqrt 2"
    return Judgement(ours, np.nan, z, verdict, rule)


def of_drawn_p(rank: float, family_p: float) -> Judgement:
    """Judge a p-value of a random point set by all printed ones of its test together.

    Parameters
    ----------
    rank : float
        Share of our p-values that are at most as large.
    family_p : float
        Of the test that the printed p-values of this test and ours have one distribution.
    """
    verdict = PLAUSIBLE if family_p >= TABLE_DIFFERS_BELOW else IMPLAUSIBLE
    rule = (
        "all printed p-values of this test against ours of sets of the same size (Mann and "
        f"Whitney): plausible unless p is below {TABLE_DIFFERS_BELOW}; ours is the share of our "
        "p-values that are at most as large"
    )
    return Judgement(rank, np.nan, np.nan, verdict, rule)
