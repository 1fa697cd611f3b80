"""Intervals of means and of ratios, and what an interval says of a bound."""

import numpy as np
from scipy import special

from study.statistics.groups import variance
from study.statistics.thresholds import CONFIDENCE
from study.statistics.verdicts import NO, UNDECIDED, YES


def t_quantile(df: float) -> float:
    """Count the standard errors to each side of an estimate with df degrees of freedom.

    Parameters
    ----------
    df : float
        Above 0.

    Returns
    -------
    float
        The quantile of Student's t at which `study.statistics.thresholds.CONFIDENCE` lies between
        it and its negative.
    """
    return float(-special.stdtrit(df, (1 - CONFIDENCE) / 2))


def mean_interval(values: np.ndarray) -> tuple[float, float, float]:
    """Mean of independent values with its t interval.

    Parameters
    ----------
    values : (n,) float64 ndarray

    Returns
    -------
    mean, low, high : float
        NaN where there is nothing to compute them from: no value for the mean; fewer than two, or
        only equal ones, for the interval.
    """
    if len(values) == 0:
        return np.nan, np.nan, np.nan
    mean, spread = float(values.mean()), variance(values)
    if not spread > 0:
        return mean, np.nan, np.nan
    half = t_quantile(len(values) - 1) * np.sqrt(spread / len(values))
    return mean, float(mean - half), float(mean + half)


def ratio_of_sums(
    numerators: np.ndarray, denominators: np.ndarray
) -> tuple[float, float, float, float]:
    """Ratio of two sums over independent triangulations, with its linearised standard error.

    Parameters
    ----------
    numerators, denominators : (r,) int64 ndarray
        A pair of counts a triangulation.

    Returns
    -------
    ratio, standard_error, low, high : float
        Error and t interval are NaN for fewer than two triangulations, or equal ratios.

    Notes
    -----
    Cochran (1977), Sampling Techniques, section 6.3.
    """
    r, total = len(denominators), denominators.sum()
    ratio = numerators.sum() / total
    squares = ((numerators - ratio * denominators) ** 2).sum()
    if r < 2 or not squares > 0:
        return float(ratio), np.nan, np.nan, np.nan
    error = np.sqrt(r / (r - 1) * squares) / total
    half = t_quantile(r - 1) * error
    return float(ratio), float(error), float(ratio - half), float(ratio + half)


def ratio_interval(ended: np.ndarray, reached: np.ndarray) -> tuple[float, float, float, float]:
    """Rate of what has ended among what has been reached: a ratio of sums within 0 and 1.

    Parameters and returns as of `ratio_of_sums`.
    """
    rate, error, low, high = ratio_of_sums(ended, reached)
    if np.isnan(error):
        return rate, error, low, high
    return rate, error, max(low, 0.0), min(high, 1.0)


def at_least(bound: float, low: float, high: float) -> str:
    """Tell whether a quantity is at least `bound`, from its interval.

    Parameters
    ----------
    bound : float
    low, high : float
        The interval; NaN where there is none.

    Returns
    -------
    str
        `YES` where all of the interval is, `NO` where nothing of it is, else `UNDECIDED`.
    """
    if low >= bound:
        return YES
    return NO if high < bound else UNDECIDED
