"""Means of parts and layers, the longest paths, and the distributions, counted by hand."""

import numpy as np
import pandas as pd
import pytest
from frames import design, frames
from scipy import stats
from statsmodels.stats.multitest import multipletests

from lepp import INTERIOR_LAYER
from study.analysis.analyse import analyse
from study.analysis.measurements import Measurements
from study.statistics.homogeneity import homogeneity
from study.statistics.size_means import SizeMeans


@pytest.fixture(scope="module")
def run():
    asked = design(methods=("incremental",), sizes=(1000, 2000, 4000, 8000, 16000))
    made = frames(asked)
    return asked, made, analyse(*made, asked)


def of_uniform(frame, **where):
    for column, value in {"distribution": "uniform", **where}.items():
        frame = frame[frame[column] == value]
    return frame


def test_means_of_the_parts(run):
    _, (results, _, _, layers, _), tables = run
    rows = of_uniform(tables["part_means"].frame).set_index(["part", "n_points"])
    whole = of_uniform(results, n_points=2000)["mean_lepp"]
    assert rows.loc[("whole", 2000), "mean_lepp"] == pytest.approx(whole.mean())
    assert rows.loc[("whole", 2000), "share"] == 1
    counts = of_uniform(layers, n_points=2000)
    inside = counts[counts["layer"] == INTERIOR_LAYER]
    means = [
        np.average(one["lepp_size"], weights=one["count"]) for _, one in inside.groupby("replicate")
    ]
    row = rows.loc[("interior", 2000)]
    assert row["mean_lepp"] == pytest.approx(np.mean(means))
    assert row["triangulations"] == 6
    half = 2.570582 * np.std(means, ddof=1) / 6**0.5
    assert (row["low"], row["high"]) == pytest.approx(
        (np.mean(means) - half, np.mean(means) + half)
    )
    assert row["share"] == pytest.approx(inside["count"].sum() / counts["count"].sum())


def test_layers_are_tested_against_the_interior(run):
    _, _, tables = run
    table = of_uniform(tables["layer_means"].frame)
    seen = set()
    for _, rows in table.groupby("n_points"):
        inside, edge = rows.iloc[-1], rows.iloc[:-1]
        t = (edge["mean_lepp"] - inside["mean_lepp"]) / np.hypot(
            edge["standard_error"], inside["standard_error"]
        )
        rejected, *_ = multipletests(2 * stats.t.sf(t.abs(), 5), method="holm")
        sides = np.where(t > 0, "above", "below")
        expected = np.where(rejected, sides, "not shown").tolist()
        assert edge["against_interior"].tolist() == expected
        assert pd.isna(inside["against_interior"])
        seen |= set(expected)
    assert "not shown" in seen


def test_a_layer_far_from_the_interior_is_above_or_below_it(run):
    asked, (results, histograms, regions, layers, sets), _ = run
    moved = layers.copy()
    moved.loc[moved["layer"] == 0, "lepp_size"] += 3
    tables = analyse(results, histograms, regions, moved, sets, asked)
    rows = of_uniform(tables["layer_means"].frame, n_points=4000).set_index("layer")
    assert rows.loc[0, "against_interior"] == "above"
    moved.loc[moved["layer"] == INTERIOR_LAYER, "lepp_size"] += 9
    tables = analyse(results, histograms, regions, moved, sets, asked)
    rows = of_uniform(tables["layer_means"].frame, n_points=4000).set_index("layer")
    assert rows["against_interior"].tolist()[:2] == ["below", "below"]


def test_means_of_the_layers(run):
    _, (_, _, _, layers, _), tables = run
    table = of_uniform(tables["layer_means"].frame)
    assert sorted(set(table["n_points"])) == [1000, 4000, 16000]
    rows = table[table["n_points"] == 4000].set_index("layer")
    assert list(rows.index) == [0, 1, INTERIOR_LAYER]
    assert rows["share"].sum() == pytest.approx(1)
    counts = of_uniform(layers, n_points=4000, layer=1)
    mean = np.average(counts["lepp_size"], weights=counts["count"])
    assert rows.loc[1, "mean_lepp"] == pytest.approx(mean)
    assert rows.loc[1, "max_lepp"] == counts["lepp_size"].max()
    # the ratio's linearised error, by the residuals of the sums
    sums = counts.assign(t=counts["lepp_size"] * counts["count"]).groupby("replicate")[
        ["t", "count"]
    ].sum()  # fmt: skip
    residuals = sums["t"] - mean * sums["count"]
    error = np.sqrt(6 / 5 * (residuals**2).sum()) / sums["count"].sum()
    assert rows.loc[1, "standard_error"] == pytest.approx(error)


