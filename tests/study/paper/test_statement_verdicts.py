"""Every statement of the paper, with made tables that bear it out and tables that do not."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from study.analysis.building import Study
from study.analysis.limits import FEW
from study.analysis.table import Column, Table, Tables
from study.paper import statements as module
from study.statistics.groups import NotEnough

ASKED = module._ASKED
JUST = 1e-9


def judged(part, **frames):
    """The verdict on the one statement that has these words, and what was measured."""
    (judge,) = [judge for _, statement, judge in ASKED if part in statement]
    population = {"method": "plain", "distribution": "uniform"}
    made = (
        table_of(name, pd.DataFrame(rows).assign(**population)) for name, rows in frames.items()
    )
    return judge(module._Tables(Tables(made), **population))


def lacking(part, **frames):
    """Why the statement cannot be judged."""
    with pytest.raises(NotEnough) as why:
        judged(part, **frames)
    return str(why.value)


# Theorem 1


def rates(*rows):
    """Termination rates: size, paths that reach it, rate, standard error."""
    return [
        {
            "method": "plain",
            "lepp_size": s,
            "reached": n,
            "rate": r,
            "standard_error": e,
            "p_type_c": 0.4156,
        }
        for s, n, r, e in rows
    ]


EVERY_STEP = "Every step of a path ends with the same probability"


def test_rates_that_differ():
    holds, evidence = judged(
        EVERY_STEP,
        termination=rates((2, 10**6, 0.42, 0.003), (3, 10**5, 0.41, 0.001), (4, 10**4, 0.5, 0.004)),
    )
    assert holds == "no"
    z = (0.5 - 0.41) / np.sqrt(0.001**2 + 0.004**2)
    assert evidence == (
        f"from 0.4100 at size 3 to 0.5000 at size 4, {z:.0f} standard errors apart; p = 0.4156"
    )


def test_the_furthest_of_three_rates_are_judged_as_the_first_of_three_pairs():
    limit = stats.norm.isf(0.05 / 3 / 2)
    for z, verdict in [(limit - 1e-6, "yes"), (limit + 1e-6, "no")]:
        high = 0.4 + z * np.sqrt(0.001**2 + 0.004**2)
        rows = rates((2, 10**6, 0.4, 0.001), (3, 10**5, 0.401, 0.003), (4, 10**4, high, 0.004))
        assert judged(EVERY_STEP, termination=rows)[0] == verdict


def test_rates_of_few_paths_and_of_the_boundary_do_not_count():
    rows = rates(
        (1, 10**7, 0.02, 0.0001),  # longest edge on the boundary: no step
        (2, 10**6, 0.42, 0.003),
        (3, 10**4, 0.421, 0.003),
        (4, 9_999, 0.9, 0.003),
        (5, 10**5, 1.0, 0.0),  # one triangulation: no error
    )
    holds, evidence = judged(EVERY_STEP, termination=rows)
    assert holds == "yes"
    assert evidence.startswith("from 0.4200 at size 2 to 0.4210 at size 3, 0 standard errors")


def test_one_rate_is_too_few():
    assert lacking(EVERY_STEP, termination=rates((2, 10**6, 0.4, 0.1))) == "too few paths"
    none = rates((2, 9_999, 0.4, 0.1))
    assert "too few" in lacking(EVERY_STEP, termination=none)


MOMENTS = {
    "The mean LEPP size is (p + 1) / p": "mean",
    "The standard deviation is sqrt(1 - p) / p": "standard deviation",
    "The skewness is (2 - p) / sqrt(1 - p)": "skewness",
    "The excess kurtosis is (p^2 - 6 p + 6) / (1 - p)": "excess kurtosis",
}


@pytest.mark.parametrize(("part", "statistic"), MOMENTS.items())
def test_moments_within_one_per_cent_at_the_largest_size(part, statistic):
    def rows(off):
        wrong = 0.5 if abs(off) < 0.02 else 0.0  # what the smaller sizes say
        table = [
            {
                "statistic": other,
                "n_points": n,
                "relative_difference": off if (other, n) == (statistic, 20_000) else away,
                "measured": 3.4125 * (1 + off),
                "predicted": 3.4125,
            }
            for n, away in ((5_000, wrong), (10_000, wrong), (20_000, 0.3))
            for other in MOMENTS.values()
        ]
        return pd.DataFrame(table)

    for off in (0.0, 0.01, -0.01):
        assert judged(part, theorem_1=rows(off))[0] == "yes"
    for off in (0.01 + JUST, -0.01 - JUST, 0.2, -0.2):
        assert judged(part, theorem_1=rows(off))[0] == "no"
    evidence = judged(part, theorem_1=rows(-0.1034))[1]
    assert evidence == f"{3.4125 * 0.8966:.4f} against 3.4125 at 20,000 points (-10.3%)"
    assert "too few" in lacking(part, theorem_1=rows(0).query("statistic == 'none'"))


# Theorem 2

PREMISE = "The probability p of a type C neighbour is at least 1/3"


@pytest.mark.parametrize(
    ("verdicts", "holds"),
    [
        (["yes", "yes"], "yes"),
        (["no", "no"], "no"),
        (["undecided", "undecided"], "undecided"),
        (["yes", "undecided"], "undecided"),
        (["undecided", "yes"], "undecided"),
        (["undecided", "no"], "no"),
        (["no", "yes"], "no"),
    ],
)
def test_premise(verdicts, holds):
    rows = {"premise": verdicts, "p_type_c": [0.41561, 0.30294]}
    assert judged(PREMISE, theorem_2=rows) == (holds, "p from 0.3029 to 0.4156")
    assert "too few" in lacking(PREMISE, theorem_2={"premise": [], "p_type_c": []})


@pytest.mark.parametrize("outside", [0, 1])
def test_bounds(outside):
    rows = {
        "triangulations": [40, 1200],
        "mean_inside": [40, 1200 - outside],
        "sd_inside": [40 - outside, 1200],
        "lowest_mean": [2.91234, 3.05],
        "highest_mean": [3.1, 3.07654],
        "highest_sd": [1.25, 1.23456],
    }
    holds = "no" if outside else "yes"
    seen = f"{1240 - outside:,} of 1,240 triangulations"
    assert judged("The mean LEPP size is between 2 and 4", theorem_2=rows) == (
        holds, f"2.9123 to 3.1000; {seen}",
    )  # fmt: skip
    assert judged("The standard deviation is at most sqrt 6", theorem_2=rows) == (
        holds, f"up to 1.2500; {seen}",
    )  # fmt: skip


# Tables 2, 3, 5 and 6


def f_rows(p, **kind):
    return kind | {"f": 7.128, "statistic": 33.526, "df_group": 19, "df_residual": 780, "p": p,
                   "log10_p": -3.26}  # fmt: skip


@pytest.mark.parametrize(
    ("part", "table", "asked", "others", "f"),
    [
        ("The variances of the groups differ", "levene", {"center": "mean"},
         [{"center": "median"}], "7.13"),
        ("The means of the groups differ", "anova",
         {"test": "classical", "effect": "eta squared"},
         [{"test": "Welch", "effect": "omega squared"},
          {"test": "classical", "effect": "omega squared"},
          {"test": "Welch", "effect": "eta squared"}], "33.53"),
    ],
)  # fmt: skip
def test_f_tests(part, table, asked, others, f):
    for p, against, holds in [
        (0.05 - JUST, 0.9, "yes"),
        (1e-30, 0.9, "yes"),
        (0.05, 0.001, "no"),
        (0.7, 0.001, "no"),
    ]:
        rows = [f_rows(against, **other) | {"f": 1, "statistic": 1} for other in others]
        rows.append(f_rows(p, **asked))
        assert judged(part, **{table: rows}) == (
            holds,
            f"F = {f} (19 and 780 degrees of freedom), log10 p = -3.3",
        )
        only_others = pd.DataFrame(rows[:-1])
        assert "too few" in lacking(part, **{table: only_others})


def test_normal_groups():
    part = "The groups are normal"
    rows = {"p": [0.04, 0.05, 0.6, 0.049, 0.7], "normal": ["not rejected"] * 5}
    assert judged(part, shapiro=rows) == (
        "yes", "2 of 5 groups below 0.05, 0 after Holm's correction",
    )  # fmt: skip
    rows = {"p": [0.001, 0.6], "normal": ["rejected", "not rejected"]}
    assert judged(part, shapiro=rows) == (
        "no", "1 of 2 groups below 0.05, 1 after Holm's correction",
    )  # fmt: skip
    assert "too few" in lacking(part, shapiro={"p": [], "normal": []})


def test_means_below_4_and_above_2():
    part = "The mean is significantly below 4 and above 2 in every group"
    rows = {"verdict": ["rejected"] * 3, "log10_p": [-77.12, -70.04, -90.0]}
    assert judged(part, bounds=rows) == (
        "yes", "3 of 3 tests significant after Bonferroni, log10 p at most -70.0",
    )  # fmt: skip
    rows = {"verdict": ["rejected", "not rejected", "rejected"], "log10_p": [-77.0, -0.5, -9.0]}
    assert judged(part, bounds=rows) == (
        "no", "2 of 3 tests significant after Bonferroni, log10 p at most -0.5",
    )  # fmt: skip
    assert "too few" in lacking(part, bounds={"verdict": [], "log10_p": []})


# Trends

TRENDS = {
    "The largest LEPP grows with the number of points": ("mean_max_lepp", 1, 2),
    "The mean varies less from mesh to mesh as the number of points grows": ("sd_between", -1, 4),
    "The mean LEPP size grows with the number of points": ("mean_lepp", 1, 4),
}


@pytest.mark.parametrize(("part", "told"), TRENDS.items())
def test_trends(part, told):
    column, sign, places = told

    def verdict(values, sizes=None):
        sizes = sizes or [1000 * 2**k for k in range(len(values))]
        return judged(part, groups={"method": "plain", "n_points": sizes, column: values})

    steps = np.array([0.0, 2.0, 3.0, 5.0])
    holds, evidence = verdict((10 + sign * steps).tolist())
    last = f"{10 + sign * 5:.{places}f}"
    assert holds == "yes"
    assert evidence == (
        f"{10:.{places}f} at 1,000 points, {last} at 8,000; Spearman's rho {sign:+.2f}"
    )
    assert verdict((10 - sign * steps).tolist())[0] == "no"
    # ranks 1 3 2 5 4 6: rho is 31/35, and one-sided p of that 0.009; of 2 1 4 3 is 0.2
    assert verdict([10 + sign * k for k in (1, 3, 2, 5, 4, 6)]) == (
        "yes",
        f"{10 + sign:.{places}f} at 1,000 points, {10 + sign * 6:.{places}f} at 32,000; "
        f"Spearman's rho {sign * 31 / 35:+.2f}",
    )
    assert verdict([10 + sign * k for k in (2, 1, 4, 3)])[0] == "no"
    # rho of 2 1 3 5 4 is 0.8: one-sided p 0.052, two-sided 0.104; of 1 3 2 4 5 is 0.9, p 0.019
    assert verdict([10 + sign * k for k in (2, 1, 3, 5, 4)])[0] == "no"
    assert verdict([10 + sign * k for k in (1, 3, 2, 4, 5)])[0] == "yes"
    assert verdict([3.0] * 4) == ("no", f"{3:.{places}f} at every size")
    assert verdict([np.nan, *(10 + sign * steps)])[1].startswith(f"{10:.{places}f} at 2,000")
    for few in ([1.0, 2.0, 3.0], [np.nan, 1.0, 2.0, 3.0]):
        groups = {"n_points": range(len(few)), column: few}
        assert lacking(part, groups=groups) == "fewer than four sizes"


# Models


def fits(scores, fitting="least squares"):
    return [
        {"fitting": fitting, "model": model, "adj_r2": r2, "aic": -100 * r2}
        for model, r2 in scores.items()
    ]


BEST = "Of the four models the logarithmic one has the highest adjusted R squared"


def test_best_of_the_four_models():
    scores = {"linear": 0.33, "quadratic": 0.4012, "logistic": 0.3, "logarithmic": 0.441}
    other = fits(scores | {"linear": 0.99}, "weighted")
    more = fits({"saturating": 0.999})
    assert judged(BEST, regressions=other + more + fits(scores)) == (
        "yes", "logarithmic 0.441, quadratic 0.401, linear 0.330, logistic 0.300",
    )  # fmt: skip
    scores["quadratic"] = 0.4411
    assert judged(BEST, regressions=fits(scores)) == (
        "no", "quadratic 0.441, logarithmic 0.441, linear 0.330, logistic 0.300",
    )  # fmt: skip
    del scores["logistic"]
    why = lacking(BEST, regressions=other + more + fits(scores))
    assert why == "not all four models could be fitted"


COST, LIMIT = "cost of a LEPP is constant", "has a limit"


@pytest.mark.parametrize(
    ("highest", "holds"), [(3.07, "yes"), (4.0, "yes"), (4 + JUST, "no"), (5.0, "no")]
)
def test_the_cost_is_constant_if_no_mean_is_above_4(highest, holds):
    rows = [
        {"highest_mean": 3.0, "triangulations": 40},
        {"highest_mean": highest, "triangulations": 1000},
    ]
    assert judged(COST, theorem_2=rows) == (
        holds, f"at most {highest:.4f} in 1,040 triangulations",
    )  # fmt: skip


@pytest.mark.parametrize("verdict", ["yes", "no", "undecided"])
def test_a_limit_is_that_of_the_whole_mesh(verdict):
    rows = [
        {"part": "interior", "has_limit": "else", "reason": "not this"},
        {"part": "whole", "has_limit": verdict, "reason": "so it is"},
    ]
    assert judged(LIMIT, limit_verdicts=rows) == (verdict, "so it is")
    why = lacking(LIMIT, limit_verdicts=rows[:1])
    assert why == "the run has too few triangulations"
    few = [{"part": "whole", "has_limit": "undecided", "reason": FEW}]
    assert lacking(LIMIT, limit_verdicts=few) == "the run has too few sizes"


# The table


def table_of(name, rows):
    frame = pd.DataFrame(rows)
    return Table(name, name, frame, tuple(Column(column, column) for column in frame))


def test_statements_are_judged_for_each_population_by_its_rows():
    good, bad = [{"premise": verdict, "p_type_c": 0.4} for verdict in ("yes", "no")]
    of_a = {"method": "plain", "distribution": "uniform"}
    of_b = {"method": "plain", "distribution": "normal"}
    of_c = {"method": "delaunay", "distribution": "uniform"}
    columns = ["triangulations", "mean_inside", "sd_inside"]
    columns += ["lowest_mean", "highest_mean", "highest_sd"]
    counted = dict.fromkeys(columns, 1)
    premises = table_of(
        "theorem_2", [of_a | good | counted, of_b | bad | counted, of_c | bad | counted]
    )
    empty = {
        name: table_of(name, [of_a | dict.fromkeys(columns, 0)]).frame.iloc[:0]
        for name, columns in {
            "termination": ["lepp_size", "reached", "standard_error"],
            "theorem_1": ["statistic"],
            "bounds": ["verdict"],
            "levene": ["center"],
            "anova": ["test", "effect"],
            "shapiro": ["normal"],
            "groups": ["mean_max_lepp", "sd_between", "mean_lepp"],
            "regressions": ["fitting", "model"],
            "limit_verdicts": ["part"],
        }.items()
    }
    tables = {name: table_of(name, frame) for name, frame in empty.items()}
    tables |= {"theorem_2": premises, "overall": table_of("overall", [{"numbers": 1}])}
    populations = [tuple(of.values()) for of in (of_a, of_b, of_c)]
    study = Study(SimpleNamespace(populations=populations), Tables(tables.values()))
    (table,) = module.statements.make(study)
    frame = table.frame
    assert len(frame) == 3 * len(ASKED)
    assert set(zip(frame["method"], frame["distribution"], strict=True)) == set(populations)
    premise = frame[frame["statement"] == PREMISE]
    assert premise["holds"].tolist() == ["yes", "no", "no"]
    assert set(premise["source"]) == {"Theorem 2"}
    # Theorem 2's bounds say of the cost, too
    lacks = frame[(frame["source"] != "Theorem 2") & ~frame["statement"].str.contains(COST)]
    assert set(lacks["holds"]) == {"not tested"}
    assert "the run has too few triangulations" in set(lacks["evidence"])
    assert frame["statement"].tolist()[: len(ASKED)] == [statement for _, statement, _ in ASKED]


def test_the_note_says_by_what_it_is_judged():
    note = module.STATEMENTS.note
    for words in (
        "against 0.3333",
        "at least 10,000 paths",
        "at 0.05",
        "if it has a bound",
        "models of growth survive",
    ):
        assert words in note


def test_every_statement_is_tested_here():
    tested = [EVERY_STEP, *MOMENTS, PREMISE, *TRENDS, BEST, COST, LIMIT]
    tested += ["is between 2 and 4", "is at most sqrt 6", "The variances of the groups differ"]
    tested += ["The groups are normal", "The means of the groups differ", "below 4 and above 2"]
    for _, statement, _ in ASKED:
        assert sum(part in statement for part in tested) == 1
    assert len(tested) == len(ASKED)
