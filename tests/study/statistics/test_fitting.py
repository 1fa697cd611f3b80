"""Fits against statsmodels and scipy, by simulation, and at the edges of what can be fitted."""

import numpy as np
import pytest
from scipy import optimize, stats
from statsmodels.regression.linear_model import OLS, WLS

from study.statistics.fitting import (
    Observations,
    fit_linear,
    fit_saturating,
    leave_one_group_out,
)
from study.statistics.groups import Groups, NotEnough
from study.statistics.models import LINEAR_MODELS, SATURATING
from study.statistics.variance_function import smooth_variances

LINEAR, QUADRATIC, LOGISTIC, LOGARITHMIC = LINEAR_MODELS
SIZES = np.array([10, 20, 40, 80, 160, 320]) * 1000
COUNTS = [12, 9, 12, 6, 15, 12]


def made(truth, seed=1, noise=0.05, sizes=SIZES, counts=COUNTS):
    """Groups about a curve of thousands of points, with less spread the more points."""
    rng = np.random.default_rng(seed)
    values = (
        truth(n / 1000) + rng.normal(0, noise / np.sqrt(n / 1000), count)
        for n, count in zip(sizes, counts, strict=True)
    )
    return Groups(np.array(sizes), tuple(values))


def logarithm(x):
    return 3.0 + 0.01 * np.log2(x)


def saturation(x):
    return 3.1 - 0.4 * x**-0.5


def weights_of(groups, transform=lambda y: y):
    """Reciprocal variances, a power of the size, a value a triangulation."""
    changed = Groups(groups.n_points, tuple(transform(values) for values in groups.values))
    return np.repeat(1 / smooth_variances(changed), groups.counts)


# Observations


def test_observations():
    groups = made(logarithm)
    seen = Observations.of(groups, weighted=True)
    assert seen.x.tolist() == np.repeat(SIZES / 1000, COUNTS).tolist()
    assert seen.y.tolist() == np.concatenate(groups.values).tolist()
    assert seen.group.tolist() == np.repeat(np.arange(6), COUNTS).tolist()
    np.testing.assert_allclose(seen.group_means(seen.y), [v.mean() for v in groups.values])
    np.testing.assert_allclose(seen.weights(seen.y**2), weights_of(groups, np.square))
    plain = Observations.of(groups, weighted=False)
    assert plain.weights(seen.y).tolist() == [1.0] * sum(COUNTS)


def test_weights_need_a_variance():
    none = Groups(np.array([1000]), (np.array([3.0]),))
    with pytest.raises(NotEnough, match="no size has two or more differing"):
        Observations.of(none, weighted=True)


