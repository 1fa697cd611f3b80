"""Terminal edges and their regions, against scipy's intervals and sums by hand."""

import numpy as np
import pytest
from scipy import stats

KEY = {"method": "delaunay", "distribution": "exponential"}


def of(frame):
    return frame[(frame["method"] == KEY["method"]) & (frame["distribution"] == "exponential")]


def test_means_of_triangulations_have_t_intervals(study):
    _, (results, *_), tables = study
    table = of(tables["regions"].frame)
    assert table["n_points"].tolist() == [1000, 2000, 4000, 8000]
    for row, (_, group) in zip(
        table.to_dict("records"), of(results).groupby("n_points"), strict=True
    ):
        m, edges = group["n_triangles"], group["n_regions"]
        assert row["triangulations"] == 6
        for values, names in (
            (edges / m, ("edges_per_triangle", "edges_low", "edges_high")),
            (group["n_type_c"] / m, ("pair_share", "pair_low", "pair_high")),
            (m / edges, ("mean_region", "mean_region_low", "mean_region_high")),
        ):
            ends = stats.t.interval(0.95, 5, values.mean(), stats.sem(values))
            np.testing.assert_allclose([row[name] for name in names], [values.mean(), *ends])
        assert row["mean_max_region"] == pytest.approx(group["max_region"].mean())
        assert row["max_region"] == group["max_region"].max()


def test_region_sizes_hold_every_triangle(study):
    _, (results, *_), tables = study
    frame = tables["region_sizes"].frame
    for (method, distribution), found in frame.groupby(["method", "distribution"]):
        rows = results[(results["method"] == method) & (results["distribution"] == distribution)]
        assert found["count"].sum() == rows["n_regions"].sum()
        assert (found["count"] * found["region_size"]).sum() == rows["n_triangles"].sum()
        assert found["share"].sum() == pytest.approx(1)
        share = found["count"] * found["region_size"] / rows["n_triangles"].sum()
        assert found["share_of_triangles"].to_numpy() == pytest.approx(share.to_numpy())


def test_intervals_of_region_sizes_are_those_of_a_jackknife(study):
    """A share is a ratio of sums: leave out one triangulation after the other."""
    _, (_, _, regions, _, _), tables = study
    one = {"method": "delaunay", "distribution": "uniform"}
    rows = tables["region_sizes"].rows(**one).frame.set_index("region_size")
    of_one = regions[(regions["method"] == "delaunay") & (regions["distribution"] == "uniform")]
    tasks = of_one.groupby(["n_points", "replicate"])
    for size in (2, 3):
        counts = np.array(
            [task.loc[task["region_size"] == size, "count"].sum() for _, task in tasks]
        )
        totals = tasks["count"].sum().to_numpy()
        left_out = (counts.sum() - counts) / (totals.sum() - totals)
        r = len(totals)
        error = np.sqrt((r - 1) / r * ((left_out - left_out.mean()) ** 2).sum())
        half = stats.t.ppf(0.975, r - 1) * error
        row = rows.loc[size]
        assert (row["share_low"] + row["share_high"]) / 2 == pytest.approx(row["share"])
        assert row["share_high"] - row["share"] == pytest.approx(half, rel=0.05)
