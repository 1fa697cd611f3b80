"""The variance between triangulations as a smooth function of the number of points."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Self

import numpy as np
from scipy import special

from study.statistics.groups import Groups, NotEnough
from study.statistics.thresholds import SIGNIFICANCE

_MOST_STEPS, _CLOSE = 100, 1e-12
#: Sizes, and triangulations of each, from which on a curve is looked for.
_LEAST_SIZES, _LEAST_COUNT = 5, 6
#: Quantile of chi-squared with one degree of freedom.
_CURVED = float(special.chdtri(1, SIGNIFICANCE))


def smooth_variances(groups: Groups) -> np.ndarray:
    """Estimate the variance of a value of each group, smoothed over all groups.

    Parameters
    ----------
    groups : Groups

    Returns
    -------
    (k,) float64 ndarray
        Also of groups of a single triangulation.

    Raises
    ------
    NotEnough
        If no group has two or more differing triangulations.

    Notes
    -----
    A mean over n points whose far parts do not depend on one another has a variance in proportion
    to 1 / n; where early triangles are never taken back, it falls more slowly from some n on. So
    ln variance = alpha + beta ln n, with a further gamma (ln n)^2 where the deviance falls by more
    than the quantile of chi-squared for it. Sample variances are gamma distributed about that, with
    (r - 1) / 2 as shape for r triangulations; fitted by maximum likelihood (McCullagh and Nelder
    1989, Generalized Linear Models, chapter 8, by iteratively reweighted least squares). A
    reciprocal sample variance of three triangulations is no weight: its mean is infinite.
    """
    repeated = groups.repeated()
    if not len(repeated):
        raise NotEnough("no size has two or more differing triangulations")
    known = (repeated.n_points, repeated.counts, repeated.variances)
    return _best_fit(*(tuple(array.tolist()) for array in known)).variances(groups.n_points)


@lru_cache(maxsize=256)  # one group after the other is asked for by many models
def _best_fit(
    n_points: tuple[int, ...], counts: tuple[int, ...], variances: tuple[float, ...]
) -> "_Fit":
    """Fit a curve where the deviance asks for it, else a line."""
    known = (np.array(n_points), np.array(counts), np.array(variances))
    fit = _Fit.of(*known, 2)
    # Of fewer the deviance is no chi-squared.
    if len(n_points) >= _LEAST_SIZES and min(counts) >= _LEAST_COUNT:
        bent = _Fit.of(*known, 3)
        fit = bent if fit.deviance - bent.deviance > _CURVED else fit
    return fit


@dataclass(frozen=True)
class _Fit:
    """A polynomial of ln n, of as many coefficients as the sizes allow."""

    center: float
    coefficients: np.ndarray
    deviance: float

    @classmethod
    def of(
        cls, n_points: np.ndarray, counts: np.ndarray, variances: np.ndarray, coefficients: int
    ) -> Self:
        df = counts - 1.0
        center = float(np.average(np.log(n_points), weights=df))
        basis = _basis(n_points, center, min(coefficients, len(n_points)))
        root = np.sqrt(df)
        fitted = np.linalg.lstsq(basis * root[:, None], np.log(variances) * root, rcond=None)[0]
        for _ in range(_MOST_STEPS):
            excess = variances / np.exp(basis @ fitted) - 1
            step = np.linalg.lstsq(basis * root[:, None], excess * root, rcond=None)[0]
            # Bounded, so that a bad start cannot throw the fit far off.
            length = np.abs(basis @ step).max()
            fitted = fitted + step / max(1.0, length)
            if length < _CLOSE:
                break
        log_variance = basis @ fitted
        ratio = variances / np.exp(log_variance)
        return cls(center, fitted, float(df @ (ratio - 1 - np.log(ratio))))

    def variances(self, n_points: np.ndarray) -> np.ndarray:
        """Variances of a triangulation's value, by number of points."""
        return np.exp(_basis(n_points, self.center, len(self.coefficients)) @ self.coefficients)


def _basis(n_points: np.ndarray, center: float, coefficients: int) -> np.ndarray:
    log_n = np.log(n_points) - center
    return np.column_stack([log_n**k for k in range(coefficients)])
