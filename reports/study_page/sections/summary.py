"""What was found: in sentences, in key figures, and by the paper's statements."""

import pandas as pd

from lepp.theory import LEAST_P_TEXT
from reports.page.blocks import (
    Prose,
    Section,
    Subsection,
    TableBlock,
    Tile,
    Tiles,
    per_view,
)
from reports.page.evidence import Evidence
from reports.page.views import View
from reports.study_page.sections.continuation import one_chance_in_short
from reports.study_page.sections.limit import trend_sentence
from reports.study_page.sections.parts import edge_in_short
from reports.study_page.sections.plain_insertion import paper_triangulation
from reports.study_page.tables import TABLE_4
from reports.text.words import LEVEL
from study.analysis.group_summaries import GROUPS, OVERVIEW
from study.analysis.table import Rows
from study.analysis.terminal_regions import REGIONS
from study.analysis.theorems import MEAN, SD, THEOREM_1, THEOREM_2
from study.paper.judging import DIFFERS
from study.paper.published import INDEPENDENT, REFERENCE_METHOD, SHOWN
from study.paper.reproduction import REPRODUCTION
from study.paper.scoreboard import JUDGED
from study.paper.statements import NOT_TESTED, STATEMENTS
from study.statistics.tails import log10_chi2_tail
from study.statistics.thresholds import CLOSE_UP_TO, ROUGH_RATE
from study.statistics.verdicts import NO, NOT_REJECTED, NOT_SHOWN, UNDECIDED, YES, all_of
from study.text.numbers import count, large, listed, p_is, show


def section(evidence: Evidence) -> Section:
    """Sentences, tiles, the statements."""
    return Section(
        "found",
        "What was found",
        "In short",
        (
            Subsection(
                "key-figures",
                "",
                (
                    Prose(per_view(evidence.views, lambda view: _sentences(evidence, view))),
                    Tiles(per_view(evidence.views, lambda view: _tiles(evidence, view))),
                ),
            ),
            Subsection(
                "statements",
                "What the paper states, and whether it holds",
                (
                    Prose(per_view(evidence.views, lambda view: _statements(evidence, view))),
                    TableBlock(
                        STATEMENTS,
                        "The paper's statements, tested on this run",
                        columns=("source", "holds", "statement", "evidence"),
                    ),
                ),
            ),
        ),
    )


def _largest_group(evidence: Evidence, view: View) -> pd.Series | None:
    groups = evidence.rows(TABLE_4, view)
    return None if groups.empty else groups.last


def _interval(evidence: Evidence, view: View, n_points: int) -> str:
    group = evidence.rows(GROUPS, view, n_points=n_points).first
    if pd.isna(group["mean_low"]):
        return "of one triangulation, too few for an interval"
    low, high = show(group["mean_low"], "fixed4"), show(group["mean_high"], "fixed4")
    return f"{LEVEL} interval {low} to {high}"


def _tiles(evidence: Evidence, view: View) -> list[Tile] | None:
    overview = evidence.one(OVERVIEW, view)
    group = _largest_group(evidence, view)
    if overview is None or group is None:
        return None
    tiles = [
        Tile(
            show(group["mean_lepp"], "fixed4"),
            f"Mean LEPP at {group['n_points']:,} points",
            _interval(evidence, view, group["n_points"]),
        ),
        Tile(
            str(overview["max_lepp"]),
            "Longest path",
            f"among {large(overview['triangles'])} triangles",
        ),
    ]
    theorem = evidence.one(THEOREM_2, view, n_points=group["n_points"])
    moment = evidence.one(THEOREM_1, view, n_points=group["n_points"], statistic=MEAN)
    if theorem is not None and moment is not None:
        tiles.append(
            Tile(
                show(theorem["p_type_c"], "fixed4"),
                "Chance p that a path ends at its first step",
                f"of all steps, a share of r\u00a0=\u00a0{show(moment['p_all_steps'], 'fixed4')}",
            )
        )
    if moment is not None:
        tiles.append(
            Tile(
                show(moment["predicted"], "fixed4"),
                "Mean LEPP by Theorem 1",
                f"from p; measured is {_off(moment['relative_difference'])}",
            )
        )
    if view.method == REFERENCE_METHOD:  # of other triangulations the paper prints nothing
        tiles += _published(evidence, view)
    regions = evidence.rows(REGIONS, view)
    if not regions.empty:
        tiles.append(
            Tile(
                show(regions.last["pair_share"], "percent1"),
                "In a terminal pair",
                "triangles where a refinement stays local",
            )
        )
    return tiles


