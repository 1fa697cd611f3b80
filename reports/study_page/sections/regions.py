"""Terminal edges, and the regions of triangles whose paths end at one of them."""

import math

from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.text.words import LEVEL
from study.analysis.terminal_regions import REGION_SIZES, REGIONS
from study.text.numbers import show


def section(evidence: Evidence) -> Section:
    """How many terminal edges there are, and how large their regions."""
    return Section(
        "regions",
        "Terminal edges",
        "Where do the paths end?",
        (
            Subsection(
                "region-sizes",
                "The regions of terminal edges",
                (
                    Prose(per_view(evidence.views, lambda view: _say(evidence, view))),
                    _sizes(evidence),
                    TableBlock(
                        REGIONS,
                        "Terminal edges and regions by number of points",
                        columns=(
                            "n_points",
                            "edges_per_triangle",
                            "pair_share",
                            "pair_low",
                            "pair_high",
                            "mean_region",
                            "mean_region_low",
                            "mean_region_high",
                            "mean_max_region",
                            "max_region",
                        ),
                        folded=True,
                    ),
                ),
            ),
        ),
    )


def _say(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(REGIONS, view)
    if rows.empty:
        return None
    last = rows.last
    return [
        f"In {view.method_word} triangulations of {last['n_points']:,} {view.distribution_word} "
        f"points, {show(last['pair_share'], 'percent1')} of the triangles stand in a terminal "
        "pair: a refinement that starts there touches nothing else. The triangles whose paths end "
        f"at one terminal edge make a region of {show(last['mean_region'], 'fixed2')} triangles on "
        f"average; the largest in these triangulations has {last['max_region']:,}."
    ]


def _sizes(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        rows = evidence.rows(REGION_SIZES, view)
        if rows.empty:
            return None
        return style.plot(
            style.scatter(
                x=rows.column("region_size"),
                y=rows.column("share"),
                mode="markers",
                name="share of the regions",
                marker=style.marker(0, 6),
                error_y=style.interval(
                    rows["share"], rows["share_low"], rows["share_high"], style.SERIES[0]
                ),
                hovertemplate="%{x} triangles: %{y}<extra></extra>",
            ),
            xaxis=style.axis("Triangles in the region"),
            # Of a size that was seen once or twice, the interval reaches down to nothing.
            yaxis=style.powers(
                "Share of the regions", range=[math.log10(rows["share"].min()) - 0.5, 0]
            ),
        )

    def say(view: View) -> str | None:
        rows = evidence.rows(REGION_SIZES, view)
        if rows.empty:
            return None
        common = rows.frame.loc[rows["share"].idxmax()]
        within = rows["share"].cumsum()
        ninety = rows.frame.loc[(within >= 0.9).idxmax()]
        return (
            f"The commonest region has {common['region_size']} triangles "
            f"({show(common['share'], 'percent1')} of the regions); nine in ten have at most "
            f"{ninety['region_size']}; the largest, of all numbers of points, has "
            f"{rows['region_size'].max():,}."
        )

    return FigureBlock(
        id="figure-regions",
        title="Sizes of terminal-edge regions",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"Bars are {LEVEL} intervals: narrow where regions are many, wide where they are "
        "few. The vertical scale is logarithmic.",
        data=(TableBlock(REGION_SIZES, "sizes of the regions"),),
    )
