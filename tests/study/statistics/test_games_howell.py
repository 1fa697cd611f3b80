"""Games-Howell comparisons against scipy's, and by how often equal means are told apart."""

import numpy as np
import pytest
from scipy import stats

from study.statistics.games_howell import games_howell
from study.statistics.groups import Groups
from study.statistics.studentized_range import studentized_range_tail

MEANS = np.linspace(0, 3, 6)
SPREADS = np.linspace(0.5, 2, 6)
COUNTS = [12, 20, 10, 15, 20, 12]


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


def test_no_pair_of_equal_means_is_told_apart_19_times_of_20():
    # the critical value takes long: here p only, which is below 5 % where an interval is without 0
    rng = np.random.default_rng(1)
    first, second = np.triu_indices(6, 1)
    q, df = [], []
    for _ in range(400):
        values = [rng.normal(0, s, n) for s, n in zip(SPREADS, COUNTS, strict=True)]
        means = np.array([v.mean() for v in values])
        errors = np.array([v.var(ddof=1) / len(v) for v in values])
        a, b = errors[first], errors[second]
        n = np.array(COUNTS)
        q.append(abs(means[first] - means[second]) / np.sqrt((a + b) / 2))
        df.append((a + b) ** 2 / (a**2 / (n[first] - 1) + b**2 / (n[second] - 1)))
    p = studentized_range_tail(np.concatenate(q), 6, np.concatenate(df)).reshape(400, -1)
    assert ((p < 0.05).any(axis=1)).mean() == pytest.approx(0.05, abs=0.03)


def test_interval_is_without_zero_where_p_is_below_a_twentieth():
    rng = np.random.default_rng(4)
    values = tuple(rng.normal(m, s, n) for m, s, n in zip(MEANS, SPREADS, COUNTS, strict=True))
    difference, half, p = games_howell(Groups(np.arange(6), values), *np.triu_indices(6, 1))
    told = abs(difference) > half
    assert (told == (p < 0.05)).all()
    assert set(told) == {True, False}
