"""What the report says of models and limits, on runs whose truth is known."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from frames import adding
from grown_runs import CURVES, grown
from made_runs import DESIGN, drawn, page, page_text, run
from statsmodels.regression.linear_model import OLS

from reports.study_page.sections.limit import trend_sentence
from reports.study_page.sections.model_curves import _heights, curves_figure
from study.analysis import limits, model_scores, regressions
from study.analysis.limits import EDGE_LIMITS, LIMIT_VERDICTS
from study.analysis.regressions import PREDICTION
from study.text.numbers import listed


def test_of_sizes_without_repetitions_no_trend_is_said():
    evidence = SimpleNamespace(one=lambda *_, **__: None, rows=lambda *_: range(3))
    assert trend_sentence(evidence, None) is None


def whole(text, table, **where):
    rows = text.evidence.rows(
        _declared(text, table), method="incremental", distribution="uniform", part="whole"
    )
    return rows.select(**where).frame


def verdict_of(text):
    return text.evidence.rows(LIMIT_VERDICTS, method="incremental", distribution="uniform").first


def _declared(text, name):
    found = [
        one
        for module in (limits, model_scores, regressions)
        for one in vars(module).values()
        if getattr(one, "name", "") == name
    ]
    return found[0]


# The verdict, in the opening and in its own paragraph

SENTENCES = {
    ("thickening", "level"): (
        "The mean has a limit: the mean of the interior is level, as far as the data reach, for a "
        "constant survives, and it changes by no more than 0.001 with each tenfold number of "
        "points from 10,000 on; the limit is 3.476",
    ),
    ("saturating", "slow"): ("The mean has a limit, among the 9 models tried: all that have none",),
    ("logarithmic", "logarithmic"): (
        "The mean has no limit in sight, among the models tried: it grows like a logarithm of the "
        "number of points or faster.",
    ),
    ("falling", "falling"): (
        "The mean has a limit: the mean of the whole mesh falls, and no mean falls below 1, the "
        "size of the shortest path. The limit is below 3.5",
    ),
    ("wave", "logarithmic"): (
        "The mean has no limit in sight, among the models tried: the mean of the interior grows "
        "like a logarithm",
    ),
    ("logarithmic", "level"): (
        "Whether the mean has a limit stays undecided: the whole mesh and its interior contradict "
        "each other.",
    ),
    ("wave", "wave"): (
        "Whether the mean has a limit stays undecided: no model follows the means.",
    ),
}


@pytest.mark.parametrize("curves", SENTENCES, ids="-".join)
def test_the_verdict_is_said(curves):
    said = grown(*curves).prose("limit")
    assert said.startswith("The whole mesh and its interior have one limit, as long as the edge's")
    assert said.count("has a limit") + said.count("has no limit") == 1
    opening = grown(*curves).prose("key-figures")
    for sentence in SENTENCES[curves]:
        assert sentence in said
        short = sentence.replace("The mean has", "It has")
        short = short.replace("Whether the mean has", "Whether it has")
        assert short in opening


def test_a_limit_is_said_with_its_ends_and_what_it_rests_on():
    text = grown("saturating", "slow")
    row = verdict_of(text)
    assert (row["has_limit"], row["limit_from"]) == ("yes", "whole")
    assert row["limit_low"] < 3.09 < row["limit_high"]
    said = text.prose("limit")
    assert (
        f"The limit is {row['limit']:.4f} (95 % from {row['limit_low']:.4f} to "
        f"{row['limit_high']:.4f})."
    ) in said
    one = whole(text, "model_scores").set_index("model").loc["saturating"]
    assert (
        f"saturating (p = {one['fit_p']:.4f} for the fit to all sizes, "
        f"{one['prediction_p']:.4f} for sizes not seen)"
    ) in said


def test_of_a_mean_that_falls_the_models_on_both_sides_are_named():
    sides = set()
    for curve, spread in (("falling", 0.3), ("falling", 2.0), ("thickening", 5.0)):
        text = grown(curve, curve, spread=spread)
        row = verdict_of(text)
        assert row["reason"] == "it falls, and cannot fall below 1"
        assert np.isnan(row["limit"])
        assert np.isnan(row["limit_low"])
        said = text.prose("limit")
        of_part = {"method": "incremental", "distribution": "uniform", "part": row["limit_from"]}
        scores = text.evidence.rows(model_scores.MODEL_SCORES, **of_part, standing="survives")
        every = text.evidence.rows(limits.LIMITS, **of_part).frame
        known = every[every["model"].isin(scores["model"])]
        named = [f"{one.value:.4f} ({one.model} model)" for one in known.itertuples()]
        put = f"; models that have one and survive put it at {listed(named)}" if named else ""
        assert f"The limit is below {row['limit_high']:.4f}{put}." in said
        endless = scores["model"][scores["has_limit"] == "no"].tolist()
        assert ("How far below is open" in said) == bool(endless)
        if endless:
            assert f"How far below is open: the {endless[0]}" in said
        sides.add((bool(endless), len(known) > 0))
    assert sides == {(True, False), (True, True)}


def test_a_model_of_another_limit_is_named():
    text = grown("saturating", "off")
    assert "saturating" in whole(text, "limit_evidence").iloc[0]["struck_out"]
    said = text.prose("fits")
    assert "another limit than the interior, which is level: out as well." in said
    assert "another limit" not in grown("logarithmic", "logarithmic").prose("fits")


def test_models_on_both_sides_are_named():
    text = grown("slow", "slow", spread=2.5)
    row = verdict_of(text)
    assert row["reason"] == "models with and without a limit survive"
    said = text.prose("limit")
    match = re.search(
        r"stays undecided: with one, the (.*?) models? survives?; without, the (.*?) models?", said
    )
    scores = whole(text, "model_scores", standing="survives")
    for group, verdict in ((match[1], "yes"), (match[2], "no")):
        names = scores["model"][scores["has_limit"] == verdict].tolist()
        assert re.split(", | and ", group) == names


def test_a_change_that_counts_may_be_hidden():
    text = grown("level", "level", spread=3.0)
    row = whole(text, "limit_evidence").iloc[0]
    said = text.prose("limit")
    low, high = (f"{row[f'per_decade_{end}']:.4f}".replace("-", "−") for end in ("low", "high"))
    assert (
        f"no change is seen, but with each tenfold number of points it may be from {low} to "
        in said
    )
    assert high in said


def test_few_sizes():
    assert page("growing").prose("limit") == "Whether the mean has a limit needs more sizes."
    assert "has a limit" not in page("growing").prose("key-figures")


# Scores


def test_models_are_refuted_by_what_they_have_not_seen():
    text = grown("saturating", "level")
    said = text.prose("fits")
    assert said.startswith(
        "Each model is fitted up to 200,000 points, the paper's range, and has to predict the 3 "
        "larger sizes of this run. A p below 0.0025 there"
    )
    scores = whole(text, "model_scores").set_index("model")
    refuted = scores.index[scores["standing"] == "refuted"].tolist()
    assert "logarithmic" in refuted
    assert "saturating" not in refuted
    assert f"the {', '.join(refuted[:-1])} and {refuted[-1]} ones are refuted." in said
    predicted = whole(text, "predictions", model="logarithmic").iloc[-1]
    assert predicted["difference"] < -3
    assert (
        "At 2,000,000 points the logarithmic model, which the paper prefers, predicts "
        f"{predicted['prediction']:.4f}; measured is {predicted['mean_lepp']:.4f}, "
        f"{-predicted['difference']:.1f} standard errors below."
    ) in said


def test_a_model_that_predicts_is_not_refuted():
    text = grown("logarithmic", "saturating")
    scores = whole(text, "model_scores").set_index("model")
    assert scores.loc["logarithmic", "standing"] == "survives"
    first = text.prose("fits").split("For the interior")[0]
    survivors = first.split("For the whole mesh, the ")[1].split(" survive")[0]
    assert "logarithmic" in survivors
    assert "For the whole mesh, no model survives" in grown("wave", "wave").prose("fits")


def test_a_run_within_the_published_sizes_says_what_it_leaves_out():
    said = page("growing").prose("fits")
    assert said.startswith(
        "This run has too few sizes on one side of 200,000 points, where the paper's range ends, "
        "so that each model is fitted up to 4,000 points and has to predict the 1 larger size "
        "left out."
    )


# The edge model


@pytest.mark.parametrize(
    ("interior", "agree"), [("level", "No difference is seen"), ("off", "The two differ")]
)
def test_the_edge_limit_is_held_against_the_interior(interior, agree):
    text = grown("thickening", interior)
    said = text.prose("limit")
    assert f"{agree}: the two are " in said
    assert "not level" not in said
    row = text.evidence.rows(EDGE_LIMITS, method="incremental", distribution="uniform").first
    assert row["interior"] == pytest.approx(CURVES[interior](np.array([1.0]))[0], abs=5e-4)
    assert f"the limit {row['limit']:.4f}; the interior of the larger meshes has the mean " in said
    assert f"{row['interior']:.4f}. {agree}" in said


def test_a_mean_that_is_not_level_is_no_limit():
    refuted = grown("logarithmic", "logarithmic")
    scores = whole(refuted, "model_scores").set_index("model")["standing"]
    assert scores["thickening edge"] == "refuted"
    assert "for the interior, so that" not in refuted.prose("limit")
    text = grown("thickening", "logarithmic")
    said = text.prose("limit")
    assert "of the larger meshes" not in said
    row = text.evidence.rows(EDGE_LIMITS, method="incremental", distribution="uniform").first
    assert said.endswith(
        "No constant survives for the interior, so that its mean is no limit to hold the "
        f"thickening edge's {row['limit']:.4f} against."
    )


# Beyond the data


def test_only_survivors_are_projected():
    text = grown("logarithmic", "logarithmic")
    said = text.prose("projections")
    assert said.startswith("What follows is extrapolation, by the models that survive")
    rows = whole(text, "projections", n_points=10**9)
    assert "logarithmic" in set(rows["model"])
    for row in rows.itertuples():
        assert (
            f"{row.prediction:.4f} ({row.model}, 95 % from {row.low:.4f} to {row.high:.4f})" in said
        )
    row = rows.set_index("model").loc["logarithmic"]
    assert row["low"] < 3 + 0.005 * np.log(1e6) < row["high"]
    limited = grown("saturating", "slow").prose("projections")
    assert "(logarithmic" not in limited
    assert grown("wave", "wave").prose("projections") == ""


def test_models_that_say_nothing_of_a_limit_are_not_projected():
    text = grown("level", "level", spread=3.0)
    surviving = set(whole(text, "model_scores", standing="survives")["model"])
    assert {"quadratic", "logistic"} <= surviving
    said = text.prose("projections")
    assert "(logarithmic, 95 %" in said
    assert "quadratic" not in said
    assert "logistic" not in said


# Table 7


@pytest.mark.parametrize(("name", "best"), [("growing", "logarithmic"), ("straight", "linear")])
def test_the_best_of_the_four_models(name, best):
    results = run(name)["results"].query("method == 'incremental'")
    x, y = results["n_points"].to_numpy() / 1000, results["mean_lepp"].to_numpy()
    logit = np.log(y / (4 - y))
    one = np.ones_like(x)
    r2 = {
        "linear": OLS(y, np.column_stack([one, x])).fit().rsquared_adj,
        "quadratic": OLS(y, np.column_stack([one, x, x * x])).fit().rsquared_adj,
        "logistic": OLS(logit, np.column_stack([one, x])).fit().rsquared_adj,
        "logarithmic": OLS(y, np.column_stack([one, np.log2(x)])).fit().rsquared_adj,
    }
    top = max(r2, key=r2.get)
    assert top == best or r2[top] - r2[best] < 1e-3
    assert (
        page(name)
        .prose("table-7")
        .startswith(
            f"Of the paper's four models the {top} one fits the uniform points best by least "
            f"squares, with an adjusted R² of {r2[top]:.3f}."
        )
    )


def test_figures_say_where_the_curves_are():
    text = grown("saturating", "level")
    for figure in ("figure-models", "figure-projections"):
        match = re.fullmatch(
            r"At 2,000,000 points the curves for the whole mesh are from (\S+) \((.+)\) to (\S+) "
            r"\((.+)\), and the measured mean is (\S+)\.",
            text.finding(figure),
        )
        assert float(match[1]) <= float(match[3])
        assert float(match[5]) == pytest.approx(3.09 - 0.1 * 2000**-0.3, abs=1e-3)


def figure_of(text, part, name):
    (block,) = (b for b in text.blocks(part) if getattr(b, "id", "") == name)
    return block.specs["incremental/uniform"]["data"]


def test_figures_draw_the_models_that_they_are_about():
    text = grown("saturating", "slow")
    names = [trace["name"] for trace in figure_of(text, "table-7", "figure-models")]
    assert names == ["linear", "quadratic", "logistic", "logarithmic", "means"]
    traces = figure_of(text, "fits", "figure-projections")
    surviving = set(whole(text, "model_scores", standing="survives")["model"])
    last = [t["name"] for t in traces].index("means")
    band = "95 % of what a model that survives predicts"
    assert {t["name"] for t in traces[:last]} == (
        surviving | {"logarithmic", "end of the sizes fitted", band.replace(" %", "\u00a0%")}
    )
    end = next(t for t in traces if t["name"] == "end of the sizes fitted")
    assert end["x"] == [200_000, 200_000]


def test_the_bands_are_of_the_models_that_survive():
    text = grown("saturating", "slow")
    traces = figure_of(text, "fits", "figure-projections")
    surviving = whole(text, "model_scores", standing="survives")["model"]
    assert 0 < len(surviving) < 9
    bands = [
        t for t in traces if t.get("line", {}).get("width") == 0 and t.get("yaxis", "y") == "y"
    ]
    ends = [whole(text, "predictions", model=name) for name in surviving]
    assert [list(t["y"]) for t in bands] == [
        rows[end].tolist() for rows in ends for end in ("low", "high")
    ]
    assert [t.get("fill") for t in bands] == [None, "tonexty"] * len(surviving)
    assert sum(t.get("showlegend", True) for t in bands) == 1


def test_a_curve_that_leaves_the_means_does_not_squeeze_the_others():
    means = pd.Series([3.05, 3.07])
    curves = pd.DataFrame(
        {
            "model": ["edge", "edge", "quadratic", "quadratic"],
            "prediction": [3.05, 3.08, 3.06, -5.0],
        }
    )
    assert _heights(means, curves) == pytest.approx((3.045, 3.085))
    assert _heights(means, curves[:0]) == pytest.approx((3.045, 3.075))


def test_only_extrapolations_are_drawn_beyond_the_sizes():
    text = grown("saturating", "slow")
    ends = {}
    for part, name in (("fits", "figure-projections"), ("table-7", "figure-models")):
        (block,) = (b for b in text.blocks(part) if getattr(b, "id", "") == name)
        ends[name] = 10 ** block.specs["incremental/uniform"]["layout"]["xaxis"]["range"][1]
    assert ends["figure-projections"] > 20_000_000
    assert 2_000_000 < ends["figure-models"] < 3_000_000


def test_curves_of_the_papers_models_are_least_squares():
    text = grown("saturating", "slow")
    rows = whole(text, "curves", view="least squares", model="quadratic")
    results = text.evidence.tables["triangulations"].frame
    results = results.query("method == 'incremental' and distribution == 'uniform'")
    x = results["n_points"].to_numpy() / 1000
    fit = OLS(results["mean_lepp"].to_numpy(), np.column_stack([x**0, x, x * x])).fit()
    at = rows["n_points"].to_numpy() / 1000
    np.testing.assert_allclose(
        rows["prediction"], fit.predict(np.column_stack([at**0, at, at * at])), rtol=1e-6
    )


def test_a_run_of_one_size_says_nothing():
    said = page_text(drawn(DESIGN.model_copy(update={"sizes": (2000,)})))
    for part in ("fits", "projections", "table-7"):
        assert said.prose(part) == ""
    assert said.finding("figure-models") == ""


def test_panels_of_one_figure_have_one_kind_of_axis():
    # The interior is judged at fewer sizes than the whole, over a factor of less than 50.
    text = grown("saturating", "level")
    (block,) = (
        block for block in text.blocks("fits") if getattr(block, "id", "") == "figure-projections"
    )
    evidence = text.evidence
    curves = evidence.tables["curves"]
    of_interior = curves.frame["part"] == "interior"
    small = curves.frame["n_points"] < curves.frame["n_points"].max() / 20
    changed = replace(curves, frame=curves.frame[~(of_interior & small)])
    evidence = replace(evidence, tables=adding(evidence.tables, changed))
    block = curves_figure(evidence, block.id, block.title, "Figure 7", PREDICTION)
    layout = block.specs["incremental/uniform"]["layout"]
    kinds = [axis.get("type") for name, axis in layout.items() if name.startswith("xaxis")]
    assert kinds == ["log", "log"]
