"""What group means and standard deviations that are rounded leave open of statistics made of them.

A printed number stands for the interval of all that rounds to it; the means and standard deviations
of all groups stand for a box. Two ranges of a statistic over the box are given. The *bounds* are
proven: nothing in the box lies beyond them. The *attained* range is inside: made-up data sets that
round to what is printed reach its ends. The truth is between the two.

The bounds are those of real arithmetic; they are evaluated in doubles, whose rounding is some
10^-12 of them, and widened by 10^-9.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from scipy import optimize

from study.statistics.models import LinearModel, logit

_WIDENED = 1e-9
_STEPS = 4
#: A ratio of sums of squares without a bound: the box has means that the model explains fully.
_MOST = 1e12

Range = tuple[float, float]
Statistic = Callable[[np.ndarray, np.ndarray], float]
"""Takes the groups' means and standard deviations, (k,) float64 each."""


@dataclass(frozen=True)
class RoundedGroups:
    """Groups of equal counts, of which means and standard deviations are printed.

    Attributes
    ----------
    x : (k,) float64 ndarray
        Where each group stands: thousands of points.
    means, sds : (k,) float64 ndarray
        As printed; `sds` with the divisor ``count - 1``.
    mean_half, sd_half : float
        Half a unit of the last printed digit.
    count : int
        Values of each group, an even number.
    """

    x: np.ndarray
    means: np.ndarray
    sds: np.ndarray
    mean_half: float
    sd_half: float
    count: int

    @property
    def total(self) -> int:
        """Number of values in all groups."""
        return self.count * len(self.x)

    def attained(self, statistic: Statistic) -> Range:
        """Find values that a statistic takes in the box, as far apart as its corners give.

        Each step goes to the corner to which the slope points.
        """
        printed = np.concatenate([self.means, self.sds])
        k = len(self.means)
        half = np.repeat([self.mean_half, self.sd_half], k)

        def value(at: np.ndarray) -> float:
            return statistic(at[:k], at[k:])

        ends = []
        for side in (-1, 1):
            at, best = printed, value(printed)
            for _ in range(_STEPS):
                slopes = [value(at + h) - value(at - h) for h in np.diag(half / 8)]
                corner = printed + side * np.sign(slopes) * half
                if side * (value(corner) - best) <= 0:
                    break
                at, best = corner, value(corner)
            ends.append(best)
        return ends[0], ends[1]

    def t_statistic(self, group: int, bound: float) -> Callable[[np.ndarray, np.ndarray], float]:
        """Make the t statistic of one group's mean against a bound."""
        return lambda means, sds: (means[group] - bound) / sds[group] * np.sqrt(self.count)

    def t_range(self, group: int, bound: float) -> Range:
        """Bound t of one group's mean against a bound: exact, at corners, of which it takes all."""
        t = [
            (self.means[group] + i * self.mean_half - bound)
            / (self.sds[group] + j * self.sd_half)
            * np.sqrt(self.count)
            for i, j in product((-1, 1), repeat=2)
        ]
        return float(min(t)), float(max(t))


@dataclass(frozen=True)
class Transformed:
    """What the box leaves open of a transform of the values.

    Attributes
    ----------
    center, half : (k,) float64 ndarray
        The groups' means of the transform lie within `half` of `center`.
    within : tuple of float
        Bounds of its sum of squared deviations from the groups' means, all groups together.
    """

    center: np.ndarray
    half: np.ndarray
    within: Range


def untransformed(groups: RoundedGroups) -> Transformed:
    """Give the box itself."""
    squares = [
        float((groups.count - 1) * ((groups.sds + side * groups.sd_half) ** 2).sum())
        for side in (-1, 1)
    ]
    half = np.full(len(groups.means), groups.mean_half)
    return Transformed(groups.means, half, (squares[0], squares[1]))


def by_logit(groups: RoundedGroups) -> Transformed:
    """Bound the logit g(y) = log(y / (4 - y)), which mean and standard deviation do not fix.

    Notes
    -----
    No value lies further from the mean than d = s (n - 1) / sqrt(n) (Samuelson 1968). There, for
    2 < y < 4, g' and g'' are positive and grow, so that the mean of g is g(m) + v g'' / 2 with
    v = s^2 (n - 1) / n and some g'' of the interval (Taylor), and its sum of squares is that of y
    times some g'^2 of the interval (mean value theorem).
    """
    n = groups.count
    m_low, m_high = groups.means - groups.mean_half, groups.means + groups.mean_half
    s_low, s_high = groups.sds - groups.sd_half, groups.sds + groups.sd_half
    furthest = s_high * (n - 1) / np.sqrt(n)
    y_low, y_high = m_low - furthest, m_high + furthest
    if not (np.all(y_low > 2) and np.all(y_high < 4)):
        raise ValueError("the bounds of the logit hold for values between 2 and 4 only")
    low = logit(m_low) + _curvature(y_low) * s_low**2 * (n - 1) / n / 2
    high = logit(m_high) + _curvature(y_high) * s_high**2 * (n - 1) / n / 2
    within = (
        float((_slope(y_low) ** 2 * (n - 1) * s_low**2).sum()),
        float((_slope(y_high) ** 2 * (n - 1) * s_high**2).sum()),
    )
    return Transformed((low + high) / 2, (high - low) / 2, within)


