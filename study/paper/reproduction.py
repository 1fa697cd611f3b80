"""Every published number beside ours, with a verdict."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from functools import cached_property

import numpy as np
import pandas as pd
from scipy import stats

from study.analysis.bound_tests import BOUNDS, UPPER_BOUND
from study.analysis.building import Study, rows_of
from study.analysis.group_assumptions import CENTERS, LEVENE, SHAPIRO
from study.analysis.group_summaries import GROUPS
from study.analysis.point_randomness import COORDINATES, TESTS
from study.analysis.regressions import COEFFICIENTS, LEAST_SQUARES, REGRESSIONS
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row
from study.analysis.variance_analysis import ANOVA, CLASSICAL
from study.paper import judging, published
from study.paper.consistency import PUBLISHED_TABLE, table_4_groups
from study.paper.judging import NOT_COMPARABLE, NOT_RUN, Judgement
from study.paper.published import (
    BY_CONSTRUCTION,
    IMPLIED,
    INDEPENDENT,
    RANDOM_DRAW,
    REFERENCE_METHOD,
    REPETITIONS,
    SAME_TEST,
    SHOWN,
    Number,
)
from study.paper.runs_lattice import sizes_of_table_1
from study.statistics.replications import ADJUSTED_R2, ANOVA_F, LEVENE_F, F, Replications
from study.statistics.thresholds import AGREES_UP_TO

REPRODUCTION = Declaration(
    "reproduction",
    "The published numbers and ours",
    (
        METHOD,
        DISTRIBUTION,
        PUBLISHED_TABLE,
        Column("quantity", "Quantity"),
        N_POINTS,
        Column("printed", "Printed"),
        Column("published", "Published", "", "g6"),
        Column("ours", "Ours", "", "g6"),
        Column("standard_error", "Standard error", "", "g2"),
        Column("difference", "Difference", "standard errors", "fixed2"),
        Column("log10_ratio", "log10 of the ratio", "", "fixed1"),
        Column("chance_beyond", f"Chance of more than {AGREES_UP_TO:g}", "", "percent1"),
        Column("verdict", "Verdict", "", "verdict"),
        Column("standing", "Evidence"),
        Column("rule", "Rule"),
    ),
    note=f"{judging.RULE}. Some of so many numbers must differ by chance. Only what is "
    f"{INDEPENDENT} counts as reproduced; {IMPLIED}: it follows from the means and standard "
    f"deviations there; {BY_CONSTRUCTION}: every run of the design gives "
    f"it; {RANDOM_DRAW}: no other run can repeat it; {SAME_TEST}: its test is counted by the "
    "p-value. Levene's F is counted, though the standard deviations of Table 4 decide most of it. "
    "Errors of F, R² and coefficients are of a parametric bootstrap, in which every group "
    "has a mean and standard deviation of its own. The published numbers are of triangulations by "
    f"insertion without flips, the method {REFERENCE_METHOD}; for any "
    "other method the table shows how far it is from them, not an attempt to reproduce them.",
)

_NOT_RUN = Judgement(np.nan, np.nan, np.nan, NOT_RUN, "the run has not enough of this group")
_OTHER_DESIGN = Judgement(
    np.nan, np.nan, np.nan, NOT_COMPARABLE,
    f"needs the published sizes with {REPETITIONS} repetitions each",
)  # fmt: skip

Judged = Iterator[tuple[Number, Judgement]]


@rows_of(REPRODUCTION, needs=(GROUPS, LEVENE, SHAPIRO, ANOVA, BOUNDS, REGRESSIONS, COEFFICIENTS))
def reproduction(study: Study) -> Iterator[Row]:
    """Judge every number of Tables 1 to 7."""
    design = study.data.design
    for method in design.methods:
        for distribution in dict.fromkeys(n.distribution for n in published.table_6()):
            if distribution not in design.distributions:
                why = f"the run has no {distribution} points"
                study.lacks(method, distribution, "comparison with the paper", why)
        for number, judgement in _judge(_Ours(study, method)):
            yield {
                "method": method,
                "distribution": number.distribution,
                "published_table": number.table,
                "quantity": number.quantity,
                "n_points": number.n_points,
                "printed": number.printed,
                "published": number.value,
                "standing": number.standing,
            } | asdict(judgement)


class _Ours:
    """Our numbers of one method, looked up as the published ones are named."""

    def __init__(self, study: Study, method: str) -> None:
        self.data = study.data
        self.method = method
        self._tables = study.tables

    def row(self, declared: Declaration, **wanted: object) -> "pd.Series | None":
        """Find the row of a table of ours, or None."""
        rows = self._tables.rows(declared, method=self.method, **wanted)
        return None if rows.empty else rows.first

    @property
    def has_published_design(self) -> bool:
        """Whether all published groups of the uniform distribution are complete, and no others."""
        rows = self.data.triangulations(self.method, SHOWN)["n_points"].value_counts()
        return rows.to_dict() == dict.fromkeys(published.sizes(), REPETITIONS)

    def error(self, statistic: str, model: str = "") -> float:
        """Find the error of the difference between ours and the paper's, of the same design."""
        ours, theirs = (errors[model, statistic] for errors in self._errors)
        return float(np.hypot(ours, theirs))

    @cached_property
    def _errors(self) -> tuple[Mapping[tuple[str, str], float], ...]:
        groups, theirs = self.data.groups(self.method, SHOWN), table_4_groups()
        both = (
            Replications(
                groups.n_points / 1000, groups.means, np.sqrt(groups.variances), REPETITIONS
            ),
            Replications(theirs.x, theirs.means, theirs.sds, REPETITIONS),
        )
        # Keys of four places are those of the points.
        seeds = np.random.SeedSequence(self.data.design.seed).spawn(len(both))
        return tuple(
            one.standard_errors(np.random.default_rng(seed))
            for one, seed in zip(both, seeds, strict=True)
        )


