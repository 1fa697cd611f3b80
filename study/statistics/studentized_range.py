"""The studentized range distribution, for many pairs with different degrees of freedom at once.

SciPy's integrates each value anew, seconds for the pairs of twenty groups and a minute and a half
for their intervals. Here the range of k normal values is tabulated once, for all pairs.
"""

from functools import cache

import numpy as np
from scipy import interpolate, special
from scipy.optimize import elementwise

#: Beyond this range of k standard normal values its tail is below 10^-95 for any sensible k.
_WIDEST = 30.0
_RANGES = np.linspace(0.0, _WIDEST, 601)
_N_NODES = 300
#: exp(-40) is below the resolution of the integral.
_DECAY = 40.0
_STEPS = 240


def studentized_range_tail(q: np.ndarray, k: int, df: np.ndarray) -> np.ndarray:
    """P(Q > q) of the studentized range of k values.

    Parameters
    ----------
    q : (m,) float64 ndarray
        Not negative.
    k : int
        Number of values that the range is taken of, at least 2.
    df : (m,) float64 ndarray
        Degrees of freedom of the standard deviation, at least 1.

    Returns
    -------
    (m,) float64 ndarray
        With an absolute error below 1e-8.
    """
    return _Tail(k)(q, df)


def studentized_range_critical(level: float, k: int, df: np.ndarray) -> np.ndarray:
    """Find q with P(Q > q) = level, (m,) float64; parameters as of `studentized_range_tail`."""
    tail = _Tail(k)
    found = elementwise.find_root(
        lambda q, df: tail(q, df) - level,
        (np.full(len(df), 1e-9), np.full(len(df), 1e9)),
        args=(df,),
    )
    return found.x


class _Tail:
    """P(Q > q) = E[P(range of k normal values > q s)], s the root of a scaled chi-squared."""

    def __init__(self, k: int) -> None:
        self._log_tail = interpolate.CubicSpline(_RANGES, np.log(_normal_range_tail(k)))

    def __call__(self, q: np.ndarray, df: np.ndarray) -> np.ndarray:
        # In u = log s the density falls off at both ends at least as fast as these limits assume,
        # and the trapezoidal rule converges exponentially.
        reach = np.sqrt(_DECAY / df)
        low, high = -_DECAY / df - 1.5 * reach, reach
        u = low + (high - low) * np.linspace(0, 1, _STEPS)[:, None]
        log_density = (
            np.log(2) + df / 2 * np.log(df / 2) - special.gammaln(df / 2)
            + df * (u - np.exp(2 * u) / 2)
        )  # fmt: skip
        ranges = np.minimum(q * np.exp(u), _WIDEST)
        values = np.exp(log_density + self._log_tail(ranges))
        return np.clip(np.trapezoid(values, u, axis=0), 0.0, 1.0)


@cache
def _quadrature() -> tuple[np.ndarray, np.ndarray]:
    # Of Gauss and Legendre, from a banded matrix: NumPy takes a full one, whose threads wait for
    # each other up to a second on a machine that is busy.
    return special.roots_legendre(_N_NODES)


def _normal_range_tail(k: int) -> np.ndarray:
    # 1 - k int phi(z) (Phi(z) - Phi(z - w))^(k-1) dz, without the cancellation of the difference.
    nodes, weights = _quadrature()
    z = -9 + (nodes + 1) * (9 + _WIDEST / 2 + 9) / 2
    weights = weights * (9 + _WIDEST / 2 + 9) / 2
    density = np.exp(-z * z / 2) / np.sqrt(2 * np.pi)
    inside = special.ndtr(z)
    outside = special.ndtr(z - _RANGES[:, None]) / inside
    with np.errstate(divide="ignore"):  # at w = 0 everything is outside
        missed = -np.expm1((k - 1) * np.log1p(-outside))
    tail = k * (weights * density * inside ** (k - 1) * missed).sum(axis=1)
    return np.minimum(tail, 1.0)
