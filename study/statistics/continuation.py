"""The chance that a path goes on, size by size, and laws that are fitted to it.

Of the paths that have at least k triangles, a share c(k) has more. Theorem 1 takes c to be
constant, which makes the sizes geometric. The law lambda / (k + b)^a lets it fall.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy import optimize

from study.statistics.groups import ENOUGH, NotEnough
from study.statistics.intervals import t_quantile
from study.statistics.tails import log10_f_tail
from study.statistics.thresholds import FEW_PATHS, ROUGH_RATE

#: Size of the shortest path that takes a step.
SHORTEST = 2

#: Range of ln(2 + b) in which the law is looked for. Towards its upper end the law becomes an
#: exponential in k, towards its lower end a constant after a first, different rate.
_LEAST_SHIFT, _MOST_SHIFT = np.log(0.05), np.log(200.0)

#: Least eigenvalue of a correlation matrix that is inverted.
_SINGULAR = 1e-9

Curve = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Continuation:
    """Shares of the paths that go on, measured in several triangulations.

    Attributes
    ----------
    sizes : (s,) int64 ndarray
        Numbers of triangles k, 2 and the next ones.
    reached : (s,) int64 ndarray
        Paths of at least k triangles.
    rates : (s,) float64 ndarray
        Share of them that have more than k.
    covariance : (s, s) float64 ndarray
        Of the rates. NaN where no group has two triangulations.
    df : int
        Degrees of freedom of the covariance.
    """

    sizes: np.ndarray
    reached: np.ndarray
    rates: np.ndarray
    covariance: np.ndarray
    df: int

    @property
    def paths(self) -> int:
        """Number of paths that take a step."""
        return int(self.reached[0])

    @property
    def standard_errors(self) -> np.ndarray:
        """Of the rates, (s,) float64."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def half_widths(self) -> np.ndarray:
        """Of the rates' t intervals, (s,) float64; NaN without degrees of freedom.

        NaN, too, where fewer than `thresholds.FEW_PATHS` paths reach the size: they may be one
        bundle in one triangulation, whose residual is then zero.
        """
        if self.df < 1:
            return np.full(len(self.rates), np.nan)
        return np.where(
            self.reached >= FEW_PATHS, t_quantile(self.df) * self.standard_errors, np.nan
        )

    def sure(self) -> Self:
        """Only the sizes from 2 on up to the first whose rate is not known well.

        A rate is known well where its interval is narrower than `thresholds.ROUGH_RATE`, and not
        of no width.
        """
        widths = 2 * self.half_widths
        rough = ~((widths > 0) & (widths < ROUGH_RATE))
        return self.first(int(np.append(rough, True).argmax()))

    def first(self, number: int) -> Self:
        """Only so many sizes."""
        return type(self)(
            self.sizes[:number],
            self.reached[:number],
            self.rates[:number],
            self.covariance[:number, :number],
            self.df,
        )


def continuation(groups: Sequence[np.ndarray]) -> Continuation:
    """Measure how many of the paths go on.

    Parameters
    ----------
    groups : sequence of (r, s) int64 ndarray
        A group for each number of points, the largest last, of triangulations with their counts of
        LEPP sizes 0, 1, ..., s - 1. The rates are those of the last group.

    Returns
    -------
    Continuation
        Of the sizes from 2 on that any path of the last group reaches.

    Raises
    ------
    NotEnough
        If no path of the last group takes a step.

    Notes
    -----
    A rate is a ratio of sums over independent triangulations (Cochran (1977), Sampling
    Techniques, section 6.3). The paths of one triangulation run through the same triangles: rates
    of neighbouring sizes are correlated, up to 0.8. Their covariance is that of the residuals
    (paths that go on, less the rate of the group times paths that reach the size) of the last
    group, if it has `ENOUGH` triangulations. Of fewer it cannot be estimated: then it is taken to
    be proportional to the number of paths in the triangulation, and pooled over all groups. In
    large meshes by plain insertion it is more than that.
    """
    last = _reached(groups[-1]).sum(axis=0)
    if len(groups[-1]) >= ENOUGH:
        groups = groups[-1:]
    sizes = np.flatnonzero(last[:-1] > 0)
    sizes = sizes[sizes >= SHORTEST]
    if not len(sizes):
        raise NotEnough("no path takes a step")
    products, df = np.zeros((len(sizes), len(sizes))), 0
    for counts in groups:
        residuals = _residuals(_reached(counts), sizes)
        products += residuals.T @ residuals
        df += len(residuals) - 1
    unit = products / df if df > 0 else np.full_like(products, np.nan)
    reached = last[sizes]
    return Continuation(
        sizes=sizes,
        reached=reached,
        rates=last[sizes + 1] / reached,
        covariance=unit * reached[0] / np.outer(reached, reached),
        df=df,
    )


