"""The regressions by numpy, scipy and formula, and from the published means."""

import numpy as np
import pytest
from frames import design, frames
from scipy import optimize, stats
from statsmodels.regression.linear_model import OLS, WLS

from study.analysis.analyse import analyse
from study.analysis.measurements import Measurements, groups_of
from study.paper import published
from study.statistics.fitting import Observations, fit_saturating
from study.statistics.groups import Groups
from study.statistics.models import SATURATING
from study.statistics.power_family import PowerFamily
from study.statistics.size_means import SizeMeans
from study.statistics.variance_function import smooth_variances


@pytest.fixture(scope="module")
def observed(study):
    """x, y and group of the uniform points by the incremental method."""
    _, (results, *_), _ = study
    chosen = (results["method"] == "incremental") & (results["distribution"] == "uniform")
    rows = results[chosen]
    return rows["n_points"].to_numpy() / 1000, rows["mean_lepp"].to_numpy()


def find(tables, table, **wanted):
    frame = tables[table].frame
    wanted = {"method": "incremental", "distribution": "uniform", "part": "whole"} | wanted
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
    sizes, group = np.unique(x, return_inverse=True)
    groups = Groups(sizes * 1000, tuple(y[group == k] for k in range(len(sizes))))
    w = 1 / smooth_variances(groups)[group] if fitting == "weighted" else np.ones(len(x))
    fit = WLS(y, np.column_stack([np.ones_like(x), np.log2(x)]), weights=w).fit()
    row = find(study[2], "regressions", model="logarithmic", fitting=fitting).iloc[0]
    assert coefficients(study[2], "logarithmic", fitting) == pytest.approx(fit.params)
    assert row["adj_r2"] == pytest.approx(fit.rsquared_adj)
    assert row["f"] == pytest.approx(fit.fvalue)
    assert row["p"] == pytest.approx(fit.f_pvalue)
    if fitting == "weighted":  # the variances are known
        likelihood = stats.norm.logpdf(fit.resid, 0, 1 / np.sqrt(w)).sum()
        assert row["aic"] == pytest.approx(2 * 2 - 2 * likelihood)
    else:  # statsmodels does not count the variance as a parameter
        assert row["aic"] == pytest.approx(fit.aic + 2)
        assert row["bic"] == pytest.approx(fit.bic + np.log(len(y)))


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


def test_saturating_coefficients_have_profile_intervals():
    asked = design(distributions=("uniform",), sizes=(1000, 2000, 4000, 8000, 32000))
    results, *others = frames(asked)
    n = results["n_points"].to_numpy() / 1000
    noise = np.random.default_rng(2).normal(0, 0.004, len(results)) / n**0.5
    results["mean_lepp"] = 3.1 - 0.2 * n**-0.5 + noise
    tables = analyse(results, *others, asked)
    frame = find(tables, "coefficients", model="saturating").set_index("term")
    assert frame["standard_error"].isna().all()
    family = PowerFamily(SizeMeans.of(groups_of(results, "mean_lepp")))
    assert frame.loc["b", ["low", "high"]].tolist() == pytest.approx(
        [-family.power.high, -family.power.low]
    )
    limit = family.value(np.inf)
    assert frame.loc["c", ["low", "high"]].tolist() == pytest.approx([limit.low, limit.high])
    assert frame.loc["c", "estimate"] == pytest.approx(limit.estimate, abs=1e-4)
    assert frame.loc["a", ["low", "high"]].isna().all()


def test_least_squares_is_for_the_four_models_of_the_paper_and_the_whole(study):
    frame = study[2]["regressions"].frame
    plain = frame[frame["fitting"] == "least squares"]
    assert set(plain["part"]) == {"whole"}
    assert set(plain["model"]) <= {"linear", "quadratic", "logistic", "logarithmic"}
    weighted = frame[frame["fitting"] == "weighted"]
    assert set(weighted["part"]) == {"whole", "interior"}
    assert {"edge", "thickening edge", "doubly logarithmic"} <= set(weighted["model"])


def test_curves_go_on_beyond_the_largest_size_by_a_factor(study):
    curves = find(study[2], "curves", model="logarithmic", view="prediction")
    seen = study[1][0]["n_points"]
    assert curves["n_points"].min() == seen.min()
    assert curves["n_points"].max() == 10 * seen.max()


def test_curves_pass_through_the_fits(study):
    c, d = coefficients(study[2], "logarithmic", "least squares")
    curve = find(study[2], "curves", model="logarithmic", view="least squares")
    np.testing.assert_allclose(curve["prediction"], c + d * np.log2(curve["n_points"] / 1000))
    # of four sizes, three predict the last
    curve = find(study[2], "curves", model="logarithmic", view="prediction")
    at = curve["n_points"].to_numpy()
    groups = Measurements.of(*study[1], study[0]).groups("incremental", "uniform")
    means = SizeMeans.of(groups)
    fit = WLS(
        means.means[:3],
        np.column_stack([np.ones(3), np.log2(means.x[:3])]),
        weights=1 / means.variances[:3],
    ).fit()
    expected = fit.params[0] + fit.params[1] * np.log2(at / 1000)
    np.testing.assert_allclose(curve["prediction"], expected)


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
