"""Shares of false alarms and uniformity of p-values."""

import numpy as np
import pytest
from frames import design, frames
from scipy import stats

from study.analysis.analyse import analyse


def test_points_of_several_methods_count_once(study):
    asked, _, tables = study
    frame = tables["randomness"].frame
    sets = len(asked.sizes) * asked.repetitions
    assert set(frame["tests"].iloc[:-1]) == {sets}
    assert frame["tests"].iloc[-1] == 8 * sets
    assert (frame["expected_below"] == 0.05 * frame["tests"]).all()


def test_share_and_interval_are_scipys(study):
    _, (*_, sets), tables = study
    row = (
        tables["randomness"]
        .frame.query("distribution == 'exponential' and coordinate == 'y'")
        .iloc[1]
    )
    assert row["test"] == "Kolmogorov-Smirnov"
    p = sets.loc[sets["distribution"] == "exponential", "ks_p_y"].to_numpy()
    below = sum(p < 0.05)
    interval = stats.binomtest(int(below), len(p)).proportion_ci(0.95, method="exact")
    assert row["below"] == below
    assert (row["share_low"], row["share_high"]) == pytest.approx((interval.low, interval.high))
    # Kolmogorov-Smirnov distance by hand
    ordered = np.sort(p)
    steps = np.arange(len(p) + 1) / len(p)
    assert row["uniform_d"] == pytest.approx(
        max((steps[1:] - ordered).max(), (ordered - steps[:-1]).max())
    )
    assert row["lowest_p"] == ordered[0]


def test_too_many_small_p_values_are_rejected():
    asked = design(repetitions=30)
    *others, sets = frames(asked)
    sets.loc[sets["distribution"] == "uniform", "runs_p_x"] **= 4
    frame = analyse(*others, sets, asked)["randomness"].frame.set_index(
        ["distribution", "test", "coordinate"]
    )
    assert frame.loc[("uniform", "runs", "x"), "verdict"] == "rejected"
    assert frame.loc[("uniform", "runs", "x"), "uniform_p"] < 1e-6
    assert frame.loc[("uniform", "runs", "y"), "verdict"] == "not rejected"


def test_histogram_counts_every_p_value(study):
    frame = study[2]["uniformity"].frame
    grouped = frame.groupby(["distribution", "test", "coordinate"])
    assert (grouped["count"].sum() == grouped["expected"].sum()).all()
    assert (frame["p_to"] - frame["p_from"]).to_numpy() == pytest.approx(0.05)
