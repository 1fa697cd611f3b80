import numpy as np
import pytest
from scipy import stats

from study.statistics.intervals import at_least, ratio_interval


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [(0.34, 0.4, "yes"), (0.2, 0.3, "no"), (0.3, 0.4, "undecided"), (np.nan, np.nan, "undecided")],
)
def test_an_interval_decides_or_does_not(low, high, verdict):
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
