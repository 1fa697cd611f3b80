"""The edge of the mesh and its interior: where the mean comes from, and the longest paths."""

from collections.abc import Callable

import pandas as pd

from lepp import INTERIOR_LAYER
from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View, distribution_name, distribution_word
from reports.text.words import LEVEL
from study.analysis.part_changes import LAST_LAYERS, LAST_LAYERS_ARE, PART_CHANGES
from study.analysis.part_means import (
    ABOVE,
    BELOW,
    COMMON_MEANS,
    LAYER_MEANS,
    LONGEST_PATHS,
    PART_MEANS,
)
from study.analysis.parts import INTERIOR, WHOLE
from study.analysis.table import Rows
from study.statistics.thresholds import SIGNIFICANCE
from study.statistics.verdicts import REJECTED
from study.text.numbers import count, listed, none_or, p_is, show

#: Paths of a size that so many at least have are called long.
_LONG = 100
_DEFINITION = (
    f"The interior is all triangles that are {INTERIOR_LAYER} or more steps across edges away from "
    "a triangle at the hull; the edge is all others."
)


def section(evidence: Evidence) -> Section:
    """Means of the parts, means of the layers, the layers of the longest paths."""
    return Section(
        "edge",
        "The edge and the inside",
        "Where in the mesh does the mean come from?",
        (
            Subsection(
                "parts",
                "The mean with the edge and without",
                (
                    Prose(per_view(evidence.views, lambda view: _parts(evidence, view))),
                    _figure_parts(evidence),
                    TableBlock(PART_CHANGES, "How both means change", folded=True),
                    TableBlock(
                        COMMON_MEANS,
                        "Whether the distributions have one mean",
                        columns=(
                            "part",
                            "n_points",
                            "p",
                            "one_mean",
                            "mean_lepp",
                            "low",
                            "high",
                            "largest_difference",
                        ),
                        folded=True,
                    ),
                ),
            ),
            Subsection(
                "layers",
                "Layer by layer",
                (
                    Prose(per_view(evidence.views, lambda view: _layers(evidence, view))),
                    _figure_layers(evidence),
                    TableBlock(LAST_LAYERS, "The last layers and the interior", folded=True),
                ),
            ),
            Subsection(
                "longest",
                "Where the longest paths start",
                (
                    Prose(per_view(evidence.views, lambda view: _longest(evidence, view))),
                    _figure_longest(evidence),
                ),
            ),
        ),
    )


def _parts(evidence: Evidence, view: View) -> list[str] | None:
    whole = evidence.rows(PART_MEANS, view, part=WHOLE)
    interior = evidence.rows(PART_MEANS, view, part=INTERIOR)
    if whole.empty:
        return None
    if interior.empty:
        of = f"{view.method_word} triangulation of {view.distribution_word} points"
        return [f"{_DEFINITION} No {of} is large enough here to have an interior."]
    last = interior.last
    sentences = [
        f"{_DEFINITION} At {last['n_points']:,} points the edge has "
        f"{show(1 - last['share'], 'percent2')} of the triangles by the {view.method_word} method."
    ]
    first = interior.first
    at = whole.frame.set_index("n_points")["mean_lepp"]
    if len(interior) > 1:
        ends = (first["n_points"], last["n_points"])
        change = at[ends[1]] - at[ends[0]], last["mean_lepp"] - first["mean_lepp"]
        sentences.append(
            f"From {ends[0]:,} to {ends[1]:,} points the mean of the whole mesh changes by "
            f"{show(change[0], 'fixed4')}, from {show(at[ends[0]], 'fixed4')} to "
            f"{show(at[ends[1]], 'fixed4')}, and that of the interior by "
            f"{show(change[1], 'fixed4')}, from {show(first['mean_lepp'], 'fixed4')} to "
            f"{show(last['mean_lepp'], 'fixed4')}."
        )
        whose = _whose_change(evidence, view)
        if whose:
            sentences.append(f"{whose[0].upper()}{whose[1:]}.")
    paragraphs = [" ".join(sentences)]
    one = _one_mean(evidence, view)
    return [*paragraphs, one] if one else paragraphs


