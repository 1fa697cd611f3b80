"""What the paper states, and whether it holds for each triangulation and distribution.

Every verdict follows from the other tables by the rule that the statement itself names.
"""

from collections.abc import Callable, Iterator

import numpy as np
from scipy import stats

from lepp.theory import LEAST_P, LEAST_P_TEXT
from study.analysis.bound_tests import BOUNDS
from study.analysis.building import Study, rows_of
from study.analysis.group_assumptions import CENTERS, LEVENE, SHAPIRO
from study.analysis.group_summaries import GROUPS
from study.analysis.limits import FEW, LIMIT_VERDICTS
from study.analysis.parts import WHOLE
from study.analysis.path_lengths import TERMINATION
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
from study.analysis.theorems import (
    KURTOSIS,
    LEAST_MEAN,
    MEAN,
    MOST_MEAN,
    MOST_SD,
    SD,
    SKEWNESS,
    THEOREM_1,
    THEOREM_2,
)
from study.analysis.variance_analysis import ANOVA, CLASSICAL, ETA_SQUARED
from study.statistics.groups import NotEnough
from study.statistics.models import LINEAR_MODELS, LOGARITHMIC
from study.statistics.thresholds import MANY_PATHS, SIGNIFICANCE, WITHIN_ONE_PERCENT
from study.statistics.verdicts import NO, REJECTED, all_of, yes

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
    note="Theorem 2's premise is judged by the interval of p against "
    f"{LEAST_P:.4f} at every size; its bounds by every single triangulation. A termination "
    f"rate counts where at least {MANY_PATHS:,} paths reach it. Tests are at {SIGNIFICANCE}; "
    "growth and decline are Spearman's rank correlation of the groups with the number of points. "
    "The cost is constant if it has a bound; whether the mean also has a limit is decided by which "
    "models of growth survive.",
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


def _premise(of: _Tables) -> Judged:
    rows = of.rows(THEOREM_2)
    p = rows["p_type_c"]
    return all_of(rows["premise"]), f"p from {p.min():.4f} to {p.max():.4f}"


def _constant_rate(of: _Tables) -> Judged:
    frame = of.rows(TERMINATION).frame
    frame = frame[(frame["lepp_size"] >= 2) & (frame["reached"] >= MANY_PATHS)]
    frame = frame[frame["standard_error"] > 0]
    if len(frame) < 2:
        raise NotEnough("too few paths")
    low, high = frame.loc[frame["rate"].idxmin()], frame.loc[frame["rate"].idxmax()]
    z = (high["rate"] - low["rate"]) / np.hypot(low["standard_error"], high["standard_error"])
    # The furthest two of several rates: Bonferroni over all pairs.
    tests = len(frame) * (len(frame) - 1) / 2
    differ = 2 * stats.norm.sf(z) * tests < SIGNIFICANCE
    return yes(not differ), (
        f"from {low['rate']:.4f} at size {low['lepp_size']} to {high['rate']:.4f} at size "
        f"{high['lepp_size']}, {z:.0f} standard errors apart; p = {low['p_type_c']:.4f}"
    )


def _moment(statistic: str) -> Callable[[_Tables], Judged]:
    def judge(of: _Tables) -> Judged:
        row = of.rows(THEOREM_1, statistic=statistic).last
        off = row["relative_difference"]
        return yes(abs(off) <= WITHIN_ONE_PERCENT), (
            f"{row['measured']:.4f} against {row['predicted']:.4f} at {row['n_points']:,} points "
            f"({off:+.1%})"
        )

    return judge


def _bound(column: str, lowest: str, highest: str) -> Callable[[_Tables], Judged]:
    def judge(of: _Tables) -> Judged:
        rows = of.rows(THEOREM_2)
        inside, total = rows[column].sum(), rows["triangulations"].sum()
        seen = f"up to {rows[highest].max():.4f}"
        if lowest:
            seen = f"{rows[lowest].min():.4f} to {rows[highest].max():.4f}"
        return yes(inside == total), f"{seen}; {inside:,} of {total:,} triangulations"

    return judge


def _t_tests(of: _Tables) -> Judged:
    rows = of.rows(BOUNDS)
    rejected = (rows["verdict"] == REJECTED).sum()
    return yes(rejected == len(rows)), (
        f"{rejected} of {len(rows)} tests significant after Bonferroni, "
        f"log10 p at most {rows['log10_p'].max():.1f}"
    )


