"""Whether the mean has a limit: the verdict, and what it is made of."""

import pandas as pd

from reports.page.blocks import Prose, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.views import View
from reports.study_page.tables import TABLE_4
from reports.text.words import LEVEL
from study.analysis.limits import (
    EDGE_LIMITS,
    FEW,
    LIMIT_EVIDENCE,
    LIMIT_VERDICTS,
    LIMITS,
    ONE_LIMIT,
    REASONS,
)
from study.analysis.model_scores import MODEL_SCORES, REFUTED, SURVIVES
from study.analysis.parts import INTERIOR, WHOLE
from study.analysis.variance_analysis import ANOVA, WELCH
from study.statistics.limit_verdict import BOUNDED, CONTRADICTION, NONE_FITS, ROUGH
from study.statistics.limit_verdict import LEVEL as IS_LEVEL
from study.statistics.models import THICKENING_EDGE
from study.statistics.thresholds import LEVEL_PER_DECADE, SIGNIFICANCE
from study.statistics.verdicts import NO, YES
from study.text.numbers import count, listed, p_is, show

#: Whose mean a part's is.
_MEAN_OF = {WHOLE: "the mean of the whole mesh", INTERIOR: "the mean of the interior"}


def limit(evidence: Evidence) -> Subsection:
    """Give the verdict, what it is made of, and the edge model held against the interior."""
    return Subsection(
        "limit",
        "Is there a limit?",
        (
            Prose(per_view(evidence.views, lambda view: _limit(evidence, view))),
            TableBlock(
                LIMIT_VERDICTS,
                "The verdict for every distribution",
                columns=(
                    "distribution",
                    "has_limit",
                    "reason",
                    "decided_by",
                    "limit",
                    "limit_low",
                    "limit_high",
                    "limit_from",
                ),
                follows=("method",),
            ),
            TableBlock(
                LIMIT_EVIDENCE,
                "What the whole mesh and its interior say",
                columns=(
                    "distribution",
                    "part",
                    "smallest",
                    "has_limit",
                    "reason",
                    "survivors",
                    "struck_out",
                    "limit",
                    "limit_low",
                    "limit_high",
                    "power_low",
                    "power_high",
                ),
                follows=("method",),
                folded=True,
            ),
            TableBlock(LIMITS, "The limit of each model that has one", folded=True),
            TableBlock(
                EDGE_LIMITS,
                "The edge model's limit and the interior",
                follows=("method",),
                folded=True,
            ),
        ),
    )


def trend_sentence(evidence: Evidence, view: View) -> str | None:
    """Say how the mean depends on the number of points, and whether it has a limit."""
    test = evidence.one(ANOVA, view, test=WELCH)
    groups = evidence.rows(TABLE_4, view)
    if test is None or len(groups) < 2:
        return None
    first, last = groups.first, groups.last
    welch = f"Welch's analysis of variance, {p_is(test['log10_p'])}"
    if test["p"] >= SIGNIFICANCE:
        return (
            f"The mean does not depend on the number of points, as far as this run can tell "
            f"({welch})."
        )
    direction = "grows" if last["mean_lepp"] > first["mean_lepp"] else "falls"
    sentence = (
        f"The mean {direction} with the number of points, from "
        f"{show(first['mean_lepp'], 'fixed4')} at {first['n_points']:,} to "
        f"{show(last['mean_lepp'], 'fixed4')} at {last['n_points']:,} ({welch})."
    )
    verdict = _verdict(evidence, view, "it")
    return f"{sentence} {verdict}" if verdict else sentence


def _verdict(evidence: Evidence, view: View, whose: str) -> str | None:
    """Say whether the mean has a limit: one verdict of the whole mesh and its interior."""
    row = evidence.one(LIMIT_VERDICTS, view)
    if row is None or row["reason"] == FEW:
        return None
    opening = whose[0].upper() + whose[1:]
    if row["has_limit"] == YES:
        return f"{opening} has a limit{_limit_of(row, evidence, view)}"
    if row["has_limit"] == NO:
        return f"{opening} has no limit in sight{_growth_of(row, evidence, view)}"
    return f"Whether {whose} has a limit stays undecided: {_open(row, evidence, view)}."


def _part(evidence: Evidence, view: View, part: str) -> pd.Series:
    return evidence.rows(LIMIT_EVIDENCE, view, part=part).first


def _limit_of(row: pd.Series, evidence: Evidence, view: View) -> str:
    of = row["limit_from"]
    if row["reason"] == REASONS[BOUNDED]:
        return _falling_to(row, evidence, view)
    limit = (
        f"{show(row['limit'], 'fixed4')} ({LEVEL} from {show(row['limit_low'], 'fixed4')} to "
        f"{show(row['limit_high'], 'fixed4')})"
    )
    if row["reason"] == REASONS[IS_LEVEL]:
        return (
            f": {_MEAN_OF[of]} is level, as far as the data reach, for a constant survives, and it "
            f"changes by no more than {show(LEVEL_PER_DECADE, 'g1')} with each tenfold number of "
            f"points from {_part(evidence, view, of)['smallest']:,} on; the limit is {limit}."
        )
    scores = evidence.rows(MODEL_SCORES, view, part=of, standing=SURVIVES).frame
    with_limit = scores[scores["has_limit"] == YES]
    tried = count(len(evidence.rows(MODEL_SCORES, view, part=of)), "model")
    whose = "the whole mesh" if of == WHOLE else "the interior"
    return (
        f", among the {tried} tried: all that have none are out for {whose}, and "
        f"{_with_p(with_limit)}. The limit is {limit}."
    )


