"""What the report says of the theorems, against numbers counted anew; and the opposite."""

from dataclasses import replace

import numpy as np
import pytest
from frames import adding
from made_runs import METHODS, page, run
from page_text import PageText
from scipy import stats

from study.text.numbers import p_value_from_log10, significant


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


def least(name):
    """The least share of paths that end, of all groups, up to the first size where none does."""
    frame = run(name)["histograms"].query("method == 'incremental' and lepp_size > 1")
    found = []
    for n, group in frame.groupby("n_points"):
        counts = np.bincount(group["lepp_size"], group["count"])
        reached = counts[::-1].cumsum()[::-1]
        for k in range(2, int(np.append(counts[2:] == 0, True).argmax()) + 2):
            found.append((counts[k] / reached[k], k, n))
    return min(found)


def test_premise_holds_or_fails_by_every_step():
    p = shares("high p").mean()
    means = rows("high p")["mean_lepp"]
    r = 1 / (rows("high p").query("n_points == 8000")["mean_lepp"].mean() - 1)
    said = page("high p").prose("types")
    rate, size, n = least("high p")
    assert rate > 1 / 3
    assert said == (
        "A path ends at a neighbour of type C: one whose own longest edge is the edge that is "
        "crossed. At 8,000 uniform points the share of such neighbours, which is the chance that a "
        f"path ends at its first step, but for the few that end at the boundary there, is "
        f"p = {p:.4f}. Of all steps together, a share of "
        f"r = {r:.4f} ends a path. Theorem 2 supposes p ≥ 1/3 and, with Theorem 1, the same p at "
        "every step. Its bounds need less: if every step ends a path with a chance of at least "
        "1/3, which may differ from step to step, then at most (2/3)ʲ of the paths go on for j "
        "steps after their second triangle, the mean is at most 2 + 2/3 + (2/3)² + … = 4, and the "
        "standard deviation at most √6, for no law of such chances varies more than that of 1/3 "
        "throughout. As far as the chances are known to within 0.05, this holds "
        "in every group: the least chance to end, at a neighbour of type C or at the boundary, "
        f"is {rate:.4f}, at size {size} and {n:,} points. The bounds hold in every single "
        f"triangulation: means from {means.min():.4f} to {means.max():.4f}, "
        f"standard deviations up to {rows('high p')['sd_lepp'].max():.4f}, where √6 is "
        f"{np.sqrt(6):.4f}. The lower one, 2, is the size of the shortest path inside."
    )
    rate, size, n = least("low p")
    assert (
        "known to within 0.05, this fails in every group: the least chance to end, at a neighbour "
        f"of type C or at the boundary, is {rate:.4f}, at size {size} and {n:,} points."
    ) in page("low p").prose("types")
    assert f"p = {shares('low p').mean():.4f}" in page("low p").prose("types")


def test_premise_that_fails_in_some_groups():
    assert "this fails in 2 of 4 groups: the least" in page("p falls").prose("types")


def test_broken_bounds_are_counted():
    assert "The bounds are broken in 1 of 4 groups." in page("out of bounds").prose("types")
    assert "Theorem 2's bounds fail. " in page("out of bounds").prose("key-figures")


def test_opening_on_the_theorems():
    need = "every step ends a path with a chance of at least 1/3"
    bounds = "Theorem 2's bounds hold in every triangulation"
    upto = page("high p").evidence.tables["theorem_2"].frame.query("method == 'incremental'")
    least_k, most_k = upto["upto_size"].min(), upto["upto_size"].max()
    known = f"{least_k} to {most_k}, by the number of points" if least_k < most_k else str(most_k)
    assert (
        f"{bounds}. So does what they follow from, that {need}, as far as the chances are known to "
        f"within 0.05 (up to size {known})."
    ) in page("high p").prose("key-figures")
    assert (
        f"{bounds}, although not {need} (the least is {least('low p')[0]:.4f}), from which they "
        "would follow."
    ) in page("low p").prose("key-figures")
    assert f"not {need} (at 2 of 4 numbers of points, the least" in page("p falls").prose(
        "key-figures"
    )
    for name in ("above Theorem 1", "Theorem 1"):
        p = shares(name).mean()
        last = rows(name).query("n_points == 8000")
        mean, sd = last["mean_lepp"].mean(), last["sd_lepp"].mean()
        r = 1 / (mean - 1)
        assert (
            f"With the chance at the first step, the mean is {off(mean / (1 + 1 / p) - 1)} the "
            "theorem's; with that of all steps it fits by construction, and the standard deviation "
            f"is {off(sd / (np.sqrt(1 - r) / r) - 1)}."
        ) in page(name).prose("key-figures")
    assert off(0.02) == "2.0 % above"


