"""What the paper states, and whether it holds for each triangulation and distribution.

Every verdict follows from the other tables by the rule that the statement itself names.
"""

from collections.abc import Callable, Iterator

import numpy as np
import pandas as pd
from scipy import stats

from lepp.theory import LEAST_P_TEXT
from study.analysis.bound_tests import BOUNDS, LOWER_BOUND, UPPER_BOUND
from study.analysis.building import Study, rows_of
from study.analysis.distribution_comparison import (
    ALIKE,
    ANALOGOUS,
    DIFFER,
    LITTLE,
    MARGIN,
    VERDICTS,
)
from study.analysis.group_assumptions import CENTERS, LEVENE, SHAPIRO
from study.analysis.group_summaries import GROUPS
from study.analysis.limits import FEW, LIMIT_VERDICTS
from study.analysis.model_scores import BEHIND, MODEL_SCORES, REFUTED, STRUCK_OUT, SURVIVES
from study.analysis.parts import INTERIOR, WHOLE
from study.analysis.path_lengths import CONSTANT, CONTINUATION, PATH_LAWS
from study.analysis.regressions import LEAST_SQUARES, REGRESSIONS
from study.analysis.table import (
    DISTRIBUTION,
    METHOD,
    Column,
    Declaration,
    Row,
    Rows,
    Tables,
)
from study.analysis.theorems import LEAST_MEAN, MEAN, MOST_MEAN, MOST_SD, THEOREM_1, THEOREM_2
from study.analysis.variance_analysis import ANOVA, CLASSICAL, ETA_SQUARED
from study.statistics.groups import NotEnough
from study.statistics.models import LINEAR_MODELS, LOGARITHMIC, LOGISTIC
from study.statistics.thresholds import LEVEL, ROUGH_RATE, SIGNIFICANCE
from study.statistics.verdicts import (
    NO,
    NOT_REJECTED,
    NOT_SHOWN,
    REJECTED,
    UNDECIDED,
    YES,
    all_of,
    yes,
)
from study.text.numbers import listed, p_is, show

#: What the paper's logistic regression tends to.
LOGISTIC_LIMIT = 4.0

#: Verdict on a statement that the run does not suffice for.
NOT_TESTED = "not tested"

STATEMENTS = Declaration(
    "statements",
    "The paper's statements, and for which triangulation they hold",
    (
        METHOD,
        DISTRIBUTION,
        Column("source", "Where"),
        Column("statement", "The paper's statement"),
        Column("holds", "Holds", "", "verdict"),
        Column("evidence", "Measured"),
    ),
    note="Theorem 1 stands or falls with its premise, one chance for all steps, which is tested in "
    "the interior of the meshes if they have one; the moments only follow from it, and are listed "
    "with it. Theorem 2's premise is judged by the rate at every step that is known to within "
    f"{ROUGH_RATE:g}, at every size; its bounds by every single triangulation. Tests are at "
    f"{SIGNIFICANCE}. “{NOT_REJECTED}” is said of what a test could have refuted and did not, "
    f"“{NOT_SHOWN}” of what it could have shown and did not: neither is evidence. Growth and "
    "decline are Spearman's rank correlation of the groups with the number of points. The cost is "
    "constant if it has a bound. The logistic regression's limit is held against that of the "
    "models of "
    "growth that survive, and is refuted if their interval excludes it.",
)


class _Tables:
    """The tables of one method and distribution."""

    def __init__(self, tables: Tables, method: str, distribution: str) -> None:
        self._tables = tables
        self._key = {"method": method, "distribution": distribution}

    def rows(self, declared: Declaration, **where: object) -> Rows:
        """Rows of a table; NotEnough if there is none."""
        rows = self._tables.rows(declared, **self._key, **where)
        if rows.empty:
            raise NotEnough("the run has too few triangulations")
        return rows


Judged = tuple[str, str]
"""Whether a statement holds, and what was measured."""