def _f_test(declared: Declaration, statistic: str, **where: str) -> Callable[[_Tables], Judged]:
    def judge(of: _Tables) -> Judged:
        row = of.rows(declared, **where).first
        return yes(row["p"] < SIGNIFICANCE), (
            f"F = {row[statistic]:.2f} ({row['df_group']:.0f} and {row['df_residual']:.0f} degrees "
            f"of freedom), log10 p = {row['log10_p']:.1f}"
        )

    return judge


def _normal(of: _Tables) -> Judged:
    rows = of.rows(SHAPIRO)
    rejected = (rows["normal"] == REJECTED).sum()
    return yes(not rejected), (
        f"{(rows['p'] < SIGNIFICANCE).sum()} of {len(rows)} groups below {SIGNIFICANCE}, "
        f"{rejected} after Holm's correction"
    )


def _trend(column: str, sign: int, places: int) -> Callable[[_Tables], Judged]:
    def judge(of: _Tables) -> Judged:
        frame = of.rows(GROUPS).frame.dropna(subset=[column])
        if len(frame) < 4:
            raise NotEnough("fewer than four sizes")
        if not np.ptp(frame[column]):
            return NO, f"{frame[column].iloc[0]:.{places}f} at every size"
        side = "greater" if sign > 0 else "less"
        rho, p = stats.spearmanr(frame["n_points"], frame[column], alternative=side)
        first, last = frame.iloc[0], frame.iloc[-1]
        return yes(p < SIGNIFICANCE), (
            f"{first[column]:.{places}f} at {first['n_points']:,} points, "
            f"{last[column]:.{places}f} at {last['n_points']:,}; Spearman's rho {rho:+.2f}"
        )

    return judge


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
    return yes(highest <= MOST_MEAN), (
        f"at most {highest:.4f} in {rows['triangulations'].sum():,} triangulations"
    )


def _has_limit(of: _Tables) -> Judged:
    row = of.rows(LIMIT_VERDICTS, part=WHOLE).first
    if row["reason"] == FEW:
        raise NotEnough(FEW)
    return row["has_limit"], row["reason"]


_WITHIN = f"within {100 * WITHIN_ONE_PERCENT:g} %"

#: Source, statement, and how it is answered from the tables of one method and distribution.
_ASKED: tuple[tuple[str, str, Callable[[_Tables], Judged]], ...] = (
    ("Theorem 1", "Every step of a path ends with the same probability", _constant_rate),
    ("Theorem 1", f"The mean LEPP size is (p + 1) / p, {_WITHIN}", _moment(MEAN)),
    (
        "Theorem 1",
        f"The standard deviation is sqrt(1 - p) / p, {_WITHIN}",
        _moment(SD),
    ),
    (
        "Theorem 1",
        f"The skewness is (2 - p) / sqrt(1 - p), {_WITHIN}",
        _moment(SKEWNESS),
    ),
    (
        "Theorem 1",
        f"The excess kurtosis is (p^2 - 6 p + 6) / (1 - p), {_WITHIN}",
        _moment(KURTOSIS),
    ),
    ("Theorem 2", f"The probability p of a type C neighbour is at least {LEAST_P_TEXT}", _premise),
    (
        "Theorem 2",
        f"The mean LEPP size is between {LEAST_MEAN:g} and {MOST_MEAN:g}",
        _bound("mean_inside", "lowest_mean", "highest_mean"),
    ),
    (
        "Theorem 2",
        f"The standard deviation is at most sqrt {MOST_SD**2:g}",
        _bound("sd_inside", "", "highest_sd"),
    ),
    (
        "Table 2",
        "The variances of the groups differ",
        _f_test(LEVENE, "f", center=CENTERS[0]),
    ),
    ("Table 3", "The groups are normal", _normal),
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
        "The mean LEPP size grows with the number of points",
        _trend("mean_lepp", 1, 4),
    ),
    (
        "Table 7",
        "Of the four models the logarithmic one has the highest adjusted R squared",
        _logarithmic_best,
    ),
    (
        "Conclusions",
        f"The cost of a LEPP is constant: its mean size is at most {MOST_MEAN:g}",
        _bounded,
    ),
    (
        "Conclusions",
        "The mean LEPP size has a limit as the number of points grows",
        _has_limit,
    ),
)


@rows_of(
    STATEMENTS,
    needs=(
        GROUPS, LEVENE, SHAPIRO, ANOVA, BOUNDS, REGRESSIONS, LIMIT_VERDICTS, TERMINATION, THEOREM_1,
        THEOREM_2,
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
