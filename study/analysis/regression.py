"""Table 7 and Figures 6 and 7: regressions of the mean LEPP size on the number of points."""

from collections.abc import Iterator

import numpy as np

from study.analysis.measurements import Measurements, Missing, NotEnough, Row
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Table
from study.statistics.fitting import (
    Fit,
    Observations,
    fit_linear,
    fit_saturating,
    leave_one_group_out,
)
from study.statistics.models import LINEAR_MODELS, SATURATING, LinearModel, SaturatingModel

#: How the observations are weighted, by what the tables call it.
FITTINGS = {"least squares": False, "weighted": True}
#: Where the models are asked for predictions, in points.
_FAR = (10**6, 10**7, 10**8, 10**9)

_MODEL = Column("model", "Model")
_FITTING = Column("fitting", "Fitted by")

_REGRESSIONS = (
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
)

_COEFFICIENTS = (
    METHOD,
    DISTRIBUTION,
    _MODEL,
    _FITTING,
    Column("term", "Coefficient"),
    Column("estimate", "Estimate", "", "g4"),
    Column("standard_error", "Standard error", "", "g2"),
    Column("low", "95 % from", "", "g4"),
    Column("high", "95 % to", "", "g4"),
)

_PROJECTIONS = (
    METHOD,
    DISTRIBUTION,
    _MODEL,
    _FITTING,
    N_POINTS,
    Column("prediction", "Mean LEPP", "triangles", "g5"),
    Column("low", "95 % from", "triangles", "g5"),
    Column("high", "95 % to", "triangles", "g5"),
)

_LIMITS = (
    METHOD,
    DISTRIBUTION,
    _MODEL,
    _FITTING,
    Column("limit", "As the number of points grows, the mean"),
    Column("value", "Limit", "triangles", "fixed4"),
    Column("low", "95 % from", "triangles", "fixed4"),
    Column("high", "95 % to", "triangles", "fixed4"),
)

_CURVES = (
    METHOD,
    DISTRIBUTION,
    _MODEL,
    Column("view", "View"),
    N_POINTS,
    Column("prediction", "Mean LEPP", "triangles", "fixed4"),
)

Fits = dict[tuple[str, str, str, str], Fit]


def fit_all(data: Measurements) -> tuple[Fits, list[Missing]]:
    """Fit every model, both ways, for every method and distribution.

    Returns
    -------
    fits : dict
        By method, distribution, model and fitting.
    missing : list of Missing
    """
    fits: Fits = {}
    missing = []
    for method, distribution in data.populations:
        groups = data.groups(method, distribution)
        for fitting, weighted in FITTINGS.items():
            for model in (*LINEAR_MODELS, SATURATING):
                try:
                    fit = _fit(model, Observations.of(groups, weighted))
                except NotEnough as lack:
                    what = f"{model.name} regression, {fitting}"
                    missing.append(Missing(method, distribution, what, str(lack)))
                else:
                    fits[method, distribution, model.name, fitting] = fit
    return fits, missing


def _fit(model: LinearModel | SaturatingModel, seen: Observations) -> Fit:
    if isinstance(model, SaturatingModel):
        return fit_saturating(model, seen)
    return fit_linear(model, seen)


def regressions(fits: Fits) -> tuple[Table, list[Missing]]:
    """How well each model fits, and predicts what it has not seen."""
    rows, missing = [], []
    for key, fit in fits.items():
        row = _key(key) | {
            "formula": fit.model.formula,
            "observations": len(fit.observations.y),
        }
        try:
            row["left_out_rmse"] = leave_one_group_out(fit.model, fit.observations)
        except NotEnough as lack:
            what = f"leave-one-group-out error of the {key[2]} regression, {key[3]}"
            missing.append(Missing(key[0], key[1], what, str(lack)))
        rows.append(row | fit.quality())
    note = (
        "One observation a triangulation; weights are reciprocal variances of the groups, for "
        "variances are not equal. The logistic model is a straight line for ln(y / (4 - y)), as "
        "the published coefficients and R squared are; its adjusted R squared, F and p are on that "
        "scale. AIC, BIC and both errors are on the scale of y for all models, "
        "and so comparable: AIC and BIC among the fits of the same observations. The weights "
        "count as known. Lack of fit compares the model's residuals with the spread inside the "
        "groups: a small p says that the model does not follow the groups' means. The left-out "
        "error is that of a group's mean predicted from all other groups. F and p of the "
        "saturating model are those of its linearisation."
    )
    title = "Regressions of the mean LEPP size on the number of points (Table 7)"
    return Table.from_rows("regressions", title, _REGRESSIONS, rows, note), missing


