"""Theorems 1 and 2 against meshes whose law is known."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from frames import design, frames
from numba import config
from scipy import stats
from test_group_assumptions import values_of

from lepp import LeppCounts
from study.analysis import worst_case_strip
from study.analysis.analyse import analyse
from study.analysis.building import Study

#: The strips of the page; as plain Python the largest take too long.
STRIPS = worst_case_strip._SIZES


def test_shares_of_types_by_hand(study):
    _, (results, *_), tables = study
    frame = tables["neighbor_types"].frame.set_index(["method", "distribution", "n_points", "type"])
    chosen = results.query(
        "method == 'delaunay' and distribution == 'uniform' and n_points == 2000"
    )
    for name in "ABC":
        shares = chosen[f"n_type_{name.lower()}"] / chosen["n_interior_longest"]
        row = frame.loc["delaunay", "uniform", 2000, name]
        interval = stats.ttest_1samp(shares, 0).confidence_interval(0.95)
        assert row["share"] == pytest.approx(shares.mean())
        assert (row["low"], row["high"]) == pytest.approx((interval.low, interval.high))
    by_group = tables["neighbor_types"].frame.groupby(["method", "distribution", "n_points"])
    assert by_group["share"].sum().to_numpy() == pytest.approx(1)


def geometric(p):
    """Moments of the geometric law, which in scipy starts at 1; LEPP sizes start at 2."""
    mean, variance, skewness, kurtosis = map(float, stats.geom(p, loc=1).stats("mvsk"))
    return {
        "mean": mean,
        "standard deviation": variance**0.5,
        "skewness": skewness,
        "excess kurtosis": kurtosis,
    }


def test_predicted_moments_are_the_geometric_laws(study):
    frame = study[2]["theorem_1"].frame
    for row in frame.itertuples():
        expected = geometric(row.p_type_c)[row.statistic]
        assert row.predicted == pytest.approx(expected)
        assert row.relative_difference == pytest.approx(row.measured / expected - 1)


def test_measured_moments_of_a_geometric_mesh_are_predicted(study):
    frame = study[2]["theorem_1"].frame.query("n_points == 8000")
    means = frame[frame["statistic"] == "mean"]
    assert means["relative_difference"].abs().max() < 0.02


def test_moments_with_p_of_all_steps(study):
    frame = study[2]["theorem_1"].frame
    means = frame[frame["statistic"] == "mean"]
    assert means["difference_all_steps"].to_numpy() == pytest.approx(0, abs=1e-12)
    for row in frame.itertuples():
        expected = geometric(row.p_all_steps)[row.statistic]
        assert row.predicted_all_steps == pytest.approx(expected)
        assert row.difference_all_steps == pytest.approx(row.measured / expected - 1)


def law_of(ends):
    """Mean and variance of sizes from 2 on that end with these chances, then with the last."""
    tail = np.full(400, ends[-1])
    ends = np.concatenate([ends, tail])
    share = np.concatenate([[1], np.cumprod(1 - ends)])[:-1] * ends
    sizes = np.arange(2, 2 + len(share))
    mean = (share * sizes).sum()
    return mean, (share * sizes**2).sum() - mean**2


def test_bounds_follow_from_every_step_of_a_third_and_more():
    rng = np.random.default_rng(8)
    least = 1 / 3
    for _ in range(500):
        more = rng.beta(0.3, 0.7, 30) * rng.integers(0, 2, 30)
        mean, variance = law_of(np.append(least + (1 - least) * more, least))
        assert mean <= 4 + 1e-9
        assert variance <= 6 + 1e-9
    assert law_of(np.array([least])) == pytest.approx((4, 6))
    below = law_of(np.array([0.3, least]))
    assert below[0] > 4


def test_bounds_do_not_need_a_first_step_of_a_third():
    mean, variance = law_of(np.array([0.30, 0.4]))
    assert mean < 4
    assert variance < 6


def counted(rates, *, paths=200_000, replicates=6, seed=3):
    """Results and histograms of one size, of paths that end with these rates and then the last."""
    asked = design(distributions=("uniform",), sizes=(1000,), repetitions=replicates)
    results, _, *others = frames(asked)
    ends = np.append(rates, np.full(60, rates[-1]))
    share = np.concatenate([[1], np.cumprod(1 - ends)])
    share[:-1] *= ends
    rng = np.random.default_rng(seed)
    rows = [
        {"method": "incremental", "distribution": "uniform", "n_points": 1000,
         "replicate": replicate, "lepp_size": 2 + k, "count": int(count)}
        for replicate in range(replicates)
        for k, count in enumerate(rng.multinomial(paths, share))
        if count
    ]  # fmt: skip
    return analyse(results, pd.DataFrame(rows), *others, asked)


@pytest.mark.parametrize(
    ("rates", "premise", "lowest"),
    [
        ([0.4, 0.45, 0.5], "yes", 2),
        ([0.5, 0.45, 0.36, 0.5], "yes", 4),
        ([0.3, 0.45, 0.5], "no", 2),
        ([0.4, 0.45, 0.3, 0.5], "no", 4),
        ([0.4, 1 / 3, 0.5], "undecided", 3),
    ],
)
def test_premise_is_judged_by_every_step(rates, premise, lowest):
    (row,) = counted(rates)["theorem_2"].frame.itertuples()
    assert row.premise == premise
    assert row.lowest_size == lowest
    assert row.lowest_low <= rates[lowest - 2] <= row.lowest_high
    assert row.lowest_rate == pytest.approx(rates[lowest - 2], abs=0.005)
    assert row.upto_size >= 5


def test_premise_stays_open_where_no_rate_is_known_well():
    rough = counted([0.4, 0.5], paths=100)["theorem_2"].frame
    assert rough["premise"].tolist() == ["undecided"]
    assert rough["upto_size"].isna().all()
    single = counted([0.4, 0.5], replicates=1)["theorem_2"].frame
    assert single["premise"].tolist() == ["undecided"]


def test_least_chance_to_end_is_scipys(study):
    _, (_, histograms, *_), tables = study
    frame = tables["theorem_2"].frame
    row = frame.query("method == 'delaunay' and distribution == 'uniform' and n_points == 8000")
    counts = histograms.query(
        "method == 'delaunay' and distribution == 'uniform' and n_points == 8000"
    ).pivot_table(index="replicate", columns="lepp_size", values="count", fill_value=0)
    k = row["lowest_size"].iloc[0]
    reached = counts[[c for c in counts if c >= k]].sum(axis=1)
    rate = counts[k].sum() / reached.sum()
    assert row["lowest_rate"].iloc[0] == pytest.approx(rate)
    assert rate == min(
        counts[j].sum() / counts[[c for c in counts if c >= j]].sum().sum()
        for j in range(2, row["upto_size"].iloc[0] + 1)
    )
    assert row["lowest_low"].iloc[0] < rate < row["lowest_high"].iloc[0]


def test_bounds_need_every_triangulation():
    asked = design(distributions=("uniform",))
    results, *others = frames(asked)
    results.loc[0, "mean_lepp"] = 4.01
    results.loc[7, "sd_lepp"] = 2.46
    tables = analyse(results, *others, asked)
    stated = tables["statements"].frame.set_index("statement")["holds"]
    assert stated["The mean LEPP size is between 2 and 4"] == "no"
    assert stated["The standard deviation is at most √6"] == "no"
    frame = tables["theorem_2"].frame
    assert frame["bounds"].tolist() == ["no", "no", "yes", "yes"]
    assert frame["mean_inside"].tolist() == [5, 6, 6, 6]
    assert frame["sd_inside"].tolist() == [6, 5, 6, 6]


def pooled(histograms, method, distribution):
    chosen = histograms.query("method == @method and distribution == @distribution")
    return chosen.groupby("lepp_size")["count"].sum()


def test_termination_rates_are_those_of_the_pooled_histogram(study):
    _, (_, histograms, *_), tables = study
    counts = pooled(histograms, "delaunay", "uniform")
    dense = counts.reindex(range(counts.index.max() + 1), fill_value=0).to_numpy()
    frame = tables["termination"].frame.query("method == 'delaunay' and distribution == 'uniform'")
    rates = LeppCounts(dense).termination_rates
    np.testing.assert_allclose(frame["rate"], rates[1:])
    assert frame["lepp_size"].tolist() == list(range(1, len(dense)))
    assert frame["reached"].iloc[0] == dense.sum()


def test_law_is_the_share_beside_the_geometric(study):
    _, (results, histograms, *_), tables = study
    frame = tables["law"].frame.query("method == 'incremental' and distribution == 'uniform'")
    counts = pooled(histograms, "incremental", "uniform")
    rows = results.query("method == 'incremental' and distribution == 'uniform'")
    p = rows["n_type_c"].sum() / rows["n_interior_longest"].sum()
    seen = frame.set_index("lepp_size")
    assert seen["count"].sum() == counts.sum() == rows["n_triangles"].sum()
    for size, count in counts.items():
        assert seen.loc[size, "share"] == pytest.approx(count / counts.sum())
        expected = (1 - p) ** (size - 2) * p if size > 1 else 0
        assert seen.loc[size, "geometric_share"] == pytest.approx(expected)


def test_worst_case_is_equation_1(monkeypatch):
    assert STRIPS[-1] == 10**6
    made = STRIPS[:-2] if config.DISABLE_JIT else STRIPS
    monkeypatch.setattr(worst_case_strip, "_SIZES", made)
    (table,) = worst_case_strip.worst_case.make(Study(SimpleNamespace()))
    frame = table.frame
    assert tuple(frame["n_triangles"]) == made
    assert (frame["mean_lepp"] == (frame["n_triangles"] + 1) / 2).all()
    assert (frame["max_lepp"] == frame["n_triangles"]).all()
    assert set(frame["equal"]) == {"yes"}


def test_groups_are_not_mixed(study):
    _, (results, *_), tables = study
    frame = tables["theorem_1"].frame.query("statistic == 'mean'")
    for row in frame.itertuples():
        values = values_of(results, row.method, row.distribution)[row.n_points]
        assert row.measured == pytest.approx(values.mean())
