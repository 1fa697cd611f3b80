"""What the report says of the theorems, against numbers counted anew; and the opposite."""

import numpy as np
import pytest
from made_runs import METHODS, page, run
from scipy import stats


def rows(name, method="incremental"):
    results = run(name)["results"]
    return results[results["method"] == method]


def shares(name, column="n_type_c", method="incremental"):
    last = rows(name, method).query("n_points == 8000")
    return last[column] / last["n_interior_longest"]


def pooled(name, method="incremental"):
    """Counts of LEPP sizes of all triangulations together, by size."""
    frame = run(name)["histograms"]
    frame = frame[frame["method"] == method]
    return np.bincount(frame["lepp_size"], frame["count"])


def test_premise_holds_or_fails_by_the_interval_of_p():
    p = shares("high p").mean()
    means = rows("high p")["mean_lepp"]
    said = page("high p").prose("types")
    assert said == (
        "A path ends at a neighbour of type C: one whose own longest edge is the edge that is "
        f"crossed. At 8,000 uniform points the share of such neighbours is p = {p:.4f}, so the "
        "premise of Theorem 2, p ≥ 1/3, holds in every group. Its bounds hold in every single "
        f"triangulation: means from {means.min():.4f} to {means.max():.4f}, standard deviations up "
        f"to {rows('high p')['sd_lepp'].max():.4f}, where √6 is {np.sqrt(6):.4f}."
    )
    assert "p ≥ 1/3, fails in every group." in page("low p").prose("types")
    assert f"p = {shares('low p').mean():.4f}" in page("low p").prose("types")


def test_premise_that_fails_in_some_groups():
    assert "p ≥ 1/3, fails in 2 of 4 groups." in page("p falls").prose("types")


def test_broken_bounds_are_counted():
    assert "Its bounds are broken in 1 of 4 groups." in page("out of bounds").prose("types")
    said = page("out of bounds").prose("key-figures")
    assert f"Theorem 2's bounds fail, p is {shares('out of bounds').mean():.4f}." in said


def test_opening_on_the_theorems():
    assert (
        "Theorem 2's bounds hold in every triangulation, and so does what it supposes, p ≥ 1/3."
        in page("high p").prose("key-figures")
    )
    assert (
        "Theorem 2's bounds hold in every triangulation, although what it supposes, p ≥ 1/3, does "
        f"not: p is {shares('low p').mean():.4f}."
    ) in page("low p").prose("key-figures")
    assert "Theorem 1 gives the mean and the standard deviation within one per cent." in page(
        "Theorem 1"
    ).prose("key-figures")
    p = shares("above Theorem 1").mean()
    last = rows("above Theorem 1").query("n_points == 8000")
    mean, sd = last["mean_lepp"].mean(), last["sd_lepp"].mean()
    assert (
        f"Theorem 1 gives {1 + 1 / p:.2f} for the mean, and the measured one is "
        f"{100 * (mean / (1 + 1 / p) - 1):.1f} % above; for the standard deviation it gives "
        f"{np.sqrt(1 - p) / p:.2f}, and the measured one is "
        f"{100 * (sd / (np.sqrt(1 - p) / p) - 1):.1f} % above."
    ) in page("above Theorem 1").prose("key-figures")


def test_moments_are_held_against_theorem_1():
    p = shares("drawn").mean()
    last = rows("drawn").query("n_points == 8000")
    law = stats.geom(p)
    _, _, skewness, kurtosis = law.stats("mvsk")
    theory = {
        "mean": (law.mean() + 1, "mean_lepp"),
        "standard deviation": (law.std(), "sd_lepp"),
        "skewness": (skewness, "skewness_lepp"),
        "excess kurtosis": (kurtosis, "kurtosis_lepp"),
    }
    words = []
    for name, (value, column) in theory.items():
        off = last[column].mean() / value - 1
        words.append(f"the {name} {abs(100 * off):.1f} % {'above' if off > 0 else 'below'}")
    said = page("drawn").prose("theorem-1")
    assert said.endswith(f"the theorem's, {', '.join(words[:3])} and {words[3]}.")
    assert "It puts all four too low" in page("above Theorem 1").prose("theorem-1")
    assert "It describes the measurement closely" in page("Theorem 1").prose("theorem-1")
    assert "It puts all four too high" in page("drawn").prose("theorem-1")
    assert "now on one side and now on the other" in page("mixed Theorem 1").prose("theorem-1")


