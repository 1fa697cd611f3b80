"""Does it agree with the paper: the scoreboard, and Table 4 beside the published one."""

from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.text.numbers import count, listed, show


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
                        "reproduction_summary",
                        "Verdicts by table of the paper",
                        follows=("method",),
                    ),
                    TableBlock(
                        "reproduction",
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
                    TableBlock("table_4", "Table 4. Ours, and the paper's where it prints one"),
                ),
            ),
        ),
    )


_QUANTITIES = {
    "mean LEPP": "the mean LEPP size",
    "standard deviation": "its standard deviation",
    "mean triangles": "the number of triangles",
}


def _verdicts(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows("reproduction_summary", method=view.method)
    if rows.empty:
        return None
    total = rows.drop(columns=["method", "published_table"]).sum()
    judged = int(total["agrees"] + total["close"] + total["differs"])
    said = [f"The paper prints {total['numbers']} numbers in its seven tables."]
    if judged:
        said.append(
            f"{judged} of them can be held against ours by their standard errors: "
            f"{total['agrees']} within 2 (agreement), {total['close']} within 3 (close) and "
            f"{total['differs']} beyond (different). By chance alone, one in twenty would not "
            "agree."
        )
    drawn = int(total["plausible_draw"] + total["implausible_draw"])
    if drawn:
        odd = int(total["implausible_draw"])
        said.append(
            f"{drawn} are random draws that no other run can repeat; "
            + ("all are plausible." if not odd else f"{odd} of them are not plausible.")
        )
    if total["misprint"]:
        prints = evidence.rows("reproduction", method=view.method, verdict="misprint")
        numbers = [f"{row.printed} ({row.quantity})" for row in prints.itertuples()]
        said.append(f"{count(total['misprint'], 'number')} must be a misprint: {listed(numbers)}.")
    for name, words in (
        ("not_comparable", "cannot be compared with this design"),
        ("not_run", "belong to groups that this run does not have"),
    ):
        if total[name]:
            said.append(f"{total[name]} {words}.")
    paragraphs = [" ".join(said)]
    if view.method != "incremental":
        paragraphs.append(
            "The paper's triangulations are made by inserting the points as they come, without "
            "flips (the incremental method). Delaunay triangulations are other meshes: that they "
            "differ is no failure to reproduce."
        )
    return paragraphs


def _overall(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows("reproduction_overall", view)
    if rows.empty:
        return (
            [
                "The paper shows Table 4 for uniform points only; for the others it says that the "
                "results are alike."
            ]
            if view.distribution != "uniform"
            else None
        )
    words = [
        f"{_QUANTITIES.get(row.quantity, row.quantity)} {row.verdict} "
        f"(χ² = {show(row.chi2, 'fixed1')} on {row.df} degrees of freedom, "
        f"p\u00a0=\u00a0{show(row.log10_p, 'log10p')}; largest difference "
        f"{show(abs(row.furthest), 'fixed2')} standard errors)"
        for row in rows.itertuples()
    ]
    return [f"Over all groups together, {listed(words)}."]


def _means(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        rows = evidence.rows("table_4", view)
        if rows.empty:
            return None
        parts = [_beside(evidence, view)]
        if rows["published_mean"].notna().any():
            parts.append(_differences(evidence, view))
        return style.panels(parts, height=560 if len(parts) > 1 else 400)

    def say(view: View) -> str | None:
        rows = evidence.rows("table_4", view)
        if rows.empty:
            return None
        z = rows["difference"].dropna()
        if z.empty:
            first, last = rows.iloc[0], rows.iloc[-1]
            return (
                f"The mean goes from {show(first['mean_lepp'], 'fixed4')} at {first['n_points']:,} "
                f"points to {show(last['mean_lepp'], 'fixed4')} at {last['n_points']:,}."
            )
        return (
            f"{int((z.abs() <= 2).sum())} of {count(len(z), 'group mean')} lie within 2 standard "
            f"errors of the published one and {int((z.abs() <= 3).sum())} within 3; the largest "
            f"difference is {show(z.abs().max(), 'fixed2')}."
        )

    return FigureBlock(
        id="figure-means",
        title="Mean LEPP size, ours and the paper's",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading="Where the paper prints a mean, the lower panel has the difference; dotted lines "
        "are at 2 standard errors.",
        data=(TableBlock("table_4", "Data: means by number of points"),),
    )


def _beside(evidence: Evidence, view: View) -> style.Panel:
    groups, rows = evidence.rows("groups", view), evidence.rows("table_4", view)
    interval = "95\u00a0% interval"
    traces = [
        *style.band(groups["n_points"], groups["mean_low"], groups["mean_high"], interval),
        style.scatter(
            x=rows["n_points"],
            y=rows["mean_lepp"],
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
                x=rows["n_points"],
                y=rows["published_mean"],
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
    rows = evidence.rows("table_4", view)
    furthest = max(3.0, 1.15 * float(rows["difference"].abs().max()))
    bars = style.bars(
        x=rows["n_points"],
        y=rows["difference"],
        name="difference",
        showlegend=False,
        marker={"color": style.SERIES[0]},
        hovertemplate="%{x:,} points: %{y:.2f} standard errors<extra></extra>",
    )
    return style.Panel(
        [bars],
        style.axis("Number of points", matches="x"),
        style.axis("Ours − paper’s<br>(standard errors)", range=[-furthest, furthest]),
        levels=(style.Level(-2), style.Level(2)),
    )
