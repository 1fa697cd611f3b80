"""The distributions against each other, by other libraries, simulation, and at each limit."""

from itertools import combinations

import numpy as np
import pandas as pd
import pytest
from frames import design, frames
from scipy import stats
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.weightstats import CompareMeans, DescrStatsW

from lepp import INTERIOR_LAYER
from study.analysis.analyse import analyse
from study.analysis.distribution_comparison import compared, equivalent, verdict

THREE = design(
    methods=("incremental", "delaunay"),
    distributions=("uniform", "normal", "exponential"),
    sizes=(1000, 4000),
)


@pytest.fixture(scope="module")
def run():
    made = frames(THREE)
    return made, analyse(*made, THREE)


def of(frame, method, distribution, n):
    """Rows of one group."""
    keys = (frame["method"] == method) & (frame["distribution"] == distribution)
    return frame[keys & (frame["n_points"] == n)]


def test_pairs_are_welch_tests_with_holm(run):
    (results, *_), tables = run
    frame = tables["distributions"].frame
    assert len(frame[frame["part"] == "whole"]) == 2 * 2 * 3
    for row in frame[frame["part"] == "whole"].itertuples():
        one, two = (
            of(results, row.method, name, row.n_points)["mean_lepp"]
            for name in (row.distribution_1, row.distribution_2)
        )
        means = CompareMeans(DescrStatsW(two), DescrStatsW(one))
        t, p, df = means.ttest_ind(usevar="unequal")
        assert (row.t, row.p, row.df) == pytest.approx((t, p, df))
        assert 10**row.log10_p == pytest.approx(p)
        assert row.difference == pytest.approx(two.mean() - one.mean())
        assert row.relative == pytest.approx(two.mean() / one.mean() - 1)
        # the reference is hardly uncertain: the difference's interval over the first mean
        low, high = means.tconfint_diff(usevar="unequal")
        expected = (low / one.mean(), high / one.mean())
        assert (row.low, row.high) == pytest.approx(expected, abs=0.02 * (high - low))
    for _, family in frame.groupby(["method", "part"]):
        adjusted = multipletests(family["p"], method="holm")[1]
        assert family["p_holm"].to_numpy() == pytest.approx(adjusted)


def test_the_first_distribution_is_the_first_of_its_pairs(run):
    frame = run[1]["distributions"].frame
    pairs = frame[["distribution_1", "distribution_2"]].drop_duplicates()
    assert list(pairs.itertuples(index=False, name=None)) == list(
        combinations(THREE.distributions, 2)
    )


def test_interiors_are_compared_where_there_are_some(run):
    (_, _, _, layers, _), tables = run
    frame = tables["part_means"].frame.query("part == 'interior'")
    inside = layers[layers["layer"] == INTERIOR_LAYER]
    assert len(frame) == len(inside.groupby(["method", "distribution", "n_points"]))
    for row in frame.itertuples():
        rows = of(inside, row.method, row.distribution, row.n_points)
        means = rows.groupby("replicate").apply(
            lambda g: np.average(g["lepp_size"], weights=g["count"]), include_groups=False
        )
        assert row.mean_lepp == pytest.approx(means.mean())
        assert row.triangulations == len(means)
        low, high = stats.t.interval(0.95, len(means) - 1, means.mean(), stats.sem(means))
        assert (row.low, row.high) == pytest.approx((low, high))
    compared_sizes = set(tables["distributions"].frame.query("part == 'interior'")["n_points"])
    assert compared_sizes == set(frame["n_points"])


def test_intervals_of_relative_differences_cover():
    # three values against twelve, of which the first mean is known to a tenth only
    rng = np.random.default_rng(0)
    true = 2.6 / 3.0 - 1
    inside = []
    for _ in range(1500):
        row = compared(rng.normal(3.0, 0.5, 8), rng.normal(2.6, 0.15, 20))
        inside.append(row["low"] <= true <= row["high"])
    assert np.mean(inside) == pytest.approx(0.95, abs=0.02)