def _judge(ours: _Ours) -> Judged:
    yield from _table_1(ours)
    yield from _f_test(ours, 2, LEVENE, "f", LEVENE_F, center=CENTERS[0])
    yield from _table_3(ours)
    yield from _table_4(ours)
    yield from _f_test(ours, 5, ANOVA, "statistic", ANOVA_F, test=CLASSICAL)
    yield from _table_6(ours)
    yield from _table_7(ours)


def _table_1(ours: _Ours) -> Judged:
    sets = ours.data.point_sets
    sets = sets[(sets["distribution"] == SHOWN) & sets["n_points"].isin(sizes_of_table_1())]
    numbers = published.table_1()
    columns = [f"{prefix}_{coordinate}" for prefix in TESTS.values() for coordinate in COORDINATES]
    of_test = {
        prefix: sets[[f"{prefix}_{c}" for c in COORDINATES]].to_numpy().ravel()
        for prefix in TESTS.values()
    }
    families: dict[str, list[float]] = {prefix: [] for prefix in TESTS.values()}
    prefixes = [columns[place % len(columns)].rpartition("_")[0] for place in range(len(numbers))]
    for number, prefix in zip(numbers, prefixes, strict=True):
        families[prefix].append(number.value)
    for number, prefix in zip(numbers, prefixes, strict=True):
        values = of_test[prefix][~np.isnan(of_test[prefix])]
        if not len(values):
            yield number, _NOT_RUN
            continue
        rank = float((values <= number.value).mean())
        test = stats.mannwhitneyu(families[prefix], values, method="asymptotic")
        yield number, judging.of_drawn_p(rank, float(test.pvalue))


def _f_test(
    ours: _Ours, table: int, declared: Declaration, column: str, statistic: str, **wanted: str
) -> Judged:
    df1, df2, f, p = published.f_test(table)
    row = ours.row(declared, distribution=SHOWN, **wanted)
    for df, value in (("df_group", df1), ("df_residual", df2)):
        name = df.replace("df_", "degrees of freedom, ")
        number = Number(table, name, value, 0, standing=BY_CONSTRUCTION)
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
        yield f, judging.of_f(row[column], f, ours.error(statistic))
        yield p, judging.of_rounded_p(row["p"], p)


def _table_3(ours: _Ours) -> Judged:
    for w, p in published.table_3():
        row = ours.row(SHAPIRO, distribution=SHOWN, n_points=w.n_points)
        for number, name in ((w, "w"), (p, "p")):
            found = _NOT_RUN if row is None else judging.of_null_p(row[name], p.value, row["p"])
            yield number, found


def _table_4(ours: _Ours) -> Judged:
    for triangles, largest, mean, sd in published.table_4():
        row = ours.row(GROUPS, distribution=SHOWN, n_points=mean.n_points)
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
            BOUNDS,
            distribution=number.distribution,
            n_points=number.n_points,
            bound=UPPER_BOUND,
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
        row = _regression(ours, COEFFICIENTS, model, term=term)
        if row is None or isinstance(row, Judgement):
            yield number, row or _NOT_RUN
            if (model, term) == ("linear", "b"):
                yield slope, row or _NOT_RUN
            continue
        found = judging.of_coefficient(row["estimate"], number, ours.error(term, model))
        yield number, found
        if (model, term) == ("linear", "b"):
            yield slope, _misprint(found, slope)
    for model, r2, p in published.fits():
        row = _regression(ours, REGRESSIONS, model)
        if row is None or isinstance(row, Judgement):
            yield from ((number, row or _NOT_RUN) for number in (r2, p))
            continue
        df = row["df_model"], row["df_residual"]
        yield r2, judging.of_adjusted_r2(row["adj_r2"], r2, ours.error(ADJUSTED_R2, model))
        error = ours.error(F, model)
        yield p, judging.of_regression_p(row["p"], row["log10_p"], row["f"], p, df, error)


def _regression(
    ours: _Ours, declared: Declaration, model: str, **wanted: str
) -> "pd.Series | Judgement | None":
    row = ours.row(declared, distribution=SHOWN, model=model, fitting=LEAST_SQUARES, **wanted)
    return row if row is None or ours.has_published_design else _OTHER_DESIGN


def _misprint(corrected: Judgement, printed: Number) -> Judgement:
    """Judge the slope as printed, knowing how it is judged with the other sign of its exponent."""
    z = (corrected.ours - printed.value) / corrected.standard_error
    verdict = judging.within(z)
    if verdict == judging.DIFFERS and corrected.verdict != judging.DIFFERS:
        verdict = judging.MISPRINT
    rule = "a misprint if it differs, and no longer does with the other sign of its exponent"
    return Judgement(corrected.ours, corrected.standard_error, z, verdict, rule)
