import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from statsmodels.sandbox.stats.runs import runstest_1samp

from study.design.sampling import DISTRIBUTIONS, marginal_cdf, sample_points
from study.run.point_checks import (
    bins_with_distance,
    check_randomness,
    count_sides,
    kolmogorov_p_value,
    largest_distance,
    runs_p_value,
)
from study.run.ranks import Bins


@pytest.mark.parametrize("n_points", [4, 5, 50, 999, 1000, 1001, 40_000])
@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_checks_agree_with_scipy_and_statsmodels(distribution, n_points):
    points = sample_points(distribution, n_points, 0, seed=11)
    checks = check_randomness(points, distribution)
    for values, runs_p, ks_p in (
        (points[:, 0], checks.runs_p_x, checks.ks_p_x),
        (points[:, 1], checks.runs_p_y, checks.ks_p_y),
    ):
        median = np.median(values)
        kept = values[values != median]
        assert runs_p == pytest.approx(runstest_1samp(kept, median, correction=False)[1], rel=1e-9)
        expected = stats.kstest(values, marginal_cdf(distribution)).pvalue
        assert ks_p == pytest.approx(expected, abs=2.1e-5)


def kolmogorov_distance(values, cdf):
    bins = Bins.of(values)
    taken, ranks = bins.take(bins_with_distance(bins, cdf))
    return largest_distance(cdf(taken), ranks, len(values))


@settings(deadline=None, max_examples=200)
@given(
    st.lists(
        st.floats(-0.5, 1.5) | st.sampled_from([0.0, 0.25, 0.25, 1.0]), min_size=1, max_size=9
    ).flatmap(lambda head: st.tuples(st.just(head), st.integers(1, 60), st.floats(0.2, 5)))
)
def test_distance_is_exact_with_ties_and_poor_fits(drawn):
    head, repeats, power = drawn
    values = np.r_[np.tile(head, repeats), np.linspace(0, 1, 5000) ** power]
    cdf = marginal_cdf("uniform")
    expected = stats.kstest(values, cdf).statistic
    assert kolmogorov_distance(values, cdf) == pytest.approx(expected, rel=0, abs=1e-15)


@pytest.mark.parametrize("n_points", [1, 2, 63, 4095, 4096, 200_000])
@pytest.mark.parametrize("seed", range(3))
def test_distance_needs_few_evaluations(n_points, seed):
    values = sample_points("normal", n_points, 0, seed=seed)[:, 0].copy()
    evaluated = 0

    def cdf(x):
        nonlocal evaluated
        evaluated += x.size
        return marginal_cdf("normal")(x)

    distance = kolmogorov_distance(values, cdf)
    assert distance == pytest.approx(stats.kstest(values, "norm").statistic, rel=0, abs=1e-16)
    assert evaluated <= n_points + n_points // 32 + 2
    if n_points == 200_000:
        assert evaluated < 0.1 * n_points


@pytest.mark.parametrize("n", [1000, 10_000, 200_000])
def test_p_values_of_many_points_are_within_the_stated_error(n):
    distances = np.linspace(0.3, 2.5, 40) / np.sqrt(n)
    ours = [kolmogorov_p_value(distance, n) for distance in distances]
    np.testing.assert_allclose(ours, stats.kstwo.sf(distances, n), rtol=0, atol=2.1e-5)


def runs_p(values, median):
    return runs_p_value(count_sides(values, median))


def test_runs_as_expected_give_p_of_one():
    # 2 + 2 values on the sides of the median are expected to make 3 runs.
    assert runs_p(np.array([1.0, 2.0, 2.5, 4.0, 3.0, 0.0]), 2.75) < 1
    assert runs_p(np.array([0.0, 3.0, 2.0, 1.0]), 1.5) == 1.0


def test_values_equal_to_the_median_are_left_out():
    values = np.array([0.0, 5.0, 1.0, 5.0, 9.0, 8.0, 2.0, 5.0, 7.0])
    assert runs_p(values, 5.0) == runs_p(values[values != 5.0], 5.0)


def test_order_that_is_not_random_is_found():
    n = 2000
    ascending = np.arange(n, dtype=float)
    assert runs_p(ascending, (n - 1) / 2) < 1e-100
    alternating = np.tile([0.0, 1.0], n // 2)
    assert runs_p(alternating, 0.5) < 1e-100


def test_too_few_values_have_no_runs_test():
    assert np.isnan(runs_p(np.array([1.0, 2.0, 3.0]), 2.0))
    assert np.isnan(runs_p(np.ones(50), 1.0))
