"""Intervals of differences and of effects: what share of them holds the truth."""

import numpy as np
import pytest
from scipy import stats

from study.statistics.effect_size import population_share
from study.statistics.games_howell import games_howell
from study.statistics.groups import Groups
from study.statistics.studentized_range import studentized_range_tail

MEANS = np.linspace(0, 3, 6)
SPREADS = np.linspace(0.5, 2, 6)
COUNTS = [12, 20, 10, 15, 20, 12]


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


def test_games_howell_interval_is_without_zero_where_p_is_below_a_twentieth():
    rng = np.random.default_rng(4)
    values = tuple(rng.normal(m, s, n) for m, s, n in zip(MEANS, SPREADS, COUNTS, strict=True))
    difference, half, p = games_howell(Groups(np.arange(6), values), *np.triu_indices(6, 1))
    told = abs(difference) > half
    assert (told == (p < 0.05)).all()
    assert set(told) == {True, False}


def test_games_howell_pairs_of_many_groups_are_scipys():
    rng = np.random.default_rng(2)
    values = tuple(rng.normal(3, 0.01 * (1 + k), 6 + k) for k in range(4))
    groups = Groups(np.arange(4), values)
    first, second = np.triu_indices(4, 1)
    difference, half, p = games_howell(groups, first, second)
    for i, j, d, h, q in zip(first, second, difference, half, p, strict=True):
        one, other = values[i], values[j]
        a, b = one.var(ddof=1) / len(one), other.var(ddof=1) / len(other)
        df = (a + b) ** 2 / (a**2 / (len(one) - 1) + b**2 / (len(other) - 1))
        error = np.sqrt((a + b) / 2)
        assert d == pytest.approx(other.mean() - one.mean())
        assert q == pytest.approx(stats.studentized_range.sf(abs(d) / error, 4, df), abs=1e-6)
        assert h == pytest.approx(stats.studentized_range.isf(0.05, 4, df) * error, rel=1e-5)


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
