"""Every published number beside ours, with a verdict."""

from collections.abc import Iterator
from dataclasses import asdict

import numpy as np
import pandas as pd
from scipy import stats

from study.analysis.measurements import SIGNIFICANCE, Measurements, Missing, Row
from study.analysis.randomness import TESTS
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Table
from study.paper import judging, published
from study.paper.judging import NOT_COMPARABLE, NOT_RUN, Judgement
from study.paper.published import REPETITIONS, SHOWN, Number
from study.statistics.tails import log10_chi2_tail

_PUBLISHED_TABLE = Column("published_table", "Published table", "", "int")

_REPRODUCTION = (
    METHOD,
    DISTRIBUTION,
    _PUBLISHED_TABLE,
    Column("quantity", "Quantity"),
    N_POINTS,
    Column("printed", "Printed"),
    Column("published", "Published", "", "g6"),
    Column("ours", "Ours", "", "g6"),
    Column("standard_error", "Standard error", "", "g2"),
    Column("difference", "Difference", "standard errors", "fixed2"),
    Column("log10_ratio", "log10 of the ratio", "", "fixed1"),
    Column("verdict", "Verdict"),
    Column("rule", "Rule"),
)

_SUMMARY = (
    METHOD,
    _PUBLISHED_TABLE,
    Column("numbers", "Numbers", "", "int"),
    *(
        Column(verdict.replace(" ", "_"), verdict.capitalize(), "", "int")
        for verdict in judging.VERDICTS
    ),
)

_OVERALL = (
    METHOD,
    DISTRIBUTION,
    Column("quantity", "Quantity of Table 4"),
    Column("chi2", "Chi-squared", "", "fixed1"),
    Column("df", "Df", "", "int"),
    Column("p", "p", "", "p"),
    Column("log10_p", "log10 p", "", "log10p"),
    Column("furthest", "Largest difference", "standard errors", "fixed2"),
    Column("verdict", "Verdict"),
)

_NOT_RUN = Judgement(np.nan, np.nan, np.nan, NOT_RUN, "the run has not enough of this group")
_OTHER_DESIGN = Judgement(
    np.nan, np.nan, np.nan, NOT_COMPARABLE,
    f"needs the published sizes with {REPETITIONS} repetitions each",
)  # fmt: skip

Judged = Iterator[tuple[Number, Judgement]]


def reproduction(data: Measurements, tables: dict[str, Table]) -> tuple[Table, list[Missing]]:
    """Judge every number of Tables 1 to 7.

    Parameters
    ----------
    data : Measurements
    tables : dict of str to Table
        Our groups, levene, shapiro, anova, bounds, regressions and coefficients.
    """
    rows: list[Row] = []
    missing = []
    for method in data.design.methods:
        for distribution in dict.fromkeys(n.distribution for n in published.table_6()):
            if distribution not in data.design.distributions:
                why = f"the run has no {distribution} points"
                missing.append(Missing(method, distribution, "comparison with the paper", why))
        for number, judgement in _judge(_Ours(data, tables, method)):
            rows.append(
                {
                    "method": method,
                    "distribution": number.distribution,
                    "published_table": number.table,
                    "quantity": number.quantity,
                    "n_points": number.n_points,
                    "printed": number.printed,
                    "published": number.value,
                }
                | asdict(judgement)
            )
    note = (
        f"{judging.RULE}. Some of so many numbers must differ by chance. The published numbers are "
        "of triangulations by insertion without flips, the method incremental; for any other "
        "method the table shows how far it is from them, not an attempt to reproduce them."
    )
    title = "The published numbers and ours"
    return Table.from_rows("reproduction", title, _REPRODUCTION, rows, note), missing


def summary(reproduction: Table) -> Table:
    """Count the verdicts by published table."""
    rows: list[Row] = []
    grouped = reproduction.frame.groupby(["method", "published_table"], sort=False)
    for (method, number), found in grouped:
        counts = found["verdict"].value_counts()
        row: Row = {"method": method, "published_table": number, "numbers": len(found)}
        row |= {v.replace(" ", "_"): int(counts.get(v, 0)) for v in judging.VERDICTS}
        rows.append(row)
    rows.sort(key=lambda row: str(row["published_table"]))
    order = list(dict.fromkeys(reproduction.frame["method"]))
    rows.sort(key=lambda row: order.index(str(row["method"])))
    title = "Verdicts on the published numbers"
    return Table.from_rows("reproduction_summary", title, _SUMMARY, rows, judging.RULE)


