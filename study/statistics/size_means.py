"""The mean LEPP size of each number of points, with its error: what models of growth are fitted to.

All triangulations of a size have the same x, so that a weighted fit depends on the groups' means
only.
"""

from dataclasses import dataclass

import numpy as np

from study.statistics.groups import Groups
from study.statistics.variance_function import smooth_variances


@dataclass(frozen=True)
class SizeMeans:
    """Means by size.

    Attributes
    ----------
    n_points : (g,) int64 ndarray
        Ascending.
    means : (g,) float64 ndarray
    variances : (g,) float64 ndarray
        Squared standard errors of the means.
    df : int
        Degrees of freedom of the pure error that the variances are estimated from.
    """

    n_points: np.ndarray
    means: np.ndarray
    variances: np.ndarray
    df: int

    @classmethod
    def of(cls, groups: Groups) -> "SizeMeans":
        """Take the means of groups, whose variance is a smooth function of the number of points.

        Raises
        ------
        NotEnough
            If no group has two or more differing triangulations.
        """
        spread = smooth_variances(groups)
        return cls(
            groups.n_points,
            groups.means,
            spread / groups.counts,
            int((groups.counts - 1).sum()),
        )

    def __len__(self) -> int:
        return len(self.means)

    @property
    def x(self) -> np.ndarray:
        """Thousands of points, (g,) float64."""
        return self.n_points / 1000

    @property
    def standard_errors(self) -> np.ndarray:
        """Of the means, (g,) float64."""
        return np.sqrt(self.variances)

    def where(self, kept: np.ndarray) -> "SizeMeans":
        """Only some of the sizes; the error is still that of all."""
        return SizeMeans(self.n_points[kept], self.means[kept], self.variances[kept], self.df)