def test_intervals_that_hold_theorem_1_are_counted():
    for name in ("drawn", "above Theorem 1"):
        inside = 0
        for _, group in rows(name).groupby("n_points"):
            p = (group["n_type_c"] / group["n_interior_longest"]).mean()
            law = stats.geom(p)
            _, _, skewness, kurtosis = law.stats("mvsk")
            predicted = {
                "mean_lepp": law.mean() + 1,
                "sd_lepp": law.std(),
                "skewness_lepp": skewness,
                "kurtosis_lepp": kurtosis,
            }
            for column, value in predicted.items():
                low, high = stats.t.interval(
                    0.95, 7, group[column].mean(), stats.sem(group[column])
                )
                inside += low <= value <= high
        assert page(name).finding("figure-moments") == (
            f"Theorem 1's value lies inside the 95 % interval of the measured one in {inside} of "
            "16 cases (four moments at each number of points)."
        )
    assert inside == 0


def test_types_of_neighbours():
    for name in ("drawn", "low p"):
        a, b, c = (100 * shares(name, f"n_type_{k}").mean() for k in "abc")
        assert page(name).finding("figure-types") == (
            f"At 8,000 points, {a:.2f} % of type A, {b:.2f} % of type B and {c:.2f} % of type C. A "
            "neighbour is of type A, B or C when the crossed edge is its shortest, middle or "
            "longest."
        )


def rates(name, method="incremental"):
    counts = pooled(name, method)
    reached = counts[::-1].cumsum()[::-1]
    return np.divide(counts, reached, where=reached > 0, out=np.zeros(len(counts)))


@pytest.mark.parametrize("name", ["low p", "high p"])
def test_termination_rates(name):
    rate = rates(name)
    counts = pooled(name)
    listed = [f"{100 * rate[k]:.1f} % at size {k}" for k in range(2, 6)]
    said = page(name).finding("figure-termination")
    assert said.endswith(f": {', '.join(listed[:3])} and {listed[3]}.")
    assert counts[2:6].all()


def test_rates_rise_fall_or_are_constant():
    assert (np.diff(rates("high p")[2:7]) > 0).all()
    assert "rises with every step" in page("high p").finding("figure-termination")
    assert "is constant to a hundredth" in page("constant rates").finding("figure-termination")
    assert (np.diff(rates("falling rates")[2:7]) < 0).all()
    assert "falls with every step" in page("falling rates").finding("figure-termination")
    rate = rates("uneven rates")[2:6]
    assert f"moves between {100 * rate.min():.1f} % and {100 * rate.max():.1f} %" in page(
        "uneven rates"
    ).finding("figure-termination")


def test_the_law_of_sizes():
    for name, rarer in (("high p", True), ("low p", None)):
        counts = pooled(name)
        total = run(name)["results"].query("method == 'incremental'")
        p = total["n_type_c"].sum() / total["n_interior_longest"].sum()
        common = counts[2:].argmax() + 2
        said = page(name).finding("figure-law")
        law = (1 - p) ** (common - 2) * p
        assert said.startswith(
            f"The commonest size is {common} ({100 * counts[common] / counts.sum():.1f} % of the "
            f"triangles; the law has {100 * law:.1f} %)."
        )
        if rarer:
            assert "Sizes of 8" not in said
        else:
            times = counts[8:].sum() / counts.sum() / (1 - p) ** 6
            assert times > 1
            assert said.endswith(
                f"Sizes of 8 and more are {times:.1f} times as common as in the law."
            )
    counts = pooled("rare long paths")
    total = run("rare long paths")["results"].query("method == 'incremental'")
    p = total["n_type_c"].sum() / total["n_interior_longest"].sum()
    times = (1 - p) ** 6 / (counts[8:].sum() / counts.sum())
    assert times > 1
    assert (
        page("rare long paths")
        .finding("figure-law")
        .endswith(f"Sizes of 8 and more are {times:.1f} times rarer than in the law.")
    )


@pytest.mark.parametrize("name", ["low p", "high p", "drawn"])
def test_key_figures_of_the_theory(name):
    tiles = page(name).tiles()
    p = shares(name).mean()
    last = rows(name).query("n_points == 8000")["mean_lepp"].mean()
    off = last / (1 + 1 / p) - 1
    value, context = tiles["Mean LEPP by Theorem 1"]
    assert value == f"{1 + 1 / p:.4f}"
    assert context == f"measured is {abs(100 * off):.1f} % {'above' if off > 0 else 'below'}"
    assert f"{p:.4f}" in [value for value, _ in tiles.values()]


@pytest.mark.parametrize("method", METHODS)
def test_methods_are_told_apart(method):
    view = f"{method}/uniform"
    p = shares("drawn", method=method).mean()
    assert f"p = {p:.4f}" in page("drawn").prose("types", view)
