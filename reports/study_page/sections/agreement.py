"""Does it agree with the paper: the scoreboard, and Table 4 beside the published one."""

from lepp import METHODS
from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.study_page.tables import TABLE_4
from reports.text.numbers import count, listed, show
from reports.text.words import LEVEL
from study.analysis.group_summaries import GROUPS
from study.paper.judging import (
    AGREES,
    CLOSE,
    DIFFERS,
    IMPLAUSIBLE,
    MISPRINT,
    NOT_COMPARABLE,
    NOT_RUN,
    PLAUSIBLE,
    VERDICTS,
)
from study.paper.published import MEAN_LEPP, MEAN_TRIANGLES, REFERENCE_METHOD, SD_BETWEEN, SHOWN
from study.paper.reproduction import OVERALL, REPRODUCTION, SUMMARY, verdict_column
from study.statistics.thresholds import AGREES_UP_TO, CLOSE_UP_TO, ONE_IN_TWENTY


def section(evidence: Evidence) -> Section:
    """Verdicts, Table 4, every published number."""
    return Section(
        "agreement",
        "Agreement with the paper",
        "Are the published numbers right?",
        (
            Subsection(
                "scoreboard",
                "The scoreboard",
                (
                    Prose(per_view(evidence.views, lambda view: _verdicts(evidence, view))),
                    TableBlock(
                        SUMMARY,
                        "Verdicts by table of the paper",
                        follows=("method",),
                    ),
                    TableBlock(
                        REPRODUCTION,
                        "Every published number beside ours",
                        columns=(
                            "distribution",
                            "published_table",
                            "quantity",
                            "n_points",
                            "printed",
                            "ours",
                            "difference",
                            "log10_ratio",
                            "verdict",
                        ),
                        follows=("method",),
                        folded=True,
                        printed_whole=True,
                    ),
                ),
            ),
            Subsection(
                "table-4",
                "Table 4, group by group",
                (
                    Prose(per_view(evidence.views, lambda view: _overall(evidence, view))),
                    _means(evidence),
                    TableBlock(
                        TABLE_4, "Ours, and the paper's where it prints one", paper="Table 4"
                    ),
                ),
            ),
        ),
    )


_QUANTITIES = {
    MEAN_LEPP: "the mean LEPP size",
    SD_BETWEEN: "its standard deviation",
    MEAN_TRIANGLES: "the number of triangles",
}


