"""Values whose ranks are known without sorting them all.

They are counted by bins of one width; only those in bins that somebody asks for are put in order.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lepp.jit import inlined, kernel

Values = NDArray[np.float64]

_FEWEST_BINS = 64
_VALUES_PER_BIN = 4
_MOST_BITS = 52  # of a scaled value, so that bins and their edges are exact


@dataclass(frozen=True, eq=False)
class Bins:
    """Numbers of values by bin.

    Attributes
    ----------
    values : (n,) float64 ndarray
    scale : float
        Bins per unit: a power of two, so that nothing is rounded when values are scaled.
    low : int
        What is taken off the integer part of a scaled value, to give its bin.
    ends : (k,) int64 ndarray
        How many values lie in each bin and those below it.
    """

    values: Values
    scale: float
    low: int
    ends: NDArray[np.int64]

    @classmethod
    def of(cls, values: Values) -> "Bins":
        """Count values.

        Parameters
        ----------
        values : (n,) float64 ndarray
            Contiguous; 0 or of magnitudes between 2**-500 and 2**500, whose bits scaling keeps.
        """
        least, greatest = float(values.min()), float(values.max())
        wanted = max(_FEWEST_BINS, len(values) // _VALUES_PER_BIN)
        scale = math.ldexp(
            1.0,
            min(
                _exponent(wanted) - _exponent(greatest / 2 - least / 2) - 2,
                _MOST_BITS - max(_exponent(least), _exponent(greatest)),
            ),
        )
        low = math.floor(least * scale)
        n_bins = math.floor(greatest * scale) - low + 1
        return cls(values, scale, low, _ends(values, scale, low, n_bins))

    def holding(self, ranks: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the bins of the values of some ranks, counted from 0."""
        return np.searchsorted(self.ends, ranks, side="right")

    def edges(self, bins: NDArray[np.int64]) -> Values:
        """Return where bins begin: no value in them is smaller, and all before them are."""
        return (bins + self.low) / self.scale

    def below(self, bins: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return how many values lie in the bins before each."""
        return np.where(bins > 0, self.ends[np.maximum(bins, 1) - 1], 0)

    def take(self, wanted: NDArray[np.bool_]) -> tuple[Values, NDArray[np.int64]]:
        """Return the values in some bins, ascending, and their ranks, from 0.

        Parameters
        ----------
        wanted : (k,) bool ndarray
            Which bins.
        """
        bins = np.flatnonzero(wanted)
        first_ranks = self.below(bins)
        counts = self.ends[bins] - first_ranks
        values = np.sort(_taken(self.values, self.scale, self.low, wanted, counts.sum()))
        before = np.cumsum(counts) - counts
        return values, np.arange(len(values)) + np.repeat(first_ranks - before, counts)


def _exponent(value: float) -> int:
    """Return the power of two that is just above a magnitude."""
    return math.frexp(value)[1]


@inlined
def _bin(value, scale, low):
    """Return the bin of a value, as an index that cannot be negative: so it is not looked at."""
    return np.uint64(np.int64(math.floor(value * scale)) - low)


@kernel
def _ends(values, scale, low, n_bins):
    """Count values by bin, and add up."""
    ends = np.zeros(n_bins, np.int64)
    for i in range(len(values)):
        ends[_bin(values[i], scale, low)] += 1
    for k in range(1, n_bins):
        ends[k] += ends[k - 1]
    return ends


@kernel
def _taken(values, scale, low, wanted, n_taken):
    """Return the values in wanted bins, in their order."""
    taken = np.empty(n_taken)
    n = 0
    for i in range(len(values)):
        if wanted[_bin(values[i], scale, low)]:
            taken[n] = values[i]
            n += 1
    return taken
