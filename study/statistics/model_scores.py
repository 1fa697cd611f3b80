"""How models of growth fit the means of all sizes, and predict those of sizes not seen.

A model is fitted to some sizes. The others' means are predicted with errors that share those of the
coefficients. Their chi-squared with the full covariance of the prediction errors is what the least
weighted sum of squares rises by when the sizes are added to the fit: exactly so for a model that is
linear in its coefficients (Brown, Durbin and Evans 1975, of recursive residuals), and by likelihood
ratio for one that is not. Means count with the errors of `SizeMeans`, their pure error, so that
chi-squared over its degrees of freedom is referred to the F distribution.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy import special

from study.statistics.fitting import transformed, weighted_least_squares
from study.statistics.groups import NotEnough
from study.statistics.intervals import t_quantile
from study.statistics.models import LinearModel, Model
from study.statistics.power_family import PowerFamily, ProfileInterval
from study.statistics.size_means import SizeMeans
from study.statistics.tails import log10_f_tail


@dataclass(frozen=True)
class Score:
    """A chi-squared and what it is held against.

    Attributes
    ----------
    chi_squared : float
    df : int
        Its degrees of freedom.
    df_error : int
        Those of the pure error.
    """

    chi_squared: float
    df: int
    df_error: int

    @property
    def p(self) -> float:
        """Chance of as much or more, if the model is true."""
        return float(special.fdtrc(self.df, self.df_error, self.chi_squared / self.df))

    @property
    def log10_p(self) -> float:
        """Decimal logarithm of `p`."""
        return log10_f_tail(self.chi_squared / self.df, self.df, self.df_error)


@dataclass(frozen=True)
class Prediction:
    """One size as a model predicts it that has not seen it.

    Attributes
    ----------
    n_points : int
    mean, prediction : float
        Measured and predicted.
    standard_errors : float
        Measured less predicted in standard errors of that difference, the fit's and the mean's.
    """

    n_points: int
    mean: float
    prediction: float
    standard_errors: float


def least_squares(model: Model, seen: SizeMeans) -> float:
    """Least weighted sum of squares of a model, in squared standard errors.

    Notes
    -----
    Of a transform of y, errors are the transform's slope times those of y (delta method). The
    saturating model's exponent b may be 0, which is the logarithm.
    """
    if not isinstance(model, LinearModel):
        return PowerFamily(seen).best(*model.powers)[1]
    basis, z, weights = _regression(model, seen)
    return float(weights @ (z - basis @ weighted_least_squares(basis, z, weights)) ** 2)


def fitted_curve(model: Model, seen: SizeMeans) -> Callable[[float], float]:
    """Fit a model by weighted least squares.

    Returns
    -------
    callable
        Takes thousands of points and returns the mean LEPP size there.
    """
    if not isinstance(model, LinearModel):
        family = PowerFamily(seen)
        power = family.best(*model.powers)[0]
        return lambda x: family.at(power, x)
    coefficients = weighted_least_squares(*_regression(model, seen))
    return lambda x: float(model.inverse(model.basis(np.array([x])) @ coefficients)[0])


def coefficient_interval(model: LinearModel, seen: SizeMeans, place: int) -> ProfileInterval:
    """Coefficient of the weighted fit of a linear model, with its t interval.

    For a model that is linear in its coefficients it is the profile likelihood interval.
    """
    return _interval_along(model, seen, np.eye(len(model.terms))[place])


def value_interval(model: Model, seen: SizeMeans, x: float) -> ProfileInterval:
    """Mean LEPP size at x thousand points by the weighted fit, with its interval.

    The interval holds if the model is true. That of a power model is of all powers.
    """
    if not isinstance(model, LinearModel):
        return PowerFamily(seen).value(x)
    found = _interval_along(model, seen, model.basis(np.array([x]))[0])
    return ProfileInterval(
        *(
            float(model.inverse(np.array(value)))
            for value in (found.estimate, found.low, found.high)
        )
    )


def _interval_along(model: LinearModel, seen: SizeMeans, direction: np.ndarray) -> ProfileInterval:
    basis, z, weights = _regression(model, seen)
    root = np.sqrt(weights)
    # By QR: powers of x of very different size leave the normal equations no digits.
    q, r = np.linalg.qr(basis * root[:, None])
    along = np.linalg.solve(r.T, direction)
    estimate, half = float(along @ (q.T @ (z * root))), float(np.sqrt(along @ along))
    half *= t_quantile(seen.df)
    return ProfileInterval(estimate, estimate - half, estimate + half)


def lack_of_fit(model: Model, seen: SizeMeans) -> Score:
    """Deviations of the means from the model.

    Raises
    ------
    NotEnough
        If there are no more sizes than coefficients.
    """
    _need(model, seen)
    return Score(least_squares(model, seen), len(seen) - len(model.terms), seen.df)


def prediction_score(model: Model, means: SizeMeans, fitted: np.ndarray) -> Score:
    """Deviations of the sizes not fitted from what the fit to the others predicts.

    Parameters
    ----------
    model : Model
    means : SizeMeans
    fitted : (g,) bool ndarray
        Which of the sizes the model is fitted to.

    Raises
    ------
    NotEnough
        If there are no more sizes to fit than coefficients, or none left.
    """
    seen, unseen = means.where(fitted), int((~fitted).sum())
    _need(model, seen)
    if not unseen:
        raise NotEnough("no size is left to be predicted")
    rise = least_squares(model, means) - least_squares(model, seen)
    return Score(max(rise, 0.0), unseen, means.df)


def predictions(model: Model, means: SizeMeans, fitted: np.ndarray) -> Iterator[Prediction]:
    """Predict each size not fitted from those that are. Parameters as of `prediction_score`."""
    seen = means.where(fitted)
    _need(model, seen)
    before, curve = least_squares(model, seen), fitted_curve(model, seen)
    for place in np.flatnonzero(~fitted):
        with_it = means.where(fitted | (np.arange(len(means)) == place))
        rise = max(least_squares(model, with_it) - before, 0.0)
        predicted = curve(means.x[place])
        mean = float(means.means[place])
        yield Prediction(
            int(means.n_points[place]),
            mean,
            predicted,
            float(np.copysign(np.sqrt(rise), mean - predicted)),
        )


def sizes_to_fit(n_points: np.ndarray, up_to: int, least: int) -> np.ndarray:
    """Which sizes models are fitted to: those up to a number of points.

    Where none is beyond it, or fewer than `least` are not, all but the largest quarter, or but the
    largest one if else there are fewer than `least`.

    Parameters
    ----------
    n_points : (g,) int64 ndarray
        Ascending.
    up_to, least : int

    Returns
    -------
    (g,) bool ndarray
    """
    fitted = n_points <= up_to
    if fitted.all() or fitted.sum() < least:
        unseen = max(min(-(-len(n_points) // 4), len(n_points) - least), 1)
        fitted = np.arange(len(n_points)) < len(n_points) - unseen
    return fitted


def _regression(model: LinearModel, seen: SizeMeans) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    z = transformed(model, seen.means)
    step = seen.standard_errors / 100
    slope = (model.transform(seen.means + step) - model.transform(seen.means - step)) / (2 * step)
    return model.basis(seen.x), z, 1 / (slope**2 * seen.variances)


def _need(model: Model, seen: SizeMeans) -> None:
    least = len(model.terms) + 1
    if len(seen) < least:
        raise NotEnough(f"the {model.name} model needs {least} sizes, not {len(seen)}")
