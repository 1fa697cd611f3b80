"""Does it agree with the paper: the scoreboard, Table 4, and the paper held against itself."""

from collections.abc import Iterator

import pandas as pd

from lepp import METHODS
from reports.page.blocks import (
    Prose,
    Section,
    Subsection,
    TableBlock,
    common,
    per_view,
)
from reports.page.evidence import Evidence
from reports.page.views import View
from reports.study_page.sections.table_4 import QUANTITIES, table_4
from study.paper.consistency import CONSISTENCY
from study.paper.judging import (
    AGREES,
    CONSISTENT,
    DIFFERS,
    IMPLAUSIBLE,
    MISPRINT,
    NOT_COMPARABLE,
    NOT_RUN,
    PLAUSIBLE,
)
from study.paper.published import (
    BY_CONSTRUCTION,
    IMPLIED,
    RANDOM_DRAW,
    REFERENCE_METHOD,
    SAME_TEST,
)
from study.paper.reproduction import REPRODUCTION
from study.paper.runs_lattice import RUNS_LATTICE
from study.paper.scoreboard import (
    ALL_INDEPENDENT,
    JUDGED,
    OVERALL,
    SUMMARY,
    TOO_CLOSE,
    independent_column,
    verdict_column,
)
from study.statistics.thresholds import AGREES_UP_TO, CLOSE_UP_TO, TABLE_DIFFERS_BELOW
from study.statistics.verdicts import UNDECIDED, YES
from study.text.notation import typeset
from study.text.numbers import count, listed, none_or, p_is, p_of, show


def section(evidence: Evidence) -> Section:
    """Verdicts, Table 4, the paper against itself, the point sets of Table 1."""
    return Section(
        "agreement",
        "Agreement with the paper",
        "Are the published numbers right?",
        (_scoreboard(evidence), table_4(evidence), _consistency(evidence), _table_1(evidence)),
    )


def _scoreboard(evidence: Evidence) -> Subsection:
    return Subsection(
        "scoreboard",
        "The scoreboard",
        (
            Prose(per_view(evidence.views, lambda view: _verdicts(evidence, view))),
            TableBlock(
                SUMMARY,
                "Verdicts by table of the paper",
                columns=(
                    "published_table",
                    "numbers",
                    "independent",
                    *map(independent_column, JUDGED),
                    *map(verdict_column, (PLAUSIBLE, IMPLAUSIBLE, MISPRINT)),
                ),
                follows=("method",),
            ),
            *_together(evidence),
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
                    "standing",
                ),
                follows=("method",),
                folded=True,
                printed_whole=True,
            ),
        ),
    )


def _together(evidence: Evidence) -> tuple[TableBlock, ...]:
    """Nothing where the run has no published group."""
    if evidence.rows(OVERALL).empty:
        return ()
    columns = tuple(name for name in OVERALL.column_names if name != "p")
    return (
        TableBlock(
            OVERALL, "The independent numbers together", columns=columns, follows=("method",)
        ),
    )


def _consistency(evidence: Evidence) -> Subsection:
    return Subsection(
        "consistency",
        "Is the paper consistent with itself?",
        (
            common(consistent(evidence)),
            TableBlock(
                CONSISTENCY,
                "What the paper prints, and what its Table 4 allows",
                columns=(
                    "published_table",
                    "quantity",
                    "n_points",
                    "printed",
                    "recomputed",
                    "low",
                    "high",
                    "verdict",
                ),
                folded=True,
            ),
        ),
    )


def _table_1(evidence: Evidence) -> Subsection:
    return Subsection(
        "table-1-sets",
        "Which point sets does Table 1 test?",
        (
            common(tested_sets(evidence)),
            TableBlock(
                RUNS_LATTICE,
                "p-values of the runs test that sets of each size can have",
                folded=True,
            ),
        ),
    )


