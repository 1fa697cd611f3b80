"""The power law of variances against statsmodels' gamma regression, and on means by size."""

import numpy as np
import pytest
import statsmodels.api as sm

from study.statistics.groups import Groups, NotEnough
from study.statistics.size_means import SizeMeans
from study.statistics.variance_function import smooth_variances

SIZES = np.array([10, 20, 50, 100, 500, 2000]) * 1000
COUNTS = [12, 9, 12, 6, 3, 2]


def made(seed=1, counts=COUNTS):
    rng = np.random.default_rng(seed)
    values = (3 + rng.normal(0, 0.4 * n**-0.45, r) for n, r in zip(SIZES, counts, strict=True))
    return Groups(SIZES, tuple(values))


@pytest.mark.parametrize("seed", range(5))
def test_variances_are_statsmodels_gamma_regression(seed):
    groups = made(seed)
    spread = [values.var(ddof=1) for values in groups.values]
    model = sm.GLM(
        spread,
        sm.add_constant(np.log(SIZES)),
        family=sm.families.Gamma(sm.families.links.Log()),
        var_weights=np.array(COUNTS) - 1,
    )
    np.testing.assert_allclose(smooth_variances(groups), model.fit(tol=1e-12).mu, rtol=1e-6)


def curved(bend, count, seed=3):
    rng = np.random.default_rng(seed)
    log_n = np.log(SIZES / 100_000)
    sd = 0.004 * np.exp(-0.45 * log_n + bend * log_n**2)
    return Groups(SIZES, tuple(rng.normal(3, s, count) for s in sd))


@pytest.mark.parametrize(("bend", "count"), [(0.06, 40), (0.0, 40), (0.06, 5)])
def test_a_curve_is_fitted_where_a_power_does_not_do(bend, count):
    groups = curved(bend, count)
    log_n = np.log(SIZES)
    basis = np.vander(log_n - log_n.mean(), 3)[:, 0 if bend and count > 5 else 1 :]
    spread = [values.var(ddof=1) for values in groups.values]
    model = sm.GLM(spread, basis, family=sm.families.Gamma(sm.families.links.Log()))
    np.testing.assert_allclose(smooth_variances(groups), model.fit(tol=1e-12).mu, rtol=1e-6)


def test_four_sizes_have_no_curve():
    groups = curved(0.3, 40)
    four = Groups(SIZES[:4], groups.values[:4])
    ratios = np.diff(np.log(smooth_variances(four))) / np.diff(np.log(SIZES[:4]))
    np.testing.assert_allclose(ratios, ratios[0])


def test_a_variance_far_above_the_others_counts_in_full():
    rng = np.random.default_rng(8)
    values = [rng.normal(3, 0.01, 5) for _ in SIZES]
    values[2] = 3 + 30 * (values[2] - 3)
    groups = Groups(SIZES, tuple(values))
    spread = [one.var(ddof=1) for one in values]
    basis = sm.add_constant(np.log(SIZES))
    model = sm.GLM(spread, basis, family=sm.families.Gamma(sm.families.links.Log()))
    np.testing.assert_allclose(smooth_variances(groups), model.fit(tol=1e-12).mu, rtol=1e-6)


def test_a_group_of_one_has_the_variance_of_its_size():
    groups = made(counts=[12, 9, 12, 6, 3, 1])
    others = Groups(SIZES[:5], groups.values[:5])
    found = smooth_variances(groups)
    np.testing.assert_allclose(found[:5], smooth_variances(others))
    ratios = np.diff(np.log(found)) / np.diff(np.log(SIZES))
    np.testing.assert_allclose(ratios, ratios[0])


def test_the_power_is_recovered():
    groups = made(counts=[400] * 6)
    np.testing.assert_allclose(smooth_variances(groups), 0.16 * SIZES**-0.9, rtol=0.15)


def test_one_size_has_its_sample_variance():
    values = (np.array([3.0, 3.1, 3.4]), np.array([3.0]))
    found = smooth_variances(Groups(SIZES[:2], values))
    np.testing.assert_allclose(found, values[0].var(ddof=1))


def test_no_variance_at_all():
    with pytest.raises(NotEnough, match="no size has two or more differing"):
        smooth_variances(Groups(SIZES[:2], (np.array([3.0]), np.array([3.0, 3.0]))))


def test_means_by_size():
    groups = made()
    means = SizeMeans.of(groups)
    assert means.means.tolist() == [values.mean() for values in groups.values]
    np.testing.assert_allclose(means.standard_errors**2 * COUNTS, smooth_variances(groups))
    assert means.df == sum(COUNTS) - 6
    assert means.x.tolist() == [10, 20, 50, 100, 500, 2000]
    few = means.where(means.n_points > 100_000)
    assert (len(means), len(few), few.df) == (6, 2, means.df)
    assert few.variances.tolist() == means.variances[4:].tolist()
