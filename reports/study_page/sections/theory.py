"""The theory against the measurement: Theorems 1 and 2, the geometric law, the worst case."""

import pandas as pd

from lepp.theory import LEAST_P, LEAST_P_TEXT
from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.study_page.sections.worst_case import worst_case
from reports.text.numbers import listed, show
from reports.text.words import LEVEL, PREMISE
from study.analysis.path_lengths import LAW, TERMINATION
from study.analysis.theorems import (
    MOST_SD,
    NEIGHBOR_TYPES,
    STATISTICS,
    THEOREM_1,
    THEOREM_2,
    TYPES,
)
from study.statistics.thresholds import A_HUNDREDTH, CONSTANT_RATE, ROUGH_RATE, WITHIN_ONE_PERCENT
from study.statistics.verdicts import NO, YES

#: The size from which on paths are called long.
LONG = 8


def section(evidence: Evidence) -> Section:
    """Types of neighbours, moments, termination, the law, bounds, the worst case."""
    largest: dict[str, object] = {"n_points": max(evidence.design.sizes)}
    return Section(
        "theory",
        "The theory",
        "Do the theorems describe what happens?",
        (
            Subsection(
                "types",
                "How often does a path end?",
                (
                    Prose(per_view(evidence.views, lambda view: _premise(evidence, view))),
                    _types(evidence),
                    TableBlock(THEOREM_2, "Theorem 2: its premise and its bounds", folded=True),
                ),
            ),
            Subsection(
                "theorem-1",
                "Theorem 1: four moments from one share",
                (
                    Prose(per_view(evidence.views, lambda view: _theorem_1(evidence, view))),
                    TableBlock(
                        THEOREM_1,
                        f"Theorem 1 and the measurement at {max(evidence.design.sizes):,} points",
                        where=largest,
                    ),
                    _moments(evidence),
                ),
            ),
            Subsection(
                "steps",
                "Step by step",
                (_termination(evidence), _law(evidence)),
            ),
            worst_case(evidence),
        ),
    )


