"""The methods of triangulation compared on the same points."""

from collections.abc import Callable, Iterator
from itertools import combinations

import numpy as np
import pandas as pd
from scipy import special

from study.analysis.measurements import (
    Measurements,
    Missing,
    NotEnough,
    Row,
    groups_of,
    variance,
)
from study.analysis.table import DISTRIBUTION, N_POINTS, Column, Table
from study.statistics.intervals import mean_interval
from study.statistics.tails import log10_t_tail

_FIRST = Column("method_1", "First triangulation")
_SECOND = Column("method_2", "Second triangulation")

_METHODS = (
    DISTRIBUTION,
    N_POINTS,
    Column("quantity", "Quantity"),
    _FIRST,
    _SECOND,
    Column("pairs", "Point sets", "", "int"),
    Column("mean_1", "First mean", "", "fixed4"),
    Column("mean_2", "Second mean", "", "fixed4"),
    Column("difference", "Second - first", "", "fixed4"),
    Column("low", "95 % from", "", "fixed4"),
    Column("high", "95 % to", "", "fixed4"),
    Column("correlation", "Correlation of the pairs", "", "fixed2"),
    Column("t", "t", "", "fixed1"),
    Column("df", "Df", "", "int"),
    Column("p", "p", "", "p"),
    Column("log10_p", "log10 p", "", "log10p"),
)

_GROWTH = (
    DISTRIBUTION,
    _FIRST,
    _SECOND,
    Column("slope_1", "First, by doubling", "triangles", "g3"),
    Column("slope_2", "Second, by doubling", "triangles", "g3"),
    Column("difference", "Second - first", "triangles", "g3"),
    Column("low", "95 % from", "triangles", "g3"),
    Column("high", "95 % to", "triangles", "g3"),
)

_QUANTITIES: dict[str, Callable[[pd.DataFrame], pd.Series]] = {
    "mean LEPP": lambda frame: frame["mean_lepp"],
    "SD inside a triangulation": lambda frame: frame["sd_lepp"],
    "largest LEPP": lambda frame: frame["max_lepp"],
    "share p of type C": lambda frame: frame["n_type_c"] / frame["n_interior_longest"],
    "terminal edges per triangle": lambda frame: frame["n_regions"] / frame["n_triangles"],
    "largest region": lambda frame: frame["max_region"],
}


def methods(data: Measurements) -> tuple[Table, list[Missing]]:
    """Paired differences between methods, for every distribution and size."""
    rows: list[Row] = []
    missing: list[Missing] = []
    for distribution, first, second, both in _paired(data, missing):
        names = {"distribution": distribution, "method_1": first, "method_2": second}
        for size, group in both.groupby("n_points", sort=True):
            for quantity in _QUANTITIES:
                one = group[(quantity, first)].to_numpy(dtype=np.float64)
                two = group[(quantity, second)].to_numpy(dtype=np.float64)
                kept = np.isfinite(one) & np.isfinite(two)
                row = _difference(one[kept], two[kept])
                rows.append(names | {"n_points": size, "quantity": quantity} | row)
    note = (
        "Every method triangulates the same points: differences are taken point set by point set, "
        "with the paired t interval and test of no difference. "
        f"There are {len(rows)} tests in this table; multiply p by that number (add its log10) for "
        "Bonferroni's correction."
    )
    title = "Triangulations of the same points compared"
    return Table.from_rows("methods", title, _METHODS, rows, note), missing


def _paired(
    data: Measurements, missing: list[Missing]
) -> Iterator[tuple[str, str, str, pd.DataFrame]]:
    for distribution in data.design.distributions:
        for first, second in combinations(data.design.methods, 2):
            frames = []
            for method in (first, second):
                frame = data.triangulations(method, distribution).set_index(
                    ["n_points", "replicate"]
                )
                columns = {(name, method): of(frame) for name, of in _QUANTITIES.items()}
                frames.append(pd.DataFrame(columns))
            both = frames[0].join(frames[1], how="inner")
            if both.empty:
                why = "no point set has been triangulated by both"
                missing.append(Missing(f"{first}, {second}", distribution, "comparison", why))
            else:
                yield distribution, first, second, both


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


def growth(data: Measurements) -> tuple[Table, list[Missing]]:
    """How the mean LEPP size changes with each doubling of the points, by method."""
    rows: list[Row] = []
    missing: list[Missing] = []
    for distribution, first, second, both in _paired(data, []):
        names = {"distribution": distribution, "method_1": first, "method_2": second}
        one, two = both["mean LEPP", first], both["mean LEPP", second]
        gap = pd.DataFrame({"one": one, "two": two, "gap": two - one}).reset_index()
        try:
            rows.append(names | _slopes(gap))
        except NotEnough as lack:
            missing.append(
                Missing(f"{first}, {second}", distribution, "difference of growth", str(lack))
            )
    note = (
        "Slopes of the logarithmic model, d of c + d log2(x), over the point sets that both "
        "methods have triangulated; the difference is the slope of the paired differences, with "
        "its t interval by least squares with errors that allow for unequal variances (HC3)."
    )
    title = "Growth of the mean LEPP size compared"
    return Table.from_rows("growth", title, _GROWTH, rows, note), missing


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
