"""The checks of a point set that is never in memory, in two passes over blocks of its points.

The p-values are those of `study.run.point_checks.check_randomness` on the whole set, to the last
bit, for any division into consecutive blocks and any order of their arrival:

1. `histogram` of each block; histograms add up. From their sum, `plan_checks` knows the bins
   that hold the median, and those that can hold the largest distance of the two distribution
   functions: where a bin lies among the ranks bounds the distance at all of its values.
2. `extract` of each block: the values in these few bins, and for the runs test their neighbours.
   From all extracts, `checks_of_blocks` finds the median, the runs and the largest distances.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from study.design.sampling import Points, marginal_cdf
from study.run.point_checks import (
    PointChecks,
    Sides,
    count_changes,
    count_sides,
    kolmogorov_p_value,
    largest_distance,
    middle_ranks,
    runs_p_value,
)
from study.run.ranks import Values

BinNumbers = NDArray[np.int64]

#: Bins per square root of the number of points, at least. The distance is about 1 / root, and
#: a bin's bound exceeds the distances in it by the bin's probability: with so many bins less than
#: a hundredth of all values lie in bins that can hold the largest distance.
_BINS_PER_ROOT = 32

#: Points that are binned at a time, for the processor's cache.
_CHUNK = 1 << 14

#: By so much the edges of a bin are moved outwards when bounds of its values are computed: far
#: more than `_scaled`, its inverse and the distribution function err, far less than a bin.
_MARGIN = 2.0**-40


@dataclass(frozen=True)
class Histogram:
    """Numbers of points by bin of x and of y; the histograms of blocks add up.

    Attributes
    ----------
    distribution : str
        The distribution that the points were drawn from; it sets the edges of the bins.
    n_points : int
        Number of points of the whole set; it sets the number of bins.
    counts : (2, n_bins + 1) unsigned integer ndarray
        Of x and of y, in the smallest type that holds them. The last bin is for values that are
        scaled to 1.
    """

    distribution: str
    n_points: int
    counts: NDArray[np.unsignedinteger]

    def __add__(self, other: "Histogram") -> "Histogram":
        if (self.distribution, self.n_points) != (other.distribution, other.n_points):
            raise ValueError("Histograms of different point sets do not add up.")
        counts = np.add(self.counts, other.counts, dtype=np.uint64)
        return Histogram(self.distribution, self.n_points, _narrowed(counts))


@dataclass(frozen=True)
class AxisPlan:
    """Which bins of one coordinate decide its checks.

    Attributes
    ----------
    median_bins : (int, int)
        The bins of the two middle values. Values in or between them may be the median.
    distance_bins : (m,) int64 ndarray
        The bins that can hold the largest distance, ascending.
    counts : (m,) int64 ndarray
        Numbers of values in them.
    first_ranks : (m,) int64 ndarray
        Numbers of values in all bins below each of them.
    """

    median_bins: tuple[int, int]
    distance_bins: BinNumbers
    counts: NDArray[np.int64]
    first_ranks: NDArray[np.int64]


@dataclass(frozen=True)
class Plan:
    """What the second pass looks for.

    Attributes
    ----------
    distribution, n_points
        As in `Histogram`.
    x, y : AxisPlan
    """

    distribution: str
    n_points: int
    x: AxisPlan
    y: AxisPlan


@dataclass(frozen=True)
class AxisExtract:
    """What decides the checks of one coordinate, of one block.

    Attributes
    ----------
    kept : (k,) float64 ndarray
        In the order of their drawing, the values that may be the median, their neighbours, and
        the block's first and last value.
    left_out : Sides
        The other values, all of them on a side that is known. Its changes are those that the
        whole block has more than `kept` has.
    in_distance_bins : (m,) float64 ndarray
        The values that can hold the largest distance.
    """

    kept: Values
    left_out: Sides
    in_distance_bins: Values


@dataclass(frozen=True)
class Extract:
    """What decides the checks, of one block.

    Attributes
    ----------
    first : int
        Index of the block's first point in the set.
    n_points : int
        Number of points of the block.
    x, y : AxisExtract
    """

    first: int
    n_points: int
    x: AxisExtract
    y: AxisExtract


def histogram(points: Points, distribution: str, n_points: int) -> Histogram:
    """Count the points of a block by bin: the first pass.

    Parameters
    ----------
    points : (k, 2) float64 ndarray
        Points of the block.
    distribution : str
        The distribution that they were drawn from.
    n_points : int
        Number of points of the whole set.
    """
    n_bins = _n_bins(n_points)
    counts = np.zeros((2, n_bins + 1), np.uint32)
    for axis in (0, 1):
        # With an increment of the type of the counts this is twice as fast as `bincount`.
        np.add.at(counts[axis], _bins(points[:, axis], distribution, n_bins), np.uint32(1))
    return Histogram(distribution, n_points, _narrowed(counts))


def plan_checks(total: Histogram) -> Plan:
    """Find the bins that decide the checks.

    Parameters
    ----------
    total : Histogram
        Sum of the histograms of all blocks.

    Raises
    ------
    ValueError
        If it does not count each point once.
    """
    for counts in total.counts:
        if counts.sum() != total.n_points:
            raise ValueError(
                f"The histograms count {counts.sum()} points of {total.n_points}: add up the "
                "histogram of each block once."
            )
    x, y = (_plan_axis(counts.astype(np.int64), total.distribution) for counts in total.counts)
    return Plan(total.distribution, total.n_points, x, y)


def _plan_axis(counts: NDArray[np.int64], distribution: str) -> AxisPlan:
    ends = np.cumsum(counts)
    n = int(ends[-1])
    low, high = np.searchsorted(ends, middle_ranks(n), side="right").tolist()
    # As in `bins_with_distance`, with bins for blocks: F is at least
    # `at_lower` and at most `at_upper` at each of them, of ranks starts <= i < ends.
    filled = np.flatnonzero(counts)
    counts, ends = counts[filled], ends[filled]
    starts = ends - counts
    at_lower, at_upper = (at[filled] for at in _cdf_at_edges(distribution, _n_bins(n)))
    attained = np.maximum(ends / n - at_upper, at_lower - starts / n).max()
    # Where the bound is just attained, the values in the bin are the only ones to tell.
    held = np.maximum(ends / n - at_lower, at_upper - starts / n) >= attained
    return AxisPlan((low, high), filled[held], counts[held], starts[held])


def extract(points: Points, first: int, plan: Plan) -> Extract:
    """Take from a block what decides the checks: the second pass.

    Parameters
    ----------
    points : (k, 2) float64 ndarray
        Points of the block, in the order in which they were drawn.
    first : int
        Index of the first of them in the set.
    plan : Plan
        The plan of the whole set.
    """
    n_bins = _n_bins(plan.n_points)
    x, y = (
        _extract_axis(values, _bins(values, plan.distribution, n_bins), axis_plan, n_bins)
        for values, axis_plan in ((points[:, 0], plan.x), (points[:, 1], plan.y))
    )
    return Extract(first, len(points), x, y)


def _extract_axis(values: Values, bins: BinNumbers, plan: AxisPlan, n_bins: int) -> AxisExtract:
    low, high = plan.median_bins
    above = bins > high
    open_side = np.flatnonzero((bins >= low) & ~above)
    # Between neighbours that are both left out nothing can change; with the neighbours of the
    # open values kept, all else is between values that are kept. So, for the changes that are
    # left out, the open values may be taken to lie on any side.
    ends = [0, len(values) - 1]
    kept = np.unique(np.concatenate([open_side - 1, open_side, open_side + 1, ends]))
    kept = kept[(kept >= 0) & (kept < len(values))]
    above_kept = above[kept]
    n_above = int(np.count_nonzero(above)) - int(np.count_nonzero(above_kept))
    left_out = Sides(
        n_below=len(values) - len(kept) - n_above,
        n_above=n_above,
        changes=count_changes(above) - count_changes(above_kept),
    )
    can_hold_distance = np.zeros(n_bins + 1, bool)
    can_hold_distance[plan.distance_bins] = True
    return AxisExtract(values[kept], left_out, values[can_hold_distance.take(bins)])


def checks_of_blocks(plan: Plan, extracts: Iterable[Extract]) -> PointChecks:
    """Join the blocks' extracts to the checks of the whole set.

    Parameters
    ----------
    plan : Plan
        The plan that the extracts were made with.
    extracts : iterable of Extract
        Of all blocks, in any order.

    Raises
    ------
    ValueError
        If the blocks do not have each point once, or differ from those of the first pass.
    """
    blocks = sorted(extracts, key=lambda block: (block.first, block.n_points))
    end = 0
    for block in blocks:
        if block.first != end:
            raise ValueError(
                f"The blocks do not join: one begins at point {block.first}, those before it "
                f"end at point {end}."
            )
        end += block.n_points
    if end != plan.n_points:
        raise ValueError(f"The blocks have {end} points of {plan.n_points}.")
    runs_p_x, ks_p_x = _axis_p_values(plan, plan.x, [block.x for block in blocks])
    runs_p_y, ks_p_y = _axis_p_values(plan, plan.y, [block.y for block in blocks])
    return PointChecks(runs_p_x=runs_p_x, runs_p_y=runs_p_y, ks_p_x=ks_p_x, ks_p_y=ks_p_y)


def _axis_p_values(plan: Plan, axis: AxisPlan, blocks: list[AxisExtract]) -> tuple[float, float]:
    n = plan.n_points
    values = np.concatenate([block.in_distance_bins for block in blocks])
    if len(values) != axis.counts.sum():
        raise ValueError("The blocks of the second pass are not those of the first.")
    values.sort()
    # The values of a bin follow one another; what is left out lies between the bins.
    before = np.cumsum(axis.counts) - axis.counts
    ranks = np.arange(len(values)) + np.repeat(axis.first_ranks - before, axis.counts)
    distance = largest_distance(marginal_cdf(plan.distribution)(values), ranks, n)

    left_out = sum((block.left_out for block in blocks), Sides(0, 0, 0))
    kept = np.concatenate([block.kept for block in blocks])
    median = _median_of_ordered(np.sort(kept), n, left_out.n_below)
    runs_p = runs_p_value(left_out + count_sides(kept, median))
    return runs_p, kolmogorov_p_value(distance, n)


def _median_of_ordered(ordered: Values, n: int, n_below: int) -> float:
    """Return the median of n values.

    Parameters
    ----------
    ordered : (k,) float64 ndarray
        Values in ascending order, the middle ones of the n among them.
    n : int
        Number of all values.
    n_below : int
        How many of those that are not in `ordered` lie below the middle ones; the others of
        them lie above.
    """
    low, high = middle_ranks(n)
    return float((ordered[low - n_below] + ordered[high - n_below]) / 2)


def _n_bins(n_points: int) -> int:
    """Return the number of bins, a power of two so that values are scaled to bins exactly."""
    return 1 << int(np.ceil(np.log2(_BINS_PER_ROOT * np.sqrt(n_points))))


def _narrowed(counts: NDArray[np.unsignedinteger]) -> NDArray[np.unsignedinteger]:
    return counts.astype(np.min_scalar_type(counts.max()))


def _bins(values: Values, distribution: str, n_bins: int) -> BinNumbers:
    """Return the bin of each value, from 0 to n_bins; a greater value has no smaller bin."""
    bins = np.empty(len(values), np.int64)
    for start in range(0, len(values), _CHUNK):
        chunk = slice(start, start + _CHUNK)
        bins[chunk] = _scaled(values[chunk], distribution) * n_bins
    return bins


def _scaled(values: Values, distribution: str) -> Values:
    """Map values to 0 to 1, so that equal parts of it are about equally probable.

    Rounded arithmetic keeps the order: each step is a correctly rounded function of one
    argument, and monotone. No bin has more than twice the mean probability.
    """
    if distribution == "uniform":
        return np.clip(values, 0.0, 1.0)
    if distribution == "exponential":
        return 1 - 1 / (1 + np.maximum(values, 0.0))
    return (1 + np.copysign(1 - 1 / (1 + np.abs(values)), values)) / 2


def _unscaled(scaled: Values, distribution: str) -> Values:
    """Invert `_scaled`; infinite from its ends on."""
    inside = np.clip(scaled, 0.0, 1.0)
    if distribution == "uniform":
        values = inside
    elif distribution == "exponential":
        values = inside / np.maximum(1 - inside, _MARGIN)
    else:
        from_middle = 2 * inside - 1
        values = from_middle / np.maximum(1 - np.abs(from_middle), _MARGIN)
    return np.where(scaled <= 0, -np.inf, np.where(scaled >= 1, np.inf, values))


def _cdf_at_edges(distribution: str, n_bins: int) -> tuple[Values, Values]:
    """Bound the distribution function at the values of each bin, from below and from above."""
    edges = np.arange(n_bins + 2) / n_bins
    cdf = marginal_cdf(distribution)
    at_lower = cdf(_unscaled(edges[:-1] - _MARGIN, distribution))
    at_upper = cdf(_unscaled(edges[1:] + _MARGIN, distribution))
    return at_lower, at_upper
