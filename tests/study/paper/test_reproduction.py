"""Verdicts on the published numbers: by results that reproduce them, and by results that do not."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from frames import design, frames
from scipy import stats
from statsmodels.regression.linear_model import OLS

from study.analysis.analyse import analyse
from study.paper import judging, published, reproduction
from study.paper.scoreboard import _together


def scoreboard(tables, **wanted):
    frame = tables["reproduction"].frame
    for column, value in wanted.items():
        frame = frame[frame[column] == value]
    return frame


def test_the_published_table_reproduces_itself(paper_study):
    tables = paper_study[2]
    frame = scoreboard(tables, distribution="uniform")
    judged = frame[~frame["published_table"].isin([1, 3])]
    assert set(judged["verdict"]) == {"agrees", "misprint"}
    overall = tables["reproduction_overall"].frame.set_index("quantity")
    assert overall.loc["mean LEPP", "chi2"] == pytest.approx(0, abs=1e-9)
    assert overall.loc["mean LEPP", "df"] == 20


def test_what_counts_as_reproduced(paper_study):
    frame = scoreboard(paper_study[2])
    assert frame["standing"].value_counts().to_dict() == {
        "independent": 93,
        "implied by Table 4": 1 + 4 + 18,
        "by construction": 4 + 2,
        "random draw": 16 + 4,
        "same test": 4,
    }
    summary = paper_study[2]["reproduction_summary"].frame.set_index("published_table")
    judged = frame[frame["verdict"].isin(["agrees", "close", "differs"])]
    independent = judged[judged["standing"] == "independent"]
    assert summary["independent"].sum() == len(independent) == 81  # one distribution was run
    assert summary.loc[[5, 7], "independent"].tolist() == [0, 0]
    assert summary.loc[7, "agrees"] == 17
    for verdict in ("agrees", "close", "differs"):
        expected = (independent["verdict"] == verdict).sum()
        assert summary[f"independent_{verdict}"].sum() == expected


def test_independent_numbers_together(paper_study):
    tables = paper_study[2]
    overall = tables["reproduction_overall"].frame.set_index("quantity")
    assert overall.index.tolist() == [
        "mean LEPP", "standard deviation", "mean triangles", "mean largest LEPP",
        "all independent numbers",
    ]  # fmt: skip
    assert overall["numbers"].tolist() == [20, 20, 20, 20, 81]
    assert overall.loc["mean LEPP", "verdict"] == "closer than chance"  # it is the paper's
    assert overall.loc["mean LEPP", "p_less"] < 1e-12
    assert np.isnan(overall.loc["all independent numbers", "shift"])
    frame = scoreboard(tables, standing="independent")
    expected = frame["chance_beyond"].sum()
    assert overall.loc["all independent numbers", "expected_beyond"] == pytest.approx(expected)
    assert overall.loc["standard deviation", "expected_beyond"] == pytest.approx(
        20 * 2 * stats.norm.sf(2), rel=1e-3
    )


SPREAD = np.tile([0.8, -0.8], 10)


@pytest.mark.parametrize(
    ("z", "verdict"),
    [
        (0.57 + SPREAD, "agrees"),
        (0.58 + SPREAD, "differs"),  # a shift of 2.59 standard errors: p 0.0095
        (-0.58 + SPREAD, "differs"),
        (np.full(20, 0.58), "differs"),  # by the same shift, though nearer than chance
        (np.tile([1.36, -1.36], 10), "agrees"),
        (np.tile([1.38, -1.38], 10), "differs"),  # chi-squared 38.1
        (np.tile([0.65, -0.65], 10), "agrees"),
        (np.tile([0.63, -0.63], 10), "closer than chance"),  # chi-squared 7.9
    ],
)
def test_verdicts_on_all_together(z, verdict):
    judged = pd.DataFrame({"difference": z, "chance_beyond": 0.0455})
    row = _together(judged, shift=True)
    assert row["verdict"] == verdict
    chi2 = (z**2).sum()
    assert row["p"] == pytest.approx(stats.chi2.sf(chi2, 20))
    assert row["p_less"] == pytest.approx(stats.chi2.cdf(chi2, 20))
    stouffer = stats.combine_pvalues(stats.norm.sf(z), method="stouffer")
    assert row["shift"] == pytest.approx(stouffer.statistic, abs=1e-9)
    assert row["shift_p"] == pytest.approx(2 * min(stouffer.pvalue, 1 - stouffer.pvalue))


def test_numbers_of_different_kinds_have_no_common_shift():
    judged = pd.DataFrame({"difference": 0.6 + SPREAD, "chance_beyond": 0.0455})
    row = _together(judged, shift=False)
    assert row["verdict"] == "agrees"
    assert "shift" not in row
    assert row["expected_beyond"] == pytest.approx(0.91)
    assert row["beyond"] == 0
    judged["difference"] *= 2
    assert _together(judged, shift=False)["beyond"] == 10


def test_errors_do_not_hang_on_equal_variances(paper_study):
    # of the paper's own groups: HC3 is the error of the logarithm's coefficients, not the usual one
    _, (results, *_), tables = paper_study
    y, x = results["mean_lepp"].to_numpy(), results["n_points"].to_numpy() / 1000
    hc3 = OLS(y, np.column_stack([np.ones_like(x), np.log2(x)])).fit(cov_type="HC3").bse
    frame = scoreboard(tables, published_table=7).set_index("quantity")
    for name, error in zip(("logarithmic, c", "logarithmic, d"), hc3, strict=True):
        unit = {"logarithmic, c": 1e-3, "logarithmic, d": 1e-4}[name] / np.sqrt(12)
        expected = np.hypot(np.sqrt(2) * error, unit)
        assert frame.loc[name, "standard_error"] == pytest.approx(expected, rel=0.06)


def test_the_same_design_has_the_same_errors(paper_study):
    asked, made, tables = paper_study
    again = analyse(*made, asked)
    assert again["reproduction"].to_csv() == tables["reproduction"].to_csv()


def test_every_published_number_is_there(paper_study):
    counts = scoreboard(paper_study[2])["published_table"].value_counts().to_dict()
    assert counts == PUBLISHED_NUMBERS


PUBLISHED_NUMBERS = {1: 16, 2: 4, 3: 8, 4: 80, 5: 4, 6: 16, 7: 9 + 8 + 1}


def test_every_published_number_is_there_for_each_method_of_any_design(study):
    frame, summary = study[2]["reproduction"].frame, study[2]["reproduction_summary"].frame
    for method in ("incremental", "delaunay"):
        of_method = frame[frame["method"] == method]["published_table"].value_counts().to_dict()
        counted = summary[summary["method"] == method].set_index("published_table")["numbers"]
        assert of_method == counted.to_dict() == PUBLISHED_NUMBERS


def test_equal_variances_are_tested_about_means_as_in_the_paper(paper_study):
    asked, (results, *others), _ = paper_study
    z = results.groupby("n_points")["mean_lepp"].transform(stats.zscore, ddof=1)
    skewed = results.assign(mean_lepp=results["mean_lepp"] + 0.003 * (z**2 - 1))
    tables = analyse(skewed, *others, asked)
    groups = [g["mean_lepp"].to_numpy() for _, g in skewed.groupby("n_points")]
    by_mean, by_median = (stats.levene(*groups, center=c).statistic for c in ("mean", "median"))
    assert by_mean > 1.05 * by_median
    assert pytest.approx(by_mean) in scoreboard(tables, published_table=2)["ours"].tolist()


def test_the_misprinted_slope_is_named(paper_study):
    (row,) = scoreboard(paper_study[2], verdict="misprint").to_dict("records")
    assert row["printed"] == "7.535e+05"
    assert row["quantity"] == "linear, b, as printed"
    (right,) = scoreboard(paper_study[2], quantity="linear, b").to_dict("records")
    assert right["published"] == pytest.approx(7.535e-5)
    assert right["verdict"] == "agrees"


def test_a_shifted_group_differs(paper_study):
    asked, (results, *others), _ = paper_study
    results = results.copy()
    shift = 5 * 0.0115 * np.sqrt(2 / 40)
    results.loc[results["n_points"] == 10_000, "mean_lepp"] += shift
    tables = analyse(results, *others, asked)
    frame = scoreboard(tables, quantity="mean LEPP").set_index("n_points")
    assert frame.loc[10_000, "verdict"] == "differs"
    assert frame.loc[10_000, "difference"] == pytest.approx(5, abs=0.01)
    assert set(frame["verdict"].iloc[1:]) == {"agrees"}
    overall = tables["reproduction_overall"].frame.set_index("quantity")
    assert overall.loc["mean LEPP", "chi2"] == pytest.approx(25, abs=0.1)
    assert overall.loc["mean LEPP", "p"] == pytest.approx(stats.chi2.sf(25, 20), rel=0.03)
    assert overall.loc["mean LEPP", "beyond"] == 1
    assert overall.loc["mean LEPP", "shift"] == pytest.approx(5 / np.sqrt(20), abs=0.01)


def test_verdicts_are_counted(paper_study):
    summary = paper_study[2]["reproduction_summary"].frame
    frame = scoreboard(paper_study[2])
    assert summary["numbers"].sum() == len(frame)
    for verdict in judging.VERDICTS:
        expected = (frame["verdict"] == verdict).sum()
        assert summary[verdict.replace(" ", "_")].sum() == expected


def test_other_sizes_are_not_compared(study):
    frame = scoreboard(study[2], method="incremental")
    assert set(frame.loc[frame["published_table"].isin([3, 4, 6]), "verdict"]) == {"not run"}
    fits = frame[frame["published_table"].isin([2, 5, 7])]
    assert set(fits["verdict"]) == {"not comparable"}
    assert fits["difference"].isna().all()


@pytest.mark.parametrize(
    ("z", "verdict"),
    [(0, "agrees"), (-1.99, "agrees"), (2.01, "close"), (-2.99, "close"), (-3.01, "differs")],
)
def test_verdicts_by_standard_errors(z, verdict):
    assert judging.within(z) == verdict


def test_means_are_judged_by_both_spreads_and_the_rounding():
    number = published.Number(4, "mean LEPP", 3.05, 2)
    judged = judging.of_mean(3.08, 0.06, 9, number, 0.03, 36)
    error = np.sqrt(0.06**2 / 9 + 0.03**2 / 36 + 0.01**2 / 12)
    assert judged.standard_error == pytest.approx(error)
    assert judged.difference == pytest.approx(0.03 / error)


def test_standard_deviations_are_judged_as_their_spread_is():
    # By simulation: the rule's difference has a unit normal distribution.
    rng = np.random.default_rng(0)
    ours, theirs = rng.normal(0, 1, (2, 2000, 40)).std(axis=2, ddof=1)
    z = [
        judging.of_sd(a, 40, published.Number(4, "sd", b, 12), 40).difference
        for a, b in zip(ours, theirs, strict=True)
    ]
    assert np.mean(z) == pytest.approx(0, abs=0.1)
    assert np.std(z) == pytest.approx(1, abs=0.06)


def number(value):
    return published.Number(6, "of a t test", value, 12, scientific=True)


def test_t_tests_are_judged_as_their_spread_is():
    rng = np.random.default_rng(3)
    draws = rng.normal(3, 0.1, (2, 1000, 40))
    t = (draws.mean(axis=2) - 4) / draws.std(axis=2, ddof=1) * np.sqrt(40)
    p = stats.t.cdf(t, 39)
    z = [
        judging.of_t_test(p1, np.log10(p1), t1, 40, number(p2), 40).difference
        for p1, p2, t1 in zip(p[0], p[1], t[0], strict=True)
    ]
    assert np.mean(z) == pytest.approx(0, abs=0.15)
    assert np.std(z) == pytest.approx(1, abs=0.1)


@pytest.mark.parametrize("f", [0.8, 33.34, 600.0])
def test_f_is_found_from_its_p(f):
    p = stats.f.sf(f, 1, 798)
    assert judging.f_of_p(p, 1, 798) == pytest.approx(f)


def test_p_printed_as_zero_must_be_below_half_a_unit():
    number = published.Number(5, "p", 0.0, 4)
    assert judging.of_rounded_p(4.9e-5, number).verdict == "agrees"
    assert judging.of_rounded_p(5.1e-5, number).verdict == "differs"


def test_points_that_are_not_random_are_seen_in_table_1(paper_study):
    asked, (results, *others, points), _ = paper_study
    small = points[points["n_points"] == points["n_points"].iloc[0]]
    points = small.assign(n_points=10_000)
    tests = ["runs_p_x", "runs_p_y", "ks_p_x", "ks_p_y"]
    good = scoreboard(analyse(results, *others, points, asked), published_table=1)
    assert set(good["verdict"]) == {"plausible draw"}
    values = points[tests[:2]].to_numpy().ravel()
    assert good["ours"].iloc[0] == np.mean(values <= 0.6030)
    bad = points.assign(runs_p_x=0.001, runs_p_y=0.002)
    frame = scoreboard(analyse(results, *others, bad, asked), published_table=1)
    runs = frame["quantity"].str.contains("runs")
    assert set(frame.loc[runs, "verdict"]) == {"implausible draw"}
    assert set(frame.loc[~runs, "verdict"]) == {"plausible draw"}
    # sets of another size are not those of Table 1
    others_only = scoreboard(analyse(results, *others, small, asked), published_table=1)
    assert set(others_only["verdict"]) == {"not run"}


def test_null_draws_are_judged_by_their_normal_scores():
    p = stats.norm.cdf(4.3)
    assert judging.of_null_p(0.97, 0.5, p).verdict == "implausible draw"
    assert judging.of_null_p(0.97, 0.5, p).difference == pytest.approx(4.3 / np.sqrt(2))


def test_t_tests_of_other_repetitions_have_no_ratio(paper_study):
    asked = design(distributions=("uniform",), sizes=(10_000,), repetitions=12)
    results, *others = frames(asked)
    results["mean_lepp"] = 3.0485 + 0.0115 * stats.zscore(np.arange(12.0), ddof=1)
    tables = analyse(results, *others, asked)
    (row,) = scoreboard(tables, published_table=6, n_points=10_000, distribution="uniform").to_dict(
        "records"
    )
    assert row["verdict"] == "agrees"
    assert abs(row["difference"]) < 0.1
    assert np.isnan(row["log10_ratio"])


def test_numbers_are_printed_as_in_the_paper():
    printed = [number.printed for *_, number in published.coefficients()]
    assert printed[:5] == ["3.054", "7.535e-05", "3.049", "0.000205", "-6.19e-07"]
    assert published.Number(7, "x", -6.19e-7, 2, scientific=True).unit == pytest.approx(1e-9)
    assert published.table_4()[2][0].printed == "59971.50"


@pytest.mark.parametrize(
    ("printed", "corrected", "verdict"),
    [
        (7.5, "agrees", "misprint"),
        (7.5, "differs", "differs"),
        (0.15, "differs", "close"),
        (-0.15, "agrees", "misprint"),
    ],
)
def test_a_misprint_differs_only_as_it_is_printed(printed, corrected, verdict):
    judged = reproduction._misprint(
        judging.Judgement(0.1, 0.02, 0.0, corrected, ""), SimpleNamespace(value=printed)
    )
    assert judged.difference == pytest.approx((0.1 - printed) / 0.02)
    assert judged.verdict == verdict
