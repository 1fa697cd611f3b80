"""The distributions of the points against each other."""

import pandas as pd

from reports.page.assembly import reference
from reports.page.blocks import Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.views import View, distribution_word
from reports.text.words import LEVEL
from study.analysis.distribution_comparison import (
    ALIKE,
    DIFFER,
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
    """All pairs, in words and in a table."""
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
    if not paragraphs:
        return None
    return [*paragraphs, f"{reference('figure-parts')} shows the means of all distributions."]


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
