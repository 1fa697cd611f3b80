"""Intervals of means, and what an interval says of a bound."""

import numpy as np
from scipy import special

from study.analysis.measurements import CONFIDENCE, variance


def t_quantile(df: float) -> float:
    """Count the standard errors to each side of an estimate with df degrees of freedom."""
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


def at_least(bound: float, low: float, high: float) -> str:
    """Whether a quantity with the interval [low, high] is at least `bound`: yes, no, undecided."""
    if low >= bound:
        return "yes"
    return "no" if high < bound else "undecided"
