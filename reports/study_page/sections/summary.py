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
from reports.study_page.sections.plain_insertion import paper_triangulation
from reports.study_page.sections.regressions import best
from reports.study_page.tables import TABLE_4
from reports.text.numbers import count, large, listed, show
from reports.text.words import LEVEL, PREMISE
from study.analysis.group_summaries import GROUPS, OVERVIEW
from study.analysis.terminal_regions import REGIONS
from study.analysis.theorems import MEAN, SD, THEOREM_1, THEOREM_2
from study.analysis.variance_analysis import ANOVA, WELCH
from study.paper.judging import AGREES, CLOSE, DIFFERS
from study.paper.published import REFERENCE_METHOD
from study.paper.reproduction import SUMMARY
from study.paper.statements import NOT_TESTED, STATEMENTS
from study.statistics.thresholds import CLOSE_UP_TO, ONE_PERCENT, SIGNIFICANCE, WITHIN_ONE_PERCENT
from study.statistics.verdicts import NO, UNDECIDED, YES, all_of


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


def _tiles(evidence: Evidence, view: View) -> list[Tile] | None:
    overview = evidence.one(OVERVIEW, view)
    group = _largest_group(evidence, view)
    if overview is None or group is None:
        return None
    interval = evidence.rows(GROUPS, view, n_points=group["n_points"]).first
    tiles = [
        Tile(
            show(group["mean_lepp"], "fixed4"),
            f"Mean LEPP at {group['n_points']:,} points",
            f"{LEVEL} interval {show(interval['mean_low'], 'fixed4')} to "
            f"{show(interval['mean_high'], 'fixed4')}",
        ),
        Tile(
            str(overview["max_lepp"]),
            "Longest path",
            f"among {large(overview['triangles'])} triangles",
        ),
    ]
    theorem = evidence.one(THEOREM_2, view, n_points=group["n_points"])
    if theorem is not None:
        tiles.append(
            Tile(
                show(theorem["p_type_c"], "fixed4"),
                "Chance p that a path ends",
                f"Theorem 2 supposes at least {LEAST_P_TEXT}",
            )
        )
    moment = evidence.one(THEOREM_1, view, n_points=group["n_points"], statistic=MEAN)
    if moment is not None:
        tiles.append(
            Tile(
                show(moment["predicted"], "fixed4"),
                "Mean LEPP by Theorem 1",
                f"measured is {_off(moment['relative_difference'])}",
            )
        )
    verdicts = evidence.rows(SUMMARY, method=view.method)
    agrees, close, differs = (int(verdicts[v].sum()) for v in (AGREES, CLOSE, DIFFERS))
    # Of other triangulations the paper prints nothing.
    if view.method == REFERENCE_METHOD and agrees + close + differs:
        tiles.append(
            Tile(
                f"{agrees + close} of {agrees + close + differs}",
                "Published numbers met",
                f"within {CLOSE_UP_TO:g} standard errors",
            )
        )
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


def _off(relative: float) -> str:
    side = "below" if relative < 0 else "above"
    return f"{show(abs(relative), 'percent1')} {side}"


def _sentences(evidence: Evidence, view: View) -> list[str] | None:
    parts = (
        _spread(evidence, view),
        paper_triangulation(evidence),
        _growth(evidence, view),
        _theory(evidence, view),
    )
    sentences = [part for part in parts if part]
    return sentences or None


def _spread(evidence: Evidence, view: View) -> str | None:
    overview = evidence.one(OVERVIEW, view)
    group = _largest_group(evidence, view)
    if overview is None or group is None:
        return None
    return (
        f"A refinement that starts at a random triangle of {group['n_points']:,} "
        f"{view.distribution_word} points, triangulated by the {view.method_word} method, runs "
        f"through {show(group['mean_lepp'], 'fixed2')} triangles on average. In "
        f"{count(overview['triangulations'], 'triangulation')} with {large(overview['triangles'])} "
        f"triangles, no path was longer than {overview['max_lepp']}."
    )


def _growth(evidence: Evidence, view: View) -> str | None:
    test = evidence.one(ANOVA, view, test=WELCH)
    groups = evidence.rows(TABLE_4, view)
    if test is None or len(groups) < 2:
        return None
    first, last = groups.first, groups.last
    if test["p"] >= SIGNIFICANCE:
        return (
            "The mean does not depend on the number of points, as far as this run can tell "
            f"(Welch's analysis of variance, p\u00a0=\u00a0{show(test['log10_p'], 'log10p')})."
        )
    direction = "grows" if last["mean_lepp"] > first["mean_lepp"] else "falls"
    sentence = (
        f"The mean {direction} with the number of points, from "
        f"{show(first['mean_lepp'], 'fixed4')} at {first['n_points']:,} to "
        f"{show(last['mean_lepp'], 'fixed4')} at {last['n_points']:,} "
        f"(Welch's analysis of variance, p\u00a0=\u00a0{show(test['log10_p'], 'log10p')})"
    )
    chosen = best(evidence, view)
    return sentence + (
        f"; the {chosen['model']} model describes it best by AIC." if chosen is not None else "."
    )


def _theory(evidence: Evidence, view: View) -> str | None:
    rows = evidence.rows(THEOREM_1, view)
    bounds = evidence.rows(THEOREM_2, view)
    if rows.empty or bounds.empty:
        return None
    last = rows.select(n_points=rows["n_points"].max()).frame.set_index("statistic")
    mean, sd = last.loc[MEAN], last.loc[SD]
    kept = all_of(bounds["bounds"]) == YES
    p = f"p is {show(mean['p_type_c'], 'fixed4')}"
    supposed = {
        YES: f"and so does what it supposes, {PREMISE}",
        NO: f"although what it supposes, {PREMISE}, does not{_refuted(bounds['premise'], p)}",
        UNDECIDED: f"while it stays open whether {PREMISE}, which it supposes",
    }[all_of(bounds["premise"])]
    outcome = (
        "Theorem 2's bounds hold in every triangulation" if kept else "Theorem 2's bounds fail"
    )
    if not kept:
        supposed = p
    if max(abs(mean["relative_difference"]), abs(sd["relative_difference"])) < WITHIN_ONE_PERCENT:
        first = f"Theorem 1 gives the mean and the standard deviation within {ONE_PERCENT}."
    else:
        first = (
            f"Theorem 1 gives {show(mean['predicted'], 'fixed2')} for the mean, and the measured "
            f"one is {_off(mean['relative_difference'])}; for the standard deviation it gives "
            f"{show(sd['predicted'], 'fixed2')}, and the measured one is "
            f"{_off(sd['relative_difference'])}."
        )
    return f"{outcome}, {supposed}. {first}"


def _refuted(premise: pd.Series, p: str) -> str:
    failed = int((premise == NO).sum())
    if failed == len(premise):
        return f": {p}"
    return f" at {failed} of {count(len(premise), 'number')} of points"


def _statements(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(STATEMENTS, view)
    if rows.empty:
        return None
    holds = rows["holds"].value_counts()
    counted = [
        f"{holds[key]} {word}"
        for key, word in (
            (YES, "hold"),
            (NO, "do not"),
            (UNDECIDED, UNDECIDED),
            (NOT_TESTED, NOT_TESTED),
        )
        if key in holds
    ]
    return [
        f"Of {len(rows)} statements of the paper, for {view.distribution_word} points and the "
        f"{view.method_word} method: {listed(counted)}."
    ]
