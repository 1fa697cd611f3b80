"""Where in the mesh the longest paths start."""

import pandas as pd

from lepp import INTERIOR_LAYER
from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View, distribution_word
from reports.study_page.sections.distribution_lines import lines_by_distribution
from study.analysis.part_means import LONGEST_PATHS
from study.text.numbers import count, none_or, show

#: Paths of a size that so many at least have are called long.
_LONG = 100


def longest_paths(evidence: Evidence) -> Subsection:
    """Hold the longest paths that start at the edge against its share of the mesh."""
    return Subsection(
        "longest",
        "Where the longest paths start",
        (
            Prose(per_view(evidence.views, lambda view: _longest(evidence, view))),
            _figure_longest(evidence),
        ),
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
        traces = lines_by_distribution(
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
