"""Every statement of the paper, with made tables that bear it out and tables that do not."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

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


def spaced(text):
    """Write plain spaces for those at which no line ends."""
    return text.replace("\u00a0", " ")


def lacking(part, **frames):
    """Why the statement cannot be judged."""
    with pytest.raises(NotEnough) as why:
        judged(part, **frames)
    return str(why.value)


# Theorem 1


STATISTICS = ("mean", "standard deviation", "skewness", "excess kurtosis")
EVERY_STEP = "Every step of a path ends with the same probability p"


def laws(verdict, part="interior", log10_p=-40.6):
    """The test of a constant chance beside the laws that are not asked for."""
    row = {"part": part, "n_points": 20_000, "upto_size": 5, "df": 3, "log10_p": log10_p,
           "f": 907_387.2}  # fmt: skip
    other = {"rejected": "not rejected", "not rejected": "rejected"}[verdict]
    return [
        row | {"law": "constant", "verdict": verdict},
        row | {"law": "λ / (k + b)ᵃ", "verdict": other, "f": 5.7, "log10_p": -0.1},
        row | {"law": "Theorem 1", "verdict": "", "upto_size": 2},
    ]


def chances(part="interior"):
    rates = {2: 0.58, 3: 0.49, 4: 0.43, 5: 0.3878, 6: 0.9}
    return [{"part": part, "lepp_size": k, "rate": rate} for k, rate in rates.items()]


def moments():
    """Theorem 1 at two sizes; the first is that which must not be read."""
    return [
        {
            "statistic": statistic,
            "n_points": n,
            "p_type_c": 0.4151 + away,
            "relative_difference": -0.1 - 0.01 * k + 20 * away,
            "p_all_steps": 0.4838 + away,
            "difference_all_steps": [0.0, -0.174, 0.34, -0.6][k] + 20 * away,
        }
        for n, away in ((10_000, 0.1), (200_000, 0.0))
        for k, statistic in enumerate(STATISTICS)
    ]


FOLLOWS = (
    "What follows, in whole meshes of 200,000 points: with p = 0.4151 of the first step, the mean "
    "is 10.0 % below, the standard deviation is 11.0 % below, the skewness is 12.0 % below and the "
    "excess kurtosis is 13.0 % below Theorem 1's; with r = 0.4838 of all steps the mean fits by "
    "construction, the standard deviation is 17.4 % below, the skewness is 34.0 % above and the "
    "excess kurtosis is 60.0 % below Theorem 1's"
)


def test_one_chance_for_all_steps_that_is_rejected():
    holds, evidence = judged(
        EVERY_STEP, path_laws=laws("rejected"), continuation=chances(), theorem_1=moments()
    )
    assert holds == "no"
    assert spaced(evidence) == (
        "The chance to go on is 58.0 % after 2 triangles and 38.8 % after 5 (interior, 20,000 "
        f"points). One chance for all: p = 2.5 × 10⁻⁴¹. {FOLLOWS}"
    )


def test_one_chance_for_all_steps_that_is_not_rejected():
    holds, evidence = judged(
        EVERY_STEP,
        path_laws=laws("not rejected", log10_p=-0.3),
        continuation=chances(),
        theorem_1=moments(),
    )
    assert holds == "not rejected"
    assert f"p = {10**-0.3:.4f}. {FOLLOWS}" in spaced(evidence)


@pytest.mark.parametrize("inside", ["rejected", "not rejected"])
def test_the_interior_decides_where_there_is_one(inside):
    other = "not rejected" if inside == "rejected" else "rejected"
    both = laws(other, "whole") + laws(inside)
    rates = chances("whole") + chances()
    holds, evidence = judged(EVERY_STEP, path_laws=both, continuation=rates, theorem_1=moments())
    assert holds == {"rejected": "no", "not rejected": "not rejected"}[inside]
    assert "(interior, " in evidence
    holds, evidence = judged(
        EVERY_STEP,
        path_laws=laws(inside, "whole"),
        continuation=chances("whole"),
        theorem_1=moments(),
    )
    assert holds == {"rejected": "no", "not rejected": "not rejected"}[inside]
    assert "(whole, " in evidence


def test_too_few_rates():
    only = [row for row in laws("rejected") if row["law"] != "constant"]
    assert "too few" in lacking(EVERY_STEP, path_laws=only, continuation=chances())


# Theorem 2

PREMISE = "The probability p of a type C neighbour is at least 1/3, at every step"


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
    rows = {
        "premise": verdicts,
        "p_type_c": [0.41561, 0.30294],
        "n_points": [10_000, 20_000],
        "lowest_rate": [0.4157, 0.3031],
        "lowest_size": [2, 4],
    }
    first = "share p of type C from 0.3029 to 0.4156; "
    least = (
        f"{first}the least chance to end at any step, at a neighbour of type C or at the "
        "boundary, is"
    )
    assert judged(PREMISE, theorem_2=rows) == (
        holds, f"{least} 0.3031, at size 4 (20,000 points)",
    )  # fmt: skip
    rows["lowest_rate"][1] = np.nan
    assert judged(PREMISE, theorem_2=rows) == (
        holds, f"{least} 0.4157, at size 2 (10,000 points)",
    )  # fmt: skip
    rows["lowest_rate"] = [np.nan] * 2
    assert judged(PREMISE, theorem_2=rows) == (
        holds, f"{first}no step is known to within 0.05",
    )  # fmt: skip
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
    assert judged("The standard deviation is at most √6", theorem_2=rows) == (
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
         {"test": "classical", "effect": "η²"},
         [{"test": "Welch", "effect": "ω²"},
          {"test": "classical", "effect": "ω²"},
          {"test": "Welch", "effect": "η²"}], "33.53"),
    ],
)  # fmt: skip
def test_f_tests(part, table, asked, others, f):
    for p, against, holds in [
        (0.05 - JUST, 0.9, "yes"),
        (1e-30, 0.9, "yes"),
        (0.05, 0.001, "not shown"),
        (0.7, 0.001, "not shown"),
    ]:
        rows = [f_rows(against, **other) | {"f": 1, "statistic": 1} for other in others]
        rows.append(f_rows(p, **asked))
        seen, evidence = judged(part, **{table: rows})
        assert seen == holds
        assert spaced(evidence) == f"F = {f} (19 and 780 degrees of freedom), p = 5.5 × 10⁻⁴"
        only_others = pd.DataFrame(rows[:-1])
        assert "too few" in lacking(part, **{table: only_others})


def test_normal_groups():
    part = "The data within each group are nearly normal"
    rows = {"p": [0.04, 0.05, 0.6, 0.049, 0.7], "normal": ["not rejected"] * 5}
    assert judged(part, shapiro=rows) == (
        "not rejected",
        "2 of 5 groups below 0.05, where 0.2 would be by chance; 0 after Holm's correction",
    )  # fmt: skip
    rows = {"p": [0.001, 0.6], "normal": ["rejected", "not rejected"]}
    assert judged(part, shapiro=rows) == (
        "no", "1 of 2 groups below 0.05, where 0.1 would be by chance; 1 after Holm's correction",
    )  # fmt: skip
    assert "too few" in lacking(part, shapiro={"p": [], "normal": []})


def test_means_below_4_and_above_2():
    part = "The mean is significantly below 4 and above 2 in every group"
    rows = {
        "bound": [4, 2, 4, 2],
        "verdict": ["rejected"] * 4,
        "log10_p_bonferroni": [-77.12, -70.04, -90.0, -80.0],
        "mean_low": [3.05] * 4,
        "mean_high": [3.06] * 4,
    }
    above = "above 2 says nothing, since a path inside has two triangles by definition"
    holds, evidence = judged(part, bounds=rows)
    assert holds == "yes"
    assert spaced(evidence) == (
        "4 of 4 tests significant after Bonferroni's correction, the largest p = 9.1 × 10⁻⁷¹; "
        + above
    )
    rows["verdict"][2] = "not rejected"
    rows["log10_p_bonferroni"][2] = -0.5
    holds, evidence = judged(part, bounds=rows)
    assert holds == "not shown"
    assert spaced(evidence) == (
        "3 of 4 tests significant after Bonferroni's correction, the largest p = 0.3162; " + above
    )
    for column, place, value in (("mean_low", 2, 4.001), ("mean_high", 1, 1.999)):
        wrong = rows | {column: [*rows[column]]}
        wrong[column][place] = value
        assert judged(part, bounds=wrong)[0] == "no"
        wrong[column][place] = {"mean_low": 4.0, "mean_high": 2.0}[column]
        assert judged(part, bounds=wrong)[0] == "not shown"
    assert "too few" in lacking(part, bounds={"verdict": [], "log10_p": []})


# Trends

TRENDS = {
    "The largest LEPP grows with the number of points": ("mean_max_lepp", 1, 2),
    "The mean varies less from mesh to mesh as the number of points grows": ("sd_between", -1, 4),
    "The mean LEPP size has a very weak upward trend with the number of points": (
        "mean_lepp",
        1,
        4,
    ),
}


@pytest.mark.parametrize(("part", "told"), TRENDS.items())
def test_trends(part, told):
    column, sign, places = told

    def verdict(values, sizes=None):
        sizes = sizes or [1000 * 2**k for k in range(len(values))]
        return judged(part, groups={"method": "plain", "n_points": sizes, column: values})

    def rho(value):
        return f"Spearman's ρ = {value:.2f}".replace("-", "−")

    steps = np.array([0.0, 2.0, 3.0, 5.0])
    holds, evidence = verdict((10 + sign * steps).tolist())
    last = f"{10 + sign * 5:.{places}f}"
    assert holds == "yes"
    assert evidence == f"{10:.{places}f} at 1,000 points, {last} at 8,000; {rho(sign)}"
    assert verdict((10 - sign * steps).tolist())[0] == "no"
    # ranks 1 3 2 5 4 6: rho is 31/35, and one-sided p of that 0.009; of 2 1 4 3 is 0.2
    assert verdict([10 + sign * k for k in (1, 3, 2, 5, 4, 6)]) == (
        "yes",
        f"{10 + sign:.{places}f} at 1,000 points, {10 + sign * 6:.{places}f} at 32,000; "
        f"{rho(sign * 31 / 35)}",
    )
    assert verdict([10 - sign * k for k in (1, 3, 2, 5, 4, 6)])[0] == "no"
    assert verdict([10 + sign * k for k in (2, 1, 4, 3)])[0] == "not shown"
    assert verdict([10 - sign * k for k in (2, 1, 4, 3)])[0] == "not shown"
    # rho of 2 1 3 5 4 is 0.8: one-sided p 0.052, two-sided 0.104; of 1 3 2 4 5 is 0.9, p 0.019
    assert verdict([10 + sign * k for k in (2, 1, 3, 5, 4)])[0] == "not shown"
    assert verdict([10 + sign * k for k in (1, 3, 2, 4, 5)])[0] == "yes"
    assert verdict([10 - sign * k for k in (1, 3, 2, 4, 5)])[0] == "no"
    assert verdict([3.0] * 4) == ("not shown", f"{3:.{places}f} at every size")
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


BEST = "Of the four models the logarithmic one has the highest adjusted R²"


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
    scores["linear"] = 0.5
    assert judged(BEST, regressions=fits(scores))[0] == "no"
    del scores["logistic"]
    why = lacking(BEST, regressions=other + more + fits(scores))
    assert why == "not all four models could be fitted"


COST, LIMIT = "cost of a LEPP is constant", "asymptotic limit equal to 4"


@pytest.mark.parametrize(
    ("highest", "holds"),
    [(3.07, "not rejected"), (4.0, "not rejected"), (4 + JUST, "no"), (5.0, "no")],
)
def test_the_cost_is_constant_if_no_mean_is_above_4(highest, holds):
    rows = [
        {"highest_mean": 3.0, "triangulations": 40},
        {"highest_mean": highest, "triangulations": 1000},
    ]
    assert judged(COST, theorem_2=rows) == (
        holds, f"our criterion, a mean of at most 4: it is at most {highest:.4f} in 1,040 "
        "triangulations",
    )  # fmt: skip


LOGISTIC_SURVIVES = [
    {"part": "whole", "model": "linear", "standing": "refuted"},
    {"part": "whole", "model": "logistic", "standing": "survives"},
    {"part": "interior", "model": "logistic", "standing": "refuted"},
]


@pytest.mark.parametrize(
    ("low", "high", "holds"),
    [
        (3.09, 3.11, "no"),
        (4.001, 4.2, "no"),
        (3.9, 4.0, "not rejected"),
        (4.0, 4.1, "not rejected"),
        (3.09, np.nan, "not rejected"),
        (4.01, np.nan, "no"),
    ],
)
def test_a_limit_of_4_is_held_against_the_one_of_both_parts(low, high, holds):
    limit = {"limit": 3.1, "limit_low": low, "limit_high": high}
    rows = [{"has_limit": "yes", "reason": "so it is"} | limit]
    end = "–" if np.isnan(high) else f"{high:.4f}"
    seen, evidence = judged(LIMIT, limit_verdicts=rows, model_scores=LOGISTIC_SURVIVES)
    assert seen == holds
    assert evidence == (
        f"the mean has a limit (so it is): 3.1000 (95 % interval {low:.4f} to {end}); the logistic "
        "model survives"
    )


@pytest.mark.parametrize(("high", "holds"), [(3.99, "no"), (4.01, "not rejected")])
def test_a_limit_known_from_above_alone_is_held_against_4(high, holds):
    limit = {"limit": np.nan, "limit_low": np.nan, "limit_high": high}
    rows = [{"has_limit": "yes", "reason": "so it is"} | limit]
    assert judged(LIMIT, limit_verdicts=rows, model_scores=LOGISTIC_SURVIVES) == (
        holds,
        f"the mean has a limit (so it is): below {high:.4f}; the logistic model survives",
    )


@pytest.mark.parametrize(
    ("standing", "words"),
    [
        ("survives", "survives"),
        ("behind", "fits far worse than others"),
        ("refuted", "is refuted"),
        ("struck out", "has another limit than the interior"),
    ],
)
@pytest.mark.parametrize("verdict", ["no", "undecided"])
def test_without_a_limit_none_is_refuted(verdict, standing, words):
    row = {"has_limit": verdict, "reason": "so it is", "limit": 3.1,
           "limit_low": 3.0, "limit_high": 3.2}  # fmt: skip
    scores = [{"part": "whole", "model": "logistic", "standing": standing}]
    assert judged(LIMIT, limit_verdicts=[row], model_scores=scores) == (
        "undecided",
        f"whether the mean has a limit: {verdict} (so it is); the logistic model {words}",
    )
    why = lacking(LIMIT, limit_verdicts=[])
    assert why == "the run has too few triangulations"
    few = [{"has_limit": "undecided", "reason": FEW}]
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
    columns = ["triangulations", "mean_inside", "sd_inside", "n_points"]
    columns += ["lowest_mean", "highest_mean", "highest_sd", "lowest_rate", "lowest_size"]
    counted = dict.fromkeys(columns, 1)
    premises = table_of(
        "theorem_2", [of_a | good | counted, of_b | bad | counted, of_c | bad | counted]
    )
    empty = {
        name: table_of(name, [of_a | dict.fromkeys(columns, 0)]).frame.iloc[:0]
        for name, columns in {
            "continuation": ["part"],
            "path_laws": ["law", "part"],
            "theorem_1": ["statistic"],
            "bounds": ["verdict"],
            "levene": ["center"],
            "anova": ["test", "effect"],
            "shapiro": ["normal"],
            "groups": ["mean_max_lepp", "sd_between", "mean_lepp"],
            "regressions": ["fitting", "model"],
            "analogous": ["part"],
            "limit_verdicts": ["reason"],
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
    assert set(premise["source"]) == {"Premise of Theorem 2"}
    # Theorem 2's bounds say of the cost, too
    lacks = frame[
        ~frame["source"].str.contains("Theorem 2") & ~frame["statement"].str.contains(COST)
    ]
    assert set(lacks["holds"]) == {"not tested"}
    assert "the run has too few triangulations" in set(lacks["evidence"])
    assert frame["statement"].tolist()[: len(ASKED)] == [statement for _, statement, _ in ASKED]


def test_the_note_says_by_what_it_is_judged():
    note = module.STATEMENTS.note
    for words in (
        "to within 0.05",
        "are at 0.05",
        "if it has a bound",
        "models of growth that survive",
        "“not shown” of what",
    ):
        assert words in note


ANALOGOUS = "analogous for all the distributions"


@pytest.mark.parametrize("equivalent", ["yes", "no", "undecided"])
def test_distributions_are_analogous_if_their_means_are_equivalent(equivalent):
    of_whole = {
        "part": "whole", "comparisons": 60, "alike": 27, "differ_little": 30,
        "differ": 2, "undecided": 1, "furthest": 0.0048, "furthest_n": 10_000,
        "furthest_from": "bivariate_normal", "equivalent": equivalent,
    }  # fmt: skip
    other = "no" if equivalent == "yes" else "yes"
    of_interior = of_whole | {"part": "interior", "equivalent": other}
    holds, evidence = judged(ANALOGOUS, analogous=[of_interior, of_whole])
    assert holds == equivalent
    assert evidence.replace("\u00a0", " ") == (
        "our criterion, means that differ by less than 1 %: of 60 comparisons with the others, 27 "
        "show no difference, 30 show one, of less than 1 %, 2 show one that may be 1 % or more and "
        "1 shows none, but leave room for 1 % or more; the largest difference is 0.48 %, from the "
        "bivariate normal distribution at 10,000 points"
    )
    of_whole |= {"alike": 60, "differ_little": 0, "differ": 0, "undecided": 0}
    assert "others, 60 show no difference; the" in judged(ANALOGOUS, analogous=[of_whole])[1]


def test_one_distribution_is_analogous_to_nothing():
    rows = [{"part": "interior", "equivalent": "yes"}]
    assert "too few" in lacking(ANALOGOUS, analogous=rows)


def test_every_statement_is_tested_here():
    tested = [EVERY_STEP, PREMISE, *TRENDS, BEST, COST, LIMIT]
    tested += ["is between 2 and 4", "is at most √6", "The variances of the groups differ"]
    tested += [
        ANALOGOUS,
        "The data within each group are nearly normal",
        "The means of the groups differ",
        "below 4 and above 2",
    ]
    for _, statement, _ in ASKED:
        assert sum(part in statement for part in tested) == 1
    assert len(tested) == len(ASKED)
