"""The methods of triangulation compared on the same points, each with the reference."""

from collections.abc import Callable, Iterator

import numpy as np
import pandas as pd
from scipy import special

from study.analysis.building import Study, builds, rows_of
from study.analysis.measurements import groups_of
from study.analysis.table import DISTRIBUTION, N_POINTS, Column, Declaration, Row, Table
from study.paper.published import reference_method
from study.statistics.groups import NotEnough, variance
from study.statistics.intervals import mean_interval
from study.statistics.tails import log10_t_tail
from study.statistics.thresholds import LEVEL

_FIRST = Column("method_1", "First triangulation", "", "name")
_SECOND = Column("method_2", "Second triangulation", "", "name")

METHODS_COMPARED = Declaration(
    "methods",
    "Triangulations of the same points compared",
    (
        DISTRIBUTION,
        N_POINTS,
        Column("quantity", "Quantity"),
        _FIRST,
        _SECOND,
        Column("pairs", "Point sets", "", "int"),
        Column("mean_1", "First mean", "", "g5"),
        Column("mean_2", "Second mean", "", "g5"),
        Column("difference", "Second less first", "", "g4"),
        Column("low", f"{LEVEL} from", "", "g4"),
        Column("high", f"{LEVEL} to", "", "g4"),
        Column("correlation", "Correlation of the pairs", "", "fixed2"),
        Column("t", "t", "", "fixed1"),
        Column("df", "Df", "", "int"),
        Column("p", "p", "", "p"),
        Column("log10_p", "log10 p", "", "log10p"),
    ),
    note="Every method triangulates the same points: differences are taken point set by point set, "
    "with the paired t interval and test of no difference. "
    "Of all distributions and numbers of points there are {tests} tests; multiply p by that "
    "number for Bonferroni's correction.",
)

GROWTH = Declaration(
    "growth",
    "Growth of the mean LEPP size compared",
    (
        DISTRIBUTION,
        _FIRST,
        _SECOND,
        Column("slope_1", "First, by doubling", "triangles", "g3"),
        Column("slope_2", "Second, by doubling", "triangles", "g3"),
        Column("difference", "Second less first", "triangles", "g3"),
        Column("low", f"{LEVEL} from", "triangles", "g3"),
        Column("high", f"{LEVEL} to", "triangles", "g3"),
    ),
    note="Slopes of the logarithmic model, d of c + d log₂(x), over the point sets that both "
    "methods have triangulated; the difference is the slope of the paired differences, with "
    "its t interval by least squares with errors that allow for unequal variances (HC3).",
)

#: What is compared: these two are spoken of on the page.
MEAN_LEPP, SHARE_P = "mean LEPP", "share p of type C"
_QUANTITIES: dict[str, Callable[[pd.DataFrame], pd.Series]] = {
    MEAN_LEPP: lambda frame: frame["mean_lepp"],
    "SD inside a triangulation": lambda frame: frame["sd_lepp"],
    "largest LEPP": lambda frame: frame["max_lepp"],
    SHARE_P: lambda frame: frame["n_type_c"] / frame["n_interior_longest"],
    "terminal edges per triangle": lambda frame: frame["n_regions"] / frame["n_triangles"],
    "largest region": lambda frame: frame["max_region"],
}

Paired = tuple[str, str, str, pd.DataFrame]
"""Distribution, reference method, other method, and for each point set that both have
triangulated the quantities of both, by (quantity, method)."""


@builds(METHODS_COMPARED)
def methods(study: Study) -> Iterator[Table]:
    """Paired differences from the reference method, for every distribution and size."""
    rows: list[Row] = []
    for distribution, first, second, both in _paired(study, "comparison"):
        names: Row = {"distribution": distribution, "method_1": first, "method_2": second}
        for size, group in both.groupby("n_points", sort=True):
            for quantity in _QUANTITIES:
                one = group[(quantity, first)].to_numpy(dtype=np.float64)
                two = group[(quantity, second)].to_numpy(dtype=np.float64)
                kept = np.isfinite(one) & np.isfinite(two)
                row = _difference(one[kept], two[kept])
                rows.append(names | {"n_points": size, "quantity": quantity} | row)
    yield METHODS_COMPARED.table(rows, tests=len(rows))


def _paired(study: Study, what: str = "") -> Iterator[Paired]:
    design = study.data.design
    first = reference_method(design.methods)
    for distribution in design.distributions:
        for second in (name for name in design.methods if name != first):
            both = _quantities(study, first, distribution).join(
                _quantities(study, second, distribution), how="inner"
            )
            if not both.empty:
                yield distribution, first, second, both
            elif what:
                why = "no point set has been triangulated by both"
                study.lacks(f"{first}, {second}", distribution, what, why)


def _quantities(study: Study, method: str, distribution: str) -> pd.DataFrame:
    frame = study.data.triangulations(method, distribution).set_index(["n_points", "replicate"])
    return pd.DataFrame({(name, method): of(frame) for name, of in _QUANTITIES.items()})


def _difference(one: np.ndarray, two: np.ndarray) -> Row:
    gap = two - one
    mean, low, high = mean_interval(gap)
    row: Row = {
        "pairs": len(gap),
        "mean_1": one.mean() if len(one) else np.nan,
        "mean_2": two.mean() if len(two) else np.nan,
        "difference": mean,
        "low": low,
        "high": high,
    }
    if variance(one) > 0 and variance(two) > 0 and len(gap) > 2:
        row["correlation"] = np.corrcoef(one, two)[0, 1]
    spread = variance(gap)
    if spread > 0:
        df = len(gap) - 1
        t = mean / np.sqrt(spread / len(gap))
        row |= {
            "t": t,
            "df": df,
            "p": 2 * special.stdtr(df, -abs(t)),
            "log10_p": log10_t_tail(abs(t), df) + float(np.log10(2)),
        }
    return row


@rows_of(GROWTH)
def growth(study: Study) -> Iterator[Row]:
    """How the mean LEPP size changes with each doubling of the points, by method."""
    for distribution, first, second, both in _paired(study):
        names: Row = {"distribution": distribution, "method_1": first, "method_2": second}
        one, two = both[MEAN_LEPP, first], both[MEAN_LEPP, second]
        gap = pd.DataFrame({"one": one, "two": two, "gap": two - one}).reset_index()
        try:
            yield names | _slopes(gap)
        except NotEnough as lack:
            study.lacks(f"{first}, {second}", distribution, "difference of growth", str(lack))


def _slopes(paired: pd.DataFrame) -> Row:
    from statsmodels.regression.linear_model import OLS

    if paired["n_points"].nunique() < 2 or not (groups_of(paired, "gap").counts > 1).all():
        raise NotEnough("two or more sizes with two or more point sets each are needed")
    basis = np.column_stack([np.ones(len(paired)), np.log2(paired["n_points"] / 1000)])
    slopes = {
        name: OLS(paired[column].to_numpy(), basis).fit().params[1]
        for name, column in (("slope_1", "one"), ("slope_2", "two"))
    }
    fit = OLS(paired["gap"].to_numpy(), basis).fit(cov_type="HC3", use_t=True)
    low, high = fit.conf_int()[1]
    return slopes | {"difference": fit.params[1], "low": low, "high": high}
