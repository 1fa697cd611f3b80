"""The group table by hand, and what the study lacks."""

import numpy as np
import pytest
from frames import design, failed, frames
from scipy import stats

from study.analysis.analyse import analyse


def test_every_cell_of_a_group_by_hand(study):
    asked, (results, *_), tables = study
    chosen = (results["method"] == "delaunay") & (results["distribution"] == "exponential")
    group = results[chosen & (results["n_points"] == 4000)]
    frame = tables["groups"].frame.set_index(["method", "distribution", "n_points"])
    row = frame.loc["delaunay", "exponential", 4000]
    means = sorted(group["mean_lepp"])
    assert row["triangulations"] == asked.repetitions == len(means)
    assert row["mean_lepp"] == pytest.approx(sum(means) / 6)
    sd = (sum((m - sum(means) / 6) ** 2 for m in means) / 5) ** 0.5
    assert row["sd_between"] == pytest.approx(sd)
    assert row["sd_within"] == pytest.approx(group["sd_lepp"].sum() / 6)
    interval = stats.ttest_1samp(means, 0).confidence_interval(0.95)
    assert (row["mean_low"], row["mean_high"]) == pytest.approx((interval.low, interval.high))
    assert row["max_lepp"] == max(group["max_lepp"])
    assert row["mean_max_lepp"] == pytest.approx(sum(group["max_lepp"]) / 6)
    assert abs(row["mean_max_lepp_rounded"] - row["mean_max_lepp"]) <= 0.5
    assert row["median"] == pytest.approx((means[2] + means[3]) / 2)
    assert (row["lowest"], row["highest"]) == (means[0], means[-1])
    assert row["q1"] == pytest.approx(means[1] + (means[2] - means[1]) / 4)


def test_overview_adds_up(study):
    asked, (results, *_), tables = study
    frame = tables["overview"].frame
    assert frame["triangulations"].sum() == len(results)
    assert frame["triangles"].sum() == results["n_triangles"].sum()
    assert frame["points"].sum() == results["n_points"].sum()
    assert set(frame["asked"]) == {len(asked.sizes) * asked.repetitions}


def test_failed_and_missing_tasks_are_counted_and_named():
    asked = design()
    results, *others = frames(asked)
    results = failed(results, [0, 1, 7]).drop(index=[2, 30])
    tables = analyse(results, *others, asked)
    groups = tables["groups"].frame.set_index(["distribution", "n_points"])
    assert groups.loc[("uniform", 1000), ["triangulations", "failed", "not_run"]].tolist() == [
        3,
        2,
        1,
    ]
    assert groups.loc[("uniform", 2000), ["triangulations", "failed", "not_run"]].tolist() == [
        5,
        1,
        0,
    ]
    missing = tables["missing"].frame
    why = missing.loc[missing["what"] == "triangulations", ["distribution", "why"]]
    assert "all points lie on one line" in why["why"].iloc[0]
    assert "3 of 24" in why["why"].iloc[0]
    assert why["distribution"].tolist() == ["uniform", "uniform", "exponential"]


def test_a_group_whose_tasks_all_failed_has_no_numbers():
    asked = design(distributions=("uniform",))
    results, *others = frames(asked)
    results = failed(results, range(6))
    row = analyse(results, *others, asked)["groups"].frame.iloc[0]
    assert (row["triangulations"], row["failed"]) == (0, 6)
    assert np.isnan(row["mean_lepp"])
    assert np.isnan(row["sd_between"])
