"""Which model of growth survives, whether the mean has a limit, and the paper's Table 7."""

import pandas as pd

from reports.page import style
from reports.page.assembly import reference
from reports.page.blocks import FigureBlock, Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.style import Spec
from reports.page.views import View
from reports.study_page.tables import TABLE_4
from reports.text.words import LEVEL
from study.analysis.group_summaries import GROUPS
from study.analysis.limits import (
    EDGE_LIMITS,
    FEW,
    LIMIT_EVIDENCE,
    LIMIT_VERDICTS,
    LIMITS,
    ONE_LIMIT,
    REASONS,
)
from study.analysis.model_scores import (
    MODEL_SCORES,
    PREDICTIONS,
    PROJECTIONS,
    REFUTED,
    STRUCK_OUT,
    SURVIVES,
)
from study.analysis.part_means import PART_MEANS
from study.analysis.parts import INTERIOR, WHOLE
from study.analysis.regressions import (
    COEFFICIENTS,
    CURVES,
    LEAST_SQUARES,
    PREDICTION,
    REGRESSIONS,
    WEIGHTED,
)
from study.analysis.trends import PUBLISHED_UP_TO
from study.analysis.variance_analysis import ANOVA, WELCH
from study.statistics.limit_verdict import CONTRADICTION, NONE_FITS, ROUGH
from study.statistics.limit_verdict import LEVEL as IS_LEVEL
from study.statistics.models import LINEAR_MODELS, MODELS
from study.statistics.thresholds import LEVEL_PER_DECADE, REFUTED_BELOW, SIGNIFICANCE
from study.statistics.verdicts import NO, YES
from study.text.numbers import count, listed, p_is, show, ten_to

#: Whose mean a part's is.
_MEAN_OF = {WHOLE: "the mean of the whole mesh", INTERIOR: "the mean of the interior"}


def section(evidence: Evidence) -> Section:
    """Predictions of sizes not seen, the verdict, projections, Table 7."""
    return Section(
        "regressions",
        "Which model survives",
        "Does the mean have a limit?",
        (_predicted(evidence), _judged(evidence), _projected(evidence), _table_7(evidence)),
    )


def _predicted(evidence: Evidence) -> Subsection:
    return Subsection(
        "fits",
        "Sizes not seen",
        (
            Prose(per_view(evidence.views, lambda view: _scores(evidence, view))),
            _figure(
                evidence,
                "figure-projections",
                "The models beyond the sizes that they are fitted to",
                "Figure 7",
                PREDICTION,
            ),
            TableBlock(
                MODEL_SCORES,
                "How the models fit and predict",
                columns=(
                    "part",
                    "model",
                    "has_limit",
                    "prediction_log10_p",
                    "worst",
                    "fit_p",
                    "refuted_below",
                    "delta_aic",
                    "akaike_weight",
                    "standing",
                ),
            ),
            TableBlock(PREDICTIONS, "Each size predicted by each model", folded=True),
        ),
    )


def _judged(evidence: Evidence) -> Subsection:
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


def _projected(evidence: Evidence) -> Subsection:
    return Subsection(
        "projections",
        "Beyond the data",
        (
            Prose(per_view(evidence.views, lambda view: _beyond(evidence, view))),
            TableBlock(PROJECTIONS, "What the models that survive project", folded=True),
        ),
    )


