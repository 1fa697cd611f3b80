"""Games-Howell comparisons against scipy's."""

import numpy as np
import pytest
from scipy import stats

from study.statistics.games_howell import games_howell
from study.statistics.groups import Groups


@pytest.fixture(scope="module")
def three():
    rng = np.random.default_rng(8)
    return tuple(rng.normal(3 + 0.1 * i, 0.1 * (i + 1), 8 + 2 * i) for i in range(3))


def test_pairs_are_scipys(three):
    groups = Groups(np.array([1, 2, 3]), three)
    first, second = np.array([0, 0, 1]), np.array([1, 2, 2])
    difference, half, p = games_howell(groups, first, second)
    expected = stats.tukey_hsd(*three, equal_var=False)
    interval = expected.confidence_interval(0.95)
    np.testing.assert_allclose(difference, expected.statistic[second, first])
    np.testing.assert_allclose(p, expected.pvalue[second, first], atol=1e-7)
    np.testing.assert_allclose(difference - half, interval.low[second, first], atol=1e-6)
    np.testing.assert_allclose(difference + half, interval.high[second, first], atol=1e-6)


def test_two_groups_are_welchs_t_test(three):
    groups = Groups(np.array([1, 2]), three[:2])
    _, _, p = games_howell(groups, np.array([0]), np.array([1]))
    assert p[0] == pytest.approx(stats.ttest_ind(*three[:2], equal_var=False).pvalue, abs=1e-8)
