"""The rates at which paths go on, and the laws fitted to them, by other routes."""

import numpy as np
import pytest
import statsmodels.api as sm
from scipy import optimize, stats

from study.statistics.continuation import (
    continuation,
    fit_constant,
    fit_power,
    longest_expected,
)
from study.statistics.groups import ENOUGH, NotEnough
from study.statistics.intervals import ratio_interval

TRUE = (0.9, 0.35, 0.5)


def law(k, scale=0.9, shift=0.35, nu=0.5):
    return scale / (k + shift) ** nu


def counts_of(rates, paths, triangulations, rng, clump=1):
    """Histograms of paths that go on with these rates, each path there `clump` times."""
    sizes = len(rates) + 3
    p = np.concatenate([[0, 0], np.append(1, np.cumprod(rates)) * np.append(1 - rates, 1)])
    counts = np.array([clump * rng.multinomial(paths // clump, p) for _ in range(triangulations)])
    return np.pad(counts, ((0, 0), (0, sizes - counts.shape[1])))


def drawn(curve, seed, groups=((2_000, 6), (8_000, 8), (40_000, 10)), clump=1, upto=12):
    rng = np.random.default_rng(seed)
    rates = curve(np.arange(2.0, upto))
    return [counts_of(rates, paths, r, rng, clump) for paths, r in groups]


def test_rates_by_hand():
    # two triangulations: 1 on the boundary, 4 of size 2, 3 of size 3, 1 of size 4; and twice that
    counts = np.array([[0, 1, 4, 3, 1], [0, 2, 8, 6, 2]])
    measured = continuation([counts])
    assert measured.sizes.tolist() == [2, 3, 4]
    assert measured.reached.tolist() == [24, 12, 3]
    assert measured.paths == 24
    assert measured.rates == pytest.approx([1 / 2, 1 / 4, 0])
    assert measured.df == 1
    assert measured.standard_errors == pytest.approx(0)  # the same rates in both


def test_errors_of_one_group_of_equal_path_counts_are_the_ratio_estimators():
    rng = np.random.default_rng(1)
    counts = counts_of(law(np.arange(2.0, 9)), 5_000, 12, rng)
    measured = continuation([counts])
    reached = counts[:, ::-1].cumsum(axis=1)[:, ::-1]
    for k, rate, error, half in zip(
        measured.sizes, measured.rates, measured.standard_errors, measured.half_widths, strict=True
    ):
        ended = ratio_interval(counts[:, k], reached[:, k])
        assert rate == pytest.approx(1 - ended[0])
        if error > 0:
            assert error == pytest.approx(ended[1])
            assert reached[:, k].sum() >= 1000 or np.isnan(half)
            if reached[:, k].sum() >= 1000:
                assert half == pytest.approx(stats.t.ppf(0.975, 11) * error)


@pytest.mark.parametrize("clump", [1, 5])
def test_covariance_is_that_of_repeated_draws(clump):
    groups = ((2_000, 3), (6_000, 4), (20_000, 5))
    every = [continuation(drawn(law, seed, groups, clump, upto=6)) for seed in range(600)]
    rates = np.array([one.rates[:4] for one in every])
    said = np.mean([one.covariance[:4, :4] for one in every], axis=0)
    seen = np.cov(rates.T)
    np.testing.assert_allclose(np.diag(said), np.diag(seen), rtol=0.2)
    binomial = rates.mean(0) * (1 - rates.mean(0)) / np.mean([one.reached[:4] for one in every], 0)
    np.testing.assert_allclose(np.diag(said) / binomial, clump, rtol=0.1)
    scale = np.sqrt(np.outer(np.diag(said), np.diag(said)))
    np.testing.assert_allclose(said / scale, np.eye(4), atol=0.1)  # these paths are independent


@pytest.mark.parametrize("triangulations", [ENOUGH - 1, ENOUGH])
def test_enough_triangulations_have_a_covariance_of_their_own(triangulations):
    rng = np.random.default_rng(7)
    rates = law(np.arange(2.0, 8))
    small = counts_of(rates, 4_000, 30, rng)
    large = counts_of(rates, 200_000, triangulations, rng, clump=40)
    measured = continuation([small, large])
    if triangulations < ENOUGH:
        assert measured.df == 29 + triangulations - 1
        return
    alone = continuation([large])
    assert measured.df == triangulations - 1
    assert measured.covariance.tolist() == alone.covariance.tolist()
    binomial = rates[0] * (1 - rates[0]) / measured.reached[0]
    assert measured.covariance[0, 0] / binomial > 15  # the small meshes would say 1


def test_correlated_rates_are_seen():
    # every path of size 3 or more comes with the path of its second triangle
    rng = np.random.default_rng(5)
    single = counts_of(law(np.arange(2.0, 7)), 4_000, 200, rng)
    both = single.copy()
    both[:, 2:-1] += single[:, 3:]
    covariance = continuation([both]).covariance
    correlation = covariance[:2, :2] / np.sqrt(np.outer(*[np.diag(covariance)[:2]] * 2))
    assert correlation[0, 1] > 0.3
    reached = both[:, ::-1].cumsum(axis=1)[:, ::-1].astype(float)
    rates = reached[:, 3:5] / reached[:, 2:4]
    assert correlation[0, 1] == pytest.approx(np.corrcoef(rates.T)[0, 1], abs=0.05)


def test_sure_rates_are_those_before_the_first_rough_one():
    measured = continuation(drawn(law, 3))
    sure = measured.sure()
    widths = 2 * measured.half_widths
    assert sure.sizes.tolist() == measured.sizes[: len(sure.sizes)].tolist()
    assert (widths[: len(sure.sizes)] < 0.05).all()
    assert not 0 < widths[len(sure.sizes)] < 0.05
    assert sure.covariance.shape == (len(sure.sizes), len(sure.sizes))
    assert len(continuation([drawn(law, 3)[-1][:1]]).sure().sizes) == 0  # no error known


def test_few_paths_of_one_bundle_have_no_interval():
    counts = np.array([[0, 0, 900, 99, 0, 0]] * 7 + [[0, 0, 500, 200, 100, 200]])
    measured = continuation([counts, 100 * counts])
    assert measured.standard_errors[2] == pytest.approx(0)
    small = continuation([counts])
    assert small.reached.tolist() == [7993, 1193, 300, 200]
    assert np.isnan(small.half_widths).tolist() == [False, False, True, True]


def test_no_step_is_not_enough():
    with pytest.raises(NotEnough, match="no path takes a step"):
        continuation([np.array([[0, 5]])])
    two = np.array([[0, 1, 50, 50], [0, 1, 60, 40]])
    with pytest.raises(NotEnough, match="known to within"):
        fit_constant(continuation([two]))
    with pytest.raises(NotEnough, match="4 or more sizes"):
        fit_power(continuation([two]))


@pytest.mark.parametrize(("triangulations", "sizes"), [(4, 2), (10, 6), (13, 8)])
def test_sizes_are_no_more_than_a_third_of_the_degrees_of_freedom(triangulations, sizes):
    measured = continuation(drawn(law, 3, ((900_000, triangulations), (900_000, triangulations))))
    assert measured.df == 2 * triangulations - 2
    assert len(measured.sure().sizes) > sizes
    assert fit_constant(measured).sizes.tolist() == list(range(2, 2 + sizes))


@pytest.mark.parametrize("triangulations", [2, 3])
def test_few_triangulations_are_not_enough(triangulations):
    measured = continuation(drawn(law, 3, ((900_000, triangulations), (900_000, triangulations))))
    with pytest.raises(NotEnough, match=r"there are [01]$"):
        fit_constant(measured)


def test_triangulations_that_differ_in_one_way_are_not_enough():
    base = np.array([0, 10, 1200, 600, 150, 30, 6])
    counts = np.array([200 * base + k for k in range(12)])
    with pytest.raises(NotEnough, match="do not differ enough"):
        fit_constant(continuation([counts]))


def clustered(seed):
    """Rates that are correlated: paths together with those of their second triangles."""
    groups = drawn(law, seed, ((100_000, 8), (400_000, 8)))
    for counts in groups:
        counts[:, 2:-1] += counts[:, 3:]
    measured = continuation(groups).sure()
    return measured.first(measured.df // 3)


def inflation(measured, q):
    m = measured.df
    return m * (m - 1) / ((m - q) * (m - q - 1))


def test_constant_rate_is_generalised_least_squares():
    measured = clustered(2)
    fitted = fit_constant(measured)
    q = len(measured.rates) - 1
    other = sm.GLS(measured.rates, np.ones(q + 1), sigma=measured.covariance).fit()
    assert fitted.coefficients == pytest.approx(other.params)
    assert fitted.chi_squared == pytest.approx(other.ssr)
    error = other.bse[0] / np.sqrt(other.scale) * np.sqrt(inflation(measured, q))
    assert fitted.standard_errors == pytest.approx([error])
    assert fitted.df == q
    assert fitted.curve(np.array([2, 50])) == pytest.approx([other.params[0]] * 2)
    f = other.ssr * (measured.df - q + 1) / (measured.df * q)
    p = stats.f.logsf(f, q, measured.df - q + 1) / np.log(10)
    assert fitted.log10_p == pytest.approx(p)


def test_power_law_is_curve_fits():
    measured = clustered(7)
    fitted = fit_power(measured)
    q = len(measured.rates) - 3
    values, covariance = optimize.curve_fit(
        law, measured.sizes, measured.rates, p0=TRUE, sigma=measured.covariance,
        absolute_sigma=True,
    )  # fmt: skip
    assert fitted.coefficients == pytest.approx(values, rel=1e-4)
    errors = np.sqrt(np.diag(covariance) * inflation(measured, q))
    assert fitted.standard_errors == pytest.approx(errors, rel=1e-3)
    left = measured.rates - law(measured.sizes, *values)
    chi_squared = left @ np.linalg.inv(measured.covariance) @ left
    assert fitted.chi_squared == pytest.approx(chi_squared, rel=1e-6)
    assert fitted.df == q
    assert fitted.curve(measured.sizes) == pytest.approx(law(measured.sizes, *values), rel=1e-6)


def test_the_law_that_was_drawn_from_comes_back():
    scores, p = [], []
    for seed in range(60):
        fitted = fit_power(continuation(drawn(law, seed, ((50_000, 8), (200_000, 8)))))
        scores.append((fitted.coefficients[2] - TRUE[2]) / fitted.standard_errors[2])
        p.append(10**fitted.log10_p)
    assert abs(np.mean(scores)) < 3 / np.sqrt(60)
    assert 0.75 < np.std(scores) < 1.3
    assert stats.kstest(p, "uniform").pvalue > 0.01


def test_p_is_even_for_constant_rates_and_few_triangulations():
    def level(k):
        return np.full(len(k), 0.55)

    p = []
    for seed in range(400):
        measured = continuation(drawn(level, seed, ((9_000, 6), (30_000, 6)))).sure()
        p.append(10 ** fit_constant(measured).log10_p)
    assert stats.kstest(p, "uniform").pvalue > 0.01
    assert 0.02 < np.mean(np.array(p) < 0.05) < 0.09


def test_each_law_is_rejected_where_the_other_holds():
    falling = continuation(drawn(law, 2, ((50_000, 20), (200_000, 40)))).sure()
    assert fit_constant(falling).log10_p < -10
    assert fit_power(falling).log10_p > -2

    def bent(k):
        return law(k) + 0.01 * (k % 2)

    other = continuation(drawn(bent, 1, ((50_000, 20), (200_000, 40)))).sure()
    assert fit_power(other).log10_p < -10


def test_shift_that_is_not_determined():
    def steep(k):
        return 0.9 * np.exp(-0.02 * k**2)

    with pytest.raises(NotEnough, match="do not determine"):
        fit_power(continuation(drawn(steep, 1, ((50_000, 8), (200_000, 8)))))


@pytest.mark.parametrize(("rate", "paths"), [(0.5, 10**6), (0.585, 16 * 10**6), (0.1, 50)])
def test_longest_of_a_geometric_law(rate, paths):
    # paths (rate)^(k - 1) are longer than k
    expected = np.floor(1 - np.log(paths) / np.log(rate)) + 1
    assert longest_expected(lambda k: rate + 0 * k, paths) == expected


def test_longest_by_summing_the_law():
    k = np.arange(2, 60)
    longer = 10**7 * np.cumprod(law(k))
    assert longest_expected(law, 10**7) == k[longer < 1][0]
    assert longest_expected(lambda k: 1.0 + 0 * k, 10) is None
