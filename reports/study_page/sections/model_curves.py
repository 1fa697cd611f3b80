"""The curves of the models of growth, beside the means that they are fitted to or predict."""

import pandas as pd

from reports.page import style
from reports.page.blocks import FigureBlock, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.text.words import LEVEL
from study.analysis.group_summaries import GROUPS
from study.analysis.model_scores import MODEL_SCORES, PREDICTIONS, SURVIVES
from study.analysis.part_means import PART_MEANS
from study.analysis.parts import INTERIOR, WHOLE
from study.analysis.regressions import CURVES, LEAST_SQUARES, PREDICTION
from study.statistics.models import LINEAR_MODELS, MODELS
from study.text.numbers import show

#: What the legend calls the space between the ends of an interval.
_BAND = f"{LEVEL} of what a model that survives predicts"


def curves_figure(evidence: Evidence, name: str, title: str, paper: str, which: str) -> FigureBlock:
    """Draw the means, and the curves of `which` of the two kinds of fits."""

    def draw(view: View) -> Spec | None:
        panels = [_panel(evidence, view, part, which) for part in (WHOLE, INTERIOR)]
        drawn = [panel for panel in panels if panel]
        return style.panels(drawn, height=380 * len(drawn)) if drawn else None

    def say(view: View) -> str | None:
        rows = evidence.rows(CURVES, view, part=WHOLE, view=which)
        if rows.empty:
            return None
        groups = evidence.rows(GROUPS, view)
        n = groups["n_points"].max()
        last = rows.select(n_points=n).frame.set_index("model")
        return (
            f"At {n:,} points the curves for the whole mesh are from "
            f"{show(last['prediction'].min(), 'fixed4')} ({last['prediction'].idxmin()}) to "
            f"{show(last['prediction'].max(), 'fixed4')} ({last['prediction'].idxmax()}), and the "
            f"measured mean is {show(groups.last['mean_lepp'], 'fixed4')}."
        )

    fitted = {
        PREDICTION: "curves are weighted fits of the models that survive and of the paper's "
        "logarithmic one, to the sizes up to the upright line only, and go on beyond it; shaded is "
        f"the {LEVEL} interval of what a model that survives predicts there, which holds if the "
        "model does",
        LEAST_SQUARES: "curves are least squares fits to all sizes, of the paper's four models",
    }[which]
    return FigureBlock(
        id=name,
        title=title,
        paper=paper,
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"Dots are the means with {LEVEL} intervals; {fitted}.",
        data=(TableBlock(CURVES, f"points of the curves ({which})", where={"view": which}),),
    )


def _panel(evidence: Evidence, view: View, part: str, which: str) -> style.Panel | None:
    means = evidence.rows(PART_MEANS, view, part=part)
    curves = evidence.rows(CURVES, view, part=part, view=which).frame
    traces = _lines(evidence, view, part, which)
    if means.empty or not traces:
        return None
    if which == PREDICTION:
        traces = [*_bands(evidence, view, part), *traces]
    low, high = _heights(means["mean_lepp"], curves if which == PREDICTION else curves[:0])
    # Of all panels, so that all are logarithmic or none.
    every = evidence.rows(CURVES, view, view=which)["n_points"]
    sizes = list(every) if which == PREDICTION else evidence.design.sizes
    scores = evidence.rows(MODEL_SCORES, view, part=part)
    if which == PREDICTION and not scores.empty:
        end = scores.first["fitted_up_to"]
        traces.append(
            style.scatter(
                x=[end, end],
                y=[low, high],
                mode="lines",
                name="end of the sizes fitted",
                legendgroup="end",
                showlegend=part == WHOLE,
                line={"color": style.MUTED, "width": 1.5, "dash": "dot"},
                hoverinfo="skip",
            )
        )
    traces.append(
        style.scatter(
            x=means.column("n_points"),
            y=means.column("mean_lepp"),
            mode="markers",
            name="means",
            legendgroup="means",
            showlegend=part == WHOLE,
            marker={"color": style.INK, "size": 6},
            error_y=style.interval(
                means["mean_lepp"], means["low"], means["high"], style.MUTED, thin=True
            ),
            hovertemplate="%{x:,} points: %{y:.4f}<extra></extra>",
        )
    )
    return style.Panel(
        traces,
        style.number_of_points(sizes, fixed=True),
        style.axis("Mean LEPP size", range=[low, high]),
        title=f"The {part}{' mesh' if part == WHOLE else ''}",
    )


def _lines(evidence: Evidence, view: View, part: str, which: str) -> list[Spec]:
    traces: list[Spec] = []
    models = LINEAR_MODELS if which == LEAST_SQUARES else MODELS
    for series, model in enumerate(one.name for one in models):
        rows = evidence.rows(CURVES, view, part=part, model=model, view=which)
        if not rows.empty:
            traces.append(
                style.scatter(
                    x=rows.column("n_points"),
                    y=rows.column("prediction"),
                    mode="lines",
                    name=model,
                    legendgroup=model,
                    showlegend=part == WHOLE,
                    # Pale and wide, the first is seen beside one that lies on it.
                    line=style.line(series, 2 if traces else 5),
                    opacity=1 if traces else 0.5,
                    hovertemplate="%{x:,} points: %{y:.4f}<extra>" + model + "</extra>",
                )
            )
    return traces


def _bands(evidence: Evidence, view: View, part: str) -> list[Spec]:
    """Fill the intervals of what the models that survive predict."""
    traces: list[Spec] = []
    for model in evidence.rows(MODEL_SCORES, view, part=part, standing=SURVIVES)["model"]:
        rows = evidence.rows(PREDICTIONS, view, part=part, model=model)
        if len(rows) > 1:
            low, high = style.band(
                rows.column("n_points"), rows.column("low"), rows.column("high"), _BAND
            )
            shown = part == WHOLE and not traces
            traces += [low, high | {"legendgroup": "band", "showlegend": shown}]
    return traces


def _heights(means: pd.Series, curves: pd.DataFrame) -> tuple[float, float]:
    """Return the ends of the vertical axis: all means, and all of each curve that stays near them.

    A curve that goes further away than the means lie apart leaves the panel: a parabola would
    squeeze all others together.
    """
    low, high = float(means.min()), float(means.max())
    apart = max(high - low, 0.004)
    ends = curves.groupby("model")["prediction"].agg(["min", "max"])
    near = ends[(ends["min"] > low - apart) & (ends["max"] < high + apart)]
    low, high = min([low, *near["min"]]), max([high, *near["max"]])
    return low - apart / 4, high + apart / 4
