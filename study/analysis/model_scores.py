"""Which model survives: how each fits all sizes, predicts those not seen, and what it projects."""

from collections.abc import Iterator

import numpy as np

from study.analysis.building import Study, builds
from study.analysis.parts import PART
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row, Table
from study.analysis.trends import JUDGED_NOTE, PUBLISHED_UP_TO, STRUCK_OUT_NOTE, Trend, trends
from study.statistics.limit_verdict import Candidate, survivors_of
from study.statistics.model_scores import predictions, value_interval
from study.statistics.power_family import ProfileInterval
from study.statistics.thresholds import CLEAR_AIC, LEVEL, REFUTED_BELOW
from study.statistics.verdicts import NO, YES

#: What becomes of a model.
SURVIVES, BEHIND, REFUTED, STRUCK_OUT = "survives", "behind", "refuted", "struck out"
#: Where models that survive are asked for projections, in points.
_FAR = tuple(10**power for power in range(6, 10))

_MODEL = Column("model", "Model")

MODEL_SCORES = Declaration(
    "model_scores",
    "Which model of growth survives",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        _MODEL,
        Column("formula", "Formula, x in thousands of points"),
        Column("has_limit", "Has a limit"),
        Column("fitted_up_to", "Fitted up to", "points", "int"),
        Column("predicted", "Sizes predicted", "", "int"),
        Column("prediction_chi2", "Chi-squared, prediction", "", "fixed1"),
        Column("prediction_p", "p, prediction", "", "p"),
        Column("prediction_log10_p", "log10 p, prediction", "", "log10p"),
        Column("worst", "Largest error", "standard errors", "fixed1"),
        Column("fit_chi2", "Chi-squared, all sizes", "", "fixed1"),
        Column("fit_df", "Df, all sizes", "", "int"),
        Column("fit_p", "p, all sizes", "", "p"),
        Column("refuted_below", "Refuted below p", "", "g2"),
        Column("delta_aic", "AIC above the lowest", "", "fixed1"),
        Column("akaike_weight", "Akaike weight", "", "percent1"),
        Column("standing", "Verdict"),
    ),
    note="Weighted fits to the means of the sizes; variances are a smooth function of the number "
    f"of points and count as known. {JUDGED_NOTE} A model is fitted to the sizes up to "
    f"{PUBLISHED_UP_TO:,} points, the paper's range, and predicts the others; where there are "
    "none, or too few to fit, the largest quarter is predicted from the rest. The p of a "
    "prediction counts the errors of the means and, with all covariances, those of the fit; it and "
    "the p of all sizes are of F, with the degrees of freedom of the pure error. Refuted: one p "
    f"below {REFUTED_BELOW} divided by the number of trends that this run judges, those of every "
    f"distribution, triangulation and part (Bonferroni), unless a model that it contains with "
    f"fewer coefficients stands. Struck out: {STRUCK_OUT_NOTE}. Behind: "
    f"the AIC of the fit to all sizes is more than {CLEAR_AIC:g} above that of a model that is "
    "neither. The logistic model's limit of 4 is supposed, and a parabola turns round: these two "
    "say nothing of a limit, and have a dash for it. The constant is the others with no slope; of "
    "the two powers, growing and saturating, one fits best at its end, as the logarithm: it is no "
    "model of its own, and has no row.",
)

PREDICTIONS = Declaration(
    "predictions",
    "Sizes as models predict them that have not seen them",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        _MODEL,
        N_POINTS,
        Column("mean_lepp", "Mean LEPP", "triangles", "fixed4"),
        Column("prediction", "Predicted", "triangles", "fixed4"),
        Column("low", f"{LEVEL} from", "triangles", "fixed4"),
        Column("high", f"{LEVEL} to", "triangles", "fixed4"),
        Column("difference", "Measured less predicted", "standard errors", "fixed1"),
    ),
    note="Each size by itself, from the fits of the table of models. The interval is that of the "
    "fit, the standard error that of the difference: the fit's and the mean's.",
)

PROJECTIONS = Declaration(
    "projections",
    "Projections of the models that survive",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        _MODEL,
        N_POINTS,
        Column("prediction", "Mean LEPP", "triangles", "fixed4"),
        Column("low", f"{LEVEL} from", "triangles", "fixed4"),
        Column("high", f"{LEVEL} to", "triangles", "fixed4"),
    ),
    note="Extrapolation: no data are there. Only of models that survive and say whether there is a "
    "limit, fitted to all sizes. "
    "The intervals hold only if the model is true; those of the power models are by profile "
    "likelihood over all powers.",
)


@builds(MODEL_SCORES, PREDICTIONS, PROJECTIONS)
def model_scores(study: Study) -> Iterator[Table]:
    """Score every model on every method, distribution and part."""
    judged = trends(study.data)
    yield MODEL_SCORES.table(row for trend in judged for row in _scores(trend))
    yield PREDICTIONS.table(row for trend in judged for row in _predictions(trend))
    yield PROJECTIONS.table(row for trend in judged for row in _projections(trend))


def _scores(trend: Trend) -> Iterator[Row]:
    surviving = {one.model.name for one in survivors_of(trend.candidates)}
    lowest = min((one.aic for one in trend.candidates), default=0.0)
    total = sum(np.exp((lowest - one.aic) / 2) for one in trend.candidates)
    for one in trend.candidates:
        errors = [each.standard_errors for each in _predicted(trend, one)]
        yield trend.key | {
            "model": one.model.name,
            "formula": one.model.formula,
            "has_limit": {True: YES, False: NO, None: "–"}[one.model.has_limit],
            "fitted_up_to": int(trend.means.n_points[trend.fitted].max()),
            "predicted": one.prediction.df,
            "prediction_chi2": one.prediction.chi_squared,
            "prediction_p": one.prediction.p,
            "prediction_log10_p": one.prediction.log10_p,
            "worst": max(errors, key=abs),
            "fit_chi2": one.fit.chi_squared,
            "fit_df": one.fit.df,
            "fit_p": one.fit.p,
            "refuted_below": one.refuted_below,
            "delta_aic": one.aic - lowest,
            "akaike_weight": np.exp((lowest - one.aic) / 2) / total,
            "standing": _standing(one, surviving),
        }


def _standing(one: Candidate, surviving: set[str]) -> str:
    if one.refuted:
        return REFUTED
    if one.struck_out:
        return STRUCK_OUT
    return SURVIVES if one.model.name in surviving else BEHIND


def _predicted(trend: Trend, one: Candidate) -> list:
    return list(predictions(one.model, trend.means, trend.fitted))


def _predictions(trend: Trend) -> Iterator[Row]:
    seen = trend.means.where(trend.fitted)
    for one in trend.candidates:
        for each in _predicted(trend, one):
            interval = value_interval(one.model, seen, each.n_points / 1000)
            yield trend.key | {
                "model": one.model.name,
                "n_points": each.n_points,
                "mean_lepp": each.mean,
                "prediction": each.prediction,
                "low": interval.low,
                "high": interval.high,
                "difference": each.standard_errors,
            }


def _projections(trend: Trend) -> Iterator[Row]:
    for one in survivors_of(trend.candidates):
        if one.model.has_limit is None:
            continue  # what it supposes or cannot follow far away
        for n in _FAR:
            if n > trend.means.n_points[-1]:
                found: ProfileInterval = value_interval(one.model, trend.means, n / 1000)
                yield trend.key | {
                    "model": one.model.name,
                    "n_points": n,
                    "prediction": found.estimate,
                    "low": found.low,
                    "high": found.high,
                }
