"""The mean layer by layer, in steps from the hull."""

import pandas as pd

from lepp import INTERIOR_LAYER
from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View, distribution_word
from reports.study_page.sections.distribution_lines import lines_by_distribution
from reports.text.words import LEVEL
from study.analysis.part_changes import LAST_LAYERS, LAST_LAYERS_ARE
from study.analysis.part_means import ABOVE, BELOW, LAYER_MEANS
from study.analysis.table import Rows
from study.statistics.groups import ENOUGH
from study.statistics.verdicts import REJECTED
from study.text.numbers import listed, p_is, show


def layers(evidence: Evidence) -> Subsection:
    """Hold each layer of the edge against the interior."""
    return Subsection(
        "layers",
        "Layer by layer",
        (
            Prose(per_view(evidence.views, lambda view: _layers(evidence, view))),
            _figure_layers(evidence),
            TableBlock(LAST_LAYERS, "The last layers and the interior", folded=True),
        ),
    )


def _at_largest(evidence: Evidence, view: View) -> Rows:
    """Take the largest number of points that the layers are told of."""
    rows = evidence.rows(LAYER_MEANS, view)
    return rows if rows.empty else rows.select(n_points=rows["n_points"].max())


def _layers(evidence: Evidence, view: View) -> list[str] | None:
    layers = _at_largest(evidence, view).frame
    edge = layers[layers["layer"] < INTERIOR_LAYER]
    if edge.empty:
        return None
    sentence = (
        f"The layer of a triangle is its number of steps from the hull. At "
        f"{edge['n_points'].iloc[0]:,} points the edge has {show(edge['share'].sum(), 'percent2')} "
        "of the triangles."
    )
    interior = layers[layers["layer"] == INTERIOR_LAYER]
    if interior.empty:
        return [sentence]
    inside = show(interior["mean_lepp"].iloc[0], "fixed4")
    below, above = (edge[edge["against_interior"] == side] for side in (BELOW, ABOVE))
    words = []
    if not below.empty:
        words.append(f"below it in {_layers_named(below)}")
    if not above.empty:
        top = above.loc[above["mean_lepp"].idxmax()]
        words.append(
            f"above it in {_layers_named(above)}, most in layer {top['layer']}, at "
            f"{_with_interval(top)}"
        )
    where = f"is {' and '.join(words)}" if words else "is not shown to differ from it in any layer"
    return [
        f"{sentence} The mean of the interior is {inside}; by tests of all layers, with Holm's "
        f"correction, that of the edge {where}.",
        *([reach] if (reach := _reach(evidence, view)) else []),
    ]


def _reach(evidence: Evidence, view: View) -> str | None:
    """Say whether the last layers before the interior still have the edge in them."""
    row = evidence.one(LAST_LAYERS, view)
    if row is None:
        return None
    layers = f"{LAST_LAYERS_ARE[0]} to {LAST_LAYERS_ARE[-1]}"
    opening = (
        f"Layers {layers}, the last before the interior, have a mean of "
        f"{show(row['last_layers'], 'fixed4')} together"
    )
    interval = f"{LEVEL} from {show(row['low'], 'fixed4')} to {show(row['high'], 'fixed4')}"
    off = show(row["difference"], "fixed4")
    if row["same_mean"] == REJECTED:
        side = "above" if row["difference"] > 0 else "below"
        return (
            f"{opening}, {show(abs(row['difference']), 'fixed4')} {side} that of the interior "
            f"(difference {interval}; {p_is(row['log10_p'])}): of "
            f"{view.distribution_word} points the edge, or what the density of the points has to "
            "do with it, reaches further, and some of it is in what is called the interior here."
        )
    return (
        f"{opening}, which is not shown to differ from that of the interior (by {off}, "
        f"{interval}): no reach of the edge beyond them is seen."
    )


def _layers_named(rows: pd.DataFrame) -> str:
    """Name layers, those in a row by the first and the last."""
    layers = rows["layer"].tolist()
    starts = [k for k in layers if k - 1 not in layers]
    ends = [k for k in layers if k + 1 not in layers]
    named = [f"{a} to {b}" if b > a else str(a) for a, b in zip(starts, ends, strict=True)]
    return f"layer{'s' if len(layers) > 1 else ''} {listed(named)}"


def _with_interval(row: pd.Series) -> str:
    value = show(row["mean_lepp"], "fixed2")
    if pd.isna(row["low"]):
        return value
    return f"{value} ({LEVEL} from {show(row['low'], 'fixed2')} to {show(row['high'], 'fixed2')})"


def _figure_layers(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        traces = lines_by_distribution(
            evidence,
            lambda name: _at_largest(evidence, View(view.method, name)),
            "layer",
            "mean_lepp",
            "layer %{x}: %{y:.4f}",
        )
        if not traces:
            return None
        ticks = list(range(0, INTERIOR_LAYER + 1, 5))
        return style.plot(
            *traces,
            xaxis=style.axis(
                "Layer: steps from the hull",
                tickvals=ticks,
                ticktext=[*map(str, ticks[:-1]), f"{ticks[-1]}+"],
            ),
            yaxis=style.axis("Mean LEPP size"),
            height=420,
        )

    def say(view: View) -> str | None:
        words, some = [], False
        for distribution in evidence.design.distributions:
            layers = _at_largest(evidence, View(view.method, distribution)).frame
            if layers.empty:
                continue
            above = layers[layers["against_interior"] == ABOVE]
            layer, some = "none", some or not above.empty
            if not above.empty:
                top = above.loc[above["mean_lepp"].idxmax()]
                layer = f"{top['layer']} ({show(top['mean_lepp'], 'fixed2')})"
            words.append(f"{distribution_word(distribution)} points, {layer}")
        if not words:
            return None
        interior = f"the interior, which begins at layer {INTERIOR_LAYER}"
        if not some:
            return f"No layer is shown to lie above {interior}, for any distribution."
        return f"The layer furthest above {interior}: {'; '.join(words)}."

    return FigureBlock(
        id="figure-layers",
        title="Mean LEPP size by layer",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"The last dot is the interior: layer {INTERIOR_LAYER} and all beyond. Lines are "
        f"{LEVEL} intervals over triangulations of one number of points: the largest with "
        f"{ENOUGH} triangulations or more, if there is one.",
        data=(TableBlock(LAYER_MEANS, "means of the layers"),),
    )
