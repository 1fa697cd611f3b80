"""What the paper states, and whether it holds for each triangulation and distribution.

Every verdict follows from the other tables by the rule that the statement itself names.
"""

from collections.abc import Callable

import numpy as np
import pandas as pd
from scipy import stats

from study.analysis.measurements import SIGNIFICANCE, Measurements, NotEnough, select
from study.analysis.table import DISTRIBUTION, METHOD, Column, Table
from study.analysis.theory import LEAST_P

_STATEMENTS = (
    METHOD,
    DISTRIBUTION,
    Column("source", "Where"),
    Column("statement", "The paper's statement"),
    Column("holds", "Holds"),
    Column("evidence", "Measured"),
)

#: Relative difference up to which a formula of Theorem 1 is said to hold.
_NEAR = 0.01
#: Fewer paths than this say little of a termination rate.
_MANY = 10_000
#: A difference of AIC beyond which the worse model has next to no support.
_CLEAR_AIC = 10.0

Frames = dict[str, pd.DataFrame]
Answer = tuple[str, str]


def _premise(tables: Frames) -> Answer:
    frame = _some(tables["theorem_2"])
    verdicts = set(frame["premise"])
    holds = verdicts.pop() if len(verdicts) == 1 else "undecided"
    return holds, f"p from {frame['p_type_c'].min():.4f} to {frame['p_type_c'].max():.4f}"


def _constant_rate(tables: Frames) -> Answer:
    frame = tables["termination"]
    frame = frame[(frame["lepp_size"] >= 2) & (frame["reached"] >= _MANY)]
    frame = _some(frame[frame["standard_error"] > 0])
    if len(frame) < 2:
        raise NotEnough("too few paths")
    low, high = frame.loc[frame["rate"].idxmin()], frame.loc[frame["rate"].idxmax()]
    z = (high["rate"] - low["rate"]) / np.hypot(low["standard_error"], high["standard_error"])
    # The furthest two of several rates: Bonferroni over all pairs.
    tests = len(frame) * (len(frame) - 1) / 2
    differ = 2 * stats.norm.sf(z) * tests < SIGNIFICANCE
    return "no" if differ else "yes", (
        f"from {low['rate']:.4f} at size {low['lepp_size']} to {high['rate']:.4f} at size "
        f"{high['lepp_size']}, {z:.0f} standard errors apart; p = {low['p_type_c']:.4f}"
    )


def _moment(statistic: str) -> Callable[[Frames], Answer]:
    def answer(tables: Frames) -> Answer:
        frame = tables["theorem_1"]
        row = _some(frame[frame["statistic"] == statistic]).iloc[-1]
        off = row["relative_difference"]
        return "yes" if abs(off) <= _NEAR else "no", (
            f"{row['measured']:.4f} against {row['predicted']:.4f} at {row['n_points']:,} points "
            f"({off:+.1%})"
        )

    return answer


def _bound(column: str, lowest: str, highest: str) -> Callable[[Frames], Answer]:
    def answer(tables: Frames) -> Answer:
        frame = _some(tables["theorem_2"])
        inside, total = frame[column].sum(), frame["triangulations"].sum()
        seen = f"up to {frame[highest].max():.4f}"
        if lowest:
            seen = f"{frame[lowest].min():.4f} to {frame[highest].max():.4f}"
        holds = "yes" if inside == total else "no"
        return holds, f"{seen}; {inside:,} of {total:,} triangulations"

    return answer


def _t_tests(tables: Frames) -> Answer:
    frame = _some(tables["bounds"])
    rejected = (frame["verdict"] == "rejected").sum()
    return "yes" if rejected == len(frame) else "no", (
        f"{rejected} of {len(frame)} tests significant after Bonferroni, "
        f"log10 p at most {frame['log10_p'].max():.1f}"
    )


def _f_test(table: str, choice: dict[str, str], statistic: str) -> Callable[[Frames], Answer]:
    def answer(tables: Frames) -> Answer:
        frame = tables[table]
        for column, value in choice.items():
            frame = frame[frame[column] == value]
        row = _some(frame).iloc[0]
        return "yes" if row["p"] < SIGNIFICANCE else "no", (
            f"F = {row[statistic]:.2f} ({row['df_group']:.0f} and {row['df_residual']:.0f} degrees "
            f"of freedom), log10 p = {row['log10_p']:.1f}"
        )

    return answer


def _normal(tables: Frames) -> Answer:
    frame = _some(tables["shapiro"])
    rejected = (frame["normal"] == "rejected").sum()
    return "no" if rejected else "yes", (
        f"{(frame['p'] < SIGNIFICANCE).sum()} of {len(frame)} groups below {SIGNIFICANCE}, "
        f"{rejected} after Holm's correction"
    )


