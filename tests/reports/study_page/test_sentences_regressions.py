"""What the report says of models and limits, on runs whose truth is known."""

import re

import numpy as np
import pytest
from grown_runs import CURVES, grown
from made_runs import DESIGN, drawn, page, page_text, run
from statsmodels.regression.linear_model import OLS

from study.analysis import limits, model_scores
from study.analysis.limits import EDGE_LIMITS


def whole(text, table, **where):
    rows = text.evidence.rows(
        _declared(text, table), method="incremental", distribution="uniform", part="whole"
    )
    return rows.select(**where).frame


def _declared(text, name):
    found = [
        one
        for module in (limits, model_scores)
        for one in vars(module).values()
        if getattr(one, "name", "") == name
    ]
    return found[0]


# The verdict, in the opening and in its own paragraph

SENTENCES = {
    ("saturating", "level"): (
        "The mean of the whole mesh has a limit: only models with one survive, and put it between",
        "The mean of the interior is level: it changes by no more than 0.001 with each tenfold",
    ),
    ("logarithmic", "saturating"): (
        "The mean of the whole mesh has no limit in sight: it grows like a logarithm of the number "
        "of points or faster.",
        "The mean of the interior has a limit: only models with one survive, and put it between",
    ),
    ("falling", "logarithmic"): (
        "The mean of the whole mesh has no limit in sight: it falls like a logarithm of the number "
        "of points or faster.",
        "The mean of the interior has no limit in sight: it grows like a logarithm",
    ),
    ("wave", "wave"): (
        "Whether the mean of the whole mesh has a limit stays undecided: no model follows the "
        "means.",
        "Whether the mean of the interior has a limit stays undecided: no model follows the means.",
    ),
}


@pytest.mark.parametrize("curves", SENTENCES, ids="-".join)
def test_the_verdict_is_said(curves):
    said = grown(*curves).prose("limit")
    for sentence in SENTENCES[curves]:
        assert sentence in said
    opening = grown(*curves).prose("key-figures")
    for sentence in SENTENCES[curves]:
        short = sentence.replace("The mean of the whole mesh has", "It has")
        short = short.replace("Whether the mean of the whole mesh has", "Whether it has")
        assert short in opening


def test_a_limit_is_said_with_its_ends():
    text = grown("saturating", "level")
    row = whole(text, "limit_verdicts").iloc[0]
    assert row["has_limit"] == "yes"
    assert row["limit_low"] < 3.09 < row["limit_high"]
    ends = f"between {row['limit_low']:.4f} and {row['limit_high']:.4f} (95 %)"
    assert ends in text.prose("limit")


def test_models_on_both_sides_are_named():
    text = grown("slow", "level", spread=2.5)
    row = whole(text, "limit_verdicts").iloc[0]
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
    row = whole(text, "limit_verdicts").iloc[0]
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
        "larger sizes of this run. A p below 0.01 there"
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


@pytest.mark.parametrize(("interior", "agree"), [("level", "agree"), ("off", "do not agree")])
def test_the_edge_limit_is_held_against_the_interior(interior, agree):
    text = grown("thickening", interior)
    said = text.prose("limit")
    assert f"The two {agree}: they differ by " in said
    row = text.evidence.rows(EDGE_LIMITS, method="incremental", distribution="uniform").first
    assert row["interior"] == pytest.approx(CURVES[interior](np.array([1.0]))[0], abs=5e-4)
    assert f"the limit {row['limit']:.4f}; the interior of the larger meshes has the mean " in said
    assert f"{row['interior']:.4f}. The two" in said


def test_there_is_no_edge_limit_where_the_interior_grows():
    assert "The two" not in grown("saturating", "logarithmic").prose("limit")


# Beyond the data


def test_only_survivors_are_projected():
    text = grown("logarithmic", "saturating")
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
    limited = grown("saturating", "level").prose("projections")
    assert "(logarithmic" not in limited
    assert grown("wave", "wave").prose("projections") == ""


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
        assert float(match[1]) < float(match[5]) < float(match[3])
        assert match[4] == "linear"


def test_a_run_of_one_size_says_nothing():
    said = page_text(drawn(DESIGN.model_copy(update={"sizes": (2000,)})))
    for part in ("fits", "projections", "table-7"):
        assert said.prose(part) == ""
    assert said.finding("figure-models") == ""
