"""Holm's correction for a family of tests."""

import numpy as np


def holm(p: np.ndarray) -> np.ndarray:
    """Adjust the p-values of a family of tests.

    Parameters
    ----------
    p : (m,) float64 ndarray
        From 0 to 1; m may be 0.

    Returns
    -------
    (m,) float64 ndarray
        At most 1. Rejecting where these are below a level keeps the chance of any false rejection
        below it.

    Notes
    -----
    Holm (1979), Scandinavian Journal of Statistics 6, 65-70. statsmodels' `multipletests` gives
    the same, but collects all of Python's garbage at every call, which takes longer than all
    other tests together.
    """
    order = np.argsort(p, kind="stable")
    steps = p[order] * np.arange(len(p), 0, -1)
    adjusted = np.empty(len(p))
    adjusted[order] = np.minimum(np.maximum.accumulate(steps), 1.0)
    return adjusted