def off(relative):
    return f"{abs(100 * relative):.1f} % {'above' if relative > 0 else 'below'}"


def test_moments_are_held_against_theorem_1():
    last = rows("drawn").query("n_points == 8000")
    columns = ("mean_lepp", "sd_lepp", "skewness_lepp", "kurtosis_lepp")
    names = ("the mean", "the standard deviation", "the skewness", "the excess kurtosis")

    def words(p):
        law = stats.geom(p)
        _, _, skewness, kurtosis = law.stats("mvsk")
        theory = (law.mean() + 1, law.std(), skewness, kurtosis)
        measured = [last[column].mean() for column in columns]
        return [
            f"{name} {off(m / t - 1)}" for name, m, t in zip(names, measured, theory, strict=True)
        ]

    p, r = shares("drawn").mean(), 1 / (last["mean_lepp"].mean() - 1)
    first, all_steps = words(p), words(r)[1:]
    said = page("drawn").prose("theorem-1")
    assert said.endswith(
        f"At 8,000 points, measured are, against the theorem with p = {p:.4f} of the first step, "
        f"{', '.join(first[:3])} and {first[3]}; against it with r = {r:.4f} of all steps, where "
        f"the mean fits by construction, {', '.join(all_steps[:2])} and {all_steps[2]}."
    )


def path_laws(name, part="interior"):
    frame = page(name).evidence.tables["path_laws"].rows(method="incremental", part=part).frame
    return frame.set_index("law")


def numbers(row):
    p = 10 ** row["log10_p"]
    shown = p_value_from_log10(row["log10_p"]).replace("\u00a0", " ")
    assert (p > 0.001) == ("×" not in shown)
    f = significant(row["f"], 3).replace("\u00a0", " ")
    tail = stats.f.logsf(row["f"], row["df"], row["df_residual"]) / np.log(10)
    assert row["log10_p"] == pytest.approx(tail, rel=1e-6)
    return f"F = {f} on {row['df']} and {row['df_residual']} degrees of freedom, p = {shown}"


def test_one_chance_for_all_steps_is_rejected_or_not():
    falling, constant = (path_laws(f"{n} chance").loc["constant"] for n in ("falling", "constant"))
    assert falling["log10_p"] < -30
    assert 10 ** constant["log10_p"] > 0.05
    assert (
        f"No single chance fits the steps ({numbers(falling)}, in the interior), whichever it is."
    ) in page("falling chance").prose("theorem-1")
    assert (
        f"That one chance fits all steps is not rejected ({numbers(constant)}, in the interior)."
    ) in page("constant chance").prose("theorem-1")
    for name, law in (("falling chance", falling), ("constant chance", constant)):
        p = numbers(law).split(", ")[-1]
        assert f"takes one chance for all steps, which is {law['verdict']} ({p}). " in page(
            name
        ).prose("key-figures")
        assert "No single chance" not in page(name).prose("key-figures")
    kept = page("falling chance").evidence
    untested = kept.tables["path_laws"]
    untested = replace(untested, frame=untested.frame.iloc[:0])
    changed = replace(kept, tables=adding(kept.tables, untested))
    said = PageText(changed).prose("key-figures")
    assert "for all steps, which this run is too small to test. " in said
    outside = page("falling chance, no interior").prose("theorem-1")
    assert "No single chance" in outside
    assert ", in the whole mesh), whichever" in outside


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
            "With p of the first step, Theorem 1's value lies inside the 95 % interval of the "
            f"measured one in {inside} of "
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


def chances(name, part="layers"):
    """Share of the paths of the largest size that go on after k triangles, by k."""
    frame = run(name)[part].query("method == 'incremental' and n_points == 8000")
    counts = np.bincount(frame["lepp_size"], frame["count"])
    reached = np.append(counts[::-1].cumsum()[::-1], 0)
    return reached[1:] / np.maximum(reached[:-1], 1)


SURE = "as far as it is known to within 0.05."


