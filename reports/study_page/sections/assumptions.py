"""What analysis of variance supposes: equal variances and normal groups (Tables 2 and 3)."""

import numpy as np

from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.text.words import AFTER_HOLM
from study.analysis.group_assumptions import LEVENE, QQ, SHAPIRO
from study.analysis.group_summaries import GROUPS
from study.statistics.thresholds import SIGNIFICANCE
from study.statistics.verdicts import REJECTED
from study.text.numbers import count, listed, none_or, p_is, show


def assumptions(evidence: Evidence) -> Subsection:
    """Levene's and Shapiro-Wilk's tests, and a QQ plot."""
    return Subsection(
        "assumptions",
        "Are the groups normal and equally spread?",
        (
            Prose(per_view(evidence.views, lambda view: _assumptions(evidence, view))),
            TableBlock(
                LEVENE,
                "Levene's test of equal variances",
                paper="Table 2",
                columns=(
                    "center",
                    "df_group",
                    "df_residual",
                    "f",
                    "log10_p",
                    "equal_variances",
                ),
            ),
            _qq(evidence),
            TableBlock(SHAPIRO, "Shapiro-Wilk test of each group", paper="Table 3", folded=True),
        ),
    )


def groups_tested(evidence: Evidence, view: View, number: int, total: int, whose: str = "") -> str:
    """Name so many of the groups that tests can be made of, those that have a spread."""
    words = "every group" if number == total else f"{number} of {count(total, 'group')}"
    spread = ""
    if evidence.design.single_sizes_of(view.method):
        spread = f" that {'has' if number == total or total == 1 else 'have'} a spread"
    return f"{words}{whose}{spread}"


def _assumptions(evidence: Evidence, view: View) -> list[str] | None:
    sentences = []
    levene = evidence.rows(LEVENE, view)
    if not levene.empty:
        unequal = levene["equal_variances"] == REJECTED
        first = levene.first
        numbers = (
            f"Levene's F({first['df_group']}, {first['df_residual']}) is "
            f"{show(first['f'], 'fixed2')}, {p_is(first['log10_p'])}"
        )
        if unequal.all():
            sentences.append(
                f"The groups' variances are not equal: {numbers}. The spread between "
                f"triangulations {_trend(evidence, view)}, and the classical analysis of variance "
                "supposes that it does not change; the tests below that do without are the ones to "
                "read."
            )
        elif unequal.any():
            sentences.append(
                f"Whether the groups' variances are equal depends on the centre: {numbers}."
            )
        else:
            sentences.append(
                "Equal variances of the groups are not rejected, which does not show that they "
                f"are equal: {numbers}."
            )
    shapiro = evidence.rows(SHAPIRO, view)
    if not shapiro.empty:
        below = int((shapiro["p"] < SIGNIFICANCE).sum())
        rejected = int((shapiro["normal"] == REJECTED).sum())
        sentences.append(
            f"Shapiro-Wilk gives p below {SIGNIFICANCE} in {none_or(below)} of "
            f"{count(len(shapiro), 'group')}; by chance alone it would in "
            f"{show(SIGNIFICANCE * len(shapiro), 'fixed1')}. {AFTER_HOLM} "
            f"normality is rejected in {none_or(rejected)}"
            + ("." if rejected else ", which does not show that they are normal.")
        )
    single = evidence.design.single_sizes_of(view.method)
    if single:
        each = " each" if len(single) > 1 else ""
        sentences.append(
            f"Of {listed([show(size, 'int') for size in single])} points there is one "
            f"triangulation{each}, which has no spread by itself: no test of groups, here or "
            "below, includes it. The models of growth do."
        )
    return sentences or None


def _trend(evidence: Evidence, view: View) -> str:
    spread = evidence.rows(GROUPS, view)["sd_between"].dropna()
    first, last = show(spread.iloc[0], "fixed4"), show(spread.iloc[-1], "fixed4")
    direction = "falls" if spread.iloc[-1] < spread.iloc[0] else "rises"
    return f"{direction} with their size, from {first} to {last}"


def _qq(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        rows = evidence.rows(QQ, view)
        if rows.empty:
            return None
        reach = float(np.abs(rows["normal_quantile"]).max()) * 1.05
        return style.plot(
            style.scatter(
                x=[-reach, reach],
                y=[-reach, reach],
                mode="lines",
                name="normal",
                line={"color": style.INK, "dash": "dash", "width": 1.5},
                hoverinfo="skip",
            ),
            style.scatter(
                x=rows.column("normal_quantile"),
                y=rows.column("standardised_mean"),
                mode="markers",
                name="triangulations",
                marker=style.marker(0, 5, opacity=0.6),
                hovertemplate="%{x:.2f}: %{y:.2f}<extra></extra>",
            ),
            xaxis=style.axis("Normal quantile"),
            yaxis=style.axis("Mean LEPP size, in SDs of its group"),
            height=400,
        )

    def say(view: View) -> str | None:
        rows = evidence.rows(QQ, view)
        if len(rows) < 3:
            return None
        straight = float(np.corrcoef(rows["normal_quantile"], rows["standardised_mean"])[0, 1])
        return (
            f"The {count(len(rows), 'mean')}, each in its group's standard deviations, lie along "
            f"the diagonal with a correlation of {show(straight, 'fixed4')}."
        )

    return FigureBlock(
        id="figure-qq",
        title="Normal QQ plot of the mean LEPP sizes",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading="Normal values would lie on the dashed line.",
        data=(TableBlock(QQ, "the quantiles"),),
    )
