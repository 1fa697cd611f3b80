"""The models of how the mean LEPP size y depends on the number of points.

x is in thousands of points, as the published regressions have it. All but one are linear in their
parameters, after y is transformed for one of them. Some have a limit for x -> infinity, which is
their first coefficient; some have none. The logistic model's asymptote is supposed, not estimated,
and a parabola turns round: these two say nothing of a limit.
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
    has_limit : bool or None
        Whether y tends to the first coefficient, or away without bound; None where the model says
        nothing of it.
    contains : tuple of str
        Names of the models that are this one with some coefficients fixed.
    """

    name: str
    formula: str
    terms: tuple[str, ...]
    basis: Function
    transform: Function = identity
    inverse: Function = identity
    has_limit: bool | None = None
    contains: tuple[str, ...] = ("constant",)


LINEAR_MODELS = (
    LinearModel(
        "linear",
        "a + b x",
        ("a", "b"),
        lambda x: np.column_stack([np.ones_like(x), x]),
        has_limit=False,
    ),
    LinearModel(
        "quadratic",
        "a + b x + c x^2",
        ("a", "b", "c"),
        lambda x: np.column_stack([np.ones_like(x), x, x * x]),
        contains=("constant", "linear"),
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
        "c + d log₂(x)",
        ("c", "d"),
        lambda x: np.column_stack([np.ones_like(x), np.log2(x)]),
        has_limit=False,
    ),
)
LINEAR, QUADRATIC, LOGISTIC, LOGARITHMIC = LINEAR_MODELS

CONSTANT = LinearModel(
    "constant", "c", ("c",), lambda x: np.ones((len(x), 1)), has_limit=True, contains=()
)
#: Slower than every power of the logarithm, and yet without limit.
DOUBLY_LOGARITHMIC = LinearModel(
    "doubly logarithmic",
    "c + d ln(ln(1000 x))",
    ("c", "d"),
    lambda x: np.column_stack([np.ones_like(x), np.log(np.log(1000 * x))]),
    has_limit=False,
)
#: About n^(1/2) of n points in a region lie near its edge.
EDGE = LinearModel(
    "edge",
    "c + b x^(-1/2)",
    ("c", "b"),
    lambda x: np.column_stack([np.ones_like(x), x**-0.5]),
    has_limit=True,
)
#: An edge whose depth grows with the logarithm of n.
THICKENING_EDGE = LinearModel(
    "thickening edge",
    "c + (b + d ln(x)) x^(-1/2)",
    ("c", "b", "d"),
    lambda x: np.column_stack([np.ones_like(x), x**-0.5, np.log(x) * x**-0.5]),
    has_limit=True,
    contains=("constant", "edge"),
)
EDGE_MODELS = (EDGE, THICKENING_EDGE)


@dataclass(frozen=True)
class SaturatingModel:
    """c - a x^(-b), which tends to c for b > 0."""

    name: str = "saturating"
    formula: str = "c - a x^(-b)"
    terms: tuple[str, ...] = ("c", "a", "b")
    has_limit: bool = True
    contains: tuple[str, ...] = ("constant", "logarithmic", "edge")
    #: Of x; its end 0 is the logarithm.
    powers: tuple[float, float] = (-np.inf, 0.0)

    def values(self, x: np.ndarray, c: float, a: float, b: float) -> np.ndarray:
        """Compute the mean LEPP size at x thousand points."""
        return c - a * x**-b

    def gradient(self, x: np.ndarray, c: float, a: float, b: float) -> np.ndarray:
        """Differentiate by c, a and b, (n, 3)."""
        power = x**-b
        return np.column_stack([np.ones_like(x), -power, a * power * np.log(x)])


SATURATING = SaturatingModel()


@dataclass(frozen=True)
class GrowingModel:
    """c + a x^b with b >= 0: the logarithm at its end, and all powers that grow faster."""

    name: str = "growing power"
    formula: str = "c + a x^b"
    terms: tuple[str, ...] = ("c", "a", "b")
    has_limit: bool = False
    contains: tuple[str, ...] = ("constant", "linear", "logarithmic")
    powers: tuple[float, float] = (0.0, np.inf)


GROWING = GrowingModel()

Model = LinearModel | SaturatingModel | GrowingModel
#: All that are fitted with weights and held against one another.
MODELS: tuple[Model, ...] = (
    CONSTANT,
    *LINEAR_MODELS,
    DOUBLY_LOGARITHMIC,
    GROWING,
    *EDGE_MODELS,
    SATURATING,
)
