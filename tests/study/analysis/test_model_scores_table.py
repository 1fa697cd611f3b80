"""The tables of models, their predictions and projections, of trends made for them."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats
from statsmodels.regression.linear_model import WLS

from study.analysis import model_scores
from study.analysis.building import Study
from study.analysis.trends import Trend
from study.statistics.models import LOGARITHMIC
from study.statistics.size_means import SizeMeans

SIZES = np.array([10, 20, 50, 100, 200, 500, 1000, 2000]) * 1000
KEY = {"method": "incremental", "distribution": "uniform", "part": "whole"}
ERRORS = 0.002 * (SIZES / 10_000) ** -0.5


def tables(monkeypatch, curve):
    noise = np.array([0.4, -0.7, 0.2, 0.6, -0.5, 0.3, -0.2, 0.1]) * ERRORS
    trend = Trend(KEY, SizeMeans(SIZES, curve(SIZES / 1000) + noise, ERRORS**2, 60), 0.01)
    monkeypatch.setattr(model_scores, "trends", lambda data: [trend])
    made = model_scores.model_scores.make(Study(SimpleNamespace(), {}))
    return trend, *(table.frame for table in made)


@pytest.fixture(params=["logarithm", "saturation"])
def scored(request, monkeypatch):
    curves = {
        "logarithm": lambda x: 3 + 0.02 * np.log2(x),
        "saturation": lambda x: 3.1 - 0.4 / x**0.5,
    }
    return request.param, *tables(monkeypatch, curves[request.param])


def test_standings_follow_from_the_scores(scored):
    name, _, scores, *_ = scored
    scores = scores.set_index("model")
    assert set(scores["fitted_up_to"]) == {200_000}
    assert set(scores["predicted"]) == {3}
    refuted = (scores["prediction_p"] < 0.01) | (scores["fit_p"] < 0.01)
    assert (scores["standing"] == "refuted").tolist() == refuted.tolist()
    assert scores.loc["logarithmic", "standing"] == (
        "survives" if name == "logarithm" else "refuted"
    )
    limits = scores["has_limit"].to_dict()
    assert limits["logarithmic"] == "no"
    # The other power is best as the logarithm; a logarithm's own is on either side.
    powers = {"saturating": "yes", "growing power": "no"}.items()
    own = [(name, has) for name, has in limits.items() if (name, has) in powers]
    assert len(own) == 1
    if name == "saturation":
        assert own == [("saturating", "yes")]
    assert "–" in limits.values()
    assert set(scores["refuted_below"]) == {0.01}


def test_akaike_weights(scored):
    _, trend, scores, *_ = scored
    aic = np.array([one.aic for one in trend.candidates])
    assert scores["delta_aic"].min() == 0
    np.testing.assert_allclose(scores["delta_aic"], aic - aic.min())
    weights = np.exp(-(aic - aic.min()) / 2)
    np.testing.assert_allclose(scores["akaike_weight"], weights / weights.sum())
    np.testing.assert_allclose(10 ** scores["prediction_log10_p"], scores["prediction_p"])


def test_the_worst_prediction_is_the_one_furthest_off(scored):
    _, trend, scores, predictions, _ = scored
    for row in scores.itertuples():
        each = predictions[predictions["model"] == row.model]
        assert each["n_points"].tolist() == [500_000, 1_000_000, 2_000_000]
        assert each["mean_lepp"].tolist() == trend.means.means[5:].tolist()
        assert abs(row.worst) == each["difference"].abs().max()
        assert row.worst in each["difference"].tolist()
        off = each["mean_lepp"] - each["prediction"]
        assert (np.sign(off) == np.sign(each["difference"])).all()


def test_what_a_logarithm_predicts_has_the_interval_of_weighted_least_squares(scored):
    _, trend, _, predictions, _ = scored
    assert (predictions["low"] <= predictions["prediction"]).all()
    assert (predictions["prediction"] <= predictions["high"]).all()
    seen = SIZES <= 200_000
    basis = np.column_stack([np.ones(8), np.log2(SIZES)])
    fit = WLS(trend.means.means[seen], basis[seen], weights=ERRORS[seen] ** -2.0).fit(
        cov_type="fixed scale"
    )
    rows = predictions[predictions["model"] == LOGARITHMIC.name]
    errors = np.sqrt(np.einsum("ij,jk,ik->i", basis[~seen], fit.cov_params(), basis[~seen]))
    half = stats.t.ppf(0.975, 60) * errors
    np.testing.assert_allclose(rows["prediction"], basis[~seen] @ fit.params)
    np.testing.assert_allclose(rows["high"] - rows["prediction"], half, rtol=1e-3)
    np.testing.assert_allclose(rows["prediction"] - rows["low"], half, rtol=1e-3)


def test_projections_of_a_logarithm_are_those_of_weighted_least_squares(scored):
    name, trend, scores, _, projections = scored
    alive = set(scores.query("standing == 'survives' and has_limit != '–'")["model"])
    assert set(projections["model"]) <= alive
    assert set(projections["n_points"]) <= {10**7, 10**8, 10**9}
    rows = projections[projections["model"] == LOGARITHMIC.name]
    assert len(rows) == (3 if name == "logarithm" else 0)
    for row in rows.itertuples():
        assert row.n_points > SIZES[-1]
        basis = np.column_stack([np.ones(8), np.log2(SIZES)])
        fit = WLS(trend.means.means, basis, weights=ERRORS**-2.0).fit(cov_type="fixed scale")
        at = np.array([1, np.log2(row.n_points)])
        error = np.sqrt(at @ fit.cov_params() @ at)
        half = stats.t.ppf(0.975, 60) * error
        assert row.prediction == pytest.approx(at @ fit.params)
        assert row.high - row.prediction == pytest.approx(half, rel=1e-3)
        assert row.prediction - row.low == pytest.approx(half, rel=1e-3)