def _verdicts(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(SUMMARY, method=view.method)
    if rows.empty:
        return None
    total = rows.frame[["numbers", *map(verdict_column, VERDICTS)]].sum()
    agrees, close, differs = (int(total[verdict_column(v)]) for v in (AGREES, CLOSE, DIFFERS))
    judged = agrees + close + differs
    sentences = [f"The paper prints {total['numbers']} numbers in its seven tables."]
    if judged:
        sentences.append(
            f"{judged} of them can be held against ours by their standard errors: "
            f"{agrees} within {AGREES_UP_TO:g} (agreement), {close} within {CLOSE_UP_TO:g} (close) "
            f"and {differs} beyond (different). By chance alone, {ONE_IN_TWENTY} would not "
            "agree."
        )
    odd = int(total[verdict_column(IMPLAUSIBLE)])
    drawn = int(total[verdict_column(PLAUSIBLE)]) + odd
    if drawn:
        sentences.append(
            f"{drawn} are random draws that no other run can repeat; "
            + ("all are plausible." if not odd else f"{odd} of them are not plausible.")
        )
    if misprints := int(total[verdict_column(MISPRINT)]):
        prints = evidence.rows(REPRODUCTION, method=view.method, verdict=MISPRINT)
        numbers = [f"{row.printed} ({row.quantity})" for row in prints.frame.itertuples()]
        sentences.append(f"{count(misprints, 'number')} must be a misprint: {listed(numbers)}.")
    for name, words in (
        (NOT_COMPARABLE, "cannot be compared with this design"),
        (NOT_RUN, "belong to groups that this run does not have"),
    ):
        if total[verdict_column(name)]:
            sentences.append(f"{total[verdict_column(name)]} {words}.")
    paragraphs = [" ".join(sentences)]
    if view.method != REFERENCE_METHOD:
        paragraphs.append(
            "The paper's triangulations are made by inserting the points as they come, without "
            f"flips (the {METHODS[REFERENCE_METHOD].word} method). {view.method_title} "
            "triangulations are other meshes: that they differ is no failure to reproduce."
        )
    return paragraphs


def _overall(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(OVERALL, view)
    if rows.empty:
        return (
            [
                "The paper shows Table 4 for uniform points only; for the others it says that the "
                "results are alike."
            ]
            if view.distribution != SHOWN
            else None
        )
    words = [
        f"{_QUANTITIES.get(row.quantity, row.quantity)} {row.verdict} "
        f"(χ² = {show(row.chi2, 'fixed1')} on {row.df} degrees of freedom, "
        f"p\u00a0=\u00a0{show(row.log10_p, 'log10p')}; largest difference "
        f"{show(abs(row.furthest), 'fixed2')} standard errors)"
        for row in rows.frame.itertuples()
    ]
    return [f"Over all groups together, {listed(words)}."]


def _means(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        rows = evidence.rows(TABLE_4, view)
        if rows.empty:
            return None
        parts = [_beside(evidence, view)]
        if rows["published_mean"].notna().any():
            parts.append(_differences(evidence, view))
        return style.panels(parts, height=560 if len(parts) > 1 else 400)

    def say(view: View) -> str | None:
        rows = evidence.rows(TABLE_4, view)
        if rows.empty:
            return None
        z = rows["difference"].dropna()
        if z.empty:
            first, last = rows.first, rows.last
            return (
                f"The mean goes from {show(first['mean_lepp'], 'fixed4')} at {first['n_points']:,} "
                f"points to {show(last['mean_lepp'], 'fixed4')} at {last['n_points']:,}."
            )
        return (
            f"{int((z.abs() <= AGREES_UP_TO).sum())} of {count(len(z), 'group mean')} lie within "
            f"{AGREES_UP_TO:g} standard errors of the published one and "
            f"{int((z.abs() <= CLOSE_UP_TO).sum())} within {CLOSE_UP_TO:g}; the largest "
            f"difference is {show(z.abs().max(), 'fixed2')}."
        )

    return FigureBlock(
        id="figure-means",
        title="Mean LEPP size, ours and the paper's",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading="Where the paper prints a mean, the lower panel has the difference; dotted lines "
        f"are at {AGREES_UP_TO:g} standard errors.",
        data=(TableBlock(TABLE_4, "means by number of points"),),
    )


def _beside(evidence: Evidence, view: View) -> style.Panel:
    groups, rows = evidence.rows(GROUPS, view), evidence.rows(TABLE_4, view)
    traces = [
        *style.band(
            groups.column("n_points"),
            groups.column("mean_low"),
            groups.column("mean_high"),
            f"{LEVEL} interval",
        ),
        style.scatter(
            x=rows.column("n_points"),
            y=rows.column("mean_lepp"),
            mode="lines+markers",
            name="this run",
            line=style.line(0),
            marker=style.marker(0),
            hovertemplate="%{x:,} points: %{y:.4f}<extra>this run</extra>",
        ),
    ]
    if rows["published_mean"].notna().any():
        traces.append(
            style.scatter(
                x=rows.column("n_points"),
                y=rows.column("published_mean"),
                mode="markers",
                name="the paper",
                marker=style.marker(1, 8),
                hovertemplate="%{x:,} points: %{y:.4f}<extra>the paper</extra>",
            )
        )
    return style.Panel(
        traces, style.axis("Number of points"), style.axis("Mean LEPP size"), height=2
    )


def _differences(evidence: Evidence, view: View) -> style.Panel:
    rows = evidence.rows(TABLE_4, view)
    furthest = max(CLOSE_UP_TO, 1.15 * float(rows["difference"].abs().max()))
    bars = style.bars(
        x=rows.column("n_points"),
        y=rows.column("difference"),
        name="difference",
        showlegend=False,
        marker={"color": style.SERIES[0]},
        hovertemplate="%{x:,} points: %{y:.2f} standard errors<extra></extra>",
    )
    return style.Panel(
        [bars],
        style.axis("Number of points", matches="x"),
        style.axis("Ours − paper’s<br>(standard errors)", range=[-furthest, furthest]),
        levels=(style.Level(-AGREES_UP_TO), style.Level(AGREES_UP_TO)),
    )