def _constant_rate(of: _Tables) -> Judged:
    parts = of.rows(PATH_LAWS, law=CONSTANT).frame
    test = parts.set_index("part").loc[INTERIOR if INTERIOR in set(parts["part"]) else WHOLE]
    rates = of.rows(CONTINUATION, part=test.name)
    first = rates.first
    last = rates.select(lepp_size=test["upto_size"]).first
    rejected = test["verdict"] == REJECTED
    return NO if rejected else NOT_REJECTED, (
        f"The chance to go on is {show(first['rate'], 'percent1')} after {first['lepp_size']} "
        f"triangles and {show(last['rate'], 'percent1')} after {last['lepp_size']} ({test.name}, "
        f"{test['n_points']:,} points). One chance for all: "
        f"{p_is(test['log10_p'])}. {_moments(of)}"
    )


def _moments(of: _Tables) -> str:
    """Say how far the moments are from Theorem 1's, with p of the first step and of all steps."""
    rows = of.rows(THEOREM_1)
    last = rows.select(n_points=rows["n_points"].max())
    row = last.first
    others = last.frame[last["statistic"] != MEAN]
    by_first = [
        _off(*pair) for pair in zip(last["statistic"], last["relative_difference"], strict=True)
    ]
    by_all = [
        _off(*pair)
        for pair in zip(others["statistic"], others["difference_all_steps"], strict=True)
    ]
    return (
        f"What follows, in whole meshes of {row['n_points']:,} points: with "
        f"p = {show(row['p_type_c'], 'fixed4')} of the first step, {listed(by_first)} Theorem 1's; "
        f"with r = {show(row['p_all_steps'], 'fixed4')} of all steps the mean fits by "
        f"construction, {listed(by_all)} Theorem 1's"
    )


def _off(statistic: str, relative: float) -> str:
    side = "above" if relative > 0 else "below"
    return f"the {statistic} is {show(abs(relative), 'percent1')} {side}"


def _premise(of: _Tables) -> Judged:
    rows = of.rows(THEOREM_2)
    p = rows["p_type_c"]
    seen = f"share p of type C from {show(p.min(), 'fixed4')} to {show(p.max(), 'fixed4')}; "
    known = rows.frame.dropna(subset="lowest_rate")
    holds = all_of(rows["premise"].dropna())
    if known.empty:
        return holds, f"{seen}no step is known to within {ROUGH_RATE:g}"
    least = known.loc[known["lowest_rate"].idxmin()]
    return holds, (
        f"{seen}the least chance to end at any step, at a neighbour of type C or at the boundary, "
        f"is {show(least['lowest_rate'], 'fixed4')}, at size {least['lowest_size']} "
        f"({least['n_points']:,} points)"
    )


def _bound(column: str, lowest: str, highest: str) -> Callable[[_Tables], Judged]:
    def judge(of: _Tables) -> Judged:
        rows = of.rows(THEOREM_2)
        inside, total = rows[column].sum(), rows["triangulations"].sum()
        most = show(rows[highest].max(), "fixed4")
        seen = f"{show(rows[lowest].min(), 'fixed4')} to {most}" if lowest else f"up to {most}"
        return yes(inside == total), f"{seen}; {inside:,} of {total:,} triangulations"

    return judge


def _t_tests(of: _Tables) -> Judged:
    rows = of.rows(BOUNDS)
    rejected = (rows["verdict"] == REJECTED).sum()
    beyond = (rows["bound"] == UPPER_BOUND) & (rows["mean_low"] > UPPER_BOUND)
    beyond |= (rows["bound"] == LOWER_BOUND) & (rows["mean_high"] < LOWER_BOUND)
    holds = NO if beyond.any() else YES if rejected == len(rows) else NOT_SHOWN
    return holds, (
        f"{rejected} of {len(rows)} tests significant after Bonferroni's correction, "
        f"the largest {p_is(rows['log10_p_bonferroni'].max())}; above {LOWER_BOUND} says "
        "nothing, since a path inside has two triangles by definition"
    )


def _f_test(declared: Declaration, statistic: str, **where: str) -> Callable[[_Tables], Judged]:
    def judge(of: _Tables) -> Judged:
        row = of.rows(declared, **where).first
        return YES if row["p"] < SIGNIFICANCE else NOT_SHOWN, (
            f"F = {show(row[statistic], 'fixed2')} ({show(row['df_group'], 'int')} and "
            f"{show(row['df_residual'], 'int')} degrees of freedom), "
            f"{p_is(row['log10_p'])}"
        )

    return judge


