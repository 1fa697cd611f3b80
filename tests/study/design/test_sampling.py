import numpy as np
import pytest
from scipy import stats

from lepp import InputError
from study.design import sampling
from study.design.sampling import DISTRIBUTIONS, marginal_cdf, sample_block, sample_points


def stated_points(number, n_points, replicate, seed, draw):
    """The points by the words of the design: a generator for each block of 2^20 points."""
    parts = []
    for block, start in enumerate(range(0, n_points, 2**20)):
        key = (number, n_points, replicate, block)
        bits = np.random.PCG64DXSM(np.random.SeedSequence(seed, spawn_key=key))
        parts.append(draw(np.random.Generator(bits), (min(2**20, n_points - start), 2)))
    return np.concatenate(parts)


@pytest.mark.parametrize("n_points", [5, 2**20, 2**20 + 3])
def test_points_are_those_of_the_stated_seeds(n_points):
    uniform = sample_points("uniform", n_points, 4, seed=9)
    assert np.array_equal(uniform, stated_points(0, n_points, 4, 9, lambda g, s: g.random(s)))
    normal = sample_points("normal", n_points, 4, seed=9)
    assert np.array_equal(
        normal, stated_points(1, n_points, 4, 9, lambda g, s: g.standard_normal(s))
    )
    exponential = sample_points("exponential", n_points, 4, seed=9)
    assert np.array_equal(
        exponential, stated_points(3, n_points, 4, 9, lambda g, s: g.standard_exponential(s))
    )


def test_bivariate_normal_mixes_standard_normals():
    z = stated_points(2, 50, 0, 1, lambda g, s: g.standard_normal(s))
    points = sample_points("bivariate_normal", 50, 0, seed=1, correlation=0.6)
    np.testing.assert_allclose(points, np.c_[z[:, 0], 0.6 * z[:, 0] + 0.8 * z[:, 1]], rtol=1e-15)


def test_blocks_can_be_drawn_in_any_order(monkeypatch):
    monkeypatch.setattr(sampling, "BLOCK", 10)
    whole = sample_points("normal", 25, 3, seed=5)
    backwards = [sample_block("normal", 25, 3, block, seed=5) for block in (2, 1, 0)]
    assert [len(block) for block in backwards] == [5, 10, 10]
    assert np.array_equal(whole, np.concatenate(backwards[::-1]))


@pytest.mark.parametrize(
    "other",
    [
        ("exponential", 100, 0, 1),
        ("uniform", 101, 0, 1),
        ("uniform", 100, 1, 1),
        ("uniform", 100, 0, 2),
    ],
)
def test_each_part_of_the_key_changes_the_points(other):
    *key, seed = other
    first = sample_points("uniform", 100, 0, seed=1)
    assert not np.isin(sample_points(*key, seed=seed), first).any()


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_points_follow_their_distribution(distribution):
    points = sample_points(distribution, 50_000, 0, seed=3, correlation=0.5)
    for values in points.T:
        assert stats.kstest(values, marginal_cdf(distribution)).pvalue > 1e-3
    expected = 0.5 if distribution == "bivariate_normal" else 0.0
    # The standard error of the correlation is at most 1 / sqrt(n) = 0.0045.
    assert abs(np.corrcoef(points.T)[0, 1] - expected) < 0.02


def test_marginals_are_scipys():
    x = np.linspace(-2, 5, 99)
    np.testing.assert_allclose(marginal_cdf("uniform")(x), stats.uniform.cdf(x))
    np.testing.assert_allclose(marginal_cdf("normal")(x), stats.norm.cdf(x))
    np.testing.assert_allclose(marginal_cdf("exponential")(x), stats.expon.cdf(x))


def test_an_unknown_distribution_lists_the_known():
    with pytest.raises(InputError, match="'cauchy'; the distributions are uniform, normal"):
        sample_points("cauchy", 10, 0, seed=1)
