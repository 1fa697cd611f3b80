"""Predictions of sizes not seen against statsmodels' covariance, and their false alarms."""

import numpy as np
import pytest
from scipy import stats
from statsmodels.regression.linear_model import WLS

from study.statistics import models
from study.statistics.groups import NotEnough
from study.statistics.model_scores import (
    coefficient_interval,
    fitted_curve,
    lack_of_fit,
    least_squares,
    prediction_score,
    predictions,
    sizes_to_fit,
)
from study.statistics.size_means import SizeMeans

SIZES = np.array([10, 20, 50, 100, 200, 500, 1000, 2000]) * 1000
ERRORS = 0.005 * (SIZES / 10_000) ** -0.5
SEEN = SIZES <= 200_000
X = SIZES / 1000
BASES = {
    "constant": [],
    "linear": [X],
    "quadratic": [X, X**2],
    "logarithmic": [np.log2(X)],
    "doubly logarithmic": [np.log(np.log(SIZES))],
    "edge": [X**-0.5],
    "thickening edge": [X**-0.5, np.log(X) * X**-0.5],
}
LINEAR = [model for model in models.MODELS if model.name in BASES]


def made(curve, seed=1, df=60):
    rng = np.random.default_rng(seed)
    return SizeMeans(SIZES, curve(X) + rng.normal(0, ERRORS), ERRORS**2, df)


def logarithm(x):
    return 3.0 + 0.01 * np.log2(x)


def saturation(x):
    return 3.1 - 0.4 * x**-0.5


def fitted_by_statsmodels(name, means, kept):
    """Prediction and covariance of the errors of the sizes left out."""
    basis = np.column_stack([np.ones(8), *BASES[name]])
    fit = WLS(means.means[kept], basis[kept], weights=1 / ERRORS[kept] ** 2).fit(
        cov_type="fixed scale"
    )
    covariance = np.diag(ERRORS[~kept] ** 2) + basis[~kept] @ fit.cov_params() @ basis[~kept].T
    return fit.predict(basis[~kept]), covariance


def test_all_models_are_here():
    names = {model.name for model in models.MODELS} - set(BASES)
    assert names == {"logistic", "saturating", "growing power"}


@pytest.mark.parametrize("model", LINEAR, ids=lambda model: model.name)
def test_predictions_are_statsmodels(model):
    means = made(logarithm)
    predicted, covariance = fitted_by_statsmodels(model.name, means, SEEN)
    off = means.means[~SEEN] - predicted
    score = prediction_score(model, means, SEEN)
    assert score.chi_squared == pytest.approx(off @ np.linalg.solve(covariance, off), rel=1e-6)
    assert (score.df, score.df_error) == (3, 60)
    assert score.p == pytest.approx(stats.f.sf(score.chi_squared / 3, 3, 60))
    assert 10**score.log10_p == pytest.approx(score.p)
    found = list(predictions(model, means, SEEN))
    assert [one.n_points for one in found] == [500_000, 1_000_000, 2_000_000]
    assert [one.mean for one in found] == means.means[~SEEN].tolist()
    np.testing.assert_allclose([one.prediction for one in found], predicted)
    np.testing.assert_allclose(
        [one.standard_errors for one in found], off / np.sqrt(np.diag(covariance)), rtol=1e-5
    )


@pytest.mark.parametrize("model", LINEAR, ids=lambda model: model.name)
def test_fits_are_statsmodels(model):
    means = made(saturation)
    basis = np.column_stack([np.ones(8), *BASES[model.name]])
    fit = WLS(means.means, basis, weights=1 / ERRORS**2).fit(cov_type="fixed scale")
    fitted = lack_of_fit(model, means)
    assert fitted.chi_squared == pytest.approx(((fit.resid / ERRORS) ** 2).sum())
    assert fitted.df == 8 - len(model.terms)
    for place in range(len(model.terms)):
        found = coefficient_interval(model, means, place)
        half = stats.t.isf(0.025, 60) * fit.bse[place]
        expected = (fit.params[place], fit.params[place] - half, fit.params[place] + half)
        assert (found.estimate, found.low, found.high) == pytest.approx(expected, rel=1e-6)


def test_the_logistic_model_is_a_line_for_the_logit():
    means = made(logarithm)
    z, slope = np.log(means.means / (4 - means.means)), 4 / means.means / (4 - means.means)
    basis = np.column_stack([np.ones(8), X])
    fit = WLS(z, basis, weights=1 / (slope * ERRORS) ** 2).fit()
    assert least_squares(models.LOGISTIC, means) == pytest.approx(fit.ssr, rel=1e-4)
    expected = 4 / (1 + np.exp(-fit.predict([[1, 5000.0]])[0]))
    assert fitted_curve(models.LOGISTIC, means)(5000.0) == pytest.approx(expected, rel=1e-6)
    high = SizeMeans(SIZES, means.means + 1, ERRORS**2, 60)
    with pytest.raises(NotEnough, match="of 4 or more has no logistic"):
        least_squares(models.LOGISTIC, high)


@pytest.mark.parametrize(
    ("curve", "true"), [(saturation, "saturating"), (logarithm, "logarithmic")]
)
def test_true_models_have_few_false_alarms_and_wrong_ones_are_seen(curve, true):
    model = {one.name: one for one in models.MODELS}[true]
    below = [prediction_score(model, made(curve, seed), SEEN).p < 0.05 for seed in range(400)]
    assert 0.01 <= np.mean(below) <= 0.09
    wrong = [
        prediction_score(models.LINEAR, made(curve, seed), SEEN).p < 0.05 for seed in range(20)
    ]
    assert all(wrong)


def test_the_saturating_model_predicts_by_its_best_fit():
    means = made(saturation)
    found = list(predictions(models.SATURATING, means, SEEN))
    for one in found:
        assert one.prediction == pytest.approx(saturation(one.n_points / 1000), abs=0.02)
        assert (one.standard_errors > 0) == (one.mean > one.prediction)
        assert abs(one.standard_errors) < 3
    # a logarithm is the end of both power models, and no better than either
    for model in (models.SATURATING, models.GROWING):
        of_power = least_squares(model, means)
        assert of_power <= least_squares(models.LOGARITHMIC, means) + 1e-9
    assert least_squares(models.GROWING, means) == pytest.approx(
        least_squares(models.LOGARITHMIC, means)
    )


def test_which_sizes_are_fitted():
    assert sizes_to_fit(SIZES, 200_000, 4).tolist() == SEEN.tolist()
    assert sizes_to_fit(SIZES, 100_000, 4).sum() == 4
    # too few below: all but the largest quarter
    assert sizes_to_fit(SIZES, 50_000, 4).tolist() == [True] * 6 + [False] * 2
    # none beyond
    assert sizes_to_fit(SIZES[:5], 200_000, 4).tolist() == [True] * 4 + [False]
    assert sizes_to_fit(np.arange(20), 20, 4).sum() == 15


def test_too_few():
    means = made(logarithm)
    three = means.where(SIZES <= 50_000)
    with pytest.raises(NotEnough, match="quadratic model needs 4 sizes, not 3"):
        lack_of_fit(models.QUADRATIC, three)
    with pytest.raises(NotEnough, match="linear model needs 3 sizes, not 2"):
        prediction_score(models.LINEAR, three, three.n_points < 50_000)
    with pytest.raises(NotEnough, match="linear model needs 3 sizes, not 2"):
        list(predictions(models.LINEAR, three, three.n_points < 50_000))
    with pytest.raises(NotEnough, match="no size is left"):
        prediction_score(models.LINEAR, three, np.array([True] * 3))