# Linear models


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("model", LINEAR_MODELS, ids=lambda model: model.name)
def test_linear_fits_are_statsmodels(model, weighted):
    groups = made(logarithm)
    x, y = np.repeat(SIZES / 1000, COUNTS), np.concatenate(groups.values)
    columns = {
        "linear": [x],
        "quadratic": [x, x**2],
        "logistic": [x],
        "logarithmic": [np.log2(x)],
    }[model.name]
    basis = np.column_stack([np.ones_like(x), *columns])

    def transform(y):
        return np.log(y / (4 - y)) if model.name == "logistic" else y

    def inverse(z):
        return 4 / (1 + np.exp(-z)) if model.name == "logistic" else z

    w = weights_of(groups, transform) if weighted else np.ones(len(x))
    expected = WLS(transform(y), basis, weights=w).fit()
    fit = fit_linear(model, Observations.of(groups, weighted))
    n, k = basis.shape
    assert fit.df_residual == n - k
    np.testing.assert_allclose(fit.coefficients, expected.params)
    np.testing.assert_allclose(fit.standard_errors, expected.bse)
    np.testing.assert_allclose(fit.intervals, expected.conf_int().T)
    at = np.array([1.0, 1000.0])
    at_columns = {"linear": [at], "quadratic": [at, at**2], "logistic": [at]}
    at_basis = np.column_stack([np.ones(2), *at_columns.get(model.name, [np.log2(at)])])
    frame = expected.get_prediction(at_basis).summary_frame()
    np.testing.assert_allclose(fit.predict(at), inverse(frame["mean"]))
    np.testing.assert_allclose(
        fit.predict_interval(at), [inverse(frame["mean_ci_lower"]), inverse(frame["mean_ci_upper"])]
    )
    quality = fit.quality()
    assert quality["adj_r2"] == pytest.approx(expected.rsquared_adj)
    assert quality["f"] == pytest.approx(expected.fvalue)
    assert (quality["df_model"], quality["df_residual"]) == (k - 1, n - k)
    assert quality["p"] == pytest.approx(expected.f_pvalue)
    assert quality["log10_p"] == pytest.approx(np.log10(expected.f_pvalue))
    # lack of fit: the model is nested in one with a mean of its own for each group
    each = WLS(transform(y), (x[:, None] == np.unique(x)).astype(float), weights=w).fit()
    f, p, _ = each.compare_f_test(expected)
    assert (quality["lack_of_fit_f"], quality["lack_of_fit_p"]) == pytest.approx((f, p))


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("model", [LOGISTIC, LOGARITHMIC, SATURATING], ids=lambda m: m.name)
def test_information_is_of_the_likelihood_of_y(model, weighted):
    groups = made(saturation)
    seen = Observations.of(groups, weighted)
    fit = (fit_saturating if model is SATURATING else fit_linear)(model, seen)
    w = weights_of(groups) if weighted else np.ones(len(seen.y))
    residuals = seen.y - fit.predict(seen.x)
    # 1 / w are the variances, which count as known; without weights, one at its most likely
    sigma = 1 / np.sqrt(w) if weighted else np.sqrt(np.mean(residuals**2))
    likelihood = stats.norm.logpdf(residuals, 0, sigma).sum()
    parameters = len(fit.coefficients) + (not weighted)
    quality = fit.quality()
    assert quality["aic"] == pytest.approx(2 * parameters - 2 * likelihood)
    assert quality["bic"] == pytest.approx(parameters * np.log(len(w)) - 2 * likelihood)
    assert quality["rmse"] == pytest.approx(np.sqrt(np.mean(residuals**2)))


def test_no_lack_of_fit_without_more_sizes_than_coefficients_or_without_spread():
    two = made(logarithm, sizes=SIZES[:2], counts=[5, 5])
    assert "lack_of_fit_f" not in fit_linear(LINEAR, Observations.of(two, False)).quality()
    three = made(logarithm, sizes=SIZES[:3], counts=[5, 5, 5])
    assert "lack_of_fit_f" in fit_linear(LINEAR, Observations.of(three, False)).quality()
    single = made(logarithm, sizes=SIZES, counts=[1] * 6)
    assert "lack_of_fit_f" not in fit_linear(LINEAR, Observations.of(single, False)).quality()
    equal = Groups(SIZES[:3], tuple(np.full(3, v) for v in (3.0, 3.5, 3.25)))
    assert "lack_of_fit_f" not in fit_linear(LINEAR, Observations.of(equal, False)).quality()


def test_intervals_of_predictions_cover_the_curve():
    at = np.array([1000.0])
    covered = []
    for seed in range(400):
        groups = made(logarithm, seed, noise=0.0)
        rng = np.random.default_rng(seed)
        noisy = tuple(v + rng.normal(0, 0.02, len(v)) for v in groups.values)
        fit = fit_linear(LOGARITHMIC, Observations.of(Groups(SIZES, noisy), False))
        low, high = fit.predict_interval(at)
        covered.append(low[0] <= logarithm(1000.0) <= high[0])
    assert np.mean(covered) == pytest.approx(0.95, abs=0.03)


# The saturating model


