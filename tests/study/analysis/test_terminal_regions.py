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


def test_regions_are_counted_by_size(study):
    _, (results, _, regions, *_), tables = study
    table = of(tables["region_sizes"].frame).set_index("region_size")
    counts = of(regions).groupby("region_size")["count"].sum()
    assert table.index.tolist() == counts.index.tolist()
    assert table["count"].tolist() == counts.tolist()
    all_regions, all_triangles = of(results)["n_regions"].sum(), of(results)["n_triangles"].sum()
    np.testing.assert_allclose(table["share"], counts / all_regions)
    np.testing.assert_allclose(table["share_of_triangles"], counts * counts.index / all_triangles)
    # The error of a ratio of sums by the spread of its residuals (W. G. Cochran, 1977, eq. 2.39).
    by_task = of(regions).query("region_size == 2").set_index(["n_points", "replicate"])["count"]
    each = of(results).set_index(["n_points", "replicate"])["n_regions"]
    share = table.loc[2, "share"]
    residuals = by_task.reindex(each.index, fill_value=0) - share * each
    error = np.sqrt((residuals**2).sum() * len(each) / (len(each) - 1)) / each.sum()
    half = stats.t.ppf(0.975, len(each) - 1) * error
    assert table.loc[2, "share_low"] == pytest.approx(share - half)
    assert table.loc[2, "share_high"] == pytest.approx(share + half)
