"""The statistics: what the paper tests (Tables 1 to 3, 5, 6), and what it should have tested."""

import numpy as np

from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.study_page.sections.assumptions import assumptions, groups_tested
from reports.study_page.sections.randomness import randomness
from reports.text.words import LEVEL
from study.analysis.bound_tests import BOUNDS, LOWER_BOUND, UPPER_BOUND
from study.analysis.group_summaries import GROUPS
from study.analysis.pairwise_comparisons import PAIRS
from study.analysis.variance_analysis import ANOVA, WELCH
from study.statistics.thresholds import SIGNIFICANCE
from study.statistics.verdicts import NOT_SHOWN, REJECTED, YES
from study.text.numbers import count, listed, show


def section(evidence: Evidence) -> Section:
    """Randomness, assumptions, equality of the means, bounds."""
    return Section(
        "statistics",
        "The statistics",
        "Do the tests hold?",
        (
            randomness(evidence),
            assumptions(evidence),
            Subsection(
                "anova",
                "Does the mean depend on the number of points?",
                (
                    Prose(per_view(evidence.views, lambda view: _anova(evidence, view))),
                    TableBlock(
                        ANOVA,
                        "Analysis of variance, three ways",
                        paper="Table 5",
                        columns=(
                            "test",
                            "df_group",
                            "df_residual",
                            "statistic",
                            "log10_p",
                            "effect",
                            "effect_size",
                            "effect_low",
                            "effect_high",
                        ),
                    ),
                    _pairs(evidence),
                ),
            ),
            Subsection(
                "bounds",
                f"Is the mean between {LOWER_BOUND} and {UPPER_BOUND}?",
                (
                    Prose(per_view(evidence.views, lambda view: _bounds(evidence, view))),
                    TableBlock(
                        BOUNDS,
                        f"t tests of every group against {LOWER_BOUND} and {UPPER_BOUND}",
                        paper="Table 6",
                        columns=(
                            "n_points",
                            "bound",
                            "alternative",
                            "t",
                            "df",
                            "log10_p",
                            "log10_p_bonferroni",
                            "verdict",
                            "mean_lepp",
                            "mean_low",
                            "mean_high",
                        ),
                        folded=True,
                    ),
                ),
            ),
        ),
    )


def _anova(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(ANOVA, view).frame.drop_duplicates("test")
    if rows.empty:
        return None
    differ = rows["log10_p"] < np.log10(SIGNIFICANCE)
    tests = listed([f"{row.test} ({show(row.log10_p, 'log10p')})" for row in rows.itertuples()])
    verdict = (
        "The mean LEPP size does depend on the number of points"
        if differ.all()
        else "No test shows that the mean LEPP size depends on the number of points"
        if not differ.any()
        else "The tests disagree on whether the mean LEPP size depends on the number of points"
    )
    sentences = [f"{verdict}, for {view.distribution_word} points; p by test: {tests}."]
    effect = evidence.one(ANOVA, view, test=WELCH)
    groups = evidence.rows(GROUPS, view)["mean_lepp"].dropna()
    if effect is not None and len(groups) > 1:
        sentences.append(
            "In this design, with these numbers of points and so many triangulations of each, the "
            f"number of points accounts for {show(effect['effect_size'], 'percent0')} of the "
            "variance between triangulations (ω² of Welch's test, which does without equal "
            "variances); another design has another share. What does not depend on the design are "
            f"the groups' means, which span {show(groups.min(), 'fixed4')} to "
            f"{show(groups.max(), 'fixed4')}."
        )
    return sentences


def _pairs(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        pairs = evidence.rows(PAIRS, view)
        if pairs.empty:
            return None
        alike = evidence.rows(PAIRS, view, different=NOT_SHOWN)
        most = float(pairs["difference"].abs().max())
        sizes = sorted({*pairs["n_points_1"], *pairs["n_points_2"]})
        return style.plot(
            style.heatmap(
                x=pairs.column("n_points_1"),
                y=pairs.column("n_points_2"),
                z=pairs.column("difference"),
                customdata=pairs.column("different"),
                colorscale=style.SCALE,
                zmin=-most,
                zmax=most,
                xgap=1,
                ygap=1,
                colorbar=style.color_bar("Difference of means", most),
                hovertemplate="%{y} − %{x}: %{z:.4f}, different: %{customdata}<extra></extra>",
            ),
            style.scatter(
                x=alike.column("n_points_1"),
                y=alike.column("n_points_2"),
                mode="markers",
                marker={"size": 5, "color": style.INK},
                name=f"{NOT_SHOWN} to differ",
                hoverinfo="skip",
            ),
            xaxis=style.sizes_axis(sizes, "Points, first group"),
            yaxis=style.sizes_axis(sizes, "Points, second group"),
            showlegend=False,
            height=520,
        )

    def say(view: View) -> str | None:
        pairs = evidence.rows(PAIRS, view)
        if pairs.empty:
            return None
        differ = int((pairs["different"] == YES).sum())
        largest = pairs.frame.loc[pairs["difference"].abs().idxmax()]
        return (
            f"{differ} of {count(len(pairs), 'pair')} of groups differ ({LEVEL} level for all "
            f"together). The largest difference, {show(largest['difference'], 'fixed4')}, is that "
            f"of {largest['n_points_2']:,} and {largest['n_points_1']:,} points."
        )

    return FigureBlock(
        id="figure-pairs",
        title="Which groups differ? Games-Howell comparisons",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading="A square is the second group's mean less the first's, blue where it is larger "
        "and orange where it is smaller; a dot marks pairs that cannot be told apart.",
        data=(TableBlock(PAIRS, "all pairs"),),
    )


def _bounds(evidence: Evidence, view: View) -> list[str] | None:
    sentences = []
    for bound, side in ((UPPER_BOUND, "below"), (LOWER_BOUND, "above")):
        rows = evidence.rows(BOUNDS, view, bound=bound)
        if rows.empty:
            continue
        rejected = int((rows["verdict"] == REJECTED).sum())
        weakest = rows["log10_p_bonferroni"].max()
        whose = f" of {view.distribution_word} points"
        where = groups_tested(evidence, view, rejected, len(rows), whose)
        sentences.append(
            f"In {where} the mean is significantly {side} {bound}; the largest p is "
            f"{show(weakest, 'log10p')}, corrected for all tests."
        )
    rows = evidence.rows(BOUNDS, view, bound=UPPER_BOUND)
    if not rows.empty:
        sentences.append(
            f"That it is above {LOWER_BOUND} had to come out: a path in the interior has "
            f"{LOWER_BOUND} triangles or more by definition. A p-value says only that the mean is "
            "not the bound; its interval says how far it is: "
            f"over all groups they reach from {show(rows['mean_low'].min(), 'fixed4')} "
            f"to {show(rows['mean_high'].max(), 'fixed4')}."
        )
    return [" ".join(sentences)] if sentences else None
