"""The theory against the measurement: Theorems 1 and 2, the laws of paths, the worst case."""

import pandas as pd

from lepp.theory import LEAST_P, LEAST_P_TEXT
from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.study_page.sections.assumptions import groups_tested
from reports.study_page.sections.continuation import going_on, one_chance, sure
from reports.study_page.sections.worst_case import worst_case
from reports.text.words import LEVEL, PREMISE
from study.analysis.parts import INTERIOR
from study.analysis.path_lengths import (
    CONTINUATION,
)
from study.analysis.table import Rows
from study.analysis.theorems import (
    MEAN,
    MOST_MEAN,
    MOST_SD,
    NEIGHBOR_TYPES,
    STATISTICS,
    THEOREM_1,
    THEOREM_2,
    TYPES,
)
from study.statistics.thresholds import ROUGH_RATE
from study.statistics.verdicts import NO, YES
from study.text.numbers import count, listed, show


def section(evidence: Evidence) -> Section:
    """Types of neighbours and bounds, moments, the chance to go on, the worst case."""
    largest = evidence.design.largest_of_all
    return Section(
        "theory",
        "The theory",
        "Do the theorems describe what happens?",
        (
            Subsection(
                "types",
                "How often does a path end at its first step?",
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
                        f"Theorem 1 and the measurement at {largest:,} points",
                        where={"n_points": largest},
                    ),
                    _moments(evidence),
                ),
            ),
            going_on(evidence),
            worst_case(evidence),
        ),
    )