def _normal(of: _Tables) -> Judged:
    rows = of.rows(SHAPIRO)
    rejected = (rows["normal"] == REJECTED).sum()
    return NO if rejected else NOT_REJECTED, (
        f"{(rows['p'] < SIGNIFICANCE).sum()} of {len(rows)} groups below {SIGNIFICANCE}, where "
        f"{show(SIGNIFICANCE * len(rows), 'fixed1')} would be by chance; {rejected} after Holm's "
        "correction"
    )


def _trend(column: str, sign: int, places: int) -> Callable[[_Tables], Judged]:
    how = f"fixed{places}"

    def judge(of: _Tables) -> Judged:
        frame = of.rows(GROUPS).frame.dropna(subset=[column])
        if len(frame) < 4:
            raise NotEnough("fewer than four sizes")
        first, last = frame.iloc[0], frame.iloc[-1]
        if not np.ptp(frame[column]):
            return NOT_SHOWN, f"{show(first[column], how)} at every size"
        rho, as_stated = _rank_test(frame, column, "greater" if sign > 0 else "less")
        _, against = _rank_test(frame, column, "less" if sign > 0 else "greater")
        holds = YES if as_stated < SIGNIFICANCE else NO if against < SIGNIFICANCE else NOT_SHOWN
        return holds, (
            f"{show(first[column], how)} at {first['n_points']:,} points, "
            f"{show(last[column], how)} at {last['n_points']:,}; "
            f"Spearman's ρ = {show(rho, 'fixed2')}"
        )

    return judge


def _rank_test(frame: pd.DataFrame, column: str, side: str) -> tuple[float, float]:
    test = stats.spearmanr(frame["n_points"], frame[column], alternative=side)
    return float(test.statistic), float(test.pvalue)


def _logarithmic_best(of: _Tables) -> Judged:
    frame = of.rows(REGRESSIONS, fitting=LEAST_SQUARES).frame
    frame = frame[frame["model"].isin([model.name for model in LINEAR_MODELS])]
    if len(frame) < len(LINEAR_MODELS):
        raise NotEnough("not all four models could be fitted")
    ranked = frame.sort_values("adj_r2", ascending=False, kind="stable")
    evidence = ", ".join(
        f"{m} {r:.3f}" for m, r in zip(ranked["model"], ranked["adj_r2"], strict=True)
    )
    return yes(ranked.iloc[0]["model"] == LOGARITHMIC.name), evidence


def _bounded(of: _Tables) -> Judged:
    rows = of.rows(THEOREM_2)
    highest = rows["highest_mean"].max()
    return NOT_REJECTED if highest <= MOST_MEAN else NO, (
        f"our criterion, a mean of at most {MOST_MEAN:g}: it is at most {highest:.4f} in "
        f"{rows['triangulations'].sum():,} triangulations"
    )


def _analogous(of: _Tables) -> Judged:
    row = of.rows(ANALOGOUS, part=WHOLE).first
    other = row["furthest_from"].replace("_", " ")
    return row["equivalent"], (
        f"our criterion, means that differ by less than {MARGIN}: of {row['comparisons']} "
        f"comparisons with the others, {listed(_compared(row))}; the largest difference is "
        f"{100 * row['furthest']:.2f} %, from the {other} distribution at "
        f"{row['furthest_n']:,} points"
    )


def _compared(row: pd.Series) -> list[str]:
    """Count the comparisons of a distribution with the others, by what they show."""
    counts = {verdict: row[verdict.replace(" ", "_")] for verdict in VERDICTS}
    return [
        f"{counts[verdict]} {'shows' if counts[verdict] == 1 else 'show'} {words}"
        for verdict, words in (
            (ALIKE, "no difference"),
            (LITTLE, f"one, of less than {MARGIN}"),
            (DIFFER, f"one that may be {MARGIN} or more"),
            (UNDECIDED, f"none, but leave room for {MARGIN} or more"),
        )
        if counts[verdict]
    ]


#: What becomes of a model, as of one that a sentence is about.
_STANDING = {
    SURVIVES: "survives",
    BEHIND: "fits far worse than others",
    REFUTED: "is refuted",
    STRUCK_OUT: "has another limit than the interior",
}


