"""The variance between triangulations as a power of the number of points."""

import numpy as np

from study.statistics.groups import Groups, NotEnough

_MOST_STEPS, _CLOSE = 100, 1e-12


def power_law_variances(groups: Groups) -> np.ndarray:
    """Estimate the variance of a value of each group, smoothed over all groups.

    Parameters
    ----------
    groups : Groups

    Returns
    -------
    (k,) float64 ndarray
        Also of groups of a single triangulation.

    Raises
    ------
    NotEnough
        If no group has two or more differing triangulations.

    Notes
    -----
    A mean over n points whose far parts do not depend on one another has a variance in proportion
    to a power of n. Sample variances are gamma distributed about it, with (r - 1) / 2 as shape for
    r triangulations; ln variance = alpha + beta ln n is fitted by maximum likelihood (McCullagh and
    Nelder 1989, Generalized Linear Models, chapter 8, by iteratively reweighted least squares). A
    reciprocal sample variance of three triangulations is no weight: its mean is infinite.
    """
    repeated = groups.repeated()
    if not len(repeated):
        raise NotEnough("no size has two or more differing triangulations")
    df = repeated.counts - 1.0
    center = np.average(np.log(repeated.n_points), weights=df)
    basis = _basis(repeated.n_points, center, len(repeated))
    root = np.sqrt(df)[:, None]
    # Of ln s^2 first, which is near enough to start from.
    target = np.log(repeated.variances)
    log_variance = np.zeros_like(target)
    for _ in range(_MOST_STEPS):
        coefficients = np.linalg.lstsq(basis * root, target * root[:, 0], rcond=None)[0]
        before, log_variance = log_variance, basis @ coefficients
        if np.abs(log_variance - before).max() < _CLOSE:
            break
        # A step is bounded, so that a bad start cannot throw the fit far off.
        excess = np.minimum(repeated.variances / np.exp(log_variance) - 1, 3.0)
        target = log_variance + excess
    return np.exp(_basis(groups.n_points, center, len(repeated)) @ coefficients)


def _basis(n_points: np.ndarray, center: float, sizes: int) -> np.ndarray:
    log_n = np.log(n_points) - center
    # One size says nothing of the power.
    return np.column_stack([np.ones_like(log_n), log_n])[:, : min(sizes, 2)]
