"""Whether the limit that the edge model has for the whole mesh is the mean of its interior."""

from dataclasses import dataclass

import numpy as np
from scipy import special

from study.statistics.groups import Groups, NotEnough
from study.statistics.models import CONSTANT, Function, LinearModel
from study.statistics.size_means import SizeMeans


@dataclass(frozen=True)
class EdgeLimit:
    """The two numbers, and their difference.

    Attributes
    ----------
    limit, interior : float
    standard_error : float
        Of limit - interior, with what the two have in common.
    df : float
        Its degrees of freedom, by Welch and Satterthwaite.
    """

    limit: float
    interior: float
    standard_error: float
    df: float

    @property
    def difference(self) -> float:
        """Limit less interior."""
        return self.limit - self.interior

    @property
    def t(self) -> float:
        """Difference in standard errors."""
        return self.difference / self.standard_error

    @property
    def p(self) -> float:
        """Chance of as large a difference, to either side."""
        return float(2 * special.stdtr(self.df, -abs(self.t)))


def edge_limit(model: LinearModel, whole: Groups, interior: Groups) -> EdgeLimit:
    """Compare a model's limit, from the whole meshes, with a level mean of their interiors.

    Parameters
    ----------
    model : LinearModel
        Its first coefficient is a limit.
    whole, interior : Groups
        Mean LEPP sizes of the same triangulations, in the same order; the interiors of only some
        of the sizes.

    Raises
    ------
    NotEnough
        If they are not the same, or too few.

    Notes
    -----
    Both numbers are weighted sums of the triangulations' means, so that their difference is one,
    and its variance the sum of the variances inside the groups.
    """
    if not len(whole) or not len(interior):
        raise NotEnough("no triangulation has an interior")
    at = np.searchsorted(whole.n_points, interior.n_points)
    if whole.counts[at].tolist() != interior.counts.tolist() or (whole.counts < 2).any():
        raise NotEnough("some triangulations have no interior, or a size has only one")
    if len(whole) < len(model.terms):
        raise NotEnough(f"the {model.name} model needs {len(model.terms)} sizes, not {len(whole)}")
    of_limit = _shares(model.basis, SizeMeans.of(whole))
    of_interior = _shares(CONSTANT.basis, SizeMeans.of(interior))
    summands = [share * values for share, values in zip(of_limit, whole.values, strict=True)]
    for place, share, values in zip(at, of_interior, interior.values, strict=True):
        summands[place] = summands[place] - share * values
    parts = np.array([each.var(ddof=1) / len(each) for each in summands])
    df = parts.sum() ** 2 / (parts**2 / (whole.counts - 1)).sum()
    return EdgeLimit(
        float(of_limit @ whole.means),
        float(of_interior @ interior.means),
        float(np.sqrt(parts.sum())),
        float(df),
    )


def _shares(basis: Function, means: SizeMeans) -> np.ndarray:
    # What each mean adds to the first coefficient.
    root = np.sqrt(1 / means.variances)[:, None]
    return (np.linalg.pinv(basis(means.x) * root) * root.T)[0]