def _limit(of: _Tables) -> Judged:
    row = of.rows(LIMIT_VERDICTS).first
    if row["reason"] == FEW:
        raise NotEnough(FEW)
    logistic = of.rows(MODEL_SCORES, part=WHOLE, model=LOGISTIC.name).first["standing"]
    model = f"; the logistic model {_STANDING[logistic]}"
    if row["has_limit"] != YES:
        found = f"whether the mean has a limit: {row['has_limit']} ({row['reason']})"
        return UNDECIDED, found + model
    low, high = row["limit_low"], row["limit_high"]
    excluded = high < LOGISTIC_LIMIT or low > LOGISTIC_LIMIT
    if pd.isna(row["limit"]):
        where = f"below {show(high, 'fixed4')}"
    else:
        where = (
            f"{show(row['limit'], 'fixed4')} ({LEVEL} interval {show(low, 'fixed4')} to "
            f"{show(high, 'fixed4')})"
        )
    found = f"the mean has a limit ({row['reason']}): {where}"
    return NO if excluded else NOT_REJECTED, found + model


#: Source, statement, and how it is answered from the tables of one method and distribution.
_ASKED: tuple[tuple[str, str, Callable[[_Tables], Judged]], ...] = (
    (
        "Premise of Theorem 1",
        "Every step of a path ends with the same probability p, and so the sizes are geometric: "
        "mean (p + 1) / p, standard deviation √(1 − p) / p, skewness (2 − p) / √(1 − p), excess "
        "kurtosis (p² − 6 p + 6) / (1 − p)",
        _constant_rate,
    ),
    (
        "Premise of Theorem 2",
        f"The probability p of a type C neighbour is at least {LEAST_P_TEXT}, at every step",
        _premise,
    ),
    (
        "Theorem 2",
        f"The mean LEPP size is between {LEAST_MEAN:g} and {MOST_MEAN:g}",
        _bound("mean_inside", "lowest_mean", "highest_mean"),
    ),
    (
        "Theorem 2",
        f"The standard deviation is at most √{MOST_SD**2:g}",
        _bound("sd_inside", "", "highest_sd"),
    ),
    (
        "Table 2",
        "The variances of the groups differ",
        _f_test(LEVENE, "f", center=CENTERS[0]),
    ),
    ("Table 3", "The data within each group are nearly normal", _normal),
    ("Table 4", "The largest LEPP grows with the number of points", _trend("mean_max_lepp", 1, 2)),
    (
        "Figure 5",
        "The mean varies less from mesh to mesh as the number of points grows",
        _trend("sd_between", -1, 4),
    ),
    (
        "Table 5",
        "The means of the groups differ",
        _f_test(ANOVA, "statistic", test=CLASSICAL, effect=ETA_SQUARED),
    ),
    (
        "Table 6",
        f"The mean is significantly below {MOST_MEAN:g} and above {LEAST_MEAN:g} in every group",
        _t_tests,
    ),
    (
        "Figure 6",
        "The mean LEPP size has a very weak upward trend with the number of points",
        _trend("mean_lepp", 1, 4),
    ),
    (
        "Table 7",
        "Of the four models the logarithmic one has the highest adjusted R²",
        _logarithmic_best,
    ),
    (
        "Section 4",
        "Results and conclusions are analogous for all the distributions",
        _analogous,
    ),
    (
        "Conclusions",
        "The cost of a LEPP is constant",
        _bounded,
    ),
    (
        "Table 7",
        f"The logistic regression has an asymptotic limit equal to {LOGISTIC_LIMIT:g}",
        _limit,
    ),
)


@rows_of(
    STATEMENTS,
    needs=(
        GROUPS, LEVENE, SHAPIRO, ANOVA, BOUNDS, REGRESSIONS, CONTINUATION, PATH_LAWS, THEOREM_1,
        THEOREM_2, ANALOGOUS, LIMIT_VERDICTS, MODEL_SCORES,
    ),
)  # fmt: skip
def statements(study: Study) -> Iterator[Row]:
    """Say of each statement of the paper whether it holds, by method and distribution."""
    for method, distribution in study.data.populations:
        of = _Tables(study.tables, method, distribution)
        for source, statement, judge in _ASKED:
            try:
                holds, evidence = judge(of)
            except NotEnough as lack:
                holds, evidence = NOT_TESTED, str(lack)
            yield {
                "method": method,
                "distribution": distribution,
                "source": source,
                "statement": statement,
                "holds": holds,
                "evidence": evidence,
            }
