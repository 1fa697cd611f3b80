"""The models of how the mean LEPP size y grows with the number of points.

x is in thousands of points, as the published regressions have it. Four models are linear in their
parameters, after y is transformed for one of them; the fifth is not.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import special

Function = Callable[[np.ndarray], np.ndarray]

#: Theorem 2's upper bound of the mean, the asymptote of the logistic model.
ASYMPTOTE = 4.0


def identity(y: np.ndarray) -> np.ndarray:
    """Return y itself."""
    return y


def logit(y: np.ndarray) -> np.ndarray:
    """ln(y / (4 - y)): what the logistic model takes to be linear in x."""
    return np.log(y / (ASYMPTOTE - y))


def logistic(z: np.ndarray) -> np.ndarray:
    """4 / (1 + exp(-z)), the inverse of `logit`."""
    return ASYMPTOTE * special.expit(z)


@dataclass(frozen=True)
class LinearModel:
    """A model transform(y) = basis(x) . coefficients.

    Attributes
    ----------
    name, formula : str
    terms : tuple of str
        Names of the coefficients.
    basis : callable
        Takes x, (n,) thousands of points, and returns the (n, k) matrix of the regression.
    transform, inverse : callable
        From y to the scale of the fit, and back.
    """

    name: str
    formula: str
    terms: tuple[str, ...]
    basis: Function
    transform: Function = identity
    inverse: Function = identity


LINEAR_MODELS = (
    LinearModel("linear", "a + b x", ("a", "b"), lambda x: np.column_stack([np.ones_like(x), x])),
    LinearModel(
        "quadratic",
        "a + b x + c x^2",
        ("a", "b", "c"),
        lambda x: np.column_stack([np.ones_like(x), x, x * x]),
    ),
    LinearModel(
        "logistic",
        "4 / (1 + exp(-a - b x))",
        ("a", "b"),
        lambda x: np.column_stack([np.ones_like(x), x]),
        logit,
        logistic,
    ),
    LinearModel(
        "logarithmic",
        "c + d log2(x)",
        ("c", "d"),
        lambda x: np.column_stack([np.ones_like(x), np.log2(x)]),
    ),
)
LOGARITHMIC = LINEAR_MODELS[-1]


@dataclass(frozen=True)
class SaturatingModel:
    """c - a x^(-b), which tends to c for b > 0."""

    name: str = "saturating"
    formula: str = "c - a x^(-b)"
    terms: tuple[str, ...] = ("c", "a", "b")

    def values(self, x: np.ndarray, c: float, a: float, b: float) -> np.ndarray:
        """Compute the mean LEPP size at x thousand points."""
        return c - a * x**-b

    def gradient(self, x: np.ndarray, c: float, a: float, b: float) -> np.ndarray:
        """Differentiate by c, a and b, (n, 3)."""
        power = x**-b
        return np.column_stack([np.ones_like(x), -power, a * power * np.log(x)])


SATURATING = SaturatingModel()