def _reached(counts: np.ndarray) -> np.ndarray:
    """Count paths of at least k triangles: (r, s + 1), the last column zero."""
    reached = counts[:, ::-1].cumsum(axis=1)[:, ::-1]
    return np.pad(reached, ((0, 0), (0, 1)))


def _residuals(reached: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Find what the triangulations of one group have beyond the group's rates, a path."""
    kept = reached[reached[:, SHORTEST] > 0]
    wide = np.zeros((len(kept), sizes[-1] + 2), dtype=np.int64)
    wide[:, : kept.shape[1]] = kept[:, : wide.shape[1]]
    base, more = wide[:, sizes], wide[:, sizes + 1]
    total = base.sum(axis=0)
    rates = np.divide(more.sum(axis=0), total, out=np.zeros(len(sizes)), where=total > 0)
    return (more - rates * base) / np.sqrt(kept[:, [SHORTEST]])


@dataclass(frozen=True)
class LawFit:
    """A law of the rates, fitted by generalised least squares.

    Attributes
    ----------
    sizes : (s,) int64 ndarray
        Numbers of triangles whose rates it is fitted to.
    coefficients : (k,) float64 ndarray
    standard_errors : (k,) float64 ndarray
    curve : callable
        Takes sizes and returns the rates of the law.
    chi_squared : float
        Weighted sum of the squared residuals.
    f : float
        The sum in the scale of an F distribution, as the covariance is estimated.
    df, df_residual : int
        Its degrees of freedom: sizes less coefficients, and what the covariance has beyond those.
    log10_p : float
        Decimal logarithm of the chance of as large an F, if the law is true.
    """

    sizes: np.ndarray
    coefficients: np.ndarray
    standard_errors: np.ndarray
    curve: Curve
    chi_squared: float
    f: float
    df: int
    df_residual: int
    log10_p: float


def fit_constant(measured: Continuation) -> LawFit:
    """Fit one rate to all sizes that are known well.

    Raises
    ------
    NotEnough
        If the sizes do not suffice.
    """
    measured = _fitted(measured, 1)
    whiten = _whitening(measured)
    ones, rates = whiten(np.ones(len(measured.rates))), whiten(measured.rates)
    rate = float(ones @ rates / (ones @ ones))
    return _law_fit(
        measured,
        np.array([rate]),
        np.array([[1.0]]),
        ones[:, None],
        rates - rate * ones,
        lambda sizes: np.full(np.shape(sizes), rate),
    )


def fit_power(measured: Continuation) -> LawFit:
    """Fit c(k) = lambda / (k + b)^a to the sizes that are known well.

    The coefficients are lambda, b and a.

    Raises
    ------
    NotEnough
        If the sizes do not suffice, or the rates do not determine b.

    Notes
    -----
    Fitted are ln c(2), ln(2 + b) and a, which are far less correlated than the coefficients;
    their errors follow by the delta method.
    """
    measured = _fitted(measured, 3)
    whiten = _whitening(measured)
    best = _least_squares(lambda theta: whiten(measured.rates - _power(theta, measured.sizes)))
    log_first, log_base, exponent = best.x
    if best.active_mask.any() or np.linalg.matrix_rank(best.jac) < len(best.x):
        raise NotEnough("the rates do not determine the shift b of the law")
    base, scale = np.exp(log_base), np.exp(log_first + exponent * log_base)
    by_theta = [[scale, scale * exponent, scale * log_base], [0.0, base, 0.0], [0.0, 0.0, 1.0]]
    return _law_fit(
        measured,
        np.array([scale, base - SHORTEST, exponent]),
        np.array(by_theta),
        -best.jac,
        best.fun,
        lambda sizes: _power(best.x, np.asarray(sizes)),
    )


def _power(theta: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Rates of the law with ln c(2), ln(2 + b) and a."""
    log_first, log_base, exponent = theta
    return np.exp(log_first - exponent * np.log1p((sizes - SHORTEST) / np.exp(log_base)))


def _least_squares(residuals: Curve) -> optimize.OptimizeResult:
    """Fit the falling law from several starts, the shift held fast at first."""

    def fit_from(log_base: float) -> optimize.OptimizeResult:
        held = optimize.least_squares(
            lambda two: residuals(np.array([two[0], log_base, two[1]])), [-0.5, 0.5]
        )
        return optimize.least_squares(
            residuals,
            [held.x[0], log_base, held.x[1]],
            bounds=([-np.inf, _LEAST_SHIFT, -np.inf], [np.inf, _MOST_SHIFT, np.inf]),
            xtol=1e-12,
            ftol=1e-12,
            gtol=1e-12,
        )

    starts = np.linspace(_LEAST_SHIFT, _MOST_SHIFT, 5)[1:-1]
    return min(map(fit_from, starts), key=lambda fitted: fitted.cost)


def _fitted(measured: Continuation, coefficients: int) -> Continuation:
    """Only the sizes known well, and no more than a third of the degrees of freedom.

    The covariance of more is too rough to be inverted.
    """
    sure = measured.sure().first(measured.df // 3)
    if len(sure.sizes) <= coefficients:
        raise NotEnough(
            f"{coefficients + 1} or more sizes are needed whose rates are known to within "
            f"{ROUGH_RATE:g}, there are {len(sure.sizes)}"
        )
    return sure


def _whitening(measured: Continuation) -> Curve:
    """Map that makes the rates uncorrelated, each of variance 1."""
    errors = measured.standard_errors
    correlation = measured.covariance / np.outer(errors, errors)
    if np.linalg.eigvalsh(correlation)[0] < _SINGULAR:
        raise NotEnough("the triangulations do not differ enough for a covariance of the rates")
    root = np.linalg.cholesky(correlation)
    return lambda values: np.linalg.solve(root, values / errors)


def _law_fit(
    measured: Continuation,
    coefficients: np.ndarray,
    jacobian: np.ndarray,
    slopes: np.ndarray,
    residuals: np.ndarray,
    curve: Curve,
) -> LawFit:
    """Errors and goodness of fit.

    The covariance of the rates is itself estimated, with m degrees of freedom. With q more sizes
    than coefficients, chi-squared times (m - q + 1) / (m q) then has an F distribution with q and
    m - q + 1 degrees of freedom, and the variances of the coefficients are larger than with known
    covariance, by m (m - 1) / ((m - q) (m - q - 1)): C. R. Rao (1967), Least squares theory using
    an estimated dispersion matrix, Proc. Fifth Berkeley Symposium 1, 355-372.
    """
    m, q = measured.df, len(residuals) - slopes.shape[1]
    chi_squared = float(residuals @ residuals)
    f = chi_squared * (m - q + 1) / (m * q)
    inflation = m * (m - 1) / ((m - q) * (m - q - 1))
    covariance = jacobian @ np.linalg.inv(slopes.T @ slopes) @ jacobian.T * inflation
    return LawFit(
        sizes=measured.sizes,
        coefficients=coefficients,
        standard_errors=np.sqrt(np.diag(covariance)),
        curve=curve,
        chi_squared=chi_squared,
        f=f,
        df=q,
        df_residual=m - q + 1,
        log10_p=log10_f_tail(f, q, m - q + 1),
    )


def longest_expected(curve: Curve, paths: int) -> int | None:
    """Size of which a law lets one expect fewer than one longer path.

    Parameters
    ----------
    curve : callable
        Takes a size and returns the chance that a path of at least that size goes on.
    paths : int
        Number of paths that take a step.

    Returns
    -------
    int or None
        Smallest such size; None if the law has a chance of 1 or more before it is reached.

    Notes
    -----
    An expected number adds up whether or not the paths are independent. But long paths come
    together: those of all triangles that lead into one. So the longest path seen scatters more
    widely around this size than that of independent paths would.
    """
    size, longer = SHORTEST, float(paths)
    while True:
        chance = float(curve(np.array(size)))
        if not chance < 1:
            return None
        longer *= chance
        if longer < 1:
            return size
        size += 1