def overall(reproduction: Table) -> Table:
    """Chi-squared over all groups of Table 4, for the means and the standard deviations."""
    rows: list[Row] = []
    frame = reproduction.frame
    for method in dict.fromkeys(frame["method"]):
        for quantity in ("mean LEPP", "standard deviation", "mean triangles"):
            z = frame.loc[
                (frame["method"] == method) & (frame["quantity"] == quantity), "difference"
            ].dropna()
            if z.empty:
                continue
            chi2, df = float((z**2).sum()), len(z)
            p = float(stats.chi2.sf(chi2, df))
            rows.append(
                {
                    "method": method,
                    "distribution": SHOWN,
                    "quantity": quantity,
                    "chi2": chi2,
                    "df": df,
                    "p": p,
                    "log10_p": log10_chi2_tail(chi2, df),
                    "furthest": z.loc[z.abs().idxmax()],
                    "verdict": "differs" if p < 0.01 else "agrees",
                }
            )
    note = (
        "Sum of the squared differences, in standard errors, of all groups of Table 4 that were "
        "run. It agrees unless p is below 0.01."
    )
    title = "Table 4 as a whole"
    return Table.from_rows("reproduction_overall", title, _OVERALL, rows, note)


class _Ours:
    """Our numbers of one method, looked up as the published ones are named."""

    def __init__(self, data: Measurements, tables: dict[str, Table], method: str) -> None:
        self.data = data
        self.method = method
        self._frames = {
            name: table.frame[table.frame["method"] == method]
            for name, table in tables.items()
            if "method" in table.frame.columns
        }

    def row(self, table: str, **wanted: object) -> "pd.Series | None":
        """Find the row of a table of ours, or None."""
        frame = self._frames[table]
        for name, value in wanted.items():
            frame = frame[frame[name] == value]
        return None if frame.empty else frame.iloc[0]

    @property
    def has_published_design(self) -> bool:
        """Whether all published groups of the uniform distribution are complete, and no others."""
        rows = self.data.triangulations(self.method, SHOWN)["n_points"].value_counts()
        return rows.to_dict() == dict.fromkeys(published.sizes(), REPETITIONS)


def _judge(ours: _Ours) -> Judged:
    yield from _table_1(ours)
    yield from _f_test(ours, 2, "levene", center="mean", column="f")
    yield from _table_3(ours)
    yield from _table_4(ours)
    yield from _f_test(ours, 5, "anova", test="classical", column="statistic")
    yield from _table_6(ours)
    yield from _table_7(ours)


def _table_1(ours: _Ours) -> Judged:
    sets = ours.data.point_sets
    sets = sets[sets["distribution"] == SHOWN]
    numbers = published.table_1()
    columns = [f"{prefix}_{coordinate}" for prefix in TESTS.values() for coordinate in "xy"]
    for place, number in enumerate(numbers):
        values = sets[columns[place % len(columns)]].dropna()
        rank = float((values <= number.value).mean()) if len(values) else np.nan
        yield number, judging.of_unnamed_p(rank, number, len(numbers), SIGNIFICANCE)


def _f_test(ours: _Ours, table: int, name: str, column: str, **wanted: str) -> Judged:
    df1, df2, f, p = published.f_test(table)
    row = ours.row(name, distribution=SHOWN, **wanted)
    for df, value in (("df_group", df1), ("df_residual", df2)):
        number = Number(table, f"{df.replace('df_', 'degrees of freedom, ')}", value, 0)
        if row is None:
            yield number, _NOT_RUN
            continue
        verdict = judging.AGREES if row[df] == value else NOT_COMPARABLE
        rule = "equal if sizes and repetitions are the published ones"
        yield number, Judgement(float(row[df]), np.nan, np.nan, verdict, rule)
    if row is None:
        yield from ((number, _NOT_RUN) for number in (f, p))
    elif not ours.has_published_design:
        yield from ((number, _OTHER_DESIGN) for number in (f, p))
    else:
        yield f, judging.of_f(row[column], f, df1, df2)
        yield p, judging.of_rounded_p(row["p"], p)