def _whose_change(evidence: Evidence, view: View) -> str | None:
    """Say whether the change of the mean is the edge's, as a clause; None if none is shown."""
    whole = evidence.one(PART_CHANGES, view, part=WHOLE)
    interior = evidence.one(PART_CHANGES, view, part=INTERIOR)
    if whole is None or interior is None or whole["p"] >= SIGNIFICANCE:
        return None
    # As shares of the change of the whole mesh, whichever its direction.
    low, high = sorted((interior["low"] / whole["change"], interior["high"] / whole["change"]))
    word = "growth" if whole["change"] > 0 else "fall"
    if high < 0.5:
        return f"most of the {word} of the whole mesh is the edge's"
    if low > 0.5:
        return f"most of the {word} of the whole mesh is the interior's own"
    return f"how much of the {word} of the whole mesh is the edge's stays open"


def edge_in_short(evidence: Evidence, view: View) -> str | None:
    """Say how the mean changes in the interior, and whose the change of the whole mesh is."""
    whose = _whose_change(evidence, view)
    row = evidence.one(PART_CHANGES, view, part=INTERIOR)
    if whose is None or row is None:
        return None
    return (
        f"In the interior, {INTERIOR_LAYER} steps or more from the hull, it changes by "
        f"{show(row['change'], 'fixed4')} ({LEVEL} from {show(row['low'], 'fixed4')} to "
        f"{show(row['high'], 'fixed4')}) from {row['from_points']:,} points to "
        f"{row['to_points']:,}: {whose}."
    )


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


def _one_mean(evidence: Evidence, view: View) -> str | None:
    """Say whether the distributions have one mean in the interior, at the largest size."""
    rows = evidence.rows(COMMON_MEANS, method=view.method, part=INTERIOR)
    if rows.empty:
        return None
    row = rows.last
    which = (
        f"the {distribution_word(row['lowest'])} points have the lowest and the "
        f"{distribution_word(row['highest'])} ones the highest, "
        f"{show(row['largest_difference'], 'fixed4')} apart"
    )
    opening = f"At {row['n_points']:,} points the interiors of the {row['distributions']} "
    p = p_is(row["log10_p"])
    if row["one_mean"] == REJECTED:
        return f"{opening}distributions do not have one mean ({p}): {which}."
    return (
        f"{opening}distributions may have one mean ({p}), {show(row['mean_lepp'], 'fixed4')} "
        f"({LEVEL} from {show(row['low'], 'fixed4')} to {show(row['high'], 'fixed4')}): {which}."
    )


def _lines(
    evidence: Evidence,
    rows_of: Callable[[str], Rows | pd.DataFrame],
    x: str,
    y: str,
    hover: str,
    in_legend: bool | None = None,
) -> list[Spec]:
    """Draw a line for each distribution that has rows, with intervals where there are some.

    Whether they are in the legend is said where several panels share one.
    """
    shared = in_legend is not None
    lines = []
    for series, distribution in enumerate(evidence.design.distributions):
        rows = rows_of(distribution)
        if rows.empty:
            continue
        name = distribution_name(distribution)
        line = style.scatter(
            x=rows.column(x) if isinstance(rows, Rows) else rows[x],
            y=rows.column(y) if isinstance(rows, Rows) else rows[y],
            mode="lines+markers",
            name=name,
            line=style.line(series),
            marker=style.marker(series),
            hovertemplate=f"{hover}<extra>{name}</extra>",
            **({"legendgroup": distribution, "showlegend": in_legend} if shared else {}),
        )
        if isinstance(rows, Rows) and "low" in rows.frame:
            line["error_y"] = style.interval(
                rows[y], rows["low"], rows["high"], style.line(series)["color"], thin=True
            )
        lines.append(line)
    return lines


