import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

import lepp

sizes = st.lists(st.integers(1, 60), min_size=2, max_size=200).map(np.array)


@given(sizes)
def test_moments_are_those_of_scipy(sizes):
    counts = lepp.LeppCounts.from_sizes(sizes)
    assert counts.count == len(sizes)
    assert counts.max == sizes.max()
    assert counts.mean == pytest.approx(sizes.mean())
    assert counts.sd == pytest.approx(sizes.std())
    if len(set(sizes.tolist())) > 1:
        assert counts.skewness == pytest.approx(stats.skew(sizes), abs=1e-9)
        assert counts.kurtosis == pytest.approx(stats.kurtosis(sizes), abs=1e-9)
    else:
        assert np.isnan(counts.skewness)
        assert np.isnan(counts.kurtosis)


@given(sizes, sizes)
def test_counts_add_up(a, b):
    total = lepp.LeppCounts.from_sizes(a) + lepp.LeppCounts.from_sizes(b)
    assert total == lepp.LeppCounts.from_sizes(np.concatenate((a, b)))
    assert total.mean == lepp.LeppCounts.from_sizes(np.concatenate((b, a))).mean


@given(sizes)
def test_termination_rates(sizes):
    rates = lepp.LeppCounts.from_sizes(sizes).termination_rates
    for s in range(1, sizes.max() + 1):
        assert rates[s] == (sizes == s).sum() / (sizes >= s).sum()


def test_geometric_sizes_have_the_moments_of_theorem_1():
    p = 0.4
    k = np.arange(2, 200)
    counts = np.zeros(200, np.int64)
    counts[2:] = np.round(1e15 * lepp.theory.probability(k, p)).astype(np.int64)
    counts = lepp.LeppCounts(counts)
    assert counts.mean == pytest.approx(lepp.theory.mean(p))
    assert counts.sd == pytest.approx(lepp.theory.sd(p))
    assert counts.skewness == pytest.approx(lepp.theory.skewness(p))
    assert counts.kurtosis == pytest.approx(lepp.theory.kurtosis(p), abs=1e-6)
    assert counts.termination_rates[2:20] == pytest.approx(p)


def test_bounds_of_theorem_2():
    assert lepp.theory.bounds() == ((2.0, pytest.approx(4.0)), (0.0, pytest.approx(np.sqrt(6))))


def test_impossible_counts_are_refused():
    with pytest.raises(ValueError, match="integers"):
        lepp.LeppCounts(np.array([1, -1]))
    assert np.isnan(lepp.LeppCounts(np.zeros(3, int)).mean)
