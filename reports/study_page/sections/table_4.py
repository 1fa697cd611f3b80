"""Table 4: the means of the groups, ours and the paper's."""

from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.study_page.tables import TABLE_4
from reports.text.words import LEVEL
from study.analysis.group_summaries import GROUPS
from study.paper.judging import AGREES, DIFFERS
from study.paper.published import LARGEST_LEPP, MEAN_LEPP, MEAN_TRIANGLES, SD_BETWEEN, SHOWN
from study.paper.scoreboard import OVERALL, TOO_CLOSE
from study.statistics.thresholds import AGREES_UP_TO, CLOSE_UP_TO
from study.text.numbers import count, listed, p_is, p_of, show

#: What the paper's Table 4 has of each group, in words.
QUANTITIES = {
    MEAN_LEPP: "the mean LEPP size",
    SD_BETWEEN: "its standard deviation",
    MEAN_TRIANGLES: "the number of triangles",
    LARGEST_LEPP: "the largest LEPP",
}
_VERDICTS = {AGREES: AGREES, DIFFERS: DIFFERS, TOO_CLOSE: f"agrees {TOO_CLOSE}"}


def table_4(evidence: Evidence) -> Subsection:
    """Judge the groups together, draw their means, list them."""
    return Subsection(
        "table-4",
        "Table 4, group by group",
        (
            Prose(per_view(evidence.views, lambda view: _overall(evidence, view))),
            _means(evidence),
            TableBlock(TABLE_4, "Ours, and the paper's where it prints one", paper="Table 4"),
        ),
    )


def _overall(evidence: Evidence, view: View) -> list[str] | None:
    if view.distribution != SHOWN:
        return [
            "The paper shows Table 4 for uniform points only; for the others it says that the "
            "results are alike."
        ]
    rows = evidence.rows(OVERALL, method=view.method)
    each = rows.frame[rows["quantity"].isin(list(QUANTITIES))]
    if each.empty:
        return None
    words = [
        f"{QUANTITIES[row.quantity]} {_VERDICTS[row.verdict]} "
        f"(χ² = {show(row.chi2, 'fixed1')} on {row.df} degrees of freedom, "
        f"{_chance(row.verdict, row.log10_p, row.p_less)}; largest difference "
        f"{show(abs(row.furthest), 'fixed2')} standard errors)"
        for row in each.itertuples()
    ]
    return [f"Over all groups together, {listed(words)}."]


def _chance(verdict: str, log10_more: float, less: float) -> str:
    """Say how likely a sum as large is, or one as small where the verdict is that it is small."""
    return f"{p_of(less)} for less" if verdict == TOO_CLOSE else p_is(log10_more)


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
        traces,
        style.number_of_points(evidence.design.sizes),
        style.axis("Mean LEPP size"),
        height=2,
    )


def _differences(evidence: Evidence, view: View) -> style.Panel:
    rows = evidence.rows(TABLE_4, view)
    furthest = max(CLOSE_UP_TO, 1.15 * float(rows["difference"].abs().max()))
    bars = style.bars(
        x=rows.column("n_points"),
        y=rows.column("difference"),
        width=style.bar_widths(rows["n_points"], evidence.design.sizes),
        name="difference",
        showlegend=False,
        marker={"color": style.SERIES[0]},
        hovertemplate="%{x:,} points: %{y:.2f} standard errors<extra></extra>",
    )
    return style.Panel(
        [bars],
        style.number_of_points(evidence.design.sizes, matches="x"),
        style.axis("Ours − paper’s<br>(standard errors)", range=[-furthest, furthest]),
        levels=(style.Level(-AGREES_UP_TO), style.Level(AGREES_UP_TO)),
    )
