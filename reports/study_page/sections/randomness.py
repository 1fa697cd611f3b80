"""Are the points random: the runs and Kolmogorov-Smirnov tests of every point set (Table 1)."""

from reports.page import style
from reports.page.blocks import ALWAYS, FigureBlock, Prose, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.text.words import AFTER_HOLM, LEVEL
from study.analysis.point_randomness import ALL, BINS, COORDINATES, RANDOMNESS, UNIFORMITY
from study.statistics.thresholds import SIGNIFICANCE
from study.statistics.verdicts import NOT_REJECTED
from study.text.numbers import count, listed, none_or, show


def randomness(evidence: Evidence) -> Subsection:
    """All tests in a sentence, in a plot of their p-values and in a table."""
    return Subsection(
        "randomness",
        "Are the points random?",
        (
            _randomness(evidence),
            _uniformity(evidence),
            TableBlock(
                RANDOMNESS,
                "Tests of randomness and of fit",
                paper="Table 1",
                columns=(
                    "distribution",
                    "test",
                    "coordinate",
                    "tests",
                    "below",
                    "share_below",
                    "share_low",
                    "share_high",
                    "uniform_p",
                    "verdict",
                ),
                follows=(),
            ),
        ),
    )


def _randomness(evidence: Evidence) -> Prose:
    row = evidence.one(RANDOMNESS, distribution=ALL)
    if row is None:
        return Prose({})
    chance = (
        "which is what chance alone leads one to expect"
        if row["verdict"] == NOT_REJECTED
        else "which chance alone does not explain"
    )
    return Prose(
        {
            ALWAYS: [
                f"Of {count(row['tests'], 'test')} of all point sets, "
                f"{count(row['below'], 'p-value falls', 'p-values fall')} below {SIGNIFICANCE}: "
                f"{show(row['share_below'], 'percent2')} "
                f"({LEVEL} interval {show(row['share_low'], 'percent2')} to "
                f"{show(row['share_high'], 'percent2')}), {chance}. "
                f"About {show(row['expected_below'], 'int')} would, even with perfect points. "
                f"{AFTER_HOLM} {none_or(row['rejected_holm'])} "
                f"{'reject' if row['rejected_holm'] > 1 else 'rejects'}."
            ]
        }
    )


def _uniformity(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        rows = evidence.rows(UNIFORMITY, view)
        if rows.empty:
            return None
        tests = list(dict.fromkeys(rows["test"]))
        return style.panels(
            [_evenness(evidence, view, test, first=test == tests[0]) for test in tests],
            height=520,
            bargap=0.25,
        )

    def say(view: View) -> str | None:
        rows = evidence.rows(RANDOMNESS, view)
        if rows.empty:
            return None
        odd = rows.frame[rows["uniform_p"] < SIGNIFICANCE]
        names = [f"{row.test} of {row.coordinate}" for row in odd.itertuples()]
        found = (
            f"all {len(rows)} families of p-values are as even as chance allows "
            f"(lowest p of uniformity {show(rows['uniform_p'].min(), 'p')})"
            if not names
            else f"the p-values of {listed(names)} are less even than chance would have them "
            f"(p {listed([show(p, 'p') for p in odd['uniform_p']])})"
        )
        return f"For {view.distribution_word} points, {found}."

    return FigureBlock(
        id="figure-uniformity",
        title="Are the p-values uniform?",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading="If the points are random, the bars are level with the dashed line, give or take.",
        data=(TableBlock(UNIFORMITY, f"p-values counted in steps of {1 / BINS:g}"),),
    )


def _evenness(evidence: Evidence, view: View, test: str, *, first: bool) -> style.Panel:
    traces = []
    for series, coordinate in enumerate(COORDINATES):
        rows = evidence.rows(UNIFORMITY, view, test=test, coordinate=coordinate)
        traces.append(
            style.bars(
                x=(rows["p_from"] + rows["p_to"]) / 2,  # bars are drawn about their x
                y=rows.column("count"),
                name=coordinate,
                offsetgroup=coordinate,
                legendgroup=coordinate,
                showlegend=first,
                marker={"color": style.SERIES[series], "pattern": {"shape": ("", "/")[series]}},
                customdata=rows.column("p_from"),
                hovertemplate="p from %{customdata:.2f}: %{y} tests<extra>"
                + coordinate
                + "</extra>",
            )
        )
    expected = float(rows["expected"].iloc[0])
    traces.append(
        style.scatter(
            x=[0, 1],
            y=[expected, expected],
            mode="lines",
            name="expected",
            line={"color": style.INK, "dash": "dash", "width": 1.5},
            showlegend=first,
            hoverinfo="skip",
        )
    )
    bins = style.axis("p-value", range=[0, 1], dtick=0.2)
    return style.Panel(traces, bins, style.axis("Tests"), f"{test} test")
