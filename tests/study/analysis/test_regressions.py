"""The regressions by numpy, scipy and formula, and from the published means."""

import numpy as np
import pytest
from frames import design, frames
from scipy import optimize, stats
from statsmodels.regression.linear_model import OLS, WLS

from study.analysis import analyse
from study.paper import published
from study.statistics.fitting import Observations, fit_saturating
from study.statistics.groups import Groups
from study.statistics.models import SATURATING


@pytest.fixture(scope="module")
def observed(study):
    """x, y and group of the uniform points by the incremental method."""
    _, (results, *_), _ = study
    chosen = (results["method"] == "incremental") & (results["distribution"] == "uniform")
    rows = results[chosen]
    return rows["n_points"].to_numpy() / 1000, rows["mean_lepp"].to_numpy()


def find(tables, table, **wanted):
    frame = tables[table].frame
    wanted = {"method": "incremental", "distribution": "uniform"} | wanted
    for column, value in wanted.items():
        frame = frame[frame[column] == value]
    return frame


def coefficients(tables, model, fitting="least squares"):
    return find(tables, "coefficients", model=model, fitting=fitting)["estimate"].to_numpy()


def test_linear_is_scipys(study, observed):
    found = stats.linregress(*observed)
    frame = find(study[2], "coefficients", model="linear", fitting="least squares")
    slope = frame.set_index("term").loc["b"]
    assert slope["estimate"] == pytest.approx(found.slope)
    assert slope["standard_error"] == pytest.approx(found.stderr)
    half = stats.t.isf(0.025, len(observed[0]) - 2) * found.stderr
    assert (slope["low"], slope["high"]) == pytest.approx((found.slope - half, found.slope + half))
    row = find(study[2], "regressions", model="linear", fitting="least squares").iloc[0]
    assert row["p"] == pytest.approx(found.pvalue)
    assert 10 ** row["log10_p"] == pytest.approx(found.pvalue)


def test_quadratic_and_logarithmic_are_numpys(study, observed):
    x, y = observed
    assert coefficients(study[2], "quadratic") == pytest.approx(np.polyfit(x, y, 2)[::-1])
    assert coefficients(study[2], "logarithmic") == pytest.approx(
        np.polyfit(np.log2(x), y, 1)[::-1]
    )


def test_logistic_is_the_straight_line_of_the_logit(study, observed):
    x, y = observed
    found = stats.linregress(x, np.log(y / (4 - y)))
    assert coefficients(study[2], "logistic") == pytest.approx([found.intercept, found.slope])
    row = find(study[2], "regressions", model="logistic", fitting="least squares").iloc[0]
    n = len(x)
    assert row["adj_r2"] == pytest.approx(1 - (1 - found.rvalue**2) * (n - 1) / (n - 2))


@pytest.mark.parametrize("fitting", ["least squares", "weighted"])
def test_quality_is_statsmodels(study, observed, fitting):
    x, y = observed
    spread = {n: y[x == n].var(ddof=1) for n in np.unique(x)}
    w = np.array([1 / spread[n] for n in x]) if fitting == "weighted" else np.ones(len(x))
    fit = WLS(y, np.column_stack([np.ones_like(x), np.log2(x)]), weights=w).fit()
    row = find(study[2], "regressions", model="logarithmic", fitting=fitting).iloc[0]
    assert coefficients(study[2], "logarithmic", fitting) == pytest.approx(fit.params)
    assert row["adj_r2"] == pytest.approx(fit.rsquared_adj)
    assert row["f"] == pytest.approx(fit.fvalue)
    assert row["p"] == pytest.approx(fit.f_pvalue)
    # statsmodels does not count the variance as a parameter
    assert row["aic"] == pytest.approx(fit.aic + 2)
    assert row["bic"] == pytest.approx(fit.bic + np.log(len(y)))


def test_weights_are_reciprocal_sample_variances_of_groups_of_any_size():
    values = (np.array([3.0, 3.1]), np.array([3.0, 3.2, 3.1, 3.4]))
    seen = Observations.of(Groups(np.array([1000, 2000]), values), weighted=True)
    expected = np.repeat([1 / np.var(group, ddof=1) for group in values], [2, 4])
    np.testing.assert_allclose(seen.weights(seen.y), expected)


def test_aic_of_the_logistic_model_is_that_of_y(study, observed):
    x, y = observed
    a, b = coefficients(study[2], "logistic")
    residual = y - 4 / (1 + np.exp(-a - b * x))
    likelihood = stats.norm.logpdf(residual, 0, np.sqrt(np.mean(residual**2))).sum()
    row = find(study[2], "regressions", model="logistic", fitting="least squares").iloc[0]
    assert row["aic"] == pytest.approx(2 * 3 - 2 * likelihood)
    assert row["rmse"] == pytest.approx(np.sqrt(np.mean(residual**2)))