def coefficients(fits: Fits) -> Table:
    """Coefficients with their t intervals."""
    rows = [
        _key(key)
        | {"term": term, "estimate": estimate, "standard_error": error, "low": low, "high": high}
        for key, fit in fits.items()
        for term, estimate, error, low, high in zip(
            fit.model.terms, fit.coefficients, fit.standard_errors, *fit.intervals, strict=True
        )
    ]
    note = (
        "x is in thousands of points. Intervals suppose that the model is true; those of the fits "
        "by least squares also that all groups have the same variance, which Levene's test tells."
    )
    title = "Coefficients of the regressions (Table 7)"
    return Table.from_rows("coefficients", title, _COEFFICIENTS, rows, note)


def projections(fits: Fits) -> Table:
    """Predict the mean LEPP size at 10^6 to 10^9 points by each model."""
    rows: list[Row] = []
    for key, fit in fits.items():
        x = np.array(_FAR) / 1000
        for n, value, low, high in zip(_FAR, fit.predict(x), *fit.predict_interval(x), strict=True):
            rows.append(_key(key) | {"n_points": n, "prediction": value, "low": low, "high": high})
    note = (
        "Far outside the data. The intervals hold only if the model is true: that they "
        "exclude one another shows that at most one of the models can be."
    )
    title = "Projections to 10^6 to 10^9 points (Figure 7)"
    return Table.from_rows("projections", title, _PROJECTIONS, rows, note)


def limits(fits: Fits) -> Table:
    """Say what each model makes of an infinite mesh."""
    rows = [_key(key) | _limit(fit) for key, fit in fits.items()]
    note = (
        "From the sign of the coefficient that outgrows the others, undecided where its interval "
        "contains zero."
    )
    return Table.from_rows("limits", "Limits of the regressions", _LIMITS, rows, note)


def _limit(fit: Fit) -> Row:
    low, high = fit.intervals
    if not low[-1] > 0 and not high[-1] < 0:
        return {"limit": "undecided"}
    if fit.model.name == "saturating":
        return {
            "limit": "tends to a limit",
            "value": fit.coefficients[0],
            "low": low[0],
            "high": high[0],
        }
    if fit.model.name == "logistic":
        return {"limit": "tends to a limit", "value": fit.predict(np.array([np.inf]))[0]}
    return {"limit": "grows without bound" if low[-1] > 0 else "falls without bound"}


def curves(fits: Fits) -> Table:
    """Points of the fitted curves, in the range of the data and far beyond it."""
    rows: list[Row] = []
    for key, fit in fits.items():
        if key[3] != "least squares":
            continue
        for view, n in _views(fit.observations.x * 1000):
            rows += [
                _key(key) | {"view": view, "n_points": int(at), "prediction": value}
                for at, value in zip(n, fit.predict(n / 1000), strict=True)
            ]
    note = "Curves of the fits by least squares."
    title = "Curves of the regressions (Figures 6 and 7)"
    return Table.from_rows("curves", title, _CURVES, rows, note)


def _views(n: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    yield "data", np.unique(np.linspace(n.min(), n.max(), 41).round())
    yield "projection", np.unique(np.geomspace(n.min(), max(_FAR), 61).round())


def _key(key: tuple[str, str, str, str]) -> Row:
    return dict(zip(("method", "distribution", "model", "fitting"), key, strict=True))
