"""Table 7 and Figures 6 and 7: regressions of the mean LEPP size on the number of points.

Least squares, of the paper's four models, is for the comparison with its Table 7 only: variances
are not equal. All else goes by the weighted fits.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from study.analysis.building import Study, builds
from study.analysis.parts import INTERIOR, PART, WHOLE
from study.analysis.table import (
    DISTRIBUTION,
    METHOD,
    N_POINTS,
    Column,
    Declaration,
    Row,
    Table,
    end,
)
from study.analysis.trends import Trend, trends
from study.statistics.fitting import (
    Fit,
    Observations,
    fit_linear,
    fit_saturating,
    leave_one_group_out,
)
from study.statistics.groups import NotEnough
from study.statistics.limit_verdict import survivors_of
from study.statistics.model_scores import fitted_curve
from study.statistics.models import (
    DOUBLY_LOGARITHMIC,
    EDGE_MODELS,
    LINEAR_MODELS,
    LOGARITHMIC,
    MODELS,
    SATURATING,
    LinearModel,
    Model,
    SaturatingModel,
)
from study.statistics.power_family import PowerFamily
from study.statistics.size_means import SizeMeans
from study.statistics.thresholds import LEVEL

LEAST_SQUARES, WEIGHTED = "least squares", "weighted"
_ALL = (*LINEAR_MODELS, DOUBLY_LOGARITHMIC, *EDGE_MODELS, SATURATING)
#: Which models are fitted to which part, by how they are fitted.
FITTED = (
    (LEAST_SQUARES, WHOLE, LINEAR_MODELS),
    (WEIGHTED, WHOLE, _ALL),
    (WEIGHTED, INTERIOR, _ALL),
)
#: The curves of the weighted fits to the sizes from which others are predicted; those of the
#: paper's models by least squares have `LEAST_SQUARES`.
PREDICTION = "prediction"
#: Curves are drawn so far beyond the largest size, and by so many points.
_BEYOND, _CURVE_POINTS = 10, 31

_MODEL = Column("model", "Model")
_FITTING = Column("fitting", "Fitted by")

_CRITERIA = (
    "AIC and BIC are on the scale of y for all models, and so comparable among the fits of the "
    "same observations."
)

REGRESSIONS = Declaration(
    "regressions",
    "Regressions of the mean LEPP size on the number of points (Table 7)",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        _MODEL,
        _FITTING,
        Column("formula", "Formula, x in thousands of points"),
        Column("observations", "Observations", "triangulations", "int"),
        Column(
            "adj_r2",
            "Adjusted R²",
            "",
            "fixed3",
            "The logistic model's adjusted R² is on that scale.",
        ),
        # F and p of the logistic model are on its scale, of the saturating one those of its
        # linearisation.
        Column("f", "F", "", "fixed1"),
        Column("df_model", "Df, model", "", "int"),
        Column("df_residual", "Df, residuals", "", "int"),
        Column("p", "p", "", "p"),
        Column("log10_p", "log10 p", "", "log10p"),
        Column("lack_of_fit_f", "F, lack of fit", "", "fixed2"),
        Column(
            "lack_of_fit_p",
            "p, lack of fit",
            "",
            "p",
            "Lack of fit compares the model's residuals with the spread inside the groups: a small "
            "p says that the model does not follow the groups' means.",
        ),
        Column("aic", "AIC", "", "fixed1", _CRITERIA),
        Column("bic", "BIC", "", "fixed1", _CRITERIA),
        Column("rmse", "Root mean square residual", "triangles", "g4"),
        Column(
            "left_out_rmse",
            "Error of left-out groups",
            "triangles",
            "g4",
            "The error of left-out groups is that of a group's mean predicted from all others, on "
            "the scale of y for all models.",
        ),
    ),
    note="One observation a triangulation. The weights of weighted fits are reciprocal variances, "
    "which are a smooth function of the number of points and count as known. The logistic model is "
    "a straight line for ln(y / (4 - y)), as the published coefficients and R² are.",
)

COEFFICIENTS = Declaration(
    "coefficients",
    "Coefficients of the regressions (Table 7)",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        _MODEL,
        _FITTING,
        Column("term", "Coefficient"),
        Column("estimate", "Estimate", "", "g4"),
        Column("standard_error", "Standard error", "", "g2"),
        Column("low", f"{LEVEL} from", "", "g4"),
        Column("high", f"{LEVEL} to", "", "g4"),
    ),
    note="x is in thousands of points. Intervals suppose that the model is true; those of the fits "
    "by least squares also that all groups have the same variance, which Levene's test tells. "
    "Those of the saturating model are by profile likelihood, an empty end says that there is "
    "none; no standard error stands for them.",
)

CURVES = Declaration(
    "curves",
    "Curves of the regressions (Figures 6 and 7)",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        _MODEL,
        Column("view", "View"),
        N_POINTS,
        Column("prediction", "Mean LEPP", "triangles", "fixed4"),
    ),
    note="Least squares: the paper's four models, fitted to all sizes. Prediction: weighted fits "
    "of the models that survive and of the logarithmic one, to the sizes from which the others "
    "are predicted.",
)


class Key(NamedTuple):
    """Which fit: the columns that all tables of this family begin with."""

    method: str
    distribution: str
    part: str
    model: str
    fitting: str

    @property
    def row(self) -> Row:
        """As cells of a row."""
        return dict(self._asdict())


Fits = dict[Key, Fit]


def _name(model: str, fitting: str) -> str:
    return f"{model} regression, {fitting}"


def _left_out_name(model: str, fitting: str) -> str:
    return f"leave-one-group-out error of the {_name(model, fitting)}"


#: What is missing where means show no saturation, which says something of them.
SATURATION_MISSING = frozenset(name(SATURATING.name, WEIGHTED) for name in (_name, _left_out_name))


@builds(REGRESSIONS, COEFFICIENTS, CURVES)
def regressions(study: Study) -> Iterator[Table]:
    """Fit the models to every method, distribution and part, and look at the fits."""
    fits = _fit_all(study)
    yield REGRESSIONS.table(list(_regressions(study, fits)))
    yield COEFFICIENTS.table(row for key, fit in fits.items() for row in _coefficients(key, fit))
    yield CURVES.table(_curves(study))


def _fit_all(study: Study) -> Fits:
    fits: Fits = {}
    for method, distribution in study.data.populations:
        for fitting, part, models in FITTED:
            groups = study.data.groups(method, distribution, part)
            for model in models:
                key = Key(method, distribution, part, model.name, fitting)
                try:
                    fits[key] = _fit(model, Observations.of(groups, fitting == WEIGHTED))
                except NotEnough as lack:
                    _lacks(study, key, _name(model.name, fitting), lack)
    return fits


def _lacks(study: Study, key: Key, what: str, lack: NotEnough) -> None:
    # Of a small mesh there is no interior, or hardly any, and nothing is amiss.
    if key.part == WHOLE:
        study.lacks(key.method, key.distribution, what, str(lack))


def _fit(model: LinearModel | SaturatingModel, seen: Observations) -> Fit:
    if isinstance(model, SaturatingModel):
        return fit_saturating(model, seen)
    return fit_linear(model, seen)


def _regressions(study: Study, fits: Fits) -> Iterator[Row]:
    """How well each model fits, and predicts what it has not seen."""
    for key, fit in fits.items():
        row = key.row | {
            "formula": fit.model.formula,
            "observations": len(fit.observations.y),
        }
        try:
            row["left_out_rmse"] = leave_one_group_out(fit.model, fit.observations)
        except NotEnough as lack:
            _lacks(study, key, _left_out_name(key.model, key.fitting), lack)
        yield row | fit.quality()


def _coefficients(key: Key, fit: Fit) -> Iterator[Row]:
    """Coefficients with their intervals."""
    if isinstance(fit.model, SaturatingModel):
        yield from _saturating_coefficients(key, fit)
        return
    for term, estimate, error, low, high in zip(
        fit.model.terms, fit.coefficients, fit.standard_errors, *fit.intervals, strict=True
    ):
        yield key.row | {
            "term": term,
            "estimate": estimate,
            "standard_error": error,
            "low": low,
            "high": high,
        }


def _saturating_coefficients(key: Key, fit: Fit) -> Iterator[Row]:
    family = PowerFamily(SizeMeans.of(fit.observations.groups(fit.observations.y)))
    power = family.power
    intervals = {"c": (np.nan, np.nan), "a": (np.nan, np.nan), "b": (-power.high, -power.low)}
    try:
        limit = family.value(np.inf)
        intervals["c"] = (limit.low, limit.high)
    except NotEnough:  # at the very end of the exponents
        pass
    for term, estimate in zip(fit.model.terms, fit.coefficients, strict=True):
        low, high = intervals[term]
        yield key.row | {"term": term, "estimate": estimate, "low": end(low), "high": end(high)}


def _curves(study: Study) -> Iterator[Row]:
    """Points of the curves: of the paper's fits to all sizes, and of those that predict."""
    for trend in trends(study.data):
        seen = trend.means.where(trend.fitted)
        models = {one.model.name: one.model for one in survivors_of(trend.candidates)}
        models |= {LOGARITHMIC.name: LOGARITHMIC}
        for model in MODELS:
            if model.name in models and len(seen) > len(model.terms):
                curve = fitted_curve(model, seen)
                for n in _abscissae(trend):
                    yield _point(trend, model, PREDICTION, n, curve(n / 1000))
        if trend.key["part"] == WHOLE:
            yield from _least_squares_curves(study, trend)


def _least_squares_curves(study: Study, trend: Trend) -> Iterator[Row]:
    groups = study.data.groups(str(trend.key["method"]), str(trend.key["distribution"]))
    for model in LINEAR_MODELS:
        try:
            fit = fit_linear(model, Observations.of(groups, weighted=False))
        except NotEnough:  # told of the fits
            continue
        at = _abscissae(trend)
        for n, value in zip(at, fit.predict(at / 1000), strict=True):
            yield _point(trend, model, LEAST_SQUARES, n, value)


def _point(trend: Trend, model: Model, view: str, n: float, value: float) -> Row:
    return trend.key | {
        "view": view, "model": model.name, "n_points": int(n), "prediction": float(value),
    }  # fmt: skip


def _abscissae(trend: Trend) -> np.ndarray:
    n_points = trend.means.n_points
    at = np.geomspace(n_points[0], _BEYOND * n_points[-1], _CURVE_POINTS).round()
    return np.union1d(at, n_points)
