"""Groups of independent values, and what is too little of them for a statistic."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

#: Groups of so many tell by themselves how their values vary together.
ENOUGH = 16


class NotEnough(Exception):  # noqa: N818 - it is no error: the run simply does not hold enough
    """The results do not suffice for a statistic; the message says what is lacking."""


@dataclass(frozen=True)
class Groups:
    """Mean LEPP sizes of the triangulations of one method and distribution, by size.

    Attributes
    ----------
    n_points : (k,) int64 ndarray
        Sizes, ascending, of the groups with at least one triangulation.
    values : tuple of (r,) float64 ndarray
        One mean LEPP size a triangulation, for each group.
    """

    n_points: np.ndarray
    values: tuple[np.ndarray, ...]

    def __len__(self) -> int:
        return len(self.values)

    @cached_property
    def counts(self) -> np.ndarray:
        """Triangulations of each group, (k,) int64."""
        return np.array([len(group) for group in self.values], dtype=np.int64)

    @cached_property
    def means(self) -> np.ndarray:
        """Mean of each group, (k,) float64."""
        return np.array([group.mean() for group in self.values])

    @cached_property
    def variances(self) -> np.ndarray:
        """Sample variance of each group, (k,) float64; NaN for a single triangulation."""
        return np.array([variance(group) for group in self.values])

    def repeated(self, least: int = 2) -> "Groups":
        """Only the groups of at least `least` triangulations that are not all equal."""
        kept = [i for i, group in enumerate(self.values) if len(group) >= least and np.ptp(group)]
        return Groups(self.n_points[kept], tuple(self.values[i] for i in kept))

    def need(self, groups: int) -> None:
        """Raise NotEnough unless there are at least `groups` groups."""
        if len(self) < groups:
            raise NotEnough(
                f"{groups} or more sizes with two or more differing triangulations are needed, "
                f"there {'is' if len(self) == 1 else 'are'} {len(self)}"
            )


def variance(values: np.ndarray) -> float:
    """Sample variance; NaN for fewer than two values, exactly 0 for equal ones."""
    if len(values) < 2:
        return np.nan
    return float(values.var(ddof=1)) if np.ptp(values) else 0.0


def best_repeated(triangulations: Mapping[int, int]) -> int:
    """Return the largest number of points with enough triangulations to tell how they vary.

    Parameters
    ----------
    triangulations : mapping of int to int
        By number of points; not empty.

    Returns
    -------
    int
        The largest with `ENOUGH`; if there is none, the largest with two; else the largest.
    """
    for least in (ENOUGH, 2, 0):
        repeated = [size for size, number in triangulations.items() if number >= least]
        if repeated:
            return max(repeated)
    raise ValueError("there is no number of points")
