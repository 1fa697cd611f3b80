"""Which model of growth survives, what it projects, and the paper's Table 7."""

import pandas as pd

from reports.page.assembly import reference
from reports.page.blocks import Prose, Section, Subsection, TableBlock, per_view
from reports.page.evidence import Evidence
from reports.page.views import View
from reports.study_page.sections.limit import limit, models_survive
from reports.study_page.sections.model_curves import curves_figure
from reports.text.words import LEVEL
from study.analysis.group_assumptions import LEVENE
from study.analysis.limits import (
    LIMIT_EVIDENCE,
)
from study.analysis.model_scores import (
    BEHIND,
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
    LEAST_SQUARES,
    PREDICTION,
    REGRESSIONS,
    WEIGHTED,
)
from study.analysis.table import Rows
from study.analysis.trends import PUBLISHED_UP_TO
from study.statistics.thresholds import REFUTED_BELOW
from study.statistics.verdicts import REJECTED
from study.text.numbers import count, listed, p_is, show, ten_to


def section(evidence: Evidence) -> Section:
    """Predictions of sizes not seen, the verdict, projections, Table 7."""
    return Section(
        "regressions",
        "Which model survives",
        "Does the mean have a limit?",
        (_predicted(evidence), limit(evidence), _projected(evidence), _table_7(evidence)),
    )


def _predicted(evidence: Evidence) -> Subsection:
    return Subsection(
        "fits",
        "Sizes not seen",
        (
            Prose(per_view(evidence.views, lambda view: _scores(evidence, view))),
            curves_figure(
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
            curves_figure(
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
        behind = rows["model"][rows["standing"] == BEHIND].tolist()
        if paragraphs and not _fitted_alike(rows, evidence.rows(MODEL_SCORES, view, part=WHOLE)):
            row = rows.first
            of = (
                f"{of}, fitted up to {row['fitted_up_to']:,} points to predict "
                f"{count(row['predicted'], 'larger size')}"
            )
        sentences.append(f"For {of}, {_which(left)}{_behind(behind)} and {_refuted(refuted)}.")
        if struck:
            sentences.append(
                f"The {listed(struck)} {'model has' if len(struck) == 1 else 'models have'} "
                "another limit than the interior, which is level: out as well."
            )
        worst = _worst(evidence, view, part)
        paragraphs.append(" ".join([*sentences, worst] if worst else sentences))
    return paragraphs or None


def _fitted_alike(one: Rows, other: Rows) -> bool:
    ends = [(rows.first["fitted_up_to"], rows.first["predicted"]) for rows in (one, other)]
    return ends[0] == ends[1]


def _which(left: list[str]) -> str:
    return f"the {models_survive(left)}" if left else "no model survives"


def _behind(names: list[str]) -> str:
    """Name the models that are not refuted, but fit much worse than others."""
    if not names:
        return ""
    return f", the {listed(names)} {'one is' if len(names) == 1 else 'ones are'} far behind"


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
        f"Least squares takes all variances to be equal, {_equal_variances(evidence, view)}. "
        f"{reference('figure-models')} and Table 7 have it for the comparison with the paper; all "
        "else on this page goes by weighted fits, which do not suppose it."
    ]


def _equal_variances(evidence: Evidence, view: View) -> str:
    """Say what Levene's test, about both centres, makes of equal variances."""
    tests = evidence.rows(LEVENE, view)
    if tests.empty:
        return "which this run is too small to test"
    rejected = tests["equal_variances"] == REJECTED
    if rejected.any() and not rejected.all():
        return "which Levene's test rejects about one centre of the groups but not the other"
    verb = "rejects" if rejected.all() else "does not reject"
    return f"which Levene's test {verb} ({p_is(tests.first['log10_p'])})"