def _premise(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(THEOREM_2, view)
    if rows.empty:
        return None
    last = rows.last
    size = f"{last['n_points']:,} {view.distribution_word} points"
    moments = evidence.one(THEOREM_1, view, n_points=last["n_points"])
    all_steps = ""
    if moments is not None:
        r = show(moments["p_all_steps"], "fixed4")
        all_steps = f" Of all steps together, a share of r\u00a0=\u00a0{r} ends a path."
    return [
        "A path ends at a neighbour of type C: one whose own longest edge is the edge that is "
        f"crossed. At {size} the share of such neighbours, which is the chance that a path ends at "
        "its first step, but for the few that end at the boundary there, is "
        f"p\u00a0=\u00a0{show(last['p_type_c'], 'fixed4')}.{all_steps}",
        f"Theorem 2 supposes {PREMISE} and, with Theorem 1, the same p at every step. Its bounds "
        f"need less: if every step ends a path with a chance of at least {LEAST_P_TEXT}, which may "
        "differ from step to step, then at most (2/3)ʲ of the paths go on for j steps after "
        f"their second triangle, the mean is at most 2 + 2/3 + (2/3)² + … = {MOST_MEAN:g}, and the "
        f"standard deviation at most √{MOST_SD**2:g}, for no law of such chances varies more than "
        f"that of 1/3 throughout. {_every_step(evidence, view)} "
        f"{_bounds_hold(rows)}",
    ]


def _every_step(evidence: Evidence, view: View) -> str:
    rows = evidence.rows(THEOREM_2, view)
    premise = rows["premise"].dropna()
    holds, fails = int((premise == YES).sum()), int((premise == NO).sum())
    verb = "fails" if fails else "holds" if holds == len(premise) else "is clear"
    where = groups_tested(evidence, view, fails or holds, len(premise))
    known = rows.frame.dropna(subset="lowest_rate")
    if known.empty:
        return f"No step is known to within {ROUGH_RATE:g}, so that this stays open."
    least = known.loc[known["lowest_rate"].idxmin()]
    return (
        f"As far as the chances are known to within {ROUGH_RATE:g}, this {verb} in {where}: "
        f"the least chance to end, at a neighbour of type C or at the boundary, is "
        f"{show(least['lowest_rate'], 'fixed4')}, at size {least['lowest_size']} and "
        f"{least['n_points']:,} points.{_of_the_edge(evidence, view, least)}"
    )


def _of_the_edge(evidence: Evidence, view: View, least: pd.Series) -> str:
    """Say of the interior what its least chance to end is, if that is higher."""
    inside = sure(evidence.rows(CONTINUATION, view, part=INTERIOR).frame)
    if inside.empty:
        return ""
    lowest = inside.loc[inside["rate"].idxmax()]
    whole = evidence.one(THEOREM_2, view, n_points=lowest["n_points"])
    if whole is None or not 1 - lowest["high"] > whole["lowest_high"]:
        return ""
    where = "The edge of the mesh has a part in it: in the interior,"
    if whole["n_points"] != least["n_points"]:
        whole_mesh = show(whole["lowest_rate"], "fixed4")
        where = f"Where it is {whole_mesh}, the edge of the mesh has a part in it: in the interior,"
    if 1 - lowest["low"] < LEAST_P:
        where = f"It is higher in the interior, but below {LEAST_P_TEXT} there as well:"
    return (
        f" {where} at {lowest['n_points']:,} points, the least is "
        f"{show(1 - lowest['rate'], 'fixed4')}, at size "
        f"{lowest['lepp_size']}, as far as the chances there are known (up to size "
        f"{inside['lepp_size'].max()})."
    )


def _bounds_hold(rows: Rows) -> str:
    kept = rows["bounds"] == YES
    if not kept.all():
        return f"The bounds are broken in {int((~kept).sum())} of {len(rows)} groups."
    return (
        "The bounds hold in every single triangulation: means from "
        f"{show(rows['lowest_mean'].min(), 'fixed4')} to "
        f"{show(rows['highest_mean'].max(), 'fixed4')}, standard deviations up to "
        f"{show(rows['highest_sd'].max(), 'fixed4')}, where √{MOST_SD**2:g} is "
        f"{show(MOST_SD, 'fixed4')}. The lower one, 2, is the size of the shortest path inside."
    )


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
            xaxis=style.number_of_points(evidence.design.sizes),
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
    others = last.frame[last["statistic"] != MEAN]
    first = last.first
    return [
        "Theorem 1 takes the chance to end to be the same at every step, and makes all four "
        f"moments out of it. {one_chance(evidence, view)} At {first['n_points']:,} points, "
        "measured are, against the theorem with "
        f"p\u00a0=\u00a0{show(first['p_type_c'], 'fixed4')} of the first step, "
        f"{_off(last.frame, 'relative_difference')}; against it with "
        f"r\u00a0=\u00a0{show(first['p_all_steps'], 'fixed4')} of all steps, where the mean fits "
        f"by construction, {_off(others, 'difference_all_steps')}."
    ]


def _off(rows: pd.DataFrame, column: str) -> str:
    return listed(
        [
            f"the {statistic} {show(abs(off), 'percent1')} {'above' if off > 0 else 'below'}"
            for statistic, off in zip(rows["statistic"], rows[column], strict=True)
        ]
    )


def _moments(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        if evidence.rows(THEOREM_1, view).empty:
            return None
        return style.panels(
            [_moment(evidence, view, name) for name in STATISTICS], columns=2, height=540
        )

    def say(view: View) -> str | None:
        every = evidence.rows(THEOREM_1, view).frame
        rows = every.dropna(subset="low")
        if rows.empty:
            return None
        inside = int(rows["predicted"].between(rows["low"], rows["high"]).sum())
        return (
            f"With p of the first step, Theorem 1's value lies inside the {LEVEL} interval of the "
            f"measured one in {inside} of {count(len(rows), 'case')} (four moments at each number "
            f"of points{' that has intervals' if len(rows) < len(every) else ''})."
        )

    return FigureBlock(
        id="figure-moments",
        title="The four moments, measured and by Theorem 1",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"Bars are {LEVEL} intervals, mostly narrower than the markers. The scales differ; "
        "what matters is the distance between the lines of a panel. With r of all steps the mean "
        "fits by construction.",
        data=(TableBlock(THEOREM_1, "moments by number of points"),),
    )


def _moment(evidence: Evidence, view: View, statistic: str) -> style.Panel:
    rows = evidence.rows(THEOREM_1, view, statistic=statistic)
    # With r the mean is the measured one: wide squares below show that it lies there.
    traces = [
        style.scatter(
            x=rows.column("n_points"),
            y=rows.column(column),
            mode="lines+markers",
            name=name,
            legendgroup=name,
            showlegend=statistic == STATISTICS[0],
            line=style.line(series),
            marker=style.marker(series, 10, symbol="square-open")
            if column == "predicted_all_steps"
            else style.marker(series, 5),
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
        for series, column, name in (
            (2, "predicted_all_steps", "Theorem 1, r of all steps"),
            (1, "predicted", "Theorem 1, p of the first step"),
            (0, "measured", "measured"),
        )
    ]
    return style.Panel(
        traces,
        style.number_of_points(evidence.design.sizes, columns=2),
        style.axis(""),
        statistic.capitalize(),
    )