def _published(evidence: Evidence, view: View) -> list[Tile]:
    """Count the published numbers met: all in the view of the paper's, else the distribution's."""
    rows = evidence.rows(REPRODUCTION, method=view.method, standing=INDEPENDENT).frame
    label = "Independent published numbers met"
    if view.distribution != SHOWN:
        rows = rows[rows["distribution"] == view.distribution]
        label = f"Published numbers of {view.distribution_word} points met"
    judged = rows[rows["verdict"].isin(JUDGED)]
    if judged.empty:
        return []
    z = judged["difference"].dropna().to_numpy()
    together = f"; χ² of all has {p_is(log10_chi2_tail(float(z @ z), len(z)))}" if len(z) else ""
    return [
        Tile(
            f"{int((judged['verdict'] != DIFFERS).sum())} of {len(judged)}",
            label,
            f"within {CLOSE_UP_TO:g} standard errors{together}",
        )
    ]


def _off(relative: float) -> str:
    side = "below" if relative < 0 else "above"
    return f"{show(abs(relative), 'percent1')} {side}"


def _sentences(evidence: Evidence, view: View) -> list[str] | None:
    parts = (
        _spread(evidence, view),
        paper_triangulation(evidence),
        trend_sentence(evidence, view),
        edge_in_short(evidence, view),
        _theory(evidence, view),
    )
    sentences = [part for part in parts if part]
    return sentences or None


def _spread(evidence: Evidence, view: View) -> str | None:
    overview = evidence.one(OVERVIEW, view)
    group = _largest_group(evidence, view)
    if overview is None or group is None:
        return None
    largest = overview["max_lepp"]
    return (
        f"The first step of a refinement, from a random triangle of {group['n_points']:,} "
        f"{view.distribution_word} points triangulated by the {view.method_word} method, follows "
        f"a path of {show(group['mean_lepp'], 'fixed2')} triangles on average; a refinement "
        "repeats it until the triangle is gone. In "
        f"{count(overview['triangulations'], 'triangulation')} of all sizes, with "
        f"{large(overview['triangles'])} triangles, no path was longer than {largest}."
    )


def _theory(evidence: Evidence, view: View) -> str | None:
    rows = evidence.rows(THEOREM_1, view)
    bounds = evidence.rows(THEOREM_2, view)
    if rows.empty or bounds.empty:
        return None
    last = rows.select(n_points=rows["n_points"].max()).frame.set_index("statistic")
    mean, sd = last.loc[MEAN], last.loc[SD]
    if all_of(bounds["bounds"]) == YES:
        outcome = f"Theorem 2's bounds hold in every triangulation{_supposed(bounds)}."
    else:
        outcome = "Theorem 2's bounds fail."
    return (
        f"{outcome} Theorem 1 takes one chance for all steps, "
        f"{one_chance_in_short(evidence, view)}. "
        f"With the chance at the first step, the mean is {_off(mean['relative_difference'])} the "
        "theorem's; with that of all steps it fits by construction, and the standard deviation is "
        f"{_off(sd['difference_all_steps'])}."
    )


def _supposed(bounds: Rows) -> str:
    """Say whether what the bounds follow from holds as well."""
    step = f"step ends a path with a chance of at least {LEAST_P_TEXT}"
    premise = all_of(bounds["premise"].dropna())
    if premise == YES:
        return (
            f". So does what they follow from, that every {step}, as far as the chances are known "
            f"to within {ROUGH_RATE:g} ({_known_up_to(bounds)})"
        )
    if premise == NO:
        return f", although not every {step}{_refuted(bounds)}, from which they would follow"
    return f", while it stays open whether every {step}, from which they would follow"


def _known_up_to(bounds: Rows) -> str:
    """Say up to which size of the path the chances are known."""
    upto = bounds["upto_size"].dropna()
    least, most = int(upto.min()), int(upto.max())
    if least == most:
        return f"up to size {most}"
    return f"up to size {least} to {most}, by the number of points"


def _refuted(bounds: Rows) -> str:
    premise = bounds["premise"].dropna()
    failed = int((premise == NO).sum())
    where = f"at {failed} of {count(len(premise), 'number')} of points, "
    least = show(bounds["lowest_rate"].min(), "fixed4")
    return f" ({where if failed < len(premise) else ''}the least is {least})"


def _statements(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(STATEMENTS, view)
    if rows.empty:
        return None
    holds = rows["holds"].value_counts()
    counted = [
        f"{holds[key]} {word if holds[key] > 1 else of_one}"
        for key, word, of_one in (
            (YES, "hold", "holds"),
            (NO, "do not", "does not"),
            *(
                (word, f"are {word}", f"is {word}")
                for word in (UNDECIDED, NOT_REJECTED, NOT_SHOWN, NOT_TESTED)
            ),
        )
        if key in holds
    ]
    return [
        f"Of {len(rows)} statements of the paper, for {view.distribution_word} points and the "
        f"{view.method_word} method: {listed(counted)}."
    ]
