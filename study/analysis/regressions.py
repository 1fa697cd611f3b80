"""Table 7 and Figures 6 and 7: regressions of the mean LEPP size on the number of points."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from study.analysis.building import Study, builds
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row, Table
from study.statistics.fitting import (
    Fit,
    Observations,
    fit_linear,
    fit_saturating,
    leave_one_group_out,
)
from study.statistics.groups import NotEnough
from study.statistics.models import (
    LINEAR_MODELS,
    SATURATING,
    LinearModel,
    SaturatingModel,
    logistic,
)
from study.statistics.thresholds import LEVEL
from study.statistics.verdicts import UNDECIDED

LEAST_SQUARES, WEIGHTED = "least squares", "weighted"
#: How the observations are weighted, by what the tables call it.
FITTINGS = {LEAST_SQUARES: False, WEIGHTED: True}
#: All models, in the order of the tables.
MODELS = (*LINEAR_MODELS, SATURATING)
#: The parts of the fitted curves: in the range of the data, and far beyond it.
INSIDE, BEYOND = "data", "projection"
#: Where the models are asked for predictions, in points.
_FAR = (10**6, 10**7, 10**8, 10**9)

_MODEL = Column("model", "Model")
_FITTING = Column("fitting", "Fitted by")

REGRESSIONS = Declaration(
    "regressions",
    "Regressions of the mean LEPP size on the number of points (Table 7)",
    (
        METHOD,
        DISTRIBUTION,
        _MODEL,
        _FITTING,
        Column("formula", "Formula, x in thousands of points"),
        Column("observations", "Observations", "triangulations", "int"),
        Column("adj_r2", "Adjusted R squared", "", "fixed3"),
        Column("f", "F", "", "fixed1"),
        Column("df_model", "Df, model", "", "int"),
        Column("df_residual", "Df, residuals", "", "int"),
        Column("p", "p", "", "p"),
        Column("log10_p", "log10 p", "", "log10p"),
        Column("lack_of_fit_f", "F, lack of fit", "", "fixed2"),
        Column("lack_of_fit_p", "p, lack of fit", "", "p"),
        Column("aic", "AIC", "", "fixed1"),
        Column("bic", "BIC", "", "fixed1"),
        Column("rmse", "Root mean square residual", "triangles", "g4"),
        Column("left_out_rmse", "Error of left-out groups", "triangles", "g4"),
    ),
    note="One observation a triangulation; weights are reciprocal variances of the groups, for "
    "variances are not equal. The logistic model is a straight line for ln(y / (4 - y)), as "
    "the published coefficients and R squared are; its adjusted R squared, F and p are on that "
    "scale. AIC, BIC and both errors are on the scale of y for all models, "
    "and so comparable: AIC and BIC among the fits of the same observations. The weights "
    "count as known. Lack of fit compares the model's residuals with the spread inside the "
    "groups: a small p says that the model does not follow the groups' means. The left-out "
    "error is that of a group's mean predicted from all other groups. F and p of the "
    "saturating model are those of its linearisation.",
)

COEFFICIENTS = Declaration(
    "coefficients",
    "Coefficients of the regressions (Table 7)",
    (
        METHOD,
        DISTRIBUTION,
        _MODEL,
        _FITTING,
        Column("term", "Coefficient"),
        Column("estimate", "Estimate", "", "g4"),
        Column("standard_error", "Standard error", "", "g2"),
        Column("low", f"{LEVEL} from", "", "g4"),
        Column("high", f"{LEVEL} to", "", "g4"),
    ),
    note="x is in thousands of points. Intervals suppose that the model is true; those of the fits "
    "by least squares also that all groups have the same variance, which Levene's test tells.",
)

PROJECTIONS = Declaration(
    "projections",
    "Projections to 10^6 to 10^9 points (Figure 7)",
    (
        METHOD,
        DISTRIBUTION,
        _MODEL,
        _FITTING,
        N_POINTS,
        Column("prediction", "Mean LEPP", "triangles", "g5"),
        Column("low", f"{LEVEL} from", "triangles", "g5"),
        Column("high", f"{LEVEL} to", "triangles", "g5"),
    ),
    note="Far outside the data. The intervals hold only if the model is true: that they "
    "exclude one another shows that at most one of the models can be.",
)

LIMITS = Declaration(
    "limits",
    "Limits of the regressions",
    (
        METHOD,
        DISTRIBUTION,
        _MODEL,
        _FITTING,
        Column("limit", "As the number of points grows, the mean"),
        Column("value", "Limit", "triangles", "fixed4"),
        Column("low", f"{LEVEL} from", "triangles", "fixed4"),
        Column("high", f"{LEVEL} to", "triangles", "fixed4"),
    ),
    note="From the sign of the coefficient that outgrows the others, undecided where its interval "
    "contains zero.",
)

CURVES = Declaration(
    "curves",
    "Curves of the regressions (Figures 6 and 7)",
    (
        METHOD,
        DISTRIBUTION,
        _MODEL,
        Column("view", "View"),
        N_POINTS,
        Column("prediction", "Mean LEPP", "triangles", "fixed4"),
    ),
    note="Curves of the fits by least squares.",
)


class Key(NamedTuple):
    """Which fit: the columns that all tables of this family begin with."""

    method: str
    distribution: str
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
    return f"leave-one-group-out error of the {model} regression, {fitting}"


#: What is missing where means show no saturation, which says something of them.
SATURATION_MISSING = frozenset(
    name(SATURATING.name, fitting) for name in (_name, _left_out_name) for fitting in FITTINGS
)


@builds(REGRESSIONS, COEFFICIENTS, PROJECTIONS, LIMITS, CURVES)
def regressions(study: Study) -> Iterator[Table]:
    """Fit every model, both ways, for every method and distribution, and look at the fits."""
    fits = _fit_all(study)
    yield REGRESSIONS.table(list(_regressions(study, fits)))
    yield COEFFICIENTS.table(_coefficients(fits))
    yield PROJECTIONS.table(_projections(fits))
    yield LIMITS.table(key.row | _limit(fit) for key, fit in fits.items())
    yield CURVES.table(_curves(fits))


def _fit_all(study: Study) -> Fits:
    fits: Fits = {}
    for method, distribution in study.data.populations:
        groups = study.data.groups(method, distribution)
        for fitting, weighted in FITTINGS.items():
            for model in MODELS:
                key = Key(method, distribution, model.name, fitting)
                try:
                    fits[key] = _fit(model, Observations.of(groups, weighted))
                except NotEnough as lack:
                    study.lacks(method, distribution, _name(model.name, fitting), str(lack))
    return fits


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
            what = _left_out_name(key.model, key.fitting)
            study.lacks(key.method, key.distribution, what, str(lack))
        yield row | fit.quality()


def _coefficients(fits: Fits) -> Iterator[Row]:
    """Coefficients with their t intervals."""
    for key, fit in fits.items():
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


def _projections(fits: Fits) -> Iterator[Row]:
    """Predict the mean LEPP size at 10^6 to 10^9 points by each model."""
    x = np.array(_FAR) / 1000
    for key, fit in fits.items():
        for n, value, low, high in zip(_FAR, fit.predict(x), *fit.predict_interval(x), strict=True):
            yield key.row | {"n_points": n, "prediction": value, "low": low, "high": high}


def _limit(fit: Fit) -> Row:
    low, high = fit.intervals
    if not low[-1] > 0 and not high[-1] < 0:
        return {"limit": UNDECIDED}
    if isinstance(fit.model, SaturatingModel):
        return {
            "limit": "tends to a limit",
            "value": fit.coefficients[0],
            "low": low[0],
            "high": high[0],
        }
    if fit.model.inverse is logistic:
        return {"limit": "tends to a limit", "value": fit.predict(np.array([np.inf]))[0]}
    return {"limit": "grows without bound" if low[-1] > 0 else "falls without bound"}


def _curves(fits: Fits) -> Iterator[Row]:
    """Points of the curves fitted by least squares."""
    for key, fit in fits.items():
        if key.fitting != LEAST_SQUARES:
            continue
        names: Row = {"method": key.method, "distribution": key.distribution, "model": key.model}
        for view, n in _views(fit.observations.x * 1000):
            for at, value in zip(n, fit.predict(n / 1000), strict=True):
                yield names | {"view": view, "n_points": int(at), "prediction": value}


def _views(n: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    yield INSIDE, np.unique(np.linspace(n.min(), n.max(), 41).round())
    yield BEYOND, np.unique(np.geomspace(n.min(), max(_FAR), 61).round())