@pytest.mark.parametrize(
    ("low", "high", "p", "expected"),
    [
        (-0.0099, 0.0099, 0.05, "alike"),
        (-0.0099, 0.0099, 0.0499, "differ little"),
        (0.002, 0.0101, 0.0499, "differ"),
        (0.002, 0.0101, 0.05, "undecided"),
        (-0.0101, 0.002, 0.9, "undecided"),
        (-0.0101, -0.002, 0.001, "differ"),
        (0.011, 0.02, 0.001, "differ"),
    ],
)
def test_verdicts(low, high, p, expected):
    assert verdict(low, high, p) == expected


@pytest.mark.parametrize(
    ("intervals", "expected"),
    [
        ([(-0.0099, 0.0099), (0.001, 0.002)], "yes"),
        ([(-0.0099, 0.0101), (0.001, 0.002)], "undecided"),
        ([(-0.0101, 0.0099), (0.001, 0.002)], "undecided"),
        ([(0.0099, 0.02), (0.001, 0.002)], "undecided"),
        ([(0.0101, 0.02), (0.001, 0.002)], "no"),
        ([(-0.02, -0.0101), (-0.02, 0.02)], "no"),
    ],
)
def test_equivalence_is_by_intervals(intervals, expected):
    low, high = np.array(intervals).T
    assert equivalent(low, high) == expected


def of_means(shift, sd=0.002):
    """The tables of a run of which the second distribution's means are a share larger."""
    asked = design(distributions=("uniform", "exponential"), sizes=(1000, 4000), repetitions=12)
    results, *others = frames(asked)
    scores = stats.zscore(np.arange(12.0), ddof=1)
    factor = 1 + shift * (results["distribution"] == "exponential")
    results["mean_lepp"] = factor * (3 + sd * scores[results["replicate"]])
    return analyse(results, *others, asked)


@pytest.mark.parametrize(
    ("shift", "sd", "pair", "holds"),
    [
        (0.0, 0.002, "alike", "yes"),
        (0.005, 0.002, "differ little", "yes"),
        (-0.005, 0.002, "differ little", "yes"),
        (0.02, 0.002, "differ", "no"),
        (0.0, 0.2, "undecided", "undecided"),
        (0.0095, 0.002, "differ", "undecided"),
    ],
)
def test_each_distribution_is_summed_up(shift, sd, pair, holds):
    tables = of_means(shift, sd)
    frame = tables["distributions"].frame.query("part == 'whole'")
    assert set(frame["verdict"]) == {pair}
    for row in tables["analogous"].frame.query("part == 'whole'").to_dict("records"):
        assert row["comparisons"] == 2
        assert row[pair.replace(" ", "_")] == 2 if pair != "undecided" else row["undecided"] == 2
        assert row["equivalent"] == holds
        assert row["furthest"] == pytest.approx(abs(shift), abs=1e-9)
        assert {row["distribution"], row["furthest_from"]} == {"uniform", "exponential"}
    said = tables["statements"].frame
    stated = said.loc[said["statement"].str.contains("analogous"), "holds"]
    assert set(stated) == {holds}


def test_one_distribution_has_nothing_to_compare():
    asked = design(distributions=("uniform",))
    tables = analyse(*frames(asked), asked)
    assert tables["distributions"].frame.empty
    assert tables["analogous"].frame.empty
    said = tables["statements"].frame
    assert set(said.loc[said["statement"].str.contains("analogous"), "holds"]) == {"not tested"}


def test_a_size_that_one_distribution_lacks_is_left_out():
    results, *others = frames(THREE)
    lost = (results["distribution"] == "normal") & (results["n_points"] == 1000)
    tables = analyse(results[~lost].reset_index(drop=True), *others, THREE)
    frame = tables["distributions"].frame.query("part == 'whole' and method == 'delaunay'")
    assert frame["n_points"].value_counts().to_dict() == {1000: 1, 4000: 3}
    assert isinstance(frame, pd.DataFrame)
