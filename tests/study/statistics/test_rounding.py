"""What rounding leaves open: bounds that no data leave, and that some data reach."""

import numpy as np
import pytest
from scipy import optimize, stats
from statsmodels.regression.linear_model import OLS

from study.statistics.models import LINEAR_MODELS
from study.statistics.rounding import RoundedGroups, RoundedRegression, by_logit

MODELS = {model.name: model for model in LINEAR_MODELS} | {"analysis of variance": None}


def groups(mean_half=5e-4, sd_half=5e-4):
    return RoundedGroups(
        x=np.array([10.0, 20.0, 50.0, 80.0, 160.0]),
        means=np.array([3.048, 3.051, 3.058, 3.055, 3.066]),
        sds=np.array([0.012, 0.009, 0.006, 0.006, 0.004]),
        mean_half=mean_half,
        sd_half=sd_half,
        count=8,
    )


def values_of(made, rng, means=None, sds=None):
    """Values whose means and standard deviations are given, or anywhere in the box."""
    k = len(made.x)
    means = made.means + rng.uniform(-1, 1, k) * made.mean_half if means is None else means
    sds = made.sds + rng.uniform(-1, 1, k) * made.sd_half if sds is None else sds
    # heavy tails as well as none: the bounds hold for any values
    drawn = rng.standard_t(1.5, (k, made.count)) if rng.random() < 0.5 else rng.random((k, 8))
    return means[:, None] + sds[:, None] * stats.zscore(drawn, axis=1, ddof=1)


def fitted(made, model, values):
    """F, adjusted R squared and coefficients by statsmodels."""
    if model is None:
        return stats.f_oneway(*values).statistic, None, None
    x = np.repeat(made.x, made.count)
    fit = OLS(model.transform(values.ravel()), model.basis(x)).fit()
    return fit.fvalue, fit.rsquared_adj, fit.params


@pytest.mark.parametrize("name", MODELS)
def test_no_data_that_round_so_leave_the_bounds(name):
    made, model = groups(), MODELS[name]
    of = RoundedRegression(made, model)
    low, high = of.f_range()
    rng = np.random.default_rng(1)
    for _ in range(300):
        f, r2, params = fitted(made, model, values_of(made, rng))
        assert low <= f <= high
        if model is None:
            continue
        assert of.adjusted_r2(f) == pytest.approx(r2)
        for term, value in enumerate(params):
            least, most = of.coefficient_range(term)
            assert least <= value <= most


@pytest.mark.parametrize("name", MODELS)
def test_bounds_are_as_tight_as_a_search_of_the_box_says(name):
    made, model = groups(5e-5, 5e-5), MODELS[name]
    of = RoundedRegression(made, model)
    k = len(made.x)
    printed = np.concatenate([made.means, made.sds])
    box = [(value - 5e-5, value + 5e-5) for value in printed]

    def search(side):
        return side * optimize.minimize(
            lambda at: -side * of.f(at[:k], at[k:]), printed, bounds=box, method="Nelder-Mead",
            options={"maxfev": 4000, "xatol": 1e-9},
        ).fun * -1  # fmt: skip

    low, high = of.f_range()
    attained = made.attained(of.f)
    searched = search(-1), search(1)
    assert low <= attained[0] <= searched[0] * (1 + 1e-6)
    assert high >= attained[1] >= searched[1] * (1 - 1e-6)
    if name != "logistic":  # of which the spread inside the groups is not fixed
        assert (low, high) == pytest.approx(attained, rel=2e-3)


@pytest.mark.parametrize("name", MODELS)
def test_attained_values_are_of_data_that_round_so(name):
    made, model = groups(), MODELS[name]
    of = RoundedRegression(made, model)
    # the made-up data: two values in each group
    means, sds = made.means + made.mean_half, made.sds - made.sd_half
    half = sds * np.sqrt(7 / 8)
    values = np.repeat(np.column_stack([means - half, means + half]), 4, axis=1)
    assert values.mean(axis=1) == pytest.approx(means)
    assert values.std(axis=1, ddof=1) == pytest.approx(sds)
    f, _, params = fitted(made, model, values)
    assert of.f(means, sds) == pytest.approx(f)
    for term, value in enumerate(() if model is None else params):
        assert of.coefficient(term)(means, sds) == pytest.approx(value)


def test_coefficients_reach_their_bounds():
    made = groups()
    for model in LINEAR_MODELS:
        of = RoundedRegression(made, model)
        for term in range(len(model.terms)):
            bounds, attained = of.coefficient_range(term), made.attained(of.coefficient(term))
            width = bounds[1] - bounds[0]
            off = 0.2 if model.name == "logistic" else 1e-5
            assert attained == pytest.approx(bounds, abs=off * width)


def test_without_rounding_there_is_one_value():
    made = groups(0.0, 0.0)
    for model in (None, LINEAR_MODELS[0], LINEAR_MODELS[1], LINEAR_MODELS[3]):
        of = RoundedRegression(made, model)
        f = of.f(made.means, made.sds)
        assert of.f_range() == pytest.approx((f, f), rel=1e-6)


def test_coarse_rounding_leaves_everything_open():
    low, high = RoundedRegression(groups(0.1, 0.004)).f_range()
    assert low == 0
    assert high > 100
    # nothing inside the groups, and all of the means on a line: F has no bound
    assert RoundedRegression(groups(0.1, 0.012), LINEAR_MODELS[0]).f_range() == (0.0, np.inf)


def test_t_is_bounded_at_corners():
    made = groups()
    low, high = made.t_range(0, 4)
    corners = [
        (3.048 + i * 5e-4 - 4) / ((0.012 + j * 5e-4) / np.sqrt(8)) for i in (-1, 1) for j in (-1, 1)
    ]
    assert (low, high) == pytest.approx((min(corners), max(corners)))
    t = made.t_statistic(0, 4)(made.means, made.sds)
    values = values_of(made, np.random.default_rng(0), made.means, made.sds)[0]
    assert t == pytest.approx(stats.ttest_1samp(values, 4).statistic)


def test_means_of_logits_lie_between_taylors_bounds():
    made, n = groups(), 8
    bounds = []
    for side in (-1, 1):
        m, s = made.means + side * made.mean_half, made.sds + side * made.sd_half
        # No value lies further out than this, where the second derivative is the least or largest.
        y = m + side * (made.sds + made.sd_half) * (n - 1) / np.sqrt(n)
        second = 1 / (4 - y) ** 2 - 1 / y**2
        bounds.append(np.log(m / (4 - m)) + second * s**2 * (n - 1) / n / 2)
    found = by_logit(made)
    np.testing.assert_allclose(found.center - found.half, bounds[0], rtol=1e-12)
    np.testing.assert_allclose(found.center + found.half, bounds[1], rtol=1e-12)


def test_logits_need_values_between_two_and_four():
    made = groups()
    wide = RoundedGroups(made.x, made.means, made.sds + 0.5, 5e-4, 5e-4, 8)
    with pytest.raises(ValueError, match="between 2 and 4"):
        RoundedRegression(wide, MODELS["logistic"]).f_range()