def _trend(column: str, sign: int, places: int) -> Callable[[Frames], Answer]:
    def answer(tables: Frames) -> Answer:
        frame = tables["groups"].dropna(subset=[column])
        if len(frame) < 4:
            raise NotEnough("fewer than four sizes")
        if not np.ptp(frame[column]):
            return "no", f"{frame[column].iloc[0]:.{places}f} at every size"
        side = "greater" if sign > 0 else "less"
        rho, p = stats.spearmanr(frame["n_points"], frame[column], alternative=side)
        first, last = frame.iloc[0], frame.iloc[-1]
        return "yes" if p < SIGNIFICANCE else "no", (
            f"{first[column]:.{places}f} at {first['n_points']:,} points, "
            f"{last[column]:.{places}f} at {last['n_points']:,}; Spearman's rho {rho:+.2f}"
        )

    return answer


def _logarithmic_best(tables: Frames) -> Answer:
    frame = tables["regressions"]
    frame = frame[(frame["fitting"] == "least squares") & (frame["model"] != "saturating")]
    if len(frame) < 4:
        raise NotEnough("not all four models could be fitted")
    ranked = frame.sort_values("adj_r2", ascending=False, kind="stable")
    evidence = ", ".join(
        f"{m} {r:.3f}" for m, r in zip(ranked["model"], ranked["adj_r2"], strict=True)
    )
    return "yes" if ranked.iloc[0]["model"] == "logarithmic" else "no", evidence


def _constant_cost(tables: Frames) -> Answer:
    frame = tables["regressions"]
    frame = frame[frame["fitting"] == "weighted"].set_index("model")
    if not {"logarithmic", "saturating"} <= set(frame.index):
        raise NotEnough("the saturating model could not be fitted")
    gain = frame.loc["logarithmic", "aic"] - frame.loc["saturating", "aic"]
    holds = "yes" if gain > _CLEAR_AIC else "no" if gain < -_CLEAR_AIC else "undecided"
    return holds, (
        f"AIC of a model with a limit {abs(gain):.1f} {'below' if gain > 0 else 'above'} that of "
        "the logarithmic one"
    )


#: Source, statement, and how it is answered from the tables of one method and distribution.
_ASKED: tuple[tuple[str, str, Callable[[Frames], Answer]], ...] = (
    ("Theorem 1", "Every step of a path ends with the same probability", _constant_rate),
    ("Theorem 1", "The mean LEPP size is (p + 1) / p, within 1 %", _moment("mean")),
    (
        "Theorem 1",
        "The standard deviation is sqrt(1 - p) / p, within 1 %",
        _moment("standard deviation"),
    ),
    (
        "Theorem 1",
        "The skewness is (2 - p) / sqrt(1 - p), within 1 %",
        _moment("skewness"),
    ),
    (
        "Theorem 1",
        "The excess kurtosis is (p^2 - 6 p + 6) / (1 - p), within 1 %",
        _moment("excess kurtosis"),
    ),
    ("Theorem 2", "The probability p of a type C neighbour is at least 1/3", _premise),
    (
        "Theorem 2",
        "The mean LEPP size is between 2 and 4",
        _bound("mean_inside", "lowest_mean", "highest_mean"),
    ),
    (
        "Theorem 2",
        "The standard deviation is at most sqrt 6",
        _bound("sd_inside", "", "highest_sd"),
    ),
    (
        "Table 2",
        "The variances of the groups differ",
        _f_test("levene", {"center": "mean"}, "f"),
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
        _f_test("anova", {"test": "classical", "effect": "eta squared"}, "statistic"),
    ),
    ("Table 6", "The mean is significantly below 4 and above 2 in every group", _t_tests),
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
        "The cost of a LEPP is constant: its mean size has a limit",
        _constant_cost,
    ),
)


def statements(data: Measurements, tables: dict[str, Table]) -> Table:
    """Say of each statement of the paper whether it holds, by method and distribution.

    Parameters
    ----------
    data : Measurements
    tables : dict of str to Table
        groups, levene, shapiro, anova, bounds, regressions, termination, theorem_1, theorem_2.
    """
    rows = []
    for method, distribution in data.populations:
        frames = {
            name: select(table.frame, method, distribution)
            for name, table in tables.items()
            if {"method", "distribution"} <= set(table.frame.columns)
        }
        for source, statement, answer in _ASKED:
            try:
                holds, evidence = answer(frames)
            except NotEnough as lack:
                holds, evidence = "not tested", str(lack)
            rows.append(
                {
                    "method": method,
                    "distribution": distribution,
                    "source": source,
                    "statement": statement,
                    "holds": holds,
                    "evidence": evidence,
                }
            )
    note = (
        "Theorem 2's premise is judged by the interval of p against "
        f"{LEAST_P:.4f} at every size; its bounds by every single triangulation. A termination "
        f"rate counts where at least {_MANY:,} paths reach it. Tests are at {SIGNIFICANCE}; growth "
        "and decline are Spearman's rank correlation of the groups with the number of points. A "
        f"limit is decided by a difference of AIC above {_CLEAR_AIC:g} between the weighted fits "
        "of the saturating and the logarithmic model."
    )
    title = "The paper's statements, and for which triangulation they hold"
    return Table.from_rows("statements", title, _STATEMENTS, rows, note)


def _some(frame: pd.DataFrame) -> pd.DataFrame:
    if frame.empty:
        raise NotEnough("the run has too few triangulations")
    return frame