def _slope(y: np.ndarray) -> np.ndarray:
    return 1 / y + 1 / (4 - y)


def _curvature(y: np.ndarray) -> np.ndarray:
    return -1 / y**2 + 1 / (4 - y) ** 2


@dataclass(frozen=True)
class RoundedRegression:
    """A linear model fitted to all values of rounded groups.

    Attributes
    ----------
    groups : RoundedGroups
    model : LinearModel or None
        None is the one-way analysis of variance: every group has a mean of its own.
    """

    groups: RoundedGroups
    model: LinearModel | None = None

    @cached_property
    def _basis(self) -> np.ndarray:
        return np.eye(len(self.groups.x)) if self.model is None else self.model.basis(self.groups.x)

    @property
    def df(self) -> tuple[int, int]:
        """Degrees of freedom of the F test, of the model and of the residuals."""
        terms = self._basis.shape[1]
        return terms - 1, self.groups.total - terms

    @cached_property
    def _transformed(self) -> Transformed:
        uses_logit = self.model is not None and self.model.transform is logit
        return by_logit(self.groups) if uses_logit else untransformed(self.groups)

    @cached_property
    def _explained_and_left(self) -> tuple[np.ndarray, np.ndarray]:
        """Make the quadratic forms of the group means: of the model, and of what it leaves."""
        k = len(self.groups.x)
        hat = self._basis @ np.linalg.pinv(self._basis)
        mean = np.full((k, k), 1 / k)
        return hat - mean, np.eye(k) - hat

    def _data(self, means: np.ndarray, sds: np.ndarray) -> tuple[np.ndarray, float]:
        """Means and sum of squares inside the groups, of groups with two different values each."""
        n = self.groups.count
        half = sds * np.sqrt((n - 1) / n)
        transform = (lambda y: y) if self.model is None else self.model.transform
        above, below = transform(means + half), transform(means - half)
        return (above + below) / 2, float(n * ((above - below) ** 2).sum() / 4)

    def coefficient(self, term: int) -> Statistic:
        """Make a coefficient of the model, as a statistic of means and standard deviations."""
        weights = np.linalg.pinv(self._basis)[term]
        return lambda means, sds: float(weights @ self._data(means, sds)[0])

    def coefficient_range(self, term: int) -> Range:
        """Bound a coefficient, which is a linear form of the groups' means."""
        weights, seen = np.linalg.pinv(self._basis)[term], self._transformed
        middle, half = float(weights @ seen.center), float(np.abs(weights) @ seen.half)
        return _wide(middle - half, middle + half)

    def f(self, means: np.ndarray, sds: np.ndarray) -> float:
        """F statistic of the model, of means and standard deviations (k,) float64."""
        df1, df2 = self.df
        explained, left = self._explained_and_left
        z, within = self._data(means, sds)
        n = self.groups.count
        return float(n * (z @ explained @ z) / df1 / ((n * (z @ left @ z) + within) / df2))

    def f_range(self) -> Range:
        """Bound the F statistic of the model.

        Notes
        -----
        With the means z = c + e, |e| <= h, the sum of squares W inside the groups, and the forms P
        of the model and R of what it leaves, F >= t if and only if
        n z'(P - uR)z - uW >= 0, where u = t df1 / df2. The linear part 2 e'(P - uR)c is at most
        2 h'|(P - uR)c|; e'Pe and e'Re are between 0 and h'h, as P and R are projections. So
        the left side has an upper bound in u; wherever that is negative, F < t. The lower bound of
        F is found in the same way.
        """
        df1, df2 = self.df
        explained, left = self._explained_and_left
        seen, n = self._transformed, self.groups.count
        c, h = seen.center, seen.half

        def bound(u: float, side: int) -> float:
            form = explained - u * left
            square = (1 if side > 0 else u) * (h @ h)
            linear = 2 * (h @ np.abs(form @ c))
            within = seen.within[0 if side > 0 else 1]
            return float(n * (c @ form @ c + side * (linear + square)) - u * within)

        middle = float(n * (c @ explained @ c) / (n * (c @ left @ c) + np.mean(seen.within)))
        # Where nothing is rounded both bounds are the middle, up to the rounding of doubles.
        below, above = _wide(middle, middle)
        high, low = 2 * middle, 0.0
        while bound(high, 1) >= 0:
            high *= 2
            if high > _MOST:
                return 0.0, np.inf
        high = optimize.brentq(bound, below, high, args=(1,), xtol=1e-15)
        if bound(0.0, -1) > 0:
            low = optimize.brentq(bound, 0.0, above, args=(-1,), xtol=1e-15)
        return _wide(low * df2 / df1, high * df2 / df1)

    def adjusted_r2(self, f: float) -> float:
        """Compute adjusted R squared of an F statistic, with which it grows."""
        df1, df2 = self.df
        return float(1 - (df1 + df2) / (df2 + df1 * f))


def _wide(low: float, high: float) -> Range:
    return low - _WIDENED * abs(low), high + _WIDENED * abs(high)