def _table_7(evidence: Evidence) -> Subsection:
    return Subsection(
        "table-7",
        "The paper's regressions",
        (
            Prose(per_view(evidence.views, lambda view: _of_paper(evidence, view))),
            _figure(
                evidence,
                "figure-models",
                "The paper's models fitted to all sizes",
                "Figure 6",
                LEAST_SQUARES,
            ),
            TableBlock(
                REGRESSIONS,
                "The paper's four models, by least squares as in the paper",
                paper="Table 7",
                columns=("model", "formula", "adj_r2", "log10_p", "lack_of_fit_p"),
                where={"fitting": LEAST_SQUARES},
            ),
            TableBlock(
                REGRESSIONS,
                "All models, weighted",
                columns=(
                    "part",
                    "model",
                    "formula",
                    "adj_r2",
                    "lack_of_fit_p",
                    "aic",
                    "bic",
                    "left_out_rmse",
                ),
                where={"fitting": WEIGHTED},
                folded=True,
                id="table-regressions-weighted",
            ),
            TableBlock(COEFFICIENTS, "Coefficients of the models, with intervals", folded=True),
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
    return " ".join([sentence, *verdict_sentences(evidence, view)])


def verdict_sentences(evidence: Evidence, view: View) -> list[str]:
    """Say whether the mean has a limit: one verdict of the whole mesh and its interior."""
    row = evidence.one(LIMIT_VERDICTS, view)
    if row is None or row["reason"] == FEW:
        return []
    if row["has_limit"] == YES:
        return [_has_limit(row, evidence, view)]
    if row["has_limit"] == NO:
        return [_grows(row, evidence, view)]
    return [f"Whether it has a limit stays undecided: {_open(row, evidence, view)}."]


def _part(evidence: Evidence, view: View, part: str) -> pd.Series:
    return evidence.rows(LIMIT_EVIDENCE, view, part=part).first


def _has_limit(row: pd.Series, evidence: Evidence, view: View) -> str:
    limit = (
        f"{show(row['limit'], 'fixed4')} ({LEVEL} from {show(row['limit_low'], 'fixed4')} to "
        f"{show(row['limit_high'], 'fixed4')})"
    )
    of = row["limit_from"]
    if row["reason"] == REASONS[IS_LEVEL]:
        return (
            f"It has a limit: {_MEAN_OF[of]} is level, for it changes by no more than "
            f"{show(LEVEL_PER_DECADE, 'g1')} with each tenfold number of points from "
            f"{_part(evidence, view, of)['smallest']:,} on; the limit is {limit}."
        )
    scores = evidence.rows(MODEL_SCORES, view, part=of, standing=SURVIVES).frame
    with_limit = scores[scores["has_limit"] == YES]
    tried = count(len(evidence.rows(MODEL_SCORES, view, part=of)), "model")
    whose = "" if of == WHOLE else " for the interior"
    return (
        f"It has a limit, among the {tried} tried: all that have none are out{whose}, and "
        f"{_with_p(with_limit)}. The limit is {limit}."
    )


def _with_p(scores: pd.DataFrame) -> str:
    """Name models that survive, with the p of what they survive."""
    names = [
        f"{row.model} (p\u00a0=\u00a0{show(row.fit_p, 'p')} for the fit to all sizes, "
        f"{show(row.prediction_p, 'p')} for sizes not seen)"
        for row in scores.itertuples()
    ]
    return f"the {_models(names)}"


def _grows(row: pd.Series, evidence: Evidence, view: View) -> str:
    part = WHOLE if WHOLE in row["decided_by"] else INTERIOR
    grows = "grows" if _part(evidence, view, part)["per_decade"] > 0 else "falls"
    it = "it" if part == WHOLE else _MEAN_OF[part]
    return (
        f"It has no limit in sight, among the models tried: {it} {grows} like a logarithm of the "
        "number of points or faster."
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
            f"the {_models(with_limit)}, but it may follow a power that no one can tell from a "
            "logarithm"
        )
    if not with_limit:
        return f"the {_models(without)}, but a power with a limit is not excluded"
    return f"with one, the {_models(with_limit)}; without, the {_models(without)}"


def _models(names: list[str]) -> str:
    return f"{listed(names)} {'model survives' if len(names) == 1 else 'models survive'}"


def _scores(evidence: Evidence, view: View) -> list[str] | None:
    paragraphs: list[str] = []
    for part, of in ((WHOLE, "the whole mesh"), (INTERIOR, "the interior")):
        rows = evidence.rows(MODEL_SCORES, view, part=part)
        if rows.empty:
            continue
        refuted = rows["model"][rows["standing"] == REFUTED].tolist()
        struck = rows["model"][rows["standing"] == STRUCK_OUT].tolist()
        left = rows["model"][rows["standing"] == SURVIVES].tolist()
        sentences = [] if paragraphs else [_what_is_predicted(rows.first)]
        smallest = evidence.rows(LIMIT_EVIDENCE, view, part=part)["smallest"].min()
        first = evidence.rows(PART_MEANS, view, part=part)["n_points"].min()
        if smallest > first:
            of = f"{of} from {smallest:,} points on"
        sentences.append(f"For {of}, {_which(left)} and {_refuted(refuted)}.")
        if struck:
            sentences.append(
                f"The {listed(struck)} {'model has' if len(struck) == 1 else 'models have'} "
                "another limit than the interior, which is level: out as well."
            )
        worst = _worst(evidence, view, part)
        paragraphs.append(" ".join([*sentences, worst] if worst else sentences))
    return paragraphs or None


def _which(left: list[str]) -> str:
    return f"the {_models(left)}" if left else "no model survives"


def _refuted(names: list[str]) -> str:
    return (
        f"the {listed(names)} {'one is' if len(names) == 1 else 'ones are'} refuted"
        if names
        else "none is refuted"
    )


def _what_is_predicted(row: pd.Series) -> str:
    up_to = row["fitted_up_to"]
    sizes = count(row["predicted"], "larger size")
    if up_to == PUBLISHED_UP_TO:
        asked = (
            f"Each model is fitted up to {up_to:,} points, the paper's range, and has to predict "
            f"the {sizes} of this run."
        )
    else:
        asked = (
            f"This run has too few sizes on one side of {PUBLISHED_UP_TO:,} points, where the "
            f"paper's range ends, so that each model is fitted up to {up_to:,} points and has to "
            f"predict the {sizes} left out."
        )
    return (
        f"{asked} A p below {show(row['refuted_below'], 'g2')} there, or for the fit to all sizes, "
        f"refutes it: {REFUTED_BELOW:g}, shared among all trends of this run."
    )


def _worst(evidence: Evidence, view: View, part: str) -> str | None:
    """Say how far off the model that the paper chose is, at the largest size."""
    rows = evidence.rows(PREDICTIONS, view, part=part, model="logarithmic")
    if rows.empty:
        return None
    row = rows.last
    off = row["difference"]
    return (
        f"At {row['n_points']:,} points the logarithmic model, which the paper prefers, predicts "
        f"{show(row['prediction'], 'fixed4')}; measured is {show(row['mean_lepp'], 'fixed4')}, "
        f"{show(abs(off), 'fixed1')} standard errors {'below' if off < 0 else 'above'}."
    )


def _limit(evidence: Evidence, view: View) -> list[str] | None:
    row = evidence.one(LIMIT_VERDICTS, view)
    sentences = verdict_sentences(evidence, view)
    if not sentences:
        return None if row is None else ["Whether the mean has a limit needs more sizes."]
    said = sentences[0].replace("It has", "The mean has", 1)
    said = said.replace("Whether it has", "Whether the mean has", 1)
    check = _edge_check(evidence, view)
    return [f"{ONE_LIMIT}. {said}", *([check] if check else [])]


def _edge_check(evidence: Evidence, view: View) -> str | None:
    row = evidence.one(EDGE_LIMITS, view)
    if row is None:
        return None
    if row["level"] != YES:  # then the mean of the interior is no limit
        return None
    agrees = "agree" if row["agrees"] == YES else "do not agree"
    return (
        "With an edge that thickens as the logarithm of the number of points, the whole mesh has "
        f"the limit {show(row['limit'], 'fixed4')}; the interior of the larger meshes has the mean "
        f"{show(row['interior'], 'fixed4')}. The two {agrees}: they differ by "
        f"{show(abs(row['t']), 'fixed1')} standard errors "
        f"(p\u00a0=\u00a0{show(row['p'], 'p')})."
    )


def _beyond(evidence: Evidence, view: View) -> list[str] | None:
    rows = evidence.rows(PROJECTIONS, view, part=WHOLE)
    if rows.empty:
        return None
    far = rows.select(n_points=rows["n_points"].max())
    power = ten_to(len(str(far.first["n_points"])) - 1)
    words = [
        f"{show(row.prediction, 'fixed4')} ({row.model}, {LEVEL} from {show(row.low, 'fixed4')} to "
        f"{show(row.high, 'fixed4')})"
        for row in far.frame.itertuples()
    ]
    return [
        f"What follows is extrapolation, by the models that survive for the whole mesh; the "
        f"intervals hold only if the model does. At {power} points they put the mean at "
        f"{listed(words)}."
    ]


def _of_paper(evidence: Evidence, view: View) -> list[str] | None:
    four = evidence.rows(REGRESSIONS, view, fitting=LEAST_SQUARES).frame
    if four.empty:
        return None
    top = four.loc[four["adj_r2"].idxmax()]
    return [
        f"Of the paper's four models the {top['model']} one fits the {view.distribution_word} "
        f"points best by least squares, with an adjusted R² of {show(top['adj_r2'], 'fixed3')}. "
        "Least squares takes all variances to be equal, which they are not: "
        f"{reference('figure-models')} and Table 7 have it for the comparison with the paper, and "
        "all else on this page goes by weighted fits."
    ]


def _figure(evidence: Evidence, name: str, title: str, paper: str, which: str) -> FigureBlock:
    def draw(view: View) -> Spec | None:
        panels = [_panel(evidence, view, part, which) for part in (WHOLE, INTERIOR)]
        drawn = [panel for panel in panels if panel]
        return style.panels(drawn, height=380 * len(drawn)) if drawn else None

    def say(view: View) -> str | None:
        rows = evidence.rows(CURVES, view, part=WHOLE, view=which)
        if rows.empty:
            return None
        groups = evidence.rows(GROUPS, view)
        n = groups["n_points"].max()
        last = rows.select(n_points=n).frame.set_index("model")
        return (
            f"At {n:,} points the curves for the whole mesh are from "
            f"{show(last['prediction'].min(), 'fixed4')} ({last['prediction'].idxmin()}) to "
            f"{show(last['prediction'].max(), 'fixed4')} ({last['prediction'].idxmax()}), and the "
            f"measured mean is {show(groups.last['mean_lepp'], 'fixed4')}."
        )

    fitted = {
        PREDICTION: "curves are weighted fits of the models that survive and of the paper's "
        "logarithmic one, to the sizes up to the upright line only, and go on beyond it",
        LEAST_SQUARES: "curves are least squares fits to all sizes, of the paper's four models",
    }[which]
    return FigureBlock(
        id=name,
        title=title,
        paper=paper,
        specs=per_view(evidence.views, draw),
        alternatives=per_view(evidence.views, say),
        reading=f"Dots are the means with {LEVEL} intervals; {fitted}.",
        data=(TableBlock(CURVES, f"points of the curves ({which})", where={"view": which}),),
    )


def _panel(evidence: Evidence, view: View, part: str, which: str) -> style.Panel | None:
    means = evidence.rows(PART_MEANS, view, part=part)
    traces: list[Spec] = []
    models = LINEAR_MODELS if which == LEAST_SQUARES else MODELS
    for series, model in enumerate(one.name for one in models):
        rows = evidence.rows(CURVES, view, part=part, model=model, view=which)
        if not rows.empty:
            traces.append(
                style.scatter(
                    x=rows.column("n_points"),
                    y=rows.column("prediction"),
                    mode="lines",
                    name=model,
                    legendgroup=model,
                    showlegend=part == WHOLE,
                    # Pale and wide, the first is seen beside one that lies on it.
                    line=style.line(series, 2 if traces else 5),
                    opacity=1 if traces else 0.5,
                    hovertemplate="%{x:,} points: %{y:.4f}<extra>" + model + "</extra>",
                )
            )
    if means.empty or not traces:
        return None
    low, high = float(means["mean_lepp"].min()), float(means["mean_lepp"].max())
    margin = max((high - low) / 4, 0.002)
    scores = evidence.rows(MODEL_SCORES, view, part=part)
    if which == PREDICTION and not scores.empty:
        end = scores.first["fitted_up_to"]
        traces.append(
            style.scatter(
                x=[end, end],
                y=[low - margin, high + margin],
                mode="lines",
                name="end of the sizes fitted",
                legendgroup="end",
                showlegend=part == WHOLE,
                line={"color": style.MUTED, "width": 1.5, "dash": "dot"},
                hoverinfo="skip",
            )
        )
    traces.append(
        style.scatter(
            x=means.column("n_points"),
            y=means.column("mean_lepp"),
            mode="markers",
            name="means",
            legendgroup="means",
            showlegend=part == WHOLE,
            marker={"color": style.INK, "size": 6},
            error_y={
                "type": "data",
                "symmetric": False,
                "thickness": 1,
                "width": 0,
                "color": style.MUTED,
                "array": means["high"] - means["mean_lepp"],
                "arrayminus": means["mean_lepp"] - means["low"],
            },
            hovertemplate="%{x:,} points: %{y:.4f}<extra></extra>",
        )
    )
    return style.Panel(
        traces,
        style.number_of_points(evidence.design.sizes),
        style.axis("Mean LEPP size", range=[low - margin, high + margin]),
        title=f"The {part}{' mesh' if part == WHOLE else ''}",
    )
