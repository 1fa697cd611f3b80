"""Scores, limits and verdicts as tables, on results made to have each verdict."""

from types import SimpleNamespace

import numpy as np
import pytest
from frames import design, frames

from study.analysis import analyse
from study.analysis.building import Study
from study.analysis.limits import limits
from study.analysis.measurements import groups_of
from study.statistics.edge_limit import edge_limit
from study.statistics.groups import Groups
from study.statistics.limit_verdict import candidates, judge, survivors_of
from study.statistics.model_scores import predictions
from study.statistics.models import THICKENING_EDGE
from study.statistics.size_means import SizeMeans

SIZES = (10_000, 20_000, 50_000, 100_000, 200_000, 500_000, 1_000_000, 2_000_000)
CURVES = {
    "yes": lambda x: 3.09 - 0.1 * x**-0.3,
    "no": lambda x: 3 + 0.005 * np.log(x),
    "undecided": lambda x: 3 + 0.03 * np.sin(2 * np.log(x)),
}


def made(curve, seed=3):
    asked = design(
        distributions=("uniform",),
        sizes=(1000, 2000, 3000, 4000, 5000, 6000, 7000, 8000),
        repetitions=12,
    )
    results, histograms, regions, layers, sets = frames(asked)
    larger = dict(zip(asked.sizes, SIZES, strict=True))
    asked = design(distributions=("uniform",), sizes=SIZES, repetitions=12)
    results, histograms, regions, layers, sets = (
        frame.assign(n_points=frame["n_points"].map(larger))
        for frame in (results, histograms, regions, layers, sets)
    )
    n = results["n_points"].to_numpy(float)
    noise = np.random.default_rng(seed).normal(0, 0.3, len(n)) * n**-0.45
    results["mean_lepp"] = curve(n / 1000) + noise
    return asked, results, analyse(results, histograms, regions, layers, sets, asked)


@pytest.fixture(scope="module", params=CURVES)
def judged(request):
    return request.param, *made(CURVES[request.param])


def of_whole(table, **where):
    frame = table.frame[table.frame["part"] == "whole"]
    for column, value in where.items():
        frame = frame[frame[column] == value]
    return frame


def test_verdicts_are_those_of_the_means(judged):
    verdict, _, results, tables = judged
    row = of_whole(tables["limit_verdicts"]).iloc[0]
    assert row["has_limit"] == verdict
    found = judge(SizeMeans.of(groups_of(results, "mean_lepp")), 200_000)
    assert row["survivors"] == ", ".join(one.model.name for one in found.survivors)
    assert row["power"] == pytest.approx(found.power.estimate)
    assert row["per_decade_low"] == pytest.approx(found.per_decade.low)
    if verdict == "yes":
        assert row["limit_low"] < 3.09 < row["limit_high"]
        assert row["reason"] == "only models with a limit survive"
    else:
        assert np.isnan(row["limit"])
    stated = tables["statements"].frame.set_index("statement")["holds"]
    assert stated["The mean LEPP size has a limit as the number of points grows"] == verdict


def test_scores_are_those_of_the_means(judged):
    _, _, results, tables = judged
    means = SizeMeans.of(groups_of(results, "mean_lepp"))
    fitted = means.n_points <= 200_000
    scored = candidates(means, fitted)
    rows = of_whole(tables["model_scores"]).set_index("model")
    assert list(rows.index) == [one.model.name for one in scored]
    surviving = {one.model.name for one in survivors_of(scored)}
    assert set(rows.index[rows["standing"] == "survives"]) == surviving
    assert set(rows.index[rows["standing"] == "refuted"]) == {
        one.model.name for one in scored if one.refuted
    }
    assert set(rows["fitted_up_to"]) == {200_000}
    assert set(rows["predicted"]) == {3}
    aic = np.array([one.aic for one in scored])
    weights = np.exp(-(aic - aic.min()) / 2)
    np.testing.assert_allclose(rows["akaike_weight"], weights / weights.sum())
    np.testing.assert_allclose(rows["delta_aic"], aic - aic.min())
    each = list(predictions(scored[0].model, means, fitted))
    table = of_whole(tables["predictions"], model=scored[0].model.name)
    np.testing.assert_allclose(table["difference"], [one.standard_errors for one in each])
    worst = max((one.standard_errors for one in each), key=abs)
    assert rows.iloc[0]["worst"] == pytest.approx(worst)


def test_only_survivors_are_projected_and_only_beyond_the_data(judged):
    _, _, _, tables = judged
    rows = of_whole(tables["projections"])
    scores = of_whole(tables["model_scores"], standing="survives")
    assert set(rows["model"]) == set(scores["model"]) - {"growing power"}
    assert set(rows["n_points"]) <= {10**7, 10**8, 10**9}
    assert (rows["low"] <= rows["prediction"]).all()
    assert (rows["prediction"] <= rows["high"]).all()


def test_limits_of_the_models_that_have_one(judged):
    verdict, _, _, tables = judged
    rows = of_whole(tables["limits"]).set_index("model")
    assert {"constant", "edge", "thickening edge"} <= set(rows.index)
    assert set(rows.index) <= {"constant", "edge", "thickening edge", "saturating"}
    if verdict == "yes":
        row = rows.loc["saturating"]
        assert row["low"] < 3.09 < row["high"]
        # not alike to both sides
        assert row["high"] - row["value"] > row["value"] - row["low"]


@pytest.mark.parametrize(
    ("interior", "agrees"),
    [
        (lambda n: 3.4765, "yes"),
        (lambda n: 3.4965, "no"),
        (lambda n: 3.4765 + 0.01 * np.log(n), None),  # no level mean to be held against
    ],
)
def test_the_edge_limit_is_held_against_a_level_interior(interior, agrees):
    rng = np.random.default_rng(6)
    whole, inside = [], []
    for n in SIZES:
        x, both = n / 1000, rng.normal(0, n**-0.5, 12)
        whole.append(3.4765 + (0.2 + 0.05 * np.log(x)) * x**-0.5 + both)
        inside.append(interior(n) + both)
    of = {"whole": Groups(np.array(SIZES), tuple(whole))}
    of["interior"] = Groups(np.array(SIZES), tuple(inside))
    data = SimpleNamespace(
        populations=[("delaunay", "uniform")], groups=lambda method, distribution, part: of[part]
    )
    table = list(limits.make(Study(data)))[-1]
    if agrees is None:
        assert table.frame.empty
        return
    row = table.frame.iloc[0]
    found = edge_limit(THICKENING_EDGE, of["whole"], Groups(np.array(SIZES[4:]), tuple(inside[4:])))
    assert (row["limit"], row["interior"]) == pytest.approx((found.limit, found.interior))
    assert (row["t"], row["p"]) == pytest.approx((found.t, found.p))
    assert row["agrees"] == agrees


def test_few_sizes_are_undecided_without_being_missed():
    asked = design(distributions=("uniform",))
    tables = analyse(*frames(asked), asked)
    verdicts = tables["limit_verdicts"].frame
    assert set(verdicts["has_limit"]) == {"undecided"}
    assert set(verdicts["reason"]) == {"the run has too few sizes"}
    assert not tables["missing"].frame["what"].str.contains("limit").any()
    # three sizes predict the fourth
    scores = tables["model_scores"].frame
    assert set(scores["fitted_up_to"]) == {4000}
    assert set(scores["predicted"]) == {1}
