"""Least squares fits of the growth models, plain and weighted by the groups' variances."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import optimize, stats

from study.statistics.groups import Groups, NotEnough
from study.statistics.intervals import t_quantile
from study.statistics.models import ASYMPTOTE, SATURATING, LinearModel, SaturatingModel, logit
from study.statistics.tails import log10_f_tail
from study.statistics.variance_function import smooth_variances

#: Exponents b of the saturating model that are looked at. At the lower end c - a x^(-b) is a
#: logarithm, at the upper a constant beyond the first group.
_LEAST_B, _MOST_B = 1e-3, 10.0

#: Fits z at x with weights, and predicts y at one more x.
Predictor = Callable[[np.ndarray, np.ndarray, np.ndarray, np.ndarray], float]


@dataclass(frozen=True)
class Observations:
    """What a model is fitted to.

    Attributes
    ----------
    x : (n,) float64 ndarray
        Thousands of points of each triangulation.
    y : (n,) float64 ndarray
        Its mean LEPP size.
    group : (n,) integer ndarray
        Index of its size.
    weighted : bool
        Whether each is weighted by the reciprocal variance of its group, a smooth function of
        its size.
    """

    x: np.ndarray
    y: np.ndarray
    group: np.ndarray
    weighted: bool

    @classmethod
    def of(cls, groups: Groups, weighted: bool) -> "Observations":
        """All triangulations of the groups; weights need a group that has a variance."""
        if not len(groups.repeated() if weighted else groups):
            raise NotEnough("no size has two or more differing triangulations")
        group = np.repeat(np.arange(len(groups)), groups.counts)
        return cls(groups.n_points[group] / 1000, np.concatenate(groups.values), group, weighted)

    def weights(self, y: np.ndarray) -> np.ndarray:
        """Weight of each observation for a fit to `y`, (n,) float64."""
        if not self.weighted:
            return np.ones(len(y))
        return 1 / smooth_variances(self.groups(y))[self.group]

    def groups(self, y: np.ndarray) -> Groups:
        """Part `y` by size."""
        sizes = (1000 * self.group_means(self.x)).round().astype(np.int64)
        return Groups(sizes, tuple(y[self.group == k] for k in range(len(sizes))))

    def group_means(self, y: np.ndarray) -> np.ndarray:
        """Mean of `y` in each group, (g,) float64."""
        return np.bincount(self.group, y) / np.bincount(self.group)


@dataclass(frozen=True)
class Fit:
    """A fitted model.

    Attributes
    ----------
    model : LinearModel or SaturatingModel
    observations : Observations
    coefficients : (k,) float64 ndarray
    covariance : (k, k) float64 ndarray
        Of the coefficients.
    """

    model: LinearModel | SaturatingModel
    observations: Observations
    coefficients: np.ndarray
    covariance: np.ndarray

    @property
    def df_residual(self) -> int:
        """Observations less coefficients."""
        return len(self.observations.y) - len(self.coefficients)

    @property
    def standard_errors(self) -> np.ndarray:
        """Of the coefficients, (k,) float64."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def intervals(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper ends of the coefficients' t intervals, (k,) float64 each."""
        half = t_quantile(self.df_residual) * self.standard_errors
        return self.coefficients - half, self.coefficients + half

    def predict(self, x: np.ndarray) -> np.ndarray:
        """Mean LEPP size at x thousand points."""
        if isinstance(self.model, SaturatingModel):
            return self.model.values(x, *self.coefficients)
        return self.model.inverse(self.model.basis(x) @ self.coefficients)

    def predict_interval(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Interval of the mean LEPP size at x thousand points, if the model is true.

        For the saturating model by the delta method.
        """
        if isinstance(self.model, SaturatingModel):
            slopes, inverse = self.model.gradient(x, *self.coefficients), None
            center = self.predict(x)
        else:
            slopes, inverse = self.model.basis(x), self.model.inverse
            center = slopes @ self.coefficients
        half = t_quantile(self.df_residual) * np.sqrt(
            np.einsum("ij,jk,ik->i", slopes, self.covariance, slopes)
        )
        low, high = center - half, center + half
        return (inverse(low), inverse(high)) if inverse else (low, high)

    def quality(self) -> dict[str, float]:
        """How well the model fits: adjusted R squared, F test, lack of fit, AIC, BIC."""
        seen = self.observations
        transform = getattr(self.model, "transform", lambda y: y)
        z, fitted = transform(seen.y), transform(self.predict(seen.x))
        w = seen.weights(z)
        n, k = len(z), len(self.coefficients)
        residual = float(w @ (z - fitted) ** 2)
        total = float(w @ (z - np.average(z, weights=w)) ** 2)
        f = max(total - residual, 0.0) / (k - 1) / (residual / (n - k))
        return {
            "adj_r2": 1 - residual / (n - k) / (total / (n - 1)),
            "f": f,
            "df_model": k - 1,
            "df_residual": n - k,
            "p": float(stats.f.sf(f, k - 1, n - k)),
            "log10_p": log10_f_tail(f, k - 1, n - k),
            **_lack_of_fit(seen, z, w, residual, k),
            **self._information(),
        }

    def _information(self) -> dict[str, float]:
        # The Gaussian likelihood of y itself, also for a model fitted to a transform of it, so
        # that all models are compared on one scale. Weights count as known variances; without
        # them the variance is one more parameter.
        seen = self.observations
        w = seen.weights(seen.y)
        squares = (seen.y - self.predict(seen.x)) ** 2
        n, parameters = len(seen.y), len(self.coefficients)
        if seen.weighted:
            log_likelihood = (np.log(w / (2 * np.pi)).sum() - w @ squares) / 2
        else:
            log_likelihood = -n / 2 * (np.log(2 * np.pi * squares.mean()) + 1)
            parameters += 1
        return {
            "aic": float(2 * parameters - 2 * log_likelihood),
            "bic": float(np.log(n) * parameters - 2 * log_likelihood),
            "rmse": float(np.sqrt(squares.mean())),
        }


def _lack_of_fit(
    seen: Observations, z: np.ndarray, w: np.ndarray, residual: float, k: int
) -> dict[str, float]:
    # Residuals of the model against the spread inside the groups, which no model of n explains.
    g, n = int(seen.group[-1]) + 1, len(z)
    pure = float(w @ (z - seen.group_means(z)[seen.group]) ** 2)
    if g <= k or n <= g or pure <= 0:
        return {}
    f = (residual - pure) / (g - k) / (pure / (n - g))
    return {"lack_of_fit_f": f, "lack_of_fit_p": float(stats.f.sf(f, g - k, n - g))}


def fit_linear(model: LinearModel, seen: Observations) -> Fit:
    """Fit a model that is linear in its coefficients, by statsmodels' least squares."""
    from statsmodels.regression.linear_model import WLS

    _need(model, seen)
    z = transformed(model, seen.y)
    found = WLS(z, model.basis(seen.x), weights=seen.weights(z)).fit()
    return Fit(model, seen, np.asarray(found.params), np.asarray(found.cov_params()))


def fit_saturating(model: SaturatingModel, seen: Observations) -> Fit:
    """Fit c - a x^(-b) by nonlinear least squares.

    Raises
    ------
    NotEnough
        Also where the best b is at an end of what is looked at, so that there is no limit c.

    Notes
    -----
    For a given b, c and a are a linear fit, so only b is searched for. The covariance is that of
    the model linearised at the solution.
    """
    _need(model, seen)
    w = seen.weights(seen.y)
    b = _best_exponent(*_grouped(seen, seen.y))
    basis = np.column_stack([np.ones_like(seen.x), -(seen.x**-b)])
    c, a = weighted_least_squares(basis, seen.y, w)
    coefficients = np.array([c, a, b])
    slopes = model.gradient(seen.x, c, a, b)
    residuals = seen.y - model.values(seen.x, c, a, b)
    variance = (w @ residuals**2) / (len(seen.y) - 3)
    information = slopes.T @ (slopes * w[:, None])
    return Fit(model, seen, coefficients, variance * np.linalg.inv(information))


def leave_one_group_out(model: LinearModel | SaturatingModel, seen: Observations) -> float:
    """Root mean square error of the means of groups predicted from all other groups.

    Raises
    ------
    NotEnough
        Where the other groups are too few for the model, or show no limit to the saturating one.

    Notes
    -----
    x is the same in a group, so that a least squares fit depends on the groups' means only.
    """
    x, y, weights = _grouped(seen, seen.y)
    if len(x) <= len(model.terms):
        raise NotEnough(f"leaving a size out needs {len(model.terms) + 1} sizes, not {len(x)}")
    predict: Predictor
    if isinstance(model, LinearModel):
        predict = _linear_predictor(model)
        x, z, weights = _grouped(seen, transformed(model, seen.y))
    else:
        predict, z = _predict_saturating, y
    errors = []
    for left_out in range(len(x)):
        others = np.arange(len(x)) != left_out
        at = x[left_out : left_out + 1]
        errors.append(predict(x[others], z[others], weights[others], at) - y[left_out])
    return float(np.sqrt(np.mean(np.square(errors))))


def _linear_predictor(model: LinearModel) -> Predictor:
    def predict(x: np.ndarray, z: np.ndarray, w: np.ndarray, at: np.ndarray) -> float:
        found = weighted_least_squares(model.basis(x), z, w)
        return float(model.inverse(model.basis(at) @ found)[0])

    return predict


def _predict_saturating(x: np.ndarray, z: np.ndarray, w: np.ndarray, at: np.ndarray) -> float:
    b = _best_exponent(x, z, w)
    c, a = weighted_least_squares(np.column_stack([np.ones_like(x), -(x**-b)]), z, w)
    return float(SATURATING.values(at, c, a, b)[0])


def _best_exponent(x: np.ndarray, y: np.ndarray, w: np.ndarray) -> float:
    def squares(b: float) -> float:
        basis = np.column_stack([np.ones_like(x), -(x**-b)])
        return float(w @ (y - basis @ weighted_least_squares(basis, y, w)) ** 2)

    found = optimize.minimize_scalar(
        lambda log_b: squares(np.exp(log_b)),
        bounds=(np.log(_LEAST_B), np.log(_MOST_B)),
        method="bounded",
        options={"xatol": 1e-9},
    )
    b = float(np.exp(found.x))
    if not 2 * _LEAST_B < b < _MOST_B / 2:
        raise NotEnough("the means show no saturation: the best b is at an end of its range")
    return b


def weighted_least_squares(basis: np.ndarray, y: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Coefficients of the columns of a basis that fit y best with weights w."""
    root = np.sqrt(w)
    return np.linalg.lstsq(basis * root[:, None], y * root, rcond=None)[0]


def _grouped(seen: Observations, z: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return (
        seen.group_means(seen.x),
        seen.group_means(z),
        np.bincount(seen.group, seen.weights(z)),
    )


def transformed(model: LinearModel, y: np.ndarray) -> np.ndarray:
    """Means on the scale of a model's fit; NotEnough where the logistic one has none."""
    if model.transform is logit and not (y < ASYMPTOTE).all():
        raise NotEnough(f"a mean LEPP size of {ASYMPTOTE:g} or more has no logistic model")
    return model.transform(y)


def _need(model: LinearModel | SaturatingModel, seen: Observations) -> None:
    k = len(model.terms)
    sizes = int(seen.group[-1]) + 1
    if sizes < k:
        raise NotEnough(f"the {model.name} model needs {k} sizes, not {sizes}")
    if len(seen.y) <= k:
        raise NotEnough(f"the {model.name} model needs {k + 1} triangulations, not {len(seen.y)}")
    if not np.ptp(seen.y):
        raise NotEnough("all mean LEPP sizes are equal")
