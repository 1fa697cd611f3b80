"""Methods on the same points, and the paper's statements."""

import numpy as np
import pandas as pd
import pytest
from frames import design, failed, frames
from scipy import stats
from statsmodels.regression.linear_model import OLS

from study.analysis.analyse import analyse
from study.analysis.building import Study
from study.analysis.measurements import Measurements
from study.analysis.method_comparison import _difference, _paired
from study.analysis.table import Tables


def test_differences_are_paired_t_tests(study):
    _, (results, *_), tables = study
    frame = tables["methods"].frame
    assert len(frame) == 2 * 4 * 6
    for row in frame[frame["quantity"] == "mean LEPP"].itertuples():
        group = results[
            (results["distribution"] == row.distribution) & (results["n_points"] == row.n_points)
        ].sort_values("replicate")
        by_method = {
            method: found["mean_lepp"].to_numpy() for method, found in group.groupby("method")
        }
        one, two = by_method["incremental"], by_method["delaunay"]
        expected = stats.ttest_rel(two, one)
        interval = expected.confidence_interval(0.95)
        assert row.difference == pytest.approx(two.mean() - one.mean())
        assert (row.low, row.high) == pytest.approx((interval.low, interval.high))
        assert (row.t, row.df) == pytest.approx((expected.statistic, expected.df))
        assert row.p == pytest.approx(expected.pvalue)
        assert 10**row.log10_p == pytest.approx(expected.pvalue)
        assert row.correlation == pytest.approx(stats.pearsonr(one, two).statistic)


def test_point_sets_that_one_method_failed_on_are_left_out():
    asked = design(methods=("incremental", "delaunay"), distributions=("uniform",))
    results, *others = frames(asked)
    frame = analyse(failed(results, [0]), *others, asked)["methods"].frame
    assert frame.groupby("n_points")["pairs"].max().tolist() == [5, 6, 6, 6]


@pytest.mark.parametrize("name", ["another", "zigzag"])
def test_all_methods_are_held_against_the_reference_whatever_their_names(name):
    asked = design(methods=("incremental", "delaunay"), distributions=("uniform",))
    results, *others = frames(asked)
    third = [frame.assign(method=name) for frame in (results, *others[:-1])]
    made = [
        pd.concat(pair, ignore_index=True)
        for pair in zip((results, *others[:-1]), third, strict=True)
    ]
    wider = asked.model_copy(update={"methods": (*asked.methods, name)})
    study = Study(Measurements.of(*made, others[-1], wider), Tables())
    assert [(first, second) for _, first, second, _ in _paired(study)] == [
        ("incremental", "delaunay"),
        ("incremental", name),
    ]


@pytest.mark.parametrize("constant", [0, 1])
def test_what_does_not_vary_has_no_correlation(constant):
    pair = [np.array([1.0, 2.0, 4.0]), np.array([3.0, 7.0, 8.0])]
    assert "correlation" in _difference(*pair)
    pair[constant] = np.full(3, 5.0)
    assert "correlation" not in _difference(*pair)


def test_one_method_has_nothing_to_compare():
    asked = design()
    tables = analyse(*frames(asked), asked)
    assert tables["methods"].frame.empty
    assert tables["growth"].frame.empty


def test_growth_is_the_slope_of_the_differences(study):
    _, (results, *_), tables = study
    wide = results.query("distribution == 'uniform'").pivot(
        index=["n_points", "replicate"], columns="method", values="mean_lepp"
    )
    x = np.log2(wide.index.get_level_values("n_points").to_numpy() / 1000)
    slopes = {name: np.polyfit(x, wide[name], 1)[0] for name in wide}
    row = tables["growth"].frame.iloc[0]
    assert row["slope_1"] == pytest.approx(slopes["incremental"])
    assert row["slope_2"] == pytest.approx(slopes["delaunay"])
    assert row["difference"] == pytest.approx(slopes["delaunay"] - slopes["incremental"])
    # HC3 by its formula
    X = np.column_stack([np.ones_like(x), x])
    fit = OLS((wide["delaunay"] - wide["incremental"]).to_numpy(), X).fit()
    inverse = np.linalg.inv(X.T @ X)
    leverage = np.einsum("ij,jk,ik->i", X, inverse, X)
    meat = X.T @ (X * ((fit.resid / (1 - leverage)) ** 2)[:, None])
    error = np.sqrt((inverse @ meat @ inverse)[1, 1])
    half = stats.t.isf(0.025, len(x) - 2) * error
    assert row["high"] - row["low"] == pytest.approx(2 * half)


def holds(tables, method, statement):
    frame = tables["statements"].frame
    chosen = (frame["method"] == method) & frame["statement"].str.contains(statement, regex=False)
    (verdict,) = set(frame.loc[chosen & (frame["distribution"] == "uniform"), "holds"])
    return verdict


def test_statements_are_judged_for_each_method(study):
    tables = study[2]
    assert holds(tables, "incremental", "at least 1/3") == "yes"
    assert holds(tables, "delaunay", "at least 1/3") == "no"
    assert holds(tables, "incremental", "between 2 and 4") == "yes"
    assert holds(tables, "delaunay", "between 2 and 4") == "no"
    assert holds(tables, "incremental", "below 4 and above 2") == "yes"
    assert holds(tables, "delaunay", "below 4 and above 2") == "no"
    # sizes were drawn from a geometric law
    assert holds(tables, "incremental", "Every step of a path") == "not rejected"


def test_published_means_bear_out_the_published_statements(paper_study):
    tables = paper_study[2]
    for statement in (
        "means of the groups differ",
        "variances of the groups differ",
        "upward trend with the number of points",
        "varies less from mesh to mesh",
        "logarithmic one has the highest",
        "below 4 and above 2",
    ):
        assert holds(tables, "incremental", statement) == "yes", statement
    assert holds(tables, "incremental", "group are nearly normal") == "not rejected"


def test_unequal_termination_rates_are_seen():
    asked = design(distributions=("uniform",), sizes=(8000, 16000), repetitions=10)
    results, histograms, regions, layers, point_sets = frames(asked)
    # every tenth path of size 2 goes on to size 3
    counts = histograms.pivot_table(
        index=["n_points", "replicate"], columns="lepp_size", values="count"
    )
    moved = (counts[2] // 10).rename("moved").reset_index()
    changed = histograms.merge(moved, on=["n_points", "replicate"])
    changed.loc[changed["lepp_size"] == 2, "count"] -= changed["moved"]
    changed.loc[changed["lepp_size"] == 3, "count"] += changed["moved"]
    histograms = changed.drop(columns="moved")
    no_interior = layers.iloc[:0]
    tables = analyse(results, histograms, regions, no_interior, point_sets, asked)
    assert holds(tables, "incremental", "Every step of a path") == "no"
