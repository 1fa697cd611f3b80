"""Seeded random point sets of the study's four distributions."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from lepp import InputError

Points = NDArray[np.float64]

#: The distributions; the index of a name is its number in the spawn key of a point set's seed.
DISTRIBUTIONS = ("uniform", "normal", "bivariate_normal", "exponential")

#: Consecutive points that share one generator.
BLOCK = 1 << 20


def sample_points(
    distribution: str, n_points: int, replicate: int, *, seed: int, correlation: float = 0.5
) -> Points:
    """Draw one point set.

    Parameters
    ----------
    distribution : str
        One of `DISTRIBUTIONS`: uniform on the unit square; normal, independent standard x and y;
        bivariate_normal, standard x and y with the given correlation; exponential, independent
        x and y of rate 1.
    n_points : int
        Number of points.
    replicate : int
        Number of the repetition, from 0.
    seed : int
        Seed of the study.
    correlation : float
        Correlation of x and y of bivariate_normal, between -1 and 1.

    Returns
    -------
    points : (n_points, 2) float64 ndarray

    Raises
    ------
    InputError
        If the distribution is not known.
    """
    blocks = [
        sample_block(distribution, n_points, replicate, block, seed=seed, correlation=correlation)
        for block in range(-(-n_points // BLOCK))
    ]
    return blocks[0] if len(blocks) == 1 else np.concatenate(blocks)


def sample_block(
    distribution: str,
    n_points: int,
    replicate: int,
    block: int,
    *,
    seed: int,
    correlation: float = 0.5,
) -> Points:
    """Draw the points ``block * BLOCK`` to ``(block + 1) * BLOCK`` of a point set.

    A block depends on nothing but the arguments, so blocks can be drawn anywhere, in any order.

    Returns
    -------
    points : (k, 2) float64 ndarray
        `BLOCK` points, or what is left of `n_points` in the last block.
    """
    if distribution not in DISTRIBUTIONS:
        raise InputError(
            f"There is no distribution {distribution!r}; the distributions are "
            f"{', '.join(DISTRIBUTIONS)}."
        )
    key = (DISTRIBUTIONS.index(distribution), n_points, replicate, block)
    generator = np.random.Generator(
        np.random.PCG64DXSM(np.random.SeedSequence(seed, spawn_key=key))
    )
    shape = (min(BLOCK, n_points - block * BLOCK), 2)
    if distribution == "uniform":
        return generator.random(shape)
    if distribution == "exponential":
        return generator.standard_exponential(shape)
    points = generator.standard_normal(shape)
    if distribution == "bivariate_normal":
        points[:, 1] *= np.sqrt(1 - correlation**2)
        points[:, 1] += correlation * points[:, 0]
    return points


def _uniform_cdf(x: Points) -> Points:
    return np.clip(x, 0.0, 1.0)


def _exponential_cdf(x: Points) -> Points:
    return -np.expm1(-np.maximum(x, 0.0))


def marginal_cdf(distribution: str) -> Callable[[Points], Points]:
    """Return the cumulative distribution function that x and y of a distribution both have."""
    if distribution == "uniform":
        return _uniform_cdf
    if distribution == "exponential":
        return _exponential_cdf
    return ndtr