def _table_3(ours: _Ours) -> Judged:
    for w, p in published.table_3():
        row = ours.row("shapiro", distribution=SHOWN, n_points=w.n_points)
        for number, name in ((w, "w"), (p, "p")):
            found = _NOT_RUN if row is None else judging.of_null_p(row[name], p.value, row["p"])
            yield number, found


def _table_4(ours: _Ours) -> Judged:
    for triangles, largest, mean, sd in published.table_4():
        row = ours.row("groups", distribution=SHOWN, n_points=mean.n_points)
        if row is None or not row["sd_between"] > 0:
            yield from ((number, _NOT_RUN) for number in (triangles, largest, mean, sd))
            continue
        group = ours.data.triangulations(ours.method, SHOWN)
        group = group[group["n_points"] == mean.n_points]
        count = len(group)
        # The paper has no spread for these two: ours stands for both.
        for number, column, name in (
            (triangles, "n_triangles", "mean_triangles"),
            (largest, "max_lepp", "mean_max_lepp"),
        ):
            spread = float(group[column].std())
            yield (
                number,
                judging.of_mean(row[name], spread, count, number, spread, REPETITIONS),
            )
        spread = row["sd_between"]
        yield mean, judging.of_mean(row["mean_lepp"], spread, count, mean, sd.value, REPETITIONS)
        yield sd, judging.of_sd(spread, count, sd, REPETITIONS)


def _table_6(ours: _Ours) -> Judged:
    for number in published.table_6():
        row = ours.row(
            "bounds", distribution=number.distribution, n_points=number.n_points, bound=4
        )
        if row is None:
            yield number, _NOT_RUN
            continue
        count = int(row["df"]) + 1
        yield (
            number,
            judging.of_t_test(row["p"], row["log10_p"], row["t"], count, number, REPETITIONS),
        )


def _table_7(ours: _Ours) -> Judged:
    slope = published.linear_slope_as_printed()
    for model, term, number in published.coefficients():
        row = _regression(ours, "coefficients", model, term=term)
        if row is None or isinstance(row, Judgement):
            yield number, row or _NOT_RUN
            if (model, term) == ("linear", "b"):
                yield slope, row or _NOT_RUN
            continue
        found = judging.of_coefficient(row["estimate"], row["standard_error"], number)
        yield number, found
        if (model, term) == ("linear", "b"):
            yield slope, _misprint(found, slope)
    for model, r2, p in published.fits():
        row = _regression(ours, "regressions", model)
        if row is None or isinstance(row, Judgement):
            yield from ((number, row or _NOT_RUN) for number in (r2, p))
            continue
        df1, df2 = row["df_model"], row["df_residual"]
        yield r2, judging.of_adjusted_r2(row["adj_r2"], row["f"], r2, df1, df2)
        yield p, judging.of_regression_p(row["p"], row["log10_p"], row["f"], p, df1, df2)


def _regression(
    ours: _Ours, table: str, model: str, **wanted: str
) -> "pd.Series | Judgement | None":
    row = ours.row(table, distribution=SHOWN, model=model, fitting="least squares", **wanted)
    return row if row is None or ours.has_published_design else _OTHER_DESIGN


def _misprint(corrected: Judgement, printed: Number) -> Judgement:
    """Judge the slope as printed, knowing how it is judged with the other sign of its exponent."""
    z = (corrected.ours - printed.value) / corrected.standard_error
    verdict = judging.within(z)
    if verdict == judging.DIFFERS and corrected.verdict != judging.DIFFERS:
        verdict = judging.MISPRINT
    rule = "a misprint if it differs, and no longer does with the other sign of its exponent"
    return Judgement(corrected.ours, corrected.standard_error, z, verdict, rule)
