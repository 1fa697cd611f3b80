"""How far statistics of groups vary between honest replications, whatever the groups' variances.

The usual standard errors of F, R squared and regression coefficients suppose that all groups have
one variance. A parametric bootstrap does not: groups are drawn again and again, normal, each with a
mean and standard deviation of its own, and every statistic is computed of every draw (Efron and
Tibshirani 1993, An Introduction to the Bootstrap, section 6.5).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from study.statistics.models import LINEAR_MODELS, LinearModel

#: Draws of all groups: a standard deviation is then right to 1.6 per cent.
DRAWS = 2000

ANOVA_F, LEVENE_F = "F, analysis of variance", "F, Levene"
#: Of a model, beside its coefficients.
F, ADJUSTED_R2 = "F", "adjusted R squared"

#: Of which the logarithm is the nearer to normal.
_BY_LOGARITHM = (ANOVA_F, LEVENE_F, F)

Statistics = dict[tuple[str, str], np.ndarray]
"""Of each draw, (d,) float64, by (model, F, adjusted R squared or name of a coefficient);
the analysis of variance and Levene's test have no model: ("", name)."""


@dataclass(frozen=True)
class Replications:
    """Groups that are drawn again.

    Attributes
    ----------
    x : (k,) float64 ndarray
        Where each group stands: thousands of points.
    means, sds : (k,) float64 ndarray
        Of the groups; `sds` with the divisor ``count - 1``.
    count : int
        Values of each group.
    """

    x: np.ndarray
    means: np.ndarray
    sds: np.ndarray
    count: int

    def draw(self, rng: np.random.Generator, draws: int = DRAWS) -> np.ndarray:
        """Draw normal values of all groups, (draws, k, count) float64."""
        values = rng.standard_normal((draws, len(self.x), self.count))
        values *= self.sds[:, None]
        values += self.means[:, None]
        return values

    def standard_errors(self, rng: np.random.Generator) -> Mapping[tuple[str, str], float]:
        """Find every statistic's standard deviation between replications; of F, its logarithm's."""
        drawn = statistics_of(self.x, self.draw(rng))
        return {
            name: float((np.log(values) if name[1] in _BY_LOGARITHM else values).std(ddof=1))
            for name, values in drawn.items()
        }


def statistics_of(x: np.ndarray, values: np.ndarray) -> Statistics:
    """Compute the statistics of Tables 2, 5 and 7 of many draws at once.

    Parameters
    ----------
    x : (k,) float64 ndarray
        Thousands of points.
    values : (d, k, n) float64 ndarray
        A value a triangulation, for each draw and group.
    """
    deviations = np.abs(values - values.mean(axis=2, keepdims=True))
    found = {("", ANOVA_F): _one_way_f(values), ("", LEVENE_F): _one_way_f(deviations)}
    for model in LINEAR_MODELS:
        found |= _regression(model, x, model.transform(values))
    return found


def _inside(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means of the groups, (d, k), and the sum of squares inside all of them, (d,)."""
    means = values.mean(axis=2)
    return means, np.square(values - means[:, :, None]).sum(axis=(1, 2))


def _one_way_f(values: np.ndarray) -> np.ndarray:
    _, k, n = values.shape
    means, within = _inside(values)
    between = n * np.square(means - means.mean(axis=1, keepdims=True)).sum(axis=1)
    return between / (k - 1) / (within / (k * n - k))


def _regression(model: LinearModel, x: np.ndarray, z: np.ndarray) -> Statistics:
    _, k, n = z.shape
    means, within = _inside(z)
    basis = model.basis(x)
    coefficients = means @ np.linalg.pinv(basis).T
    fitted = coefficients @ basis.T
    explained = n * np.square(fitted - means.mean(axis=1, keepdims=True)).sum(axis=1)
    left = n * np.square(means - fitted).sum(axis=1) + within
    df1, df2 = basis.shape[1] - 1, k * n - basis.shape[1]
    return {
        (model.name, F): explained / df1 / (left / df2),
        (model.name, ADJUSTED_R2): 1 - left / df2 / ((explained + left) / (df1 + df2)),
    } | {(model.name, term): coefficients[:, i] for i, term in enumerate(model.terms)}
