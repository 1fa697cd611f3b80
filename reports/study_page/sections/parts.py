"""The mean of the whole mesh and of its interior, and whose a trend is."""

from lepp import INTERIOR_LAYER
from reports.page import style
from reports.page.blocks import FigureBlock, Prose, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View, distribution_word
from reports.study_page.sections.distribution_lines import lines_by_distribution
from reports.text.words import LEVEL
from study.analysis.part_changes import PART_CHANGES
from study.analysis.part_means import COMMON_MEANS, PART_MEANS
from study.analysis.parts import INTERIOR, WHOLE
from study.statistics.thresholds import SIGNIFICANCE
from study.statistics.verdicts import REJECTED
from study.text.numbers import count, listed, p_is, show

_DEFINITION = (
    f"The interior is all triangles that are {INTERIOR_LAYER} or more steps across edges away from "
    "a triangle at the hull; the edge is all others."
)


def parts(evidence: Evidence) -> Subsection:
    """Compare both means, and say how much of a trend is the edge's."""
    return Subsection(
        "parts",
        "The mean with the edge and without",
        (
            Prose(per_view(evidence.views, lambda view: _parts(evidence, view))),
            _figure_parts(evidence),
            TableBlock(PART_CHANGES, "How both means change", folded=True),
            TableBlock(
                COMMON_MEANS,
                "Whether the distributions have one mean",
                columns=(
                    "part",
                    "n_points",
                    "p",
                    "one_mean",
                    "mean_lepp",
                    "low",
                    "high",
                    "largest_difference",
                ),
                folded=True,
            ),
        ),
    )


def _parts(evidence: Evidence, view: View) -> list[str] | None:
    whole = evidence.rows(PART_MEANS, view, part=WHOLE)
    interior = evidence.rows(PART_MEANS, view, part=INTERIOR)
    if whole.empty:
        return None
    if interior.empty:
        of = f"{view.method_word} triangulation of {view.distribution_word} points"
        return [f"{_DEFINITION} No {of} is large enough here to have an interior."]
    last = interior.last
    sentences = [
        f"{_DEFINITION} At {last['n_points']:,} points the edge has "
        f"{show(1 - last['share'], 'percent2')} of the triangles by the {view.method_word} method."
    ]
    first = interior.first
    at = whole.frame.set_index("n_points")["mean_lepp"]
    if len(interior) > 1:
        ends = (first["n_points"], last["n_points"])
        change = at[ends[1]] - at[ends[0]], last["mean_lepp"] - first["mean_lepp"]
        sentences.append(
            f"From {ends[0]:,} to {ends[1]:,} points the mean of the whole mesh changes by "
            f"{show(change[0], 'fixed4')}, from {show(at[ends[0]], 'fixed4')} to "
            f"{show(at[ends[1]], 'fixed4')}, and that of the interior by "
            f"{show(change[1], 'fixed4')}, from {show(first['mean_lepp'], 'fixed4')} to "
            f"{show(last['mean_lepp'], 'fixed4')}."
        )
        whose = _whose_change(evidence, view)
        if whose:
            sentences.append(f"{whose[0].upper()}{whose[1:]}.")
    paragraphs = [" ".join(sentences)]
    one = _one_mean(evidence, view)
    return [*paragraphs, one] if one else paragraphs


def _whose_change(evidence: Evidence, view: View) -> str | None:
    """Say whether the change of the mean is the edge's, as a clause; None if none is shown."""
    whole = evidence.one(PART_CHANGES, view, part=WHOLE)
    interior = evidence.one(PART_CHANGES, view, part=INTERIOR)
    if whole is None or interior is None or whole["p"] >= SIGNIFICANCE:
        return None
    # As shares of the change of the whole mesh, whichever its direction.
    low, high = sorted((interior["low"] / whole["change"], interior["high"] / whole["change"]))
    word = "growth" if whole["change"] > 0 else "fall"
    if high < 0.5:
        return f"most of the {word} of the whole mesh is the edge's"
    if low > 0.5:
        return f"most of the {word} of the whole mesh is the interior's own"
    return f"how much of the {word} of the whole mesh is the edge's stays open"


def edge_in_short(evidence: Evidence, view: View) -> str | None:
    """Say how the mean changes in the interior, and whose the change of the whole mesh is."""
    whose = _whose_change(evidence, view)
    row = evidence.one(PART_CHANGES, view, part=INTERIOR)
    if whose is None or row is None:
        return None
    return (
        f"In the interior, {INTERIOR_LAYER} steps or more from the hull, it changes by "
        f"{show(row['change'], 'fixed4')} ({LEVEL} from {show(row['low'], 'fixed4')} to "
        f"{show(row['high'], 'fixed4')}) from {row['from_points']:,} points to "
        f"{row['to_points']:,}: {whose}."
    )


def _one_mean(evidence: Evidence, view: View) -> str | None:
    """Say whether the distributions have one mean in the interior, at the largest size."""
    rows = evidence.rows(COMMON_MEANS, method=view.method, part=INTERIOR)
    if rows.empty:
        return None
    row = rows.last
    which = (
        f"the {distribution_word(row['lowest'])} points have the lowest and the "
        f"{distribution_word(row['highest'])} ones the highest, "
        f"{show(row['largest_difference'], 'fixed4')} apart"
    )
    opening = f"At {row['n_points']:,} points the interiors of the {row['distributions']} "
    p = p_is(row["log10_p"])
    if row["one_mean"] == REJECTED:
        return f"{opening}distributions do not have one mean ({p}): {which}."
    return (
        f"{opening}distributions may have one mean ({p}), {show(row['mean_lepp'], 'fixed4')} "
        f"({LEVEL} from {show(row['low'], 'fixed4')} to {show(row['high'], 'fixed4')}): {which}."
    )


def _figure_parts(evidence: Evidence) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        def traces(part: str) -> list[Spec]:
            return lines_by_distribution(
                evidence,
                lambda name: evidence.rows(PART_MEANS, View(view.method, name), part=part),
                "n_points",
                "mean_lepp",
                "%{x:,} points: %{y:.4f}",
                in_legend=part == WHOLE,
            )

        parts = [(part, traces(part)) for part in (WHOLE, INTERIOR)]
        drawn = [
            style.Panel(
                found,
                style.number_of_points(evidence.design.sizes),
                style.axis("Mean LEPP size"),
                title=f"The {part}{' mesh' if part == WHOLE else ''}",
            )
            for part, found in parts
            if found
        ]
        return style.panels(drawn, height=340 * len(drawn)) if drawn else None

    def say(view: View) -> str | None:
        words = []
        for part in (WHOLE, INTERIOR):
            rows = evidence.rows(PART_MEANS, method=view.method, part=part).frame
            if rows.empty:
                continue
            last = rows[rows["n_points"] == rows["n_points"].max()]["mean_lepp"]
            least, most = show(last.min(), "fixed4"), show(last.max(), "fixed4")
            means = (
                f"the means of {count(len(last), 'distribution')} lie between {least} and {most}"
                if len(last) > 1
                else f"the mean is {least}"
            )
            words.append(f"in the {'whole mesh' if part == WHOLE else part} {means}")
        if not words:
            return None
        largest = evidence.design.sizes_of(view.method)[-1]
        return f"At {largest:,} points, {listed(words)}."

    return FigureBlock(
        id="figure-parts",
        title="Mean LEPP size of the whole mesh and of its interior",
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"Dots are means over triangulations with {LEVEL} intervals.",
        data=(
            TableBlock(PART_MEANS, "means of the parts", follows=("method",)),
        ),
    )  # fmt: skip