@pytest.mark.parametrize("weighted", [False, True])
def test_saturating_fit_is_scipys(weighted):
    groups = made(saturation)
    seen = Observations.of(groups, weighted)
    fit = fit_saturating(SATURATING, seen)
    w = weights_of(groups) if weighted else np.ones(len(seen.y))
    expected, covariance = optimize.curve_fit(
        lambda x, c, a, b: c - a * x**-b, seen.x, seen.y, p0=(3.1, 0.4, 0.5),
        sigma=1 / np.sqrt(w), xtol=1e-14, ftol=1e-14,
        jac=lambda x, c, a, b: np.column_stack((x**0, -(x**-b), a * x**-b * np.log(x))),
    )  # fmt: skip
    np.testing.assert_allclose(fit.coefficients, expected, rtol=1e-5)
    np.testing.assert_allclose(fit.covariance, covariance, rtol=1e-4)
    at = np.array([1000.0])
    slopes = np.array([1.0, -(1000.0 ** -expected[2]), 0.0])
    slopes[2] = -slopes[1] * expected[1] * np.log(1000.0)
    center = expected[0] - expected[1] * 1000.0 ** -expected[2]
    half = stats.t.isf(0.025, len(w) - 3) * np.sqrt(slopes @ covariance @ slopes)
    np.testing.assert_allclose(fit.predict(at), center, rtol=1e-8)
    np.testing.assert_allclose(
        np.ravel(fit.predict_interval(at)), [center - half, center + half], rtol=1e-6
    )


def test_saturating_estimates_of_honest_replications():
    # far from the ends of b, the linearised covariance is the spread of estimates
    estimates, errors = [], []
    rng = np.random.default_rng(3)
    for _ in range(200):
        values = tuple(saturation(n / 1000) + rng.normal(0, 1e-3, 12) for n in SIZES)
        fit = fit_saturating(SATURATING, Observations.of(Groups(SIZES, values), False))
        estimates.append(fit.coefficients)
        errors.append(fit.standard_errors)
    z = (np.array(estimates) - [3.1, 0.4, 0.5]) / errors
    np.testing.assert_allclose(np.sqrt((z**2).mean(axis=0)), 1, atol=0.15)


@pytest.mark.parametrize("b", [0.01, 0.3, 3.0])
def test_exponents_are_recovered(b):
    groups = made(lambda x: 3.1 - 0.4 * x**-b, noise=1e-6)
    fit = fit_saturating(SATURATING, Observations.of(groups, False))
    np.testing.assert_allclose(fit.coefficients, [3.1, 0.4, b], rtol=2e-2)