@pytest.mark.parametrize(
    ("name", "how"),
    [
        ("falling chance", "falls with every step, "),
        ("rising chance", "rises with every step, "),
        ("nearly falling chance", "falls "),
    ],
)
def test_chance_to_go_on_changes(name, how):
    said = page(name).finding("figure-continuation")
    start, _, rest = said.partition(", up to size ")
    upto = int(rest.split(",")[0])
    chance = chances(name)
    assert start == (
        f"At 8,000 points, in the interior, the chance to go on {how}from {100 * chance[2]:.1f} % "
        "to "
        f"{100 * chance[upto]:.1f} %"
    )
    assert SURE in said
    steps = np.diff(chance[2 : upto + 1])
    assert ("every step" in how) == ((steps < 0).all() or (steps > 0).all())


@pytest.mark.parametrize("name", ["uneven chance", "constant chance"])
def test_chance_to_go_on_that_neither_falls_nor_rises(name):
    said = page(name).finding("figure-continuation")
    upto = int(said.partition(", up to size ")[2].split(",")[0])
    chance = chances(name)[2 : upto + 1]
    assert said.startswith(
        "At 8,000 points, in the interior, the chance to go on moves between "
        f"{100 * chance.min():.1f} % and "
        f"{100 * chance.max():.1f} %, up to size {upto}, {SURE}"
    )


def test_no_interior_is_told_of_the_whole_mesh():
    said = page("falling chance, no interior").finding("figure-continuation")
    assert said.startswith(
        "At 8,000 points, in the whole mesh, the chance to go on falls with every step, from "
    )
    assert f"from {100 * chances('falling chance, no interior', 'histograms')[2]:.1f} %" in said


def test_the_law_of_the_chance_to_go_on():
    law = path_laws("falling chance").loc["λ / (k + b)ᵃ"]
    said = page("falling chance").finding("figure-continuation")
    assert (
        f"The law λ / (k + b)ᵃ with λ = {law['scale']:.3f} ± {law['scale_error']:.3f}, "
        f"b = {law['shift']:.3f} ± {law['shift_error']:.3f} and a = {law['exponent']:.3f} ± "
        f"{law['exponent_error']:.3f}, fitted up to size {law['upto_size']}"
    ) in said
    assert f"is not rejected ({numbers(law)})." in said
    assert abs(law["exponent"] - 0.5) < 3 * law["exponent_error"]
    other = path_laws("crooked chance").loc["λ / (k + b)ᵃ"]
    said = page("crooked chance").finding("figure-continuation")
    assert f"is rejected ({numbers(other)})." in said
    assert "The law" not in page("uneven chance").finding("figure-continuation")
    constant = path_laws("constant chance").loc["constant"]
    said = page("constant chance").finding("figure-continuation")
    assert f"One chance for all steps is not rejected ({numbers(constant)})." in said
    assert "The law" not in said


def longest_of(chance, paths):
    """First size beyond which fewer than one path is expected."""
    longer, k = float(paths), 2
    while longer * chance(k) >= 1:
        longer, k = longer * chance(k), k + 1
    return k


def test_longest_paths_seen_and_expected():
    frame = run("falling chance")["layers"].query("method == 'incremental' and n_points == 8000")
    paths, longest = frame["count"].sum(), frame["lepp_size"].max()
    chance = chances("falling chance")
    law = path_laws("falling chance").loc["λ / (k + b)ᵃ"]
    r = 1 - 1 / ((frame["lepp_size"] * frame["count"]).sum() / paths - 1)
    expected = [
        longest_of(lambda k: law["scale"] / (k + law["shift"]) ** law["exponent"], paths),
        longest_of(lambda k: chance[2], paths),
        longest_of(lambda k: r, paths),
    ]
    assert (
        page("falling chance")
        .finding("figure-continuation")
        .endswith(
            f"The longest of {paths / 10**6:.3g} million such paths at 8,000 points has {longest} "
            f"triangles; expected are {expected[0]} by this law, {expected[1]} by Theorem 1 with "
            f"the chance at the first step and {expected[2]} by Theorem 1 with that of all steps."
        )
    )
    assert "by this law" not in page("constant chance").finding("figure-continuation")


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
    side = "above" if off > 0 else "below"
    assert context == f"from p; measured is {abs(100 * off):.1f} % {side}"
    value, context = tiles["Chance p that a path ends at its first step"]
    assert value == f"{p:.4f}"
    assert context == f"of all steps, a share of r = {1 / (last - 1):.4f}"


@pytest.mark.parametrize("method", METHODS)
def test_methods_are_told_apart(method):
    view = f"{method}/uniform"
    p = shares("drawn", method=method).mean()
    assert f"p = {p:.4f}" in page("drawn").prose("types", view)