def _falling_to(row: pd.Series, evidence: Evidence, view: View) -> str:
    """Say that what falls has a limit, and what is known of it."""
    of = row["limit_from"]
    survivors = evidence.rows(MODEL_SCORES, view, part=of, standing=SURVIVES)
    sentence = (
        f": {_MEAN_OF[of]} falls, and no mean falls below 1, the size of the shortest path. The "
        f"limit is below {show(row['limit_high'], 'fixed4')}"
    )
    endless = survivors.select(has_limit=NO)
    known = evidence.rows(LIMITS, view, part=of).frame
    known = known[known["model"].isin(survivors["model"])]
    if not known.empty:
        named = [f"{show(one.value, 'fixed4')} ({one.model} model)" for one in known.itertuples()]
        sentence += f"; models that have one and survive put it at {listed(named)}"
    if endless.empty:
        return sentence + "."
    names = endless["model"].tolist()
    follow = "model, which falls without end, follows"
    if len(names) > 1:
        follow = "models, which fall without end, follow"
    return f"{sentence}. How far below is open: the {listed(names)} {follow} the means as well."


def _with_p(scores: pd.DataFrame) -> str:
    """Name models that survive, with the p of what they survive."""
    names = [
        f"{row.model} (p\u00a0=\u00a0{show(row.fit_p, 'p')} for the fit to all sizes, "
        f"{show(row.prediction_p, 'p')} for sizes not seen)"
        for row in scores.itertuples()
    ]
    return f"the {models_survive(names)}"


def _growth_of(row: pd.Series, evidence: Evidence, view: View) -> str:
    part = WHOLE if WHOLE in row["decided_by"] else INTERIOR
    it = "it" if part == WHOLE else _MEAN_OF[part]
    return (
        f", among the models tried: {it} grows like a logarithm of the number of points or faster."
    )


def _open(row: pd.Series, evidence: Evidence, view: View) -> str:
    """Say why no verdict is had, without the full stop."""
    reason = row["reason"]
    if reason == REASONS[CONTRADICTION]:
        return "the whole mesh and its interior contradict each other"
    if reason == REASONS[NONE_FITS]:
        return "no model follows the means"
    parts = evidence.rows(LIMIT_EVIDENCE, view, reason=reason)
    part = parts.first
    if reason == REASONS[ROUGH]:
        per = (
            f"{show(part['per_decade_low'], 'fixed4')} to {show(part['per_decade_high'], 'fixed4')}"
        )
        return f"no change is seen, but with each tenfold number of points it may be from {per}"
    scores = evidence.rows(MODEL_SCORES, view, part=part["part"], standing=SURVIVES).frame
    with_limit, without = (
        scores["model"][scores["has_limit"] == word].tolist() for word in (YES, NO)
    )
    if not without:
        return (
            f"the {models_survive(with_limit)}, but it may follow a power that no one can tell "
            "from a logarithm"
        )
    if not with_limit:
        return f"the {models_survive(without)}, but a power with a limit is not excluded"
    return f"with one, the {models_survive(with_limit)}; without, the {models_survive(without)}"


def models_survive(names: list[str]) -> str:
    """Name the models that survive."""
    return f"{listed(names)} {'model survives' if len(names) == 1 else 'models survive'}"


def _limit(evidence: Evidence, view: View) -> list[str] | None:
    verdict = _verdict(evidence, view, "the mean")
    if verdict is None:
        known = evidence.one(LIMIT_VERDICTS, view) is not None
        return ["Whether the mean has a limit needs more sizes."] if known else None
    check = _edge_check(evidence, view)
    return [f"{ONE_LIMIT}. {verdict}", *([check] if check else [])]


def _edge_check(evidence: Evidence, view: View) -> str | None:
    row = evidence.one(EDGE_LIMITS, view)
    if row is None:
        return None
    if row["level"] != YES:
        model = evidence.one(MODEL_SCORES, view, part=WHOLE, model=THICKENING_EDGE.name)
        if model is None or model["standing"] == REFUTED:
            return None
        return (
            "No constant survives for the interior, so that its mean is no limit to hold the "
            f"thickening edge's {show(row['limit'], 'fixed4')} against."
        )
    differ = "No difference is seen" if row["agrees"] == YES else "The two differ"
    return (
        "With an edge that thickens as the logarithm of the number of points, the whole mesh has "
        f"the limit {show(row['limit'], 'fixed4')}; the interior of the larger meshes has the mean "
        f"{show(row['interior'], 'fixed4')}. {differ}: the two are "
        f"{show(abs(row['t']), 'fixed1')} standard errors apart "
        f"(p\u00a0=\u00a0{show(row['p'], 'p')})."
    )
