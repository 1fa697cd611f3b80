"""Verdicts on the published numbers: by results that reproduce them, and by results that do not."""

import numpy as np
import pytest
from frames import design, frames
from scipy import stats

from study.analysis import analyse
from study.paper import judging, published


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


def test_every_published_number_is_there(paper_study):
    counts = scoreboard(paper_study[2])["published_table"].value_counts().to_dict()
    assert counts == {1: 16, 2: 4, 3: 8, 4: 80, 5: 4, 6: 16, 7: 9 + 8 + 1}


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


def test_f_statistics_are_judged_as_their_spread_is():
    rng = np.random.default_rng(1)
    means = np.linspace(0, 1.2, 8)[:, None]

    def f(count):
        draws = means + rng.normal(size=(count, 8, 20))
        within = draws.var(axis=2, ddof=1).mean(axis=1)
        return 20 * draws.mean(axis=2).var(axis=1, ddof=1) / within

    ours, theirs = f(1000), f(1000)
    z = [
        judging.of_f(a, published.Number(5, "F", b, 12), 7, 152).difference
        for a, b in zip(ours, theirs, strict=True)
    ]
    assert np.mean(z) == pytest.approx(0, abs=0.15)
    assert np.std(z) == pytest.approx(1, abs=0.1)


X = np.repeat(np.arange(1.0, 21), 10) - 10.5
DF = len(X) - 2


def regressions(rng, count):
    """Slope, its standard error, F and adjusted R squared of fits to the same x."""
    y = 0.1 * X + rng.normal(size=(count, len(X)))
    slope = y @ X / (X @ X)
    residual = ((y - y.mean(axis=1, keepdims=True) - slope[:, None] * X) ** 2).sum(axis=1) / DF
    total = y.var(axis=1, ddof=1)
    return zip(
        slope, np.sqrt(residual / (X @ X)), slope**2 * (X @ X) / residual, 1 - residual / total,
        strict=True,
    )  # fmt: skip


def number(value):
    return published.Number(7, "of a regression", value, 12, scientific=True)


@pytest.mark.parametrize("judged", ["coefficient", "adjusted R squared", "p"])
def test_regressions_are_judged_as_their_spread_is(judged):
    rng = np.random.default_rng(2)
    z = []
    for ours, theirs in zip(regressions(rng, 1000), regressions(rng, 1000), strict=True):
        (a, error, f, r2), (published_a, _, published_f, published_r2) = ours, theirs
        if judged == "coefficient":
            judgement = judging.of_coefficient(a, error, number(published_a))
        elif judged == "p":
            p, published_p = stats.f.sf([f, published_f], 1, DF)
            judgement = judging.of_regression_p(p, np.log10(p), f, number(published_p), 1, DF)
        else:
            judgement = judging.of_adjusted_r2(r2, f, number(published_r2), 1, DF)
        z.append(judgement.difference)
    assert np.mean(z) == pytest.approx(0, abs=0.15)
    assert np.std(z) == pytest.approx(1, abs=0.1)


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


def test_an_unnamed_p_is_plausible_unless_too_small():
    small, ordinary = (published.Number(1, "p", p, 4) for p in (0.0001, 0.6))
    assert judging.of_unnamed_p(0.5, small, 16, 0.05).verdict == "implausible draw"
    assert judging.of_unnamed_p(0.5, ordinary, 16, 0.05).verdict == "plausible draw"


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
