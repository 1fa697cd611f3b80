"""Shares of variance against the noncentral F distribution, and how often they hold the truth."""

import numpy as np
import pytest
from scipy import stats

from study.statistics.effect_size import eta_squared, omega_squared, population_share


def test_shares_are_those_of_sums_of_squares():
    groups = [np.array([1.0, 2.0, 4.0]), np.array([2.0, 5.0, 6.0, 7.0]), np.array([0.0, 1.0])]
    every = np.concatenate(groups)
    between = sum(len(g) * (g.mean() - every.mean()) ** 2 for g in groups)
    whole = ((every - every.mean()) ** 2).sum()
    within = (whole - between) / 6
    f = stats.f_oneway(*groups).statistic
    assert eta_squared(f, 2, 6) == pytest.approx(between / whole)
    assert omega_squared(f, 2, 9) == pytest.approx((between - 2 * within) / (whole + within))
    assert omega_squared(0.5, 2, 9) == 0


@pytest.mark.parametrize("f", [1.5, 33.34, 3000.0, 1e6])
def test_interval_inverts_the_noncentral_f_distribution(f):
    df1, df2, total = 19, 780, 800
    low, high = population_share(f, df1, df2, total)
    for share, level in ((low, 0.975), (high, 0.025)):
        if share > 0:
            noncentrality = share * total / (1 - share)
            assert stats.ncf.cdf(f, df1, df2, noncentrality) == pytest.approx(level, rel=1e-6)
    assert low < f * df1 / (f * df1 + df2)
    assert low < high


def test_no_effect_has_an_interval_from_zero():
    assert population_share(0.5, 19, 780, 800)[0] == 0


def test_shares_of_variance_hold_19_times_of_20():
    rng = np.random.default_rng(3)
    means, n = np.linspace(0, 1, 5), 12
    share = means.var() / (means.var() + 1)
    covered = []
    for values in rng.normal(means[:, None], 1, (500, 5, n)):
        f = n * values.mean(axis=1).var(ddof=1) / values.var(axis=1, ddof=1).mean()
        low, high = population_share(f, 4, 5 * (n - 1), 5 * n)
        covered.append(low <= share <= high)
    assert np.mean(covered) == pytest.approx(0.95, abs=0.03)
