"""Games-Howell pairs against scipy's."""

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


def test_every_pair_is_in_the_table(study):
    frame = study[2]["pairs"].frame
    sizes = study[0].sizes
    assert len(frame) == 4 * len(sizes) * (len(sizes) - 1) // 2
    assert (frame["n_points_1"] < frame["n_points_2"]).all()
    excludes_zero = (frame["low"] > 0) | (frame["high"] < 0)
    assert (excludes_zero == (frame["different"] == "yes")).all()
    means = study[2]["groups"].frame.set_index(["method", "distribution", "n_points"])["mean_lepp"]
    for row in frame.itertuples():
        gap = means[row.method, row.distribution, row.n_points_2]
        gap -= means[row.method, row.distribution, row.n_points_1]
        assert row.difference == pytest.approx(gap)
