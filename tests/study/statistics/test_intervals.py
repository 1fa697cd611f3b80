"""Intervals of means and ratios against scipy's, by coverage, and what they say of a bound."""

import warnings

import numpy as np
import pytest
from scipy import stats

from study.statistics.intervals import at_least, mean_interval, ratio_interval, t_quantile


@pytest.mark.parametrize("df", [1, 2, 7.5, 39, 10_000])
def test_quantile_is_of_both_sides(df):
    assert stats.t.cdf(t_quantile(df), df) == pytest.approx(0.975)
    assert stats.t.sf(-t_quantile(df), df) == pytest.approx(0.975)


@pytest.mark.parametrize("n", [2, 3, 40])
def test_interval_is_scipys(n):
    values = np.random.default_rng(n).normal(3, 0.1, n)
    mean, low, high = mean_interval(values)
    assert mean == pytest.approx(values.mean())
    assert (low, high) == pytest.approx(
        stats.t.interval(0.95, n - 1, loc=values.mean(), scale=stats.sem(values))
    )


def test_interval_covers_the_mean_19_times_of_20():
    covered = []
    for values in np.random.default_rng(1).normal(3, 0.1, (4000, 5)):
        _, low, high = mean_interval(values)
        covered.append(low <= 3 <= high)
    assert np.mean(covered) == pytest.approx(0.95, abs=0.012)


@pytest.mark.parametrize(("values", "mean"), [([], np.nan), ([3.5], 3.5), ([0.1, 0.1, 0.1], 0.1)])
def test_no_interval_without_spread(values, mean):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = mean_interval(np.array(values))
    assert found == pytest.approx((mean, np.nan, np.nan), nan_ok=True)


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [
        (0.4, 0.5, "yes"),
        (1 / 3, 0.5, "yes"),
        (np.nextafter(1 / 3, 0), 0.5, "undecided"),
        (0.2, 1 / 3, "undecided"),
        (0.2, np.nextafter(1 / 3, 0), "no"),
        (np.nan, np.nan, "undecided"),
    ],
)
def test_bounds(low, high, verdict):
    assert at_least(1 / 3, low, high) == verdict


def test_ratio_of_equal_sums_has_the_error_of_a_mean():
    rng = np.random.default_rng(1)
    reached = np.full(30, 1000)
    ended = rng.binomial(1000, 0.4, 30)
    rate, error, low, high = ratio_interval(ended, reached)
    shares = ended / 1000
    assert rate == pytest.approx(shares.mean())
    assert error == pytest.approx(stats.sem(shares))
    interval = stats.ttest_1samp(shares, 0).confidence_interval(0.95)
    assert (low, high) == pytest.approx((interval.low, interval.high))


def test_ratio_of_one_triangulation_has_no_error():
    assert np.isnan(ratio_interval(np.array([3]), np.array([9]))[1:]).all()