def test_the_longest_paths_are_those_of_the_largest_size(run):
    _, (_, _, _, layers, _), tables = run
    rows = of_uniform(tables["longest_paths"].frame).set_index("lepp_size")
    assert set(rows["n_points"]) == {16000}
    counts = of_uniform(layers, n_points=16000)
    for size in (1, 3, rows.index.max()):
        long = counts[counts["lepp_size"] >= size]
        inside = long.loc[long["layer"] == INTERIOR_LAYER, "count"].sum()
        assert rows.loc[size, "paths"] == long["count"].sum()
        assert rows.loc[size, "interior_paths"] == inside
        assert rows.loc[size, "edge_share"] == pytest.approx(1 - inside / long["count"].sum())
        assert rows.loc[size, "layer"] == long.groupby("layer")["count"].sum().idxmax()
    assert rows["edge_triangles"].nunique() == 1
    assert rows["edge_triangles"].iloc[0] == rows.loc[1, "edge_share"]


def test_whether_distributions_have_one_mean(run):
    asked, made, tables = run
    frame = tables["common_means"].frame
    row = frame[(frame["part"] == "whole") & (frame["n_points"] == 4000)].iloc[0]
    data = Measurements.of(*made, asked)
    means = [SizeMeans.of(data.groups("incremental", one)) for one in asked.distributions]
    place = 2
    found = homogeneity(
        np.array([one.means[place] for one in means]),
        np.array([one.variances[place] for one in means]),
        sum(one.df for one in means),
    )
    assert row["p"] == pytest.approx(found.score.p)
    assert row["mean_lepp"] == pytest.approx(found.mean)
    values = {name: one.means[place] for name, one in zip(asked.distributions, means, strict=True)}
    assert row["largest_difference"] == pytest.approx(np.ptp(list(values.values())))
    assert row["lowest"] == min(values, key=values.get)
    assert row["highest"] == max(values, key=values.get)
    assert row["distributions"] == 2


def test_distributions_that_differ_are_told_from_those_that_do_not():
    asked = design(methods=("incremental",))
    results, *others = frames(asked)
    rng = np.random.default_rng(5)
    same = results.assign(mean_lepp=3 + rng.normal(0, 0.01, len(results)))
    apart = same.assign(
        mean_lepp=same["mean_lepp"] + 0.05 * (same["distribution"] == "exponential")
    )
    for changed, verdict in ((same, "not rejected"), (apart, "rejected")):
        frame = analyse(changed, *others, asked)["common_means"].frame
        whole = frame[frame["part"] == "whole"]
        assert set(whole["one_mean"]) == {verdict}
    one = design(methods=("incremental",), distributions=("uniform",))
    assert analyse(*frames(one), one)["common_means"].frame.empty


def test_meshes_without_an_interior():
    asked = design(methods=("incremental",), distributions=("uniform",))
    results, histograms, regions, layers, sets = frames(asked)
    edge = layers[layers["layer"] != INTERIOR_LAYER]
    tables = analyse(results, histograms, regions, edge, sets, asked)
    assert set(tables["part_means"].frame["part"]) == {"whole"}
    assert (tables["longest_paths"].frame["interior_paths"] == 0).all()
    assert set(tables["limit_evidence"].frame["part"]) == {"whole"}
    assert not tables["missing"].frame["what"].str.contains("interior").any()
    assert isinstance(tables["limits"].frame, pd.DataFrame)


@pytest.mark.parametrize(("repetitions", "tested"), [(1, False), (2, True)])
def test_two_triangulations_suffice_to_hold_layers_against_the_interior(repetitions, tested):
    asked = design(methods=("incremental",), sizes=(1000,), repetitions=repetitions)
    table = of_uniform(analyse(*frames(asked), asked)["layer_means"].frame)
    assert table["against_interior"].iloc[:-1].notna().tolist() == [tested] * (len(table) - 1)
    assert pd.isna(table["against_interior"].iloc[-1])
