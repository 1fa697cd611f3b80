"""The regressions: how the mean grows with n, and what each model makes of larger n (Table 7)."""

import numpy as np
import pandas as pd

from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.text.numbers import listed, show, ten_to
from reports.text.words import LEVEL, PREMISE
from study.analysis.bound_tests import LOWER_BOUND, UPPER_BOUND
from study.analysis.group_summaries import GROUPS
from study.analysis.regressions import (
    BEYOND,
    COEFFICIENTS,
    CURVES,
    INSIDE,
    LEAST_SQUARES,
    LIMITS,
    MODELS,
    PROJECTIONS,
    REGRESSIONS,
)
from study.statistics.models import LINEAR_MODELS
from study.statistics.thresholds import SIGNIFICANCE
from study.statistics.verdicts import UNDECIDED


def section(evidence: Evidence) -> Section:
    """Fits inside the data, projections beyond them."""
    return Section(
        "regressions",
        "The regressions",
        "How does the mean grow with the number of points?",
        (
            Subsection(
                "fits",
                "Inside the data",
                (
                    Prose(per_view(evidence.views, lambda view: _fits(evidence, view))),
                    _figure_6(evidence),
                    TableBlock(
                        REGRESSIONS,
                        "The models",
                        paper="Table 7",
                        columns=(
                            "model",
                            "fitting",
                            "formula",
                            "adj_r2",
                            "log10_p",
                            "lack_of_fit_p",
                            "aic",
                            "bic",
                            "left_out_rmse",
                        ),
                    ),
                    TableBlock(
                        COEFFICIENTS, "Coefficients of the models, with intervals", folded=True
                    ),
                ),
            ),
            Subsection(
                "projections",
                "Beyond the data",
                (
                    Prose(per_view(evidence.views, lambda view: _beyond(evidence, view))),
                    _figure_7(evidence),
                    TableBlock(LIMITS, "What each model says of an infinite mesh", folded=True),
                ),
            ),
        ),
    )


_LIMIT_WORDS = {UNDECIDED: "stays undecided"}


def best(evidence: Evidence, view: View, column: str = "aic") -> pd.Series | None:
    """Return the least squares fit with the lowest AIC (or another column)."""
    rows = evidence.rows(REGRESSIONS, view, fitting=LEAST_SQUARES)
    known = rows.frame.dropna(subset=[column])
    return None if known.empty else known.loc[known[column].idxmin()]


