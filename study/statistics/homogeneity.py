"""Whether means with known errors are one, and what it is."""

from dataclasses import dataclass

import numpy as np

from study.statistics.intervals import t_quantile
from study.statistics.model_scores import Score


@dataclass(frozen=True)
class Homogeneity:
    """A test of equal means, and their weighted mean.

    Attributes
    ----------
    score : Score
        Weighted squares about the mean.
    mean, low, high : float
        With its t interval, if the means are one.
    """

    score: Score
    mean: float
    low: float
    high: float


def homogeneity(means: np.ndarray, variances: np.ndarray, df_error: int) -> Homogeneity:
    """Test whether means are equal.

    Parameters
    ----------
    means, variances : (k,) float64 ndarray
        Independent means, and their squared standard errors.
    df_error : int
        Degrees of freedom that the variances are estimated from.

    Notes
    -----
    Cochran (1937): the weighted squares are chi-squared with k - 1 degrees of freedom.
    """
    weights = 1 / variances
    mean = float(np.average(means, weights=weights))
    squares = float(weights @ (means - mean) ** 2)
    half = t_quantile(df_error) / float(np.sqrt(weights.sum()))
    return Homogeneity(Score(squares, len(means) - 1, df_error), mean, mean - half, mean + half)
