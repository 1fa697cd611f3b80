"""The distributions of the points against each other."""

import pandas as pd

from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View, distribution_name, distribution_word
from reports.text.words import LEVEL
from study.analysis.distribution_comparison import (
    ALIKE,
    DIFFER,
    DISTRIBUTION_MEANS,
    DISTRIBUTIONS_COMPARED,
    LITTLE,
    MARGIN,
    equivalent,
)
from study.analysis.parts import INTERIOR, PARTS, WHOLE
from study.statistics.verdicts import NO, UNDECIDED, YES
from study.text.numbers import count, listed, show

_OF = {WHOLE: "Of whole meshes", INTERIOR: "Of their interiors"}


def section(evidence: Evidence) -> Section:
    """All pairs in words, all means in one figure, the pairs in a table."""
    return Section(
        "distributions",
        "The distributions against each other",
        "Does it matter how the points are distributed?",
        (
            Subsection(
                "distributions-compared",
                "All pairs, at every number of points",
                (
                    Prose(per_view(evidence.views, lambda view: _sentences(evidence, view))),
                    _figure(evidence),
                    TableBlock(
                        DISTRIBUTIONS_COMPARED,
                        "Every pair of distributions at every number of points",
                        columns=(
                            "part",
                            "n_points",
                            "distribution_1",
                            "distribution_2",
                            "relative",
                            "low",
                            "high",
                            "p_holm",
                            "verdict",
                        ),
                        follows=("method",),
                        folded=True,
                    ),
                ),
            ),
        ),
    )


def _sentences(evidence: Evidence, view: View) -> list[str] | None:
    paragraphs = []
    for part in PARTS:
        rows = evidence.rows(DISTRIBUTIONS_COMPARED, method=view.method, part=part)
        if not rows.empty:
            paragraphs.append(_compared(rows.frame, f"{_OF[part]}, triangulated by the "
                                        f"{view.method_word} method,"))  # fmt: skip
    return paragraphs or None


def _compared(rows: pd.DataFrame, whose: str) -> str:
    verdicts = rows["verdict"].value_counts()
    counted = [
        f"{verdicts[name]} {'shows' if verdicts[name] == 1 else 'show'} {words}"
        for name, words in (
            (ALIKE, f"no difference and leave room for less than {MARGIN}"),
            (LITTLE, f"one, of less than {MARGIN}"),
            (DIFFER, f"one that may be {MARGIN} or more"),
            (UNDECIDED, f"none, but leave room for {MARGIN} or more"),
        )
        if name in verdicts
    ]
    furthest = rows.loc[rows["relative"].abs().idxmax()]
    outcome = {
        YES: f"So the distributions agree within {MARGIN}",
        NO: f"So the distributions do not agree within {MARGIN}",
        UNDECIDED: f"Whether the distributions agree within {MARGIN} stays open",
    }[equivalent(rows["low"].to_numpy(), rows["high"].to_numpy())]
    same = set(verdicts.index) == {ALIKE}
    return (
        f"{whose} {count(len(rows), 'pair')} of means can be compared: {listed(counted)} "
        f"({LEVEL} intervals; tests at all sizes together, by Welch and Holm). The largest "
        f"difference is {show(furthest['relative'], 'percent2')} "
        f"({show(furthest['low'], 'percent2')} to {show(furthest['high'], 'percent2')}): "
        f"{distribution_word(furthest['distribution_2'])} against "
        f"{distribution_word(furthest['distribution_1'])} points, {furthest['n_points']:,} of "
        f"each. {outcome}{', and no difference is detected' if same else ''}."
    )


def _figure(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        parts = [
            _panel(evidence, view, part)
            for part in PARTS
            if not evidence.rows(DISTRIBUTION_MEANS, method=view.method, part=part).empty
        ]
        return style.panels(parts, height=380 * len(parts)) if parts else None

    def say(view: View) -> str | None:
        rows = evidence.rows(DISTRIBUTION_MEANS, method=view.method, part=WHOLE)
        if rows.empty:
            return None
        last = rows.frame[rows["n_points"] == rows["n_points"].max()]
        means = [
            f"{show(row.mean, 'fixed4')} ({distribution_word(row.distribution)})"
            for row in last.sort_values("mean").itertuples()
        ]
        return f"At {last['n_points'].iloc[0]:,} points the mean LEPP sizes are {listed(means)}."

    return FigureBlock(
        id="figure-distribution-means",
        title="Mean LEPP size by distribution of the points",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"Bars are {LEVEL} intervals of the means. Above the whole mesh, below its "
        "interior, where there is one.",
        data=(TableBlock(DISTRIBUTION_MEANS, "means of all distributions", follows=("method",)),),
    )


def _panel(evidence: Evidence, view: View, part: str) -> style.Panel:
    traces = []
    for series, distribution in enumerate(evidence.design.distributions):
        rows = evidence.rows(
            DISTRIBUTION_MEANS, method=view.method, part=part, distribution=distribution
        )
        if rows.empty:
            continue
        name = distribution_name(distribution)
        traces.append(
            style.scatter(
                x=rows.column("n_points"),
                y=rows.column("mean"),
                error_y={"type": "data", "array": rows.column("half"), "width": 2, "thickness": 1},
                mode="lines+markers",
                name=name,
                legendgroup=distribution,
                showlegend=part == WHOLE,
                line=style.line(series, 1.5),
                marker=style.marker(series, 5),
                hovertemplate="%{x:,} points: %{y:.4f}<extra>" + name + "</extra>",
            )
        )
    return style.Panel(
        traces,
        style.axis("Number of points", type="log", dtick="D2"),
        style.axis("Mean LEPP size"),
        f"{part.capitalize()} mesh" if part == WHOLE else f"{part.capitalize()}",
    )