@pytest.mark.parametrize("model", ["linear", "quadratic", "logistic", "logarithmic"])
def test_left_out_groups_are_predicted_from_the_others(study, observed, model):
    x, y = observed
    basis = {
        "linear": [np.ones_like(x), x],
        "quadratic": [np.ones_like(x), x, x**2],
        "logistic": [np.ones_like(x), x],
        "logarithmic": [np.ones_like(x), np.log2(x)],
    }[model]
    X = np.column_stack(basis)
    z = np.log(y / (4 - y)) if model == "logistic" else y
    errors = []
    for n in np.unique(x):
        kept = x != n
        predicted = X[~kept][0] @ OLS(z[kept], X[kept]).fit().params
        if model == "logistic":
            predicted = 4 / (1 + np.exp(-predicted))
        errors.append(predicted - y[~kept].mean())
    row = find(study[2], "regressions", model=model, fitting="least squares").iloc[0]
    assert row["left_out_rmse"] == pytest.approx(np.sqrt(np.mean(np.square(errors))))


def test_lack_of_fit_compares_nested_models(study, observed):
    x, y = observed
    small = OLS(y, np.column_stack([np.ones_like(x), x])).fit()
    large = OLS(y, (x[:, None] == np.unique(x)).astype(float)).fit()
    f, p, _ = large.compare_f_test(small)
    row = find(study[2], "regressions", model="linear", fitting="least squares").iloc[0]
    assert (row["lack_of_fit_f"], row["lack_of_fit_p"]) == pytest.approx((f, p))


@pytest.fixture(scope="module")
def saturating_groups():
    rng = np.random.default_rng(4)
    n = np.array([10, 20, 40, 80, 160, 320]) * 1000
    values = (3.1 - 0.2 * k**-0.5 + rng.normal(0, 0.01 / k**0.5, 12) for k in n / 1000)
    return Groups(n, tuple(values))


@pytest.mark.parametrize("weighted", [False, True])
def test_saturating_is_scipys_curve_fit(saturating_groups, weighted):
    seen = Observations.of(saturating_groups, weighted)
    fit = fit_saturating(SATURATING, seen)
    sigma = 1 / np.sqrt(seen.weights(seen.y))
    expected, covariance = optimize.curve_fit(
        lambda x, c, a, b: c - a * x**-b, seen.x, seen.y, p0=(3.1, 0.2, 0.5), sigma=sigma,
        xtol=1e-14, ftol=1e-14,
    )  # fmt: skip
    np.testing.assert_allclose(fit.coefficients, expected, rtol=1e-5)
    np.testing.assert_allclose(fit.covariance, covariance, rtol=1e-2)
    low, high = fit.intervals
    assert low[0] < 3.1 < high[0]


def test_a_straight_line_shows_no_saturation():
    asked = design(distributions=("uniform",))
    results, *others = frames(asked)
    noise = np.random.default_rng(2).normal(0, 1e-5, len(results))
    results["mean_lepp"] = 3 + 1e-3 * results["n_points"] / 1000 + noise
    tables = analyse(results, *others, asked)
    assert find(tables, "regressions", model="saturating").empty
    why = tables["missing"].frame.set_index("what").loc["saturating regression, weighted", "why"]
    assert "no saturation" in why


def test_prediction_intervals_are_statsmodels(study, observed):
    x, y = observed
    fit = OLS(y, np.column_stack([np.ones_like(x), np.log2(x)])).fit()
    expected = fit.get_prediction([[1, np.log2(1e6)]]).summary_frame().iloc[0]
    frame = find(study[2], "projections", model="logarithmic", fitting="least squares")
    row = frame[frame["n_points"] == 10**9].iloc[0]
    assert row["prediction"] == pytest.approx(expected["mean"])
    found = (row["low"], row["high"])
    assert found == pytest.approx((expected["mean_ci_lower"], expected["mean_ci_upper"]))


def test_limits_follow_the_signs(paper_study):
    frame = find(paper_study[2], "limits", fitting="least squares").set_index("model")
    assert frame.loc["linear", "limit"] == "grows without bound"
    assert frame.loc["quadratic", "limit"] == "falls without bound"
    assert frame.loc["logarithmic", "limit"] == "grows without bound"
    assert frame.loc["logistic", "value"] == 4


def test_curves_pass_through_the_fit(study):
    a, b = coefficients(study[2], "linear")
    curve = find(study[2], "curves", model="linear")
    np.testing.assert_allclose(curve["prediction"], a + b * curve["n_points"] / 1000)
    inside = curve[curve["view"] == "data"]["n_points"]
    assert (inside.min(), inside.max()) == (1000, 8000)
    assert curve["n_points"].max() == 10**9


def test_published_coefficients_follow_from_the_published_means(paper_study):
    # Coefficients depend on the groups' means only, which are printed to 4 decimals.
    for model, term, number in published.coefficients():
        frame = find(paper_study[2], "coefficients", model=model, fitting="least squares")
        row = frame.set_index("term").loc[term]
        assert abs(row["estimate"] - number.value) <= number.unit / 2 + row["standard_error"] / 5


def test_published_fits_follow_from_the_published_table(paper_study):
    for model, r2, p in published.fits():
        row = find(paper_study[2], "regressions", model=model, fitting="least squares").iloc[0]
        assert row["adj_r2"] == pytest.approx(r2.value, abs=0.01)
        assert row["log10_p"] == pytest.approx(np.log10(p.value), rel=0.03)
