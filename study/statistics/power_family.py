"""Growth like a power of x, with the logarithm and limits in one family, by profile likelihood.

y = m + s (x^lambda - 1) / lambda (Box and Cox 1964, of x): with lambda below 0 it tends to a limit,
at 0 it is the logarithm, above 0 it grows faster. The saturating model c - a x^(-b) is the part
with lambda = -b < 0, and becomes a logarithm at its end b -> 0: whether it has a limit at all is
what the data leave open, so that no interval may be had from a slope at the best fit (Wald).

An interval is all values that raise the weighted sum of squares above its least by no more than
the F distribution allows, with 1 and the pure error's degrees of freedom (Venzon and Moolgavkar
1988). For a given lambda the family is a straight line, and the interval of a value exact.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import optimize

from study.statistics.groups import NotEnough
from study.statistics.intervals import t_quantile
from study.statistics.size_means import SizeMeans

#: Powers that are looked at. At the lower end y is constant beyond the first size.
_LEAST, _MOST = -10.0, 2.0
_GRID = np.linspace(_LEAST, _MOST, 2401).round(9)


@dataclass(frozen=True)
class ProfileInterval:
    """An estimate and its ends; an infinite end says that the data set none."""

    estimate: float
    low: float
    high: float

    @property
    def bounded(self) -> bool:
        """Whether it has both ends."""
        return bool(np.isfinite([self.low, self.high]).all())


@dataclass(frozen=True)
class _Lines:
    """Straight lines through the means over a transformed x, one for each power.

    The line is center + slope * (value - middle), value being the transform of x.
    """

    center: float
    middle: np.ndarray
    slope: np.ndarray
    spread: np.ndarray
    squares: np.ndarray
    weight: float


@dataclass(frozen=True)
class PowerFamily:
    """The family fitted to means by size.

    Attributes
    ----------
    seen : SizeMeans
        Of three sizes or more.

    Raises
    ------
    NotEnough
        For fewer sizes.
    """

    seen: SizeMeans

    def __post_init__(self) -> None:
        if len(self.seen) < 3:
            raise NotEnough(f"the power of growth needs 3 sizes, not {len(self.seen)}")

    def squares(self, power: float) -> float:
        """Weighted sum of squares of the residuals, in squared standard errors."""
        return float(self._lines(np.array([power])).squares[0])

    def best(self, least: float = _LEAST, most: float = _MOST) -> tuple[float, float]:
        """Find the power, between bounds, of the least weighted sum of squares.

        Returns
        -------
        power, squares : float
        """
        return _least(lambda at: self._lines(at).squares, _GRID[(least <= _GRID) & (most >= _GRID)])

    @cached_property
    def power(self) -> ProfileInterval:
        """The power lambda; its ends are infinite beyond the powers that are looked at."""
        powers = self._powers
        inside = np.flatnonzero(self._lines(powers).squares <= self._ceiling)
        first, last = inside[0], inside[-1]

        def crossing(a: float, b: float) -> float:
            return float(optimize.brentq(lambda at: self.squares(at) - self._ceiling, a, b))

        low = crossing(powers[first - 1], powers[first]) if first > 0 else -np.inf
        high = crossing(powers[last], powers[last + 1]) if last < len(powers) - 1 else np.inf
        return ProfileInterval(self._best[0], low, high)

    def value(self, x: float) -> ProfileInterval:
        """Mean at x thousand points; at x = inf the limit, of the powers below 0.

        Raises
        ------
        NotEnough
            At infinity, if the best power is not below 0.
        """
        powers, best = self._powers, self._best[0]
        if np.isinf(x):
            if best >= 0:
                raise NotEnough("the means show no saturation: they grow like a logarithm or more")
            powers = powers[powers < 0]
        low = _least(lambda at: self._end(at, x, -1), powers)[1]
        high = -_least(lambda at: -self._end(at, x, 1), powers)[1]
        if np.isinf(x):
            low, high = self._opened(low, high)
        return ProfileInterval(float(self._end(np.array([best]), x, 0)[0]), low, high)

    def at(self, power: float, x: float) -> float:
        """Mean at x thousand points by the line of a given power."""
        return float(self._end(np.array([power]), x, 0)[0])

    @cached_property
    def _best(self) -> tuple[float, float]:
        return self.best()

    @cached_property
    def _powers(self) -> np.ndarray:
        return np.union1d(_GRID, [self._best[0]])

    @cached_property
    def _ceiling(self) -> float:
        return self._best[1] + t_quantile(self.seen.df) ** 2

    @cached_property
    def _log_scale(self) -> float:
        return float(np.average(np.log(self.seen.x), weights=1 / self.seen.variances))

    def _transformed(self, powers: np.ndarray, x: np.ndarray) -> np.ndarray:
        # (powers, x) float64; of x over its geometric mean, so that a power of 0 is no pole.
        log_x = np.log(x) - self._log_scale
        at = np.where(powers == 0, 1.0, powers)[:, None]
        return np.where(powers[:, None] == 0, log_x, np.expm1(at * log_x) / at)

    def _lines(self, powers: np.ndarray) -> _Lines:
        seen, w = self.seen, 1 / self.seen.variances
        center = float(np.average(seen.means, weights=w))
        values = self._transformed(powers, seen.x)
        middle = values @ w / w.sum()
        values = values - middle[:, None]
        off = seen.means - center
        spread = values**2 @ w
        slope = values @ (w * off) / spread
        residuals = off - slope[:, None] * values
        return _Lines(center, middle, slope, spread, residuals**2 @ w, float(w.sum()))

    def _end(self, powers: np.ndarray, x: float, side: int) -> np.ndarray:
        # The value at x for given powers, or an end of its interval (side -1 or 1); NaN for a power
        # that is outside its own. The rise that the power has used up is not left for the line.
        lines = self._lines(powers)
        to = -1 / powers if np.isinf(x) else self._transformed(powers, np.array([x]))[:, 0]
        distance = to - lines.middle
        value = lines.center + lines.slope * distance
        if not side:
            return value
        left = self._ceiling - lines.squares
        variance = 1 / lines.weight + distance**2 / lines.spread
        return value + side * np.sqrt(np.where(left >= 0, left, np.nan) * variance)

    def _opened(self, low: float, high: float) -> tuple[float, float]:
        # Powers that tend to 0 take the limit away without bound, if they are not excluded.
        lines = self._lines(np.array([0.0]))
        left = self._ceiling - lines.squares[0]
        if left < 0:
            return low, high
        half = np.sqrt(left / lines.spread[0])
        return (
            -np.inf if lines.slope[0] - half < 0 else low,
            np.inf if lines.slope[0] + half > 0 else high,
        )


def _least(cost: Callable[[np.ndarray], np.ndarray], powers: np.ndarray) -> tuple[float, float]:
    """Find where a cost is least, and how much that is: on a grid, then between its neighbours."""
    costs = cost(powers)
    place, worst = int(np.nanargmin(costs)), np.nanmax(costs)
    within = optimize.minimize_scalar(
        lambda at: np.nan_to_num(cost(np.array([at]))[0], nan=worst),
        bounds=(powers[max(place - 1, 0)], powers[min(place + 1, len(powers) - 1)]),
        method="bounded",
        options={"xatol": 1e-10},
    )
    if within.fun < costs[place]:
        return float(within.x), float(within.fun)
    return float(powers[place]), float(costs[place])
