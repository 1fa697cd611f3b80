"""Scores, limits and verdicts as tables, on results made to have each verdict."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from frames import design, frames

from lepp import INTERIOR_LAYER
from study.analysis.analyse import analyse
from study.analysis.building import Study
from study.analysis.limits import limits
from study.analysis.measurements import Measurements, groups_of
from study.analysis.trends import trends
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
    layers = layers[layers["layer"] != INTERIOR_LAYER]
    return asked, results, analyse(results, histograms, regions, layers, sets, asked)


class StandIn(SimpleNamespace):
    """Stands for measurements, and is told from others as these are: by which it is."""

    __hash__ = object.__hash__


@pytest.fixture(scope="module", params=CURVES)
def judged(request):
    return request.param, *made(CURVES[request.param])


def of_whole(table, **where):
    frame = table.frame[table.frame["part"] == "whole"]
    for column, value in where.items():
        frame = frame[frame[column] == value]
    return frame


def test_evidence_is_that_of_the_means(judged):
    verdict, _, results, tables = judged
    row = of_whole(tables["limit_evidence"]).iloc[0]
    assert row["has_limit"] == verdict
    assert (row["sizes"], row["smallest"]) == (8, 10_000)
    found = judge(SizeMeans.of(groups_of(results, "mean_lepp")), 200_000)
    assert row["survivors"] == ", ".join(one.model.name for one in found.survivors)
    assert row["power"] == pytest.approx(found.power.estimate)
    assert row["per_decade_low"] == pytest.approx(found.per_decade.low)
    if verdict == "yes":
        assert row["limit_low"] < 3.09 < row["limit_high"]
        assert row["reason"] == "only models with a limit survive"
    else:
        assert np.isnan(row["limit"])


def test_the_verdict_without_an_interior_is_the_whole_meshs(judged):
    verdict, _, _, tables = judged
    row = tables["limit_verdicts"].frame.iloc[0]
    parts = tables["limit_evidence"].frame.set_index("part")
    assert row["has_limit"] == verdict
    assert row["decided_by"] == {"undecided": ""}.get(verdict, "whole")
    if verdict == "yes":
        assert row["limit"] == parts.loc["whole", "limit"]
        assert row["limit_from"] == "whole"
    stated = tables["statements"].frame.set_index("statement")["holds"]
    holds = "no" if verdict == "yes" else "undecided"  # the limit of these means is not 4
    assert stated["The logistic regression has an asymptotic limit equal to 4"] == holds


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
    assert set(rows["refuted_below"]) == {0.01}
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
    assert set(rows["model"]) == set(scores["model"]) - {"growing power", "quadratic", "logistic"}
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


def of_parts(whole, interior, share=0.95):
    """Tables of limits, of a mesh whose interior has a share of the triangles, by size."""
    rng = np.random.default_rng(6)
    parts, layers = {"whole": [], "interior": []}, []
    for n in SIZES:
        both = rng.normal(0, 0.3 * n**-0.45, 12)
        parts["whole"].append(whole(n / 1000) + both)
        parts["interior"].append(interior(n / 1000) + both)
        inside = share(n) if callable(share) else share
        layers += [(n, 0, 1 - inside), (n, INTERIOR_LAYER, inside)]
    of = {part: Groups(np.array(SIZES), tuple(values)) for part, values in parts.items()}
    data = StandIn(
        populations=[("delaunay", "uniform")],
        groups=lambda method, distribution, part: of[part],
        by_layer=lambda *_: pd.DataFrame(layers, columns=["n_points", "layer", "count"]),
    )
    return of, {table.name: table.frame for table in limits.make(Study(data))}


def thickening(x):
    return 3.4765 + (0.2 + 0.05 * np.log(x)) * x**-0.5


@pytest.mark.parametrize(
    ("interior", "level", "agrees"),
    [
        (lambda x: 3.4765, "yes", "yes"),
        (lambda x: 3.4965, "yes", "no"),
        (lambda x: 3.4765 + 0.01 * np.log(x), "no", "no"),
    ],
)
def test_the_edge_limit_is_held_against_the_interior(interior, level, agrees):
    of, tables = of_parts(thickening, interior)
    row = tables["edge_limits"].iloc[0]
    found = edge_limit(THICKENING_EDGE, of["whole"], of["interior"])
    assert (row["limit"], row["interior"]) == pytest.approx((found.limit, found.interior))
    assert (row["t"], row["p"]) == pytest.approx((found.t, found.p))
    assert (row["level"], row["agrees"]) == (level, agrees)
    # where the interior is small, its larger half
    of, tables = of_parts(thickening, interior, share=0.8)
    half = Groups(np.array(SIZES[4:]), of["interior"].values[4:])
    found = edge_limit(THICKENING_EDGE, of["whole"], half)
    assert tables["edge_limits"]["interior"].iloc[0] == pytest.approx(found.interior)


@pytest.mark.parametrize(
    ("whole", "interior", "verdict", "reason", "decided_by"),
    [
        (thickening, lambda x: 3.4765, "yes", "the mean is level", "whole and interior"),
        (lambda x: 3.1 - 0.1 * x**-0.3, lambda x: 3.07 - 0.01 * x**-0.1, "yes",
         "only models with a limit survive", "whole"),
        (lambda x: 3 + 0.005 * np.log(x), lambda x: 3.01 + 0.005 * np.log(x), "no",
         "it grows like a logarithm or faster", "whole and interior"),
        (lambda x: 3 + 0.005 * np.log(x), lambda x: 3.4765, "undecided",
         "the whole mesh and its interior contradict each other", ""),
        (lambda x: 3 + 0.03 * np.sin(2 * np.log(x)), lambda x: 3.4765, "yes",
         "the mean is level", "interior"),
        (lambda x: 3 + 0.03 * np.sin(2 * np.log(x)), lambda x: 3 + 0.03 * np.sin(2 * np.log(x)),
         "undecided", "no model follows the means", ""),
    ],
)  # fmt: skip
def test_every_verdict_can_be_had(whole, interior, verdict, reason, decided_by):
    _, tables = of_parts(whole, interior)
    row = tables["limit_verdicts"].iloc[0]
    assert (row["has_limit"], row["reason"]) == (verdict, reason)
    assert row["decided_by"] == decided_by
    assert set(tables["limit_evidence"]["part"]) == {"whole", "interior"}
    if reason == "the mean is level":
        assert row["limit_from"] == "interior"
        assert row["limit_low"] < 3.4765 < row["limit_high"]


def test_a_level_interior_strikes_models_of_another_limit_out():
    _, tables = of_parts(lambda x: 3.09 - 0.1 * x**-0.3, lambda x: 3.4765)
    row = tables["limit_evidence"].set_index("part").loc["whole"]
    assert "saturating" in row["struck_out"].split(", ")
    assert "saturating" not in row["survivors"]
    assert row["has_limit"] != "yes"
    _, tables = of_parts(lambda x: 3.09 - 0.1 * x**-0.3, lambda x: 3.09)
    row = tables["limit_evidence"].set_index("part").loc["whole"]
    assert "saturating" not in row["struck_out"].split(", ")
    assert "saturating" in row["survivors"]


@pytest.mark.parametrize(("free", "sizes"), [(5, 5), (4, 8), (8, 8)])
def test_an_interior_is_judged_where_it_is_free_of_the_edge(free, sizes):
    # falling where the edge still reaches it
    least = SIZES[-free]
    _, tables = of_parts(
        thickening,
        lambda x: 3.4765 + 0.02 * (1000 * x < SIZES[3]) / x,
        lambda n: 0.9 if n >= least else 0.89,
    )
    row = tables["limit_evidence"].set_index("part").loc["interior"]
    assert (row["sizes"], row["smallest"]) == (sizes, SIZES[-sizes])


def test_models_are_refuted_at_a_level_for_all_trends():
    one = design(distributions=("uniform",))
    two = design(distributions=("uniform", "exponential"))
    for asked, shared in ((one, 2), (two, 4)):
        scores = analyse(*frames(asked), asked)["model_scores"].frame
        assert set(scores["refuted_below"]) == {0.01 / shared}
        p = scores[["fit_p", "prediction_p"]].min(axis=1)
        assert ((scores["standing"] == "refuted") == (p < 0.01 / shared)).all()


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


def test_trends_are_the_same_for_all_tables_of_the_same_data():
    asked = design(sizes=(1000, 2000, 4000, 8000, 16000))
    one, other = (Measurements.of(*frames(asked, seed), asked) for seed in (1, 2))
    assert trends(one) is trends(one)
    assert trends(other)[0].means.means.tolist() != trends(one)[0].means.means.tolist()