def _fits(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(REGRESSIONS, view, fitting=LEAST_SQUARES)
    if rows.empty:
        return None
    by = {name: best(evidence, view, name) for name in ("aic", "bic", "left_out_rmse")}
    names = {name: row["model"] for name, row in by.items() if row is not None}
    four = rows.frame[rows["model"].isin([model.name for model in LINEAR_MODELS])]
    sentences = []
    if not four.empty:
        top = four.loc[four["adj_r2"].idxmax()]
        sentences.append(
            f"Of the paper's four models the {top['model']} one fits the {view.distribution_word} "
            f"points best, with an adjusted R² of {show(top['adj_r2'], 'fixed3')}."
        )
    winners = set(names.values())
    labels = {"aic": "AIC", "bic": "BIC", "left_out_rmse": "the error of left-out groups"}
    if len(winners) == 1:
        sentences.append(
            f"AIC, BIC and the error of left-out groups all choose the {winners.pop()} model."
        )
    elif winners:
        sentences.append(
            "The criteria do not agree: "
            + listed([f"{labels[name]} chooses the {model} model" for name, model in names.items()])
            + "."
        )
    lacking = rows["model"][rows["lack_of_fit_p"] < SIGNIFICANCE].tolist()
    if lacking:
        sentences.append(
            f"The {listed(lacking)} {'model does' if len(lacking) == 1 else 'models do'} not "
            f"follow the groups' means: lack of fit is significant at {SIGNIFICANCE}."
        )
    return [" ".join(sentences)]


def _figure_6(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        groups = evidence.rows(GROUPS, view)
        curves = _curves(evidence, view, INSIDE)
        if not curves:
            return None
        return style.plot(
            style.scatter(
                x=groups.column("n_points"),
                y=groups.column("mean_lepp"),
                mode="markers",
                name="groups",
                marker={"color": style.INK, "size": 7},
                error_y=style.interval(
                    groups["mean_lepp"], groups["mean_low"], groups["mean_high"]
                ),
                hovertemplate="%{x:,} points: %{y:.4f}<extra></extra>",
            ),
            *curves,
            xaxis=style.axis("Number of points"),
            yaxis=style.axis("Mean LEPP size"),
            height=440,
        )

    def say(view: View) -> str | None:
        curves = evidence.rows(CURVES, view, view=INSIDE)
        if curves.empty:
            return None
        wide = curves.frame.pivot_table(index="n_points", columns="model", values="prediction")
        gap = float((wide.max(axis=1) - wide.min(axis=1)).max())
        return f"Inside the data the models lie within {show(gap, 'fixed4')} of one another."

    return FigureBlock(
        id="figure-models",
        title="The models inside the data",
        paper="Figure 6",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"Dots are the groups' means with {LEVEL} intervals, curves least squares fits.",
        data=(TableBlock(CURVES, "points of the curves"),),
    )


def _figure_7(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        curves = _curves(evidence, view, BEYOND)
        if not curves:
            return None
        groups = evidence.rows(GROUPS, view)
        return style.plot(
            *curves,
            style.scatter(
                x=groups.column("n_points"),
                y=groups.column("mean_lepp"),
                mode="markers",
                name="groups",
                marker={"color": style.INK, "size": 5},
                hovertemplate="%{x:,} points: %{y:.4f}<extra></extra>",
            ),
            xaxis=style.powers("Number of points"),
            yaxis=style.axis("Mean LEPP size", range=[LOWER_BOUND - 0.2, UPPER_BOUND + 0.2]),
            levels=(
                style.Level(UPPER_BOUND, f"upper bound {UPPER_BOUND}"),
                style.Level(LOWER_BOUND, f"lower bound {LOWER_BOUND}", above=False),
            ),
            height=440,
        )

    def say(view: View) -> str | None:
        limits = evidence.rows(LIMITS, view, fitting=LEAST_SQUARES)
        far = evidence.rows(PROJECTIONS, view, fitting=LEAST_SQUARES)
        if limits.empty or far.empty:
            return None
        at_most = int(far["n_points"].max())
        there = far.select(n_points=at_most).frame.set_index("model")["prediction"]
        words = [
            f"the {row.model} one {_LIMIT_WORDS.get(row.limit, row.limit)} "
            f"({show(there[row.model], 'g4')} there"
            + (f", {show(row.value, 'fixed4')} in the end)" if row.value == row.value else ")")
            for row in limits.frame.itertuples()
        ]
        return (
            f"Far beyond the data, drawn up to {ten_to(int(np.log10(at_most)))} "
            f"points: {listed(words)}."
        )

    return FigureBlock(
        id="figure-projections",
        title="The models far beyond the data",
        paper="Figure 7",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"A curve beyond the dotted bounds is at odds with Theorem 2 if {PREMISE}.",
        data=(TableBlock(PROJECTIONS, "What each model predicts, with intervals"),),
    )


def _curves(evidence: Evidence, view: View, part: str) -> list[Spec]:
    curves = []
    for series, model in enumerate(one.name for one in MODELS):
        rows = evidence.rows(CURVES, view, model=model, view=part)
        if not rows.empty:
            curves.append(
                style.scatter(
                    x=rows.column("n_points"),
                    y=rows.column("prediction"),
                    mode="lines",
                    name=model,
                    # Pale and wide, the first is seen beside one that lies on it.
                    line=style.line(series, 2 if series else 5),
                    opacity=1 if series else 0.5,
                    hovertemplate="%{x:,} points: %{y:.4f}<extra>" + model + "</extra>",
                )
            )
    return curves


def _beyond(evidence: Evidence, view: View) -> list[str] | None:
    chosen = best(evidence, view)
    rows = evidence.rows(PROJECTIONS, view, fitting=LEAST_SQUARES)
    if chosen is None or rows.empty:
        return None
    far = rows.select(n_points=rows["n_points"].max())
    power = ten_to(int(np.log10(far.first["n_points"])))
    words = [f"{show(row.prediction, 'g4')} ({row.model})" for row in far.frame.itertuples()]
    of_chosen = rows.select(model=chosen["model"])
    steps = [
        f"{show(row.prediction, 'fixed4')} at {ten_to(int(np.log10(row.n_points)))}"
        for row in of_chosen.frame.itertuples()
    ]
    return [
        f"At {power} points the models predict a mean of {listed(words)}. "
        f"The {chosen['model']} model, which has the lowest AIC, predicts "
        f"{listed(steps)} points."
    ]