def _premise(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(THEOREM_2, view)
    if rows.empty:
        return None
    p = rows.last
    premise = f"so the premise of Theorem 2, {PREMISE}, {_in_groups(rows['premise'])}"
    kept = rows["bounds"] == YES
    outcome = (
        "Its bounds hold in every single triangulation: means from "
        f"{show(rows['lowest_mean'].min(), 'fixed4')} to "
        f"{show(rows['highest_mean'].max(), 'fixed4')}, standard deviations up to "
        f"{show(rows['highest_sd'].max(), 'fixed4')}, where √{MOST_SD**2:g} is "
        f"{show(MOST_SD, 'fixed4')}."
        if kept.all()
        else f"Its bounds are broken in {int((~kept).sum())} of {len(rows)} groups."
    )
    return [
        "A path ends at a neighbour of type C: one whose own longest edge is the edge that is "
        f"crossed. At {p['n_points']:,} {view.distribution_word} points the share of such "
        f"neighbours is p\u00a0=\u00a0{show(p['p_type_c'], 'fixed4')}, {premise}. {outcome}"
    ]


def _in_groups(premise: pd.Series) -> str:
    holds, fails = int((premise == YES).sum()), int((premise == NO).sum())
    if len(premise) in (holds, fails):
        return f"{'holds' if holds else 'fails'} in every group"
    if fails:
        return f"fails in {fails} of {len(premise)} groups"
    return f"is clear in {holds} of {len(premise)} groups"


def _types(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        traces = []
        for series, name in enumerate(TYPES):
            rows = evidence.rows(NEIGHBOR_TYPES, view, type=name)
            if rows.empty:
                return None
            traces.append(
                style.scatter(
                    x=rows.column("n_points"),
                    y=rows.column("share"),
                    mode="lines+markers",
                    name=f"type {name}",
                    line=style.line(series),
                    marker=style.marker(series),
                    error_y=style.interval(
                        rows["share"], rows["low"], rows["high"], style.SERIES[series]
                    ),
                    hovertemplate="%{x:,} points: %{y:.4f}<extra>type " + name + "</extra>",
                )
            )
        return style.plot(
            *traces,
            xaxis=style.axis("Number of points"),
            yaxis=style.percents("Share of longest-edge neighbours", rangemode="tozero"),
            levels=[style.Level(LEAST_P, f"p = {LEAST_P_TEXT}")],
        )

    def say(view: View) -> str | None:
        rows = evidence.rows(NEIGHBOR_TYPES, view)
        if rows.empty:
            return None
        last = rows.select(n_points=rows["n_points"].max())
        shares = [
            f"{show(row.share, 'percent2')} of type {row.type}" for row in last.frame.itertuples()
        ]
        return (
            f"At {last['n_points'].iloc[0]:,} points, {listed(shares)}. A neighbour is of type A, "
            "B or C when the crossed edge is its shortest, middle or longest."
        )

    return FigureBlock(
        id="figure-types",
        title="Types of longest-edge neighbours",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"Bars are {LEVEL} intervals, mostly narrower than the markers; the dotted line is "
        "the least share of type C that Theorem 2 supposes.",
        data=(TableBlock(NEIGHBOR_TYPES, "shares of the types by number of points"),),
    )


def _theorem_1(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(THEOREM_1, view)
    if rows.empty:
        return None
    last = rows.select(n_points=rows["n_points"].max())
    off = [
        f"the {row.statistic} {show(abs(row.relative_difference), 'percent1')} "
        f"{'above' if row.relative_difference > 0 else 'below'}"
        for row in last.frame.itertuples()
    ]
    differences = last["relative_difference"]
    verdict = (
        "It describes the measurement closely"
        if differences.abs().max() < WITHIN_ONE_PERCENT
        else "It puts all four too high"
        if (differences < 0).all()
        else "It puts all four too low"
        if (differences > 0).all()
        else "It misses, now on one side and now on the other"
    )
    return [
        f"Theorem 1 makes all four moments out of p alone. {verdict}: at "
        f"{last['n_points'].iloc[0]:,} points the measured values lie, against the theorem's, "
        f"{listed(off)}."
    ]


def _moments(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        if evidence.rows(THEOREM_1, view).empty:
            return None
        return style.panels(
            [_moment(evidence, view, name) for name in STATISTICS], columns=2, height=540
        )

    def say(view: View) -> str | None:
        rows = evidence.rows(THEOREM_1, view)
        if rows.empty:
            return None
        inside = int(
            ((rows["low"] <= rows["predicted"]) & (rows["predicted"] <= rows["high"])).sum()
        )
        return (
            f"Theorem 1's value lies inside the {LEVEL} interval of the measured one in {inside} "
            f"of {len(rows)} cases (four moments at each number of points)."
        )

    return FigureBlock(
        id="figure-moments",
        title="The four moments, measured and by Theorem 1",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"Bars are {LEVEL} intervals, mostly narrower than the markers. The scales differ; "
        "what matters is the distance between the two lines of a panel.",
        data=(TableBlock(THEOREM_1, "moments by number of points"),),
    )


def _moment(evidence: Evidence, view: View, statistic: str) -> style.Panel:
    rows = evidence.rows(THEOREM_1, view, statistic=statistic)
    traces = [
        style.scatter(
            x=rows.column("n_points"),
            y=rows.column(column),
            mode="lines+markers",
            name=name,
            legendgroup=name,
            showlegend=statistic == STATISTICS[0],
            line=style.line(series),
            marker=style.marker(series, 5),
            hovertemplate="%{x:,} points: %{y:.4f}<extra>" + name + "</extra>",
            **(
                {
                    "error_y": style.interval(
                        rows[column], rows["low"], rows["high"], style.SERIES[0]
                    )
                }
                if column == "measured"
                else {}
            ),
        )
        for series, (column, name) in enumerate(
            (("measured", "measured"), ("predicted", "Theorem 1"))
        )
    ]
    return style.Panel(
        traces, style.axis("Number of points"), style.axis(""), statistic.capitalize()
    )


def _termination(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        rows = _steps(evidence, view)
        rows = rows[rows["low"].notna()]
        if rows.empty:
            return None
        p = float(rows["p_type_c"].iloc[0])
        return style.plot(
            style.scatter(
                x=rows["lepp_size"],
                y=rows["rate"],
                mode="lines+markers",
                name="measured",
                line=style.line(0),
                marker=style.marker(0),
                error_y=style.interval(rows["rate"], rows["low"], rows["high"], style.SERIES[0]),
                hovertemplate="size %{x}: %{y:.4f}<extra></extra>",
            ),
            xaxis=style.whole("LEPP size reached", int(rows["lepp_size"].max())),
            yaxis=style.axis("Share of paths that end there", range=[0, 1.02]),
            levels=[style.Level(p, f"Theorem 1: p\u00a0=\u00a0{show(p, 'fixed4')}")],
        )

    def say(view: View) -> str | None:
        rows = _steps(evidence, view)
        if rows.empty:
            return None
        steps = [
            f"{show(row.rate, 'percent1')} at size {row.lepp_size}"
            for row in rows.head(4).itertuples()
        ]
        sure = rows[(rows["high"] - rows["low"] < ROUGH_RATE).cummin()]
        known = sure if len(sure) > 1 else rows
        constant = float(known["rate"].max() - known["rate"].min()) < CONSTANT_RATE
        verdict = f"is constant to {A_HUNDREDTH}, as" if constant else f"{_trend(known)}, while"
        return (
            f"The share of paths that end {verdict} Theorem 1 takes it to be constant: "
            f"{listed(steps)}."
        )

    return FigureBlock(
        id="figure-termination",
        title="Termination rate at each size of the path",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"Of the paths that reach a size, the share that end there, with {LEVEL} "
        "intervals.",
        data=(TableBlock(TERMINATION, "termination rates"),),
    )


def _steps(evidence: Evidence, view: View) -> pd.DataFrame:
    """Termination rates from size 2 on, that is without the paths that never take a step."""
    rows = evidence.rows(TERMINATION, view)
    return rows.frame[rows["lepp_size"] >= 2]


def _trend(rows: pd.DataFrame) -> str:
    rates, upto = rows["rate"], f"with every step up to size {rows['lepp_size'].iloc[-1]}"
    if rates.is_monotonic_increasing:
        return f"rises {upto}"
    if rates.is_monotonic_decreasing:
        return f"falls {upto}"
    return f"moves between {show(rates.min(), 'percent1')} and {show(rates.max(), 'percent1')}"


def _law(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        rows = evidence.rows(LAW, view)
        if rows.empty:
            return None
        return style.plot(
            style.bars(
                x=rows.column("lepp_size"),
                y=rows.column("share"),
                name="measured",
                marker={"color": style.SERIES[0]},
                hovertemplate="size %{x}: %{y}<extra>measured</extra>",
            ),
            style.scatter(
                x=rows.column("lepp_size"),
                y=rows["geometric_share"].where(rows["geometric_share"] > 0),
                mode="lines+markers",
                name="geometric law of the measured p",
                line=style.line(1),
                marker=style.marker(1),
                hovertemplate="size %{x}: %{y}<extra>geometric law</extra>",
            ),
            xaxis=style.whole("LEPP size", int(rows["lepp_size"].max())),
            yaxis=style.powers("Share of triangles"),
            bargap=0.3,
        )

    def say(view: View) -> str | None:
        law = evidence.rows(LAW, view)
        rows = law.frame[law["geometric_share"] > 0]
        if rows.empty:
            return None
        common = rows.loc[rows["share"].idxmax()]
        long = rows[rows["lepp_size"] >= LONG]
        sentence = (
            f"The commonest size is {common['lepp_size']} ({show(common['share'], 'percent1')} of "
            f"the triangles; the law has {show(common['geometric_share'], 'percent1')})."
        )
        if len(long):
            # The law's own tail: (1 - p)^(k - 2) of the paths are of size k and more.
            p = float(evidence.rows(TERMINATION, view).first["p_type_c"])
            measured, expected = float(long["share"].sum()), float((1 - p) ** (LONG - 2))
            sentence += (
                f" Sizes of {LONG} and more are {show(expected / measured, 'g2')} times rarer than "
                "in the law."
                if measured < expected
                else f" Sizes of {LONG} and more are {show(measured / expected, 'g2')} times as "
                "common as in the law."
            )
        return sentence

    return FigureBlock(
        id="figure-law",
        title="LEPP sizes against the geometric law",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading="The vertical scale is logarithmic: a geometric law is a straight line.",
        data=(TableBlock(LAW, "LEPP sizes and the law"),),
    )