def _verdicts(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(SUMMARY, method=view.method)
    if rows.empty:
        return None
    total = rows.frame.drop(columns="method").sum()
    paragraphs = [
        " ".join(
            [
                f"The paper prints {total['numbers']} numbers in its seven tables.",
                *_independent(evidence, view, total),
            ]
        ),
        " ".join(_not_counted(evidence, view, total)),
    ]
    if view.method != REFERENCE_METHOD:
        paragraphs.append(
            "The paper's triangulations are made by inserting the points as they come, without "
            f"flips (the {METHODS[REFERENCE_METHOD].word} method). {view.method_title} "
            "triangulations are other meshes: that they differ is no failure to reproduce."
        )
    return [text for text in paragraphs if text]


def _independent(evidence: Evidence, view: View, total: pd.Series) -> Iterator[str]:
    if not total["independent"]:
        return
    agrees, close, differs = (int(total[independent_column(v)]) for v in JUDGED)
    yield (
        f"{total['independent']} of them are not derived from another printed number, and can be "
        "held against "
        f"ours by their standard errors: {agrees} within {AGREES_UP_TO:g} (agreement), {close} "
        f"within {CLOSE_UP_TO:g} (close) and {differs} beyond (different)."
    )
    together = evidence.one(OVERALL, method=view.method, quantity=ALL_INDEPENDENT)
    if together is None:
        return
    yield (
        f"By chance {show(together['expected_beyond'], 'fixed1')} would be beyond "
        f"{AGREES_UP_TO:g}; {none_or(together['beyond'])} "
        f"{'is' if together['beyond'] < 2 else 'are'}."
    )
    words = {
        AGREES: "are as far from ours as chance puts them",
        DIFFERS: "are further from ours than chance puts them",
        TOO_CLOSE: "are nearer to ours than chance puts them",
    }[together["verdict"]]
    yield (
        f"All together they {words} (χ² = {show(together['chi2'], 'fixed1')} on {together['df']} "
        f"degrees of freedom; {p_is(together['log10_p'])} for more, "
        f"{show(together['p_less'], 'p')} for less)."
    )
    shifts = evidence.rows(OVERALL, method=view.method).frame.dropna(subset=["shift"])
    if not shifts.empty:
        yield _shifts(shifts)


def _shifts(rows: pd.DataFrame) -> str:
    """Say whether numbers of one kind are off to one side."""
    each = [
        f"{QUANTITIES[row.quantity]} {show(row.shift, 'fixed2')} ({p_of(row.shift_p)})"
        for row in rows.itertuples()
    ]
    off = [
        QUANTITIES[row.quantity] for row in rows.itertuples() if row.shift_p < TABLE_DIFFERS_BELOW
    ]
    found = (
        "no kind of number is shifted to one side by more than chance"
        if not off
        else f"{listed(off)} {'is' if len(off) == 1 else 'are'} shifted to one side"
    )
    return f"Over all groups {found}; ours less the paper's, in standard errors: {listed(each)}."


def _not_counted(evidence: Evidence, view: View, total: pd.Series) -> Iterator[str]:
    rows = evidence.rows(REPRODUCTION, method=view.method)
    unseen = rows["verdict"].isin([NOT_COMPARABLE, NOT_RUN])
    standing = rows["standing"][~unseen].value_counts()
    each = [
        f"{standing[name]} {words}"
        for name, words in (
            (IMPLIED, "that follow from the paper's own Table 4"),
            (BY_CONSTRUCTION, "that every run of this design gives"),
            (SAME_TEST, "that stand beside the p-value of the same test"),
            (RANDOM_DRAW, "that are random draws, which no other run can repeat"),
        )
        if name in standing
    ]
    each += [
        f"{total[verdict_column(name)]} {words}"
        for name, words in (
            (NOT_COMPARABLE, "that cannot be compared with this design"),
            (NOT_RUN, "that belong to groups which this run does not have"),
        )
        if total[verdict_column(name)]
    ]
    others = total["numbers"] - total["independent"]
    if each:
        yield f"Not counted are the other {others}: {listed(each)}."
    draws = rows.select(standing=RANDOM_DRAW)["verdict"].value_counts()
    odd, plausible = int(draws.get(IMPLAUSIBLE, 0)), int(draws.get(PLAUSIBLE, 0))
    if odd:
        yield (
            f"Of {count(odd + plausible, 'draw')} that can be held against ours, {odd} "
            f"{'is' if odd == 1 else 'are'} not plausible."
        )
    elif plausible:
        yield f"All {count(plausible, 'draw')} that can be held against ours are plausible."


def consistent(evidence: Evidence) -> str:
    """Say whether what the paper prints can belong to its own Table 4."""
    rows = evidence.rows(CONSISTENCY)
    verdicts = rows["verdict"].value_counts()
    fits = int(verdicts.get(CONSISTENT, 0))
    sentences = [
        f"{count(len(rows), 'published number')} of Tables 5, 6 and 7 "
        f"{'follows' if len(rows) == 1 else 'follow'} from the means and standard deviations of "
        f"the paper's own Table 4; {'all' if fits == len(rows) else fits} of them lie in the "
        "range that the rounding of Table 4 leaves open."
    ]
    wrong = [
        f"{typeset(row.printed)} ({typeset(row.quantity)}), where Table 4 gives "
        f"{show(row.low, 'g4')} to "
        f"{show(row.high, 'g4')}"
        for row in rows.frame.itertuples()
        if row.verdict == MISPRINT
    ]
    if wrong:
        sentences.append(
            f"{count(len(wrong), 'number')} {'is a misprint' if len(wrong) == 1 else 'do not fit'}"
            f", whatever the data were: {'; '.join(wrong)}."
        )
    if UNDECIDED in verdicts:
        sentences.append(f"{verdicts[UNDECIDED]} cannot be decided.")
    return " ".join(sentences)


def tested_sets(evidence: Evidence) -> str:
    """Say which point sets the p-values of Table 1 can be of."""
    rows = evidence.rows(RUNS_LATTICE)
    fitting = rows.select(fits=YES)
    printed = rows.first["printed"]
    others = rows.frame[rows["fits"] != YES]
    start = (
        "The runs test counts whole numbers of runs, so that sets of a given size can have only "
        f"certain p-values. The {printed} that Table 1 prints"
    )
    if fitting.empty:
        return f"{start} are not all possible for any one of the published sizes."
    sizes = [f"{size:,}" for size in fitting["n_points"]]
    sentence = (
        f"{start} are all possible for sets of {listed(sizes)} points "
        f"({listed([show(value, 'fixed2') for value in fitting['expected']])} would be by chance)"
    )
    if not others.empty:
        sentence += f", and at most {others['possible'].max()} of them for any other size"
    if len(fitting) == 1:
        sentence += ": Table 1 tests sets of that group, and is compared with ours of that size"
    return f"{sentence}."
