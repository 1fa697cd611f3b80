"""Checks that the points of a set are as random as they should be."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import gamma, gammaln, kolmogorov, ndtr, smirnov

from study.design.sampling import Points, marginal_cdf
from study.run.measures import measure
from study.run.ranks import Bins, Values

#: Values, about, between two evaluations of the distribution function.
_STRIDE = 32

#: Fewer values than this are all looked at.
_FEW = 4096

#: From here on the corrected limiting distribution of Kolmogorov's statistic is right to 2e-5.
_MANY = 1000


@dataclass(frozen=True)
class PointChecks:
    """p-values of the checks of one point set; NaN where a test is not defined.

    Attributes
    ----------
    runs_p_x, runs_p_y : float
        Runs test about the median, of the x and of the y coordinates.
    ks_p_x, ks_p_y : float
        Kolmogorov-Smirnov test against the true distribution.
    """

    runs_p_x: float = measure("Runs test, p of x", format="p")
    runs_p_y: float = measure("Runs test, p of y", format="p")
    ks_p_x: float = measure("Kolmogorov-Smirnov, p of x", format="p")
    ks_p_y: float = measure("Kolmogorov-Smirnov, p of y", format="p")


def check_randomness(points: Points, distribution: str) -> PointChecks:
    """Test the coordinates of a point set.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
        Points in the order in which they were drawn.
    distribution : str
        The distribution that they were drawn from.
    """
    cdf = marginal_cdf(distribution)
    (runs_p_x, ks_p_x), (runs_p_y, ks_p_y) = (
        _p_values(np.ascontiguousarray(points[:, axis]), cdf) for axis in (0, 1)
    )
    return PointChecks(runs_p_x=runs_p_x, runs_p_y=runs_p_y, ks_p_x=ks_p_x, ks_p_y=ks_p_y)


def _p_values(values: Values, cdf: Callable[[Values], Values]) -> tuple[float, float]:
    """Return the p-values of the runs test and of the Kolmogorov-Smirnov test."""
    n = len(values)
    middle = np.array(middle_ranks(n))
    bins = Bins.of(values)
    wanted = bins_with_distance(bins, cdf)
    first, last = bins.holding(middle).tolist()
    wanted[first : last + 1] = True
    ordered, ranks = bins.take(wanted)
    low, high = ordered[np.searchsorted(ranks, middle)].tolist()
    runs_p = runs_p_value(count_sides(values, (low + high) / 2))
    return runs_p, kolmogorov_p_value(largest_distance(cdf(ordered), ranks, n), n)


def middle_ranks(n: int) -> tuple[int, int]:
    """Return the ranks, from 0, of the two middle ones of n values: the same rank for odd n."""
    return (n - 1) // 2, n // 2


@dataclass(frozen=True)
class Sides:
    """On which sides of their median the values of a sequence lie; sequences add up.

    Attributes
    ----------
    n_below, n_above : int
        Numbers of values below and above the median.
    changes : int
        How often a value lies on the other side than the one before it, values equal to the
        median left out: one less than the number of runs.
    """

    n_below: int
    n_above: int
    changes: int

    def __add__(self, other: "Sides") -> "Sides":
        return Sides(
            self.n_below + other.n_below,
            self.n_above + other.n_above,
            self.changes + other.changes,
        )


def count_sides(values: Values, median: float) -> Sides:
    """Count on which sides of their median values lie.

    Parameters
    ----------
    values : (n,) float64 ndarray
        Values in the order of their drawing.
    median : float
        Their median.
    """
    above = values > median
    n_above = int(np.count_nonzero(above))
    n_below = int(np.count_nonzero(values < median))
    if n_below + n_above < len(values):
        above = above[values != median]
    return Sides(n_below, n_above, count_changes(above))


def count_changes(above: NDArray[np.bool_]) -> int:
    """Return how many entries differ from the one before them."""
    return int(np.count_nonzero(above[1:] != above[:-1]))


def runs_p_value(sides: Sides) -> float:
    """Return the p-value of the Wald-Wolfowitz runs test about the median.

    Two-sided, by the normal approximation without continuity correction; values equal to the
    median are left out (as in ``randtests::runs.test`` of R, which the paper used).

    Returns
    -------
    p : float
        NaN where fewer than two values lie on a side of the median.
    """
    if sides.n_above < 2 or sides.n_below < 2:
        return float("nan")
    n = sides.n_below + sides.n_above
    product = 2 * sides.n_above * sides.n_below
    expected = product / n + 1
    variance = product * (product - n) / (n * n * (n - 1))
    z = abs(1 + sides.changes - expected) / np.sqrt(variance)
    return float(2 * ndtr(-z))


def bins_with_distance(bins: Bins, cdf: Callable[[Values], Values]) -> NDArray[np.bool_]:
    """Tell which bins can hold the largest distance of two distribution functions.

    The distribution function F is evaluated at few of the values. With ranks i from 0, the
    distance at value x_i of n is the larger of (i + 1) / n - F(x_i) and F(x_i) - i / n. F does not
    fall, so in a block of bins from edge u to edge v, with the ranks a <= i < b, the first is at
    most b / n - F(u), and the second at most F(v) - a / n. A block whose two bounds are below a
    distance that is attained at an edge cannot hold the maximum; only a handful can.

    Parameters
    ----------
    bins : Bins
        The values.
    cdf : callable
        The true distribution function F, for an array of values.

    Returns
    -------
    (k,) bool ndarray
    """
    n, n_bins = len(bins.values), len(bins.ends)
    if n < _FEW:
        return np.ones(n_bins, np.bool_)
    edges = np.append(bins.holding(np.arange(0, n, _STRIDE)), n_bins)
    edges = edges[np.append(edges[:-1] != edges[1:], True)]
    ranks, at_edges = bins.below(edges), cdf(bins.edges(edges))
    attained = np.abs(ranks / n - at_edges).max()
    bounds = np.maximum(ranks[1:] / n - at_edges[:-1], at_edges[1:] - ranks[:-1] / n)
    return np.repeat(bounds >= attained, np.diff(edges))


def largest_distance(at_values: Values, ranks: NDArray[np.int64], n: int) -> float:
    """Return the largest distance of the empirical distribution function at some values.

    Parameters
    ----------
    at_values : (k,) float64 ndarray
        The true distribution function at these values.
    ranks : (k,) int64 ndarray
        Their ranks, from 0, among all n values.
    n : int
        Number of all values.

    Returns
    -------
    distance : float
        0 where there are no values.
    """
    distances = np.maximum((ranks + 1) / n - at_values, at_values - ranks / n)
    return float(distances.max(initial=0.0))


def kolmogorov_p_value(distance: float, n: int) -> float:
    """Return the two-sided p-value of a Kolmogorov-Smirnov distance of n values.

    From 1,000 values by the limiting distribution with the correction of Vrbik (Pioneer Journal
    of Theoretical and Applied Statistics 15, 2018): within 2e-5 of the exact value. Below by the
    exact distribution; `scipy.stats` has that too, takes milliseconds for it, and would cost every
    worker a second to import.
    """
    if n >= _MANY:
        root = np.sqrt(n)
        corrected = root * distance + 1 / (6 * root) + (root * distance - 1) / (4 * n)
        return float(kolmogorov(corrected))
    if 2 * n * distance <= 1:  # no set of values has a smaller distance
        return 1.0
    if distance >= 0.5 or n * distance**2 > 4:  # both sides are exceeded together hardly ever
        return min(2 * float(smirnov(n, distance)), 1.0)
    return min(max(1 - _kolmogorov_cdf(distance, n), 0.0), 1.0)


def _kolmogorov_cdf(distance: float, n: int) -> float:
    """Return the chance of at most a distance, by Marsaglia, Tsang and Wang.

    An entry of the n-th power of a matrix (Journal of Statistical Software 8(18), 2003), which is
    divided by e in each step, as n! / n^n is, lest it overflow.
    """
    k = int(n * distance) + 1
    h = k - n * distance
    m = 2 * k - 1
    powers = h ** np.arange(1, m + 1)
    steps = np.arange(m)[:, None] - np.arange(m) + 1
    matrix = (steps >= 0).astype(np.float64)
    matrix[:, 0] -= powers
    matrix[-1] -= powers[::-1]
    matrix[-1, 0] += max(2 * h - 1, 0.0) ** m
    matrix /= gamma(np.maximum(steps, 0) + 1)
    power = np.linalg.matrix_power(matrix / math.e, n)[k - 1, k - 1]
    return float(power * np.exp(gammaln(n + 1) - n * np.log(n) + n))