@pytest.mark.parametrize(
    ("b", "shows"), [(0.0019, False), (0.0021, True), (4.95, True), (5.05, False)]
)
def test_exponents_near_the_ends_of_what_is_looked_at_are_refused(b, shows):
    # half of the greatest, and twice the least
    groups = made(lambda x: 3.1 - 0.4 * x**-b, noise=0, sizes=SIZES // 10)
    seen = Observations.of(groups, False)
    if shows:
        assert fit_saturating(SATURATING, seen).coefficients[2] == pytest.approx(b, rel=1e-3)
    else:
        with pytest.raises(NotEnough, match="show no saturation"):
            fit_saturating(SATURATING, seen)


@pytest.mark.parametrize(
    "curve", [lambda x: 3 + 1e-3 * x, lambda x: 3.1 - 1e9 * x**-9.0, lambda x: 3.1 + 0.1 * (x > 10)]
)
def test_no_saturation(curve):
    with pytest.raises(NotEnough, match="show no saturation"):
        fit_saturating(SATURATING, Observations.of(made(curve, noise=1e-7), False))


@pytest.mark.parametrize("seed", range(5))
def test_a_limit_costs_one_parameter_at_most(seed):
    # a logarithm is the saturating model's own end: its AIC cannot be lower by more than 2
    for curve in (logarithm, saturation):
        seen = Observations.of(made(curve, seed), True)
        try:
            limited = fit_saturating(SATURATING, seen).quality()["aic"]
        except NotEnough:
            continue
        assert limited <= fit_linear(LOGARITHMIC, seen).quality()["aic"] + 2 + 1e-6


# Leaving groups out


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("model", [*LINEAR_MODELS, SATURATING], ids=lambda model: model.name)
def test_left_out_groups_are_predicted_by_fits_to_the_others(model, weighted):
    groups = made(saturation)
    x, y = np.repeat(SIZES / 1000, COUNTS), np.concatenate(groups.values)
    transform = getattr(model, "transform", lambda y: y)
    # what a weight is, all groups say together
    w = weights_of(groups, transform) if weighted else np.ones(len(x))
    errors = []
    for out in SIZES / 1000:
        kept, at = x != out, np.array([out])
        if model is SATURATING:
            found, _ = optimize.curve_fit(
                lambda x, c, a, b: c - a * x**-b, x[kept], y[kept], p0=(3.1, 0.4, 0.5),
                sigma=1 / np.sqrt(w[kept]), xtol=1e-14, ftol=1e-14,
            )  # fmt: skip
            predicted = found[0] - found[1] * at ** -found[2]
        else:
            fit = WLS(transform(y[kept]), model.basis(x[kept]), weights=w[kept]).fit()
            predicted = model.inverse(fit.predict(model.basis(at)))
        errors.append(predicted[0] - y[~kept].mean())
    expected = np.sqrt(np.mean(np.square(errors)))
    found = leave_one_group_out(model, Observations.of(groups, weighted))
    assert found == pytest.approx(expected, rel=1e-5)


# What is not enough


@pytest.mark.parametrize("model", [*LINEAR_MODELS, SATURATING], ids=lambda model: model.name)
def test_too_few(model):
    fit = fit_saturating if model is SATURATING else fit_linear
    k = len(model.terms)

    def observations(sizes, count):
        values = [saturation(2.0 ** np.arange(sizes))] * count
        return Observations.of(
            Groups(1000 * 2 ** np.arange(sizes), tuple(np.transpose(values))), False
        )

    with pytest.raises(NotEnough, match=f"needs {k} sizes, not {k - 1}"):
        fit(model, observations(k - 1, 5))
    with pytest.raises(NotEnough, match=f"needs {k + 1} triangulations, not {k}"):
        fit(model, observations(k, 1))
    assert fit(model, observations(k, 2)).df_residual == k
    with pytest.raises(NotEnough, match=f"leaving a size out needs {k + 1} sizes, not {k}"):
        leave_one_group_out(model, observations(k, 2))
    assert leave_one_group_out(model, observations(k + 1, 2)) >= 0
    equal = Groups(1000 * 2 ** np.arange(k + 1), (np.full(3, 3.0),) * (k + 1))
    with pytest.raises(NotEnough, match="all mean LEPP sizes are equal"):
        fit(model, Observations.of(equal, False))


def test_means_of_four_or_more_have_no_logistic_model():
    for top, fits in [(3.999, True), (4.0, False), (5.0, False)]:
        groups = Groups(
            SIZES[:3], (np.array([3.0, 3.1]), np.array([3.2, 3.1]), np.array([3.3, top]))
        )
        seen = Observations.of(groups, False)
        if fits:
            assert np.isfinite(fit_linear(LOGISTIC, seen).coefficients).all()
        else:
            for function in (fit_linear, leave_one_group_out):
                with pytest.raises(NotEnough, match="of 4 or more has no logistic"):
                    function(LOGISTIC, seen)
        assert len(fit_linear(LINEAR, seen).coefficients) == 2
        assert OLS(seen.y, LINEAR.basis(seen.x)).fit().params == pytest.approx(
            fit_linear(LINEAR, seen).coefficients
        )