def _figure_parts(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        def traces(part: str) -> list[Spec]:
            return _lines(
                evidence,
                lambda name: evidence.rows(PART_MEANS, View(view.method, name), part=part),
                "n_points",
                "mean_lepp",
                "%{x:,} points: %{y:.4f}",
                in_legend=part == WHOLE,
            )

        parts = [(part, traces(part)) for part in (WHOLE, INTERIOR)]
        drawn = [
            style.Panel(
                found,
                style.number_of_points(evidence.design.sizes),
                style.axis("Mean LEPP size"),
                title=f"The {part}{' mesh' if part == WHOLE else ''}",
            )
            for part, found in parts
            if found
        ]
        return style.panels(drawn, height=340 * len(drawn)) if drawn else None

    def say(view: View) -> str | None:
        words = []
        for part in (WHOLE, INTERIOR):
            rows = evidence.rows(PART_MEANS, method=view.method, part=part).frame
            if rows.empty:
                continue
            last = rows[rows["n_points"] == rows["n_points"].max()]["mean_lepp"]
            least, most = show(last.min(), "fixed4"), show(last.max(), "fixed4")
            means = (
                f"the means of {count(len(last), 'distribution')} lie between {least} and {most}"
                if len(last) > 1
                else f"the mean is {least}"
            )
            words.append(f"in the {'whole mesh' if part == WHOLE else part} {means}")
        if not words:
            return None
        largest = evidence.design.sizes_of(view.method)[-1]
        return f"At {largest:,} points, {listed(words)}."

    return FigureBlock(
        id="figure-parts",
        title="Mean LEPP size of the whole mesh and of its interior",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"Dots are means over triangulations with {LEVEL} intervals.",
        data=(
            TableBlock(PART_MEANS, "means of the parts", follows=("method",)),
        ),
    )  # fmt: skip


def _at_largest(evidence: Evidence, view: View) -> Rows:
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
        traces = _lines(
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
        f"{LEVEL} intervals over triangulations of the largest number of points.",
        data=(TableBlock(LAYER_MEANS, "means of the layers"),),
    )


def _longest(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(LONGEST_PATHS, view)
    if rows.empty:
        return None
    last = rows.last
    many = _many(evidence, view)
    sentences = []
    if not many.empty:
        long = many.iloc[-1]
        sentences.append(
            f"Of the {long['paths']:,} paths of {long['lepp_size']} triangles and more at "
            f"{long['n_points']:,} points, {none_or(_at_edge(long))} "
            f"{'starts' if _at_edge(long) < 2 else 'start'} at the edge; by its share of the "
            f"triangles, {show(long['edge_triangles'], 'percent2')}, "
            f"{show(_by_share(long), 'fixed1')} would."
        )
    longest = count(last["paths"], "path has", "paths have")
    sentences.append(
        f"At this number of points {longest} the largest size of all, {last['lepp_size']}, and "
        f"{_where_they_start(last)}."
    )
    return [" ".join(sentences)]


def _where_they_start(row: pd.Series) -> str:
    paths, inside, layer = row["paths"], row["interior_paths"], row["layer"]
    where = "in the interior" if layer == INTERIOR_LAYER else f"in layer {layer}"
    if paths == 1:
        return f"starts {where}"
    if row["layer_paths"] > paths / 2:
        return f"{'all' if row['layer_paths'] == paths else 'most'} start {where}"
    return f"{none_or(inside)} of them {'starts' if inside < 2 else 'start'} in the interior"


def _many(evidence: Evidence, view: View) -> pd.DataFrame:
    """Return the sizes that so many paths have or exceed that their shares say something."""
    rows = evidence.rows(LONGEST_PATHS, view)
    return rows.frame[rows["paths"] >= _LONG]


def _at_edge(long: pd.Series) -> int:
    return int(long["paths"] - long["interior_paths"])


def _by_share(long: pd.Series) -> float:
    """How many of the paths would start at the edge if they did so like all others."""
    return float(long["paths"] * long["edge_triangles"])


def _figure_longest(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        traces = _lines(
            evidence,
            lambda name: _many(evidence, View(view.method, name)),
            "lepp_size",
            "edge_share",
            "%{x} and more: %{y:.2%}",
        )
        if not traces:
            return None
        return style.plot(
            *traces,
            xaxis=style.axis("LEPP size of at least"),
            yaxis=style.shares(
                "Share that starts at the edge", max(max(trace["y"]) for trace in traces)
            ),
        )

    def say(view: View) -> str | None:
        words = []
        for distribution in evidence.design.distributions:
            many = _many(evidence, View(view.method, distribution))
            if not many.empty:
                long = many.iloc[-1]
                words.append(
                    f"{_at_edge(long):,} and {show(_by_share(long), 'fixed1')} of "
                    f"{long['paths']:,} for {distribution_word(distribution)} points (of "
                    f"{long['lepp_size']} triangles and more)"
                )
        if not words:
            return None
        return (
            "Of the longest paths, so many start at the edge, and so many would by its share of "
            f"the triangles: {'; '.join(words)}."
        )

    return FigureBlock(
        id="figure-longest",
        title="Where the longest paths start",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading="At the left end are all triangles: there the share is that of the edge in the "
        "mesh. A line that rises says that long paths start at the edge. It ends where fewer than "
        f"{_LONG} paths are left.",
        data=(TableBlock(LONGEST_PATHS, "paths by size and part"),),
    )
