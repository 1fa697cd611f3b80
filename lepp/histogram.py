"""The histogram of LEPP sizes: the sufficient statistic of a mesh, or of many."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np


@dataclass(frozen=True, eq=False)
class LeppCounts:
    """How many triangles have each LEPP size; adds up exactly, in any order.

    Attributes
    ----------
    counts : (k,) int64 ndarray
        ``counts[s]`` triangles have a LEPP of s triangles; no trailing zeros.

    Raises
    ------
    ValueError
        Counts that are not integers of at least 0, in one dimension.

    Notes
    -----
    Moments are those of all the triangles counted, not estimates for a larger population. They are
    computed from integer sums about a size near the mean, so that they do not depend on the order
    in which counts were added.
    """

    counts: np.ndarray

    def __post_init__(self) -> None:
        counts = np.asarray(self.counts)
        if counts.ndim != 1 or counts.dtype.kind not in "iu" or (counts < 0).any():
            raise ValueError("counts must be a one-dimensional array of integers of at least 0")
        used = np.flatnonzero(counts)
        counts = counts[: used[-1] + 1 if len(used) else 0].astype(np.int64)
        counts.setflags(write=False)
        object.__setattr__(self, "counts", counts)

    @classmethod
    def from_sizes(cls, sizes: np.ndarray) -> "LeppCounts":
        """Count LEPP sizes.

        Parameters
        ----------
        sizes : (m,) ndarray of int
            At least 0.

        Returns
        -------
        LeppCounts

        Raises
        ------
        ValueError
            A negative size, or more than one dimension.
        """
        return cls(np.bincount(sizes))

    def __add__(self, other: "LeppCounts") -> "LeppCounts":
        if not isinstance(other, LeppCounts):
            return NotImplemented
        counts = np.zeros(max(len(self.counts), len(other.counts)), np.int64)
        counts[: len(self.counts)] += self.counts
        counts[: len(other.counts)] += other.counts
        return LeppCounts(counts)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, LeppCounts):
            return NotImplemented
        return np.array_equal(self.counts, other.counts)

    def __hash__(self) -> int:
        return hash(self.counts.tobytes())

    @property
    def count(self) -> int:
        """Number of triangles."""
        return int(self.counts.sum())

    @property
    def max(self) -> int:
        """Largest LEPP size; 0 when nothing was counted."""
        return max(len(self.counts) - 1, 0)

    @property
    def mean(self) -> float:
        """Mean LEPP size; nan when nothing was counted."""
        return self._power_sums(1)[0] / self.count if self.count else np.nan

    @property
    def sd(self) -> float:
        """Standard deviation of the LEPP sizes (divisor: `count`); nan when nothing was counted."""
        return float(np.sqrt(self._moments[0]))

    @property
    def skewness(self) -> float:
        """Third central moment over the cube of `sd`; nan when all sizes are equal."""
        second, third, _ = self._moments
        return third / second**1.5 if second > 0 else np.nan

    @property
    def kurtosis(self) -> float:
        """Fourth central moment over the fourth power of `sd`, minus 3 (excess kurtosis)."""
        second, _, fourth = self._moments
        return fourth / second**2 - 3.0 if second > 0 else np.nan

    @property
    def termination_rates(self) -> np.ndarray:
        """Share of the paths with at least s triangles that have s, for s = 0 .. max; (k,) float64.

        nan where no path is that long. Theorem 1 takes the rate to be p at every s from 2 on.
        """
        reached = np.cumsum(self.counts[::-1])[::-1]
        with np.errstate(invalid="ignore"):
            return np.where(reached > 0, self.counts / reached, np.nan)

    def _power_sums(self, power: int) -> list[int]:
        """Return the exact sums of size**k over all triangles, for k = 1 .. power."""
        sizes = [(size, int(number)) for size, number in enumerate(self.counts) if number]
        return [sum(number * size**k for size, number in sizes) for k in range(1, power + 1)]

    @cached_property
    def _moments(self) -> tuple[float, float, float]:
        """Return the second, third and fourth central moments, from exact integer sums."""
        n = self.count
        if n == 0:
            return np.nan, np.nan, np.nan
        s1, s2, s3, s4 = self._power_sums(4)
        second = n * s2 - s1**2
        third = n**2 * s3 - 3 * n * s1 * s2 + 2 * s1**3
        fourth = n**3 * s4 - 4 * n**2 * s1 * s3 + 6 * n * s1**2 * s2 - 3 * s1**4
        return second / n**2, third / n**3, fourth / n**4
