"""What the report says of its tests, against other routes to the same statistics."""

import numpy as np
import pandas as pd
import pytest
from frames import design
from made_runs import page, run
from page_text import drawn, page_text
from scipy import stats

from reports.study_page.sections import alarms
from study.analysis.building import MISSING
from study.analysis.part_means import LAYER_MEANS
from study.paper.statements import STATEMENTS
from study.statistics.verdicts import YES
from study.text.numbers import p_value_from_log10

HOLM = (
    "After Holm's correction, which lets a false rejection through in one in twenty such studies,"
)
SIZES = (1000, 2000, 4000, 8000)


def groups(name, column="mean_lepp", method="incremental"):
    results = run(name)["results"]
    results = results[results["method"] == method]
    return [results.loc[results["n_points"] == n, column].to_numpy() for n in SIZES]


def p_text(p):
    return p_value_from_log10(np.log10(p)).replace("\u00a0", " ")


def welch(samples):
    """F and its degrees of freedom (B. L. Welch, Biometrika 38, 1951)."""
    n = np.array([len(s) for s in samples])
    w = n / np.array([s.var(ddof=1) for s in samples])
    means = np.array([s.mean() for s in samples])
    k = len(samples)
    center = (w * means).sum() / w.sum()
    spread = ((1 - w / w.sum()) ** 2 / (n - 1)).sum()
    f = (w * (means - center) ** 2).sum() / (k - 1) / (1 + 2 * (k - 2) / (k * k - 1) * spread)
    return f, k - 1, (k * k - 1) / (3 * spread)


@pytest.mark.parametrize("name", ["level", "growing", "falling", "drawn"])
def test_opening_on_growth(name):
    samples = groups(name)
    p = stats.f.sf(*welch(samples))
    said = page(name).prose("key-figures")
    if p >= 0.05:
        assert name in ("level", "drawn")
        assert (
            "The mean does not depend on the number of points, as far as this run can tell "
            f"(Welch's analysis of variance, p = {p_text(p)})."
        ) in said
    else:
        direction = {"growing": "grows", "falling": "falls"}[name]
        assert (
            f"The mean {direction} with the number of points, from {samples[0].mean():.4f} at "
            f"1,000 to {samples[-1].mean():.4f} at 8,000 (Welch's analysis of variance, "
            f"p = {p_text(p)})"
        ) in said


def test_opening_on_the_spread():
    for name in ("growing", "falling"):
        results = run(name)["results"].query("method == 'incremental'")
        assert (
            "The first step of a refinement, from a random triangle of 8,000 uniform points "
            "triangulated by the plain insertion method, follows a path of "
            f"{groups(name)[-1].mean():.2f} triangles on average; a refinement repeats it until "
            "the triangle is gone. In 32 triangulations of all sizes, with "
            f"{results['n_triangles'].sum():,} triangles, no path was longer than "
            f"{results['max_lepp'].max()}."
        ) in page(name).prose("key-figures")


@pytest.mark.parametrize("name", ["level", "growing", "narrowing"])
def test_analysis_of_variance(name):
    samples = groups(name)
    p = {
        "classical": stats.f_oneway(*samples).pvalue,
        "Welch": stats.f.sf(*welch(samples)),
        "Kruskal-Wallis": stats.kruskal(*samples).pvalue,
    }
    tests = [f"{test} ({p_text(value)})" for test, value in p.items()]
    verdict = (
        "The mean LEPP size does depend on the number of points"
        if max(p.values()) < 0.05
        else "No test shows that the mean LEPP size depends on the number of points"
    )
    assert (name == "level") == (max(p.values()) >= 0.05)
    f = welch(samples)[0]
    omega = max(0.0, 3 * (f - 1) / (3 * (f - 1) + 32))
    means = [s.mean() for s in samples]
    assert page(name).prose("anova") == (
        f"{verdict}, for uniform points; p by test: {tests[0]}, {tests[1]} and {tests[2]}. In this "
        "design, with these numbers of points and so many triangulations of each, the number of "
        f"points accounts for {100 * omega:.0f} % of the variance between triangulations (ω² of "
        "Welch's test, which does without equal variances); another design has another share. What "
        f"does not depend on the design are the groups' means, which span {min(means):.4f} to "
        f"{max(means):.4f}."
    )


@pytest.mark.parametrize("name", ["level", "growing"])
def test_pairs_of_groups(name):
    samples = groups(name)
    p = stats.tukey_hsd(*samples, equal_var=False).pvalue
    differ = int((p[np.triu_indices(4, 1)] < 0.05).sum())
    means = np.array([s.mean() for s in samples])
    gaps = means[None, :] - means[:, None]
    i, j = max(zip(*np.triu_indices(4, 1), strict=True), key=lambda ij: abs(gaps[ij]))
    assert page(name).finding("figure-pairs") == (
        f"{differ} of 6 pairs of groups differ (95 % level for all together). The largest "
        f"difference, {gaps[i, j]:.4f}, is that of {SIZES[j]:,} and {SIZES[i]:,} points."
    ).replace("-0", "−0")
    assert differ == {"level": 0, "growing": 6}[name]


@pytest.mark.parametrize(("name", "sign"), [("growing", 1), ("falling", -1)])
def test_colours_of_pairs_say_which_way_the_means_go(name, sign):
    (block,) = (b for b in page(name).blocks("anova") if getattr(b, "id", "") == "figure-pairs")
    squares = block.specs["incremental/uniform"]["data"][0]
    assert (sign * np.array(list(squares["z"])) > 0).all()
    assert squares["zmin"] == -squares["zmax"] == -max(abs(z) for z in squares["z"])


@pytest.mark.parametrize("name", ["growing", "near 4"])
def test_bounds_of_the_mean(name):
    samples = groups(name)
    said = page(name).prose("bounds")
    for bound, side, alternative in ((4, "below", "less"), (2, "above", "greater")):
        p = [stats.ttest_1samp(s, bound, alternative=alternative).pvalue * 16 for s in samples]
        significant = sum(value < 0.05 for value in p)
        where = "every group" if significant == 4 else f"{significant} of 4 groups"
        assert (
            f"In {where} of uniform points the mean is significantly {side} {bound}; the largest p "
            f"is {p_text(min(1.0, max(p)))}, corrected for all tests."
        ) in said
    ends = [stats.t.interval(0.95, 7, s.mean(), stats.sem(s)) for s in samples]
    assert said.endswith(
        f"reach from {min(low for low, _ in ends):.4f} to {max(high for _, high in ends):.4f}."
    )
    assert ("every group of uniform points the mean is significantly below" in said) == (
        name == "growing"
    )


@pytest.mark.parametrize(
    ("repetitions", "single"),
    [((8, 8, 8, 8), ""), ((8, 8, 8, 1), "8,000"), ((1, 8, 8, 1), "1,000 and 8,000"), (1, "")],
)
def test_a_size_with_one_triangulation_by_design_is_no_alarm_but_said(repetitions, single):
    said = page_text(drawn(design(distributions=("uniform",), repetitions=repetitions)))
    each = " each" if "and" in single else ""
    sentence = (
        f"Of {single} points there is one triangulation{each}, which has no spread by itself: no "
        "test of groups, here or below, includes it. The models of growth do."
    )
    if repetitions == 1:
        missing = set(said.evidence.rows(MISSING)["what"])
        assert {"Shapiro-Wilk test", "t tests against 2 and 4"} <= missing
        return
    assert (sentence in said.prose("assumptions")) == bool(single)
    assert ("one triangulation" in said.prose("assumptions")) == bool(single)
    assert alarms(said.evidence) == []
    spread = " that has a spread" if single else ""
    assert f"In every group of uniform points{spread} the mean is" in said.prose("bounds")
    assert f"in every group{spread}: the least chance" in said.prose("types")
    lonely = "of one triangulation, too few for an interval"
    assert (said.tiles()["Mean LEPP at 8,000 points"][1] == lonely) == single.endswith("8,000")
    told = 4000 if single.endswith("8,000") else 8000
    assert said.evidence.rows(LAYER_MEANS)["n_points"].max() == told
    assert f"At {told:,} points the edge has" in said.prose("layers")
    cases = f"{16 - 4 * len(single.split(' and '))} cases" if single else "16 cases"
    some = " that has intervals" if single else ""
    assert said.finding("figure-moments").endswith(
        f"of {cases} (four moments at each number of points{some})."
    )
    premise = said.evidence.rows(STATEMENTS, source="Premise of Theorem 2")
    assert set(premise["holds"]) == {YES}


@pytest.mark.parametrize("name", ["level", "narrowing", "widening"])
def test_equal_variances(name):
    samples = groups(name)
    mean, median = (stats.levene(*samples, center=c) for c in ("mean", "median"))
    numbers = f"Levene's F(3, 28) is {mean.statistic:.2f}, p = {p_text(mean.pvalue)}"
    said = page(name).prose("assumptions")
    if name == "level":
        assert mean.pvalue > 0.05
        assert (
            "Equal variances of the groups are not rejected, which does not show that they are "
            f"equal: {numbers}."
        ) in said
        return
    assert max(mean.pvalue, median.pvalue) < 0.05
    spread = [s.std(ddof=1) for s in samples]
    direction = {"narrowing": "falls", "widening": "rises"}[name]
    assert (
        f"The groups' variances are not equal: {numbers}. The spread between triangulations "
        f"{direction} with their size, from {spread[0]:.4f} to {spread[-1]:.4f}, and"
    ) in said


def test_equal_variances_about_one_centre_only():
    mean, median = (stats.levene(*groups("skewed"), center=c) for c in ("mean", "median"))
    assert mean.pvalue < 0.05 < median.pvalue
    assert (
        "Whether the groups' variances are equal depends on the centre: "
        f"Levene's F(3, 28) is {mean.statistic:.2f}, p = {p_text(mean.pvalue)}."
    ) in page("skewed").prose("assumptions")


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("narrowing", "which Levene's test rejects (p = {})"),
        ("level", "which Levene's test does not reject (p = {})"),
        ("skewed", "which Levene's test rejects about one centre of the groups but not the other"),
    ],
)
def test_what_least_squares_supposes(name, found):
    p = stats.levene(*groups(name), center="mean").pvalue
    said = page(name).prose("table-7")
    assert f"all variances to be equal, {found.format(p_text(p))}. " in said


@pytest.mark.parametrize("name", ["drawn", "out of bounds"])
def test_normal_groups(name):
    p = np.array([stats.shapiro(s).pvalue for s in groups(name)])
    steps = np.maximum.accumulate(np.sort(p) * np.arange(4, 0, -1))
    below, rejected = int((p < 0.05).sum()), int((steps < 0.05).sum())
    assert (name == "out of bounds") == (rejected > 0)
    none = {0: "none"}
    assert (
        page(name)
        .prose("assumptions")
        .endswith(
            f"Shapiro-Wilk gives p below 0.05 in {none.get(below, below)} of 4 groups; by "
            f"chance alone it would in 0.2. {HOLM} normality is rejected in "
            f"{none.get(rejected, rejected)}"
            + ("." if rejected else ", which does not show that they are normal.")
        )
    )


@pytest.mark.parametrize("name", ["drawn", "out of bounds"])
def test_quantiles_of_the_normal_plot(name):
    scores = np.concatenate([(s - s.mean()) / s.std(ddof=1) for s in groups(name)])
    (quantiles, ordered), _ = stats.probplot(scores)
    blom = stats.norm.ppf((np.arange(1, 33) - 0.375) / 32.25)
    straight = np.corrcoef(blom, ordered)[0, 1]
    assert abs(straight - np.corrcoef(quantiles, ordered)[0, 1]) < 0.01
    assert page(name).finding("figure-qq") == (
        "The 32 means, each in its group's standard deviations, lie along the diagonal with a "
        f"correlation of {straight:.4f}."
    )


def point_tests(name):
    return run(name)["point_sets"][["runs_p_x", "runs_p_y", "ks_p_x", "ks_p_y"]]


@pytest.mark.parametrize("name", ["drawn", "poor points"])
def test_randomness_of_the_points(name):
    tests = point_tests(name)
    p = tests.to_numpy().ravel()
    below = int((p < 0.05).sum())
    low, high = stats.binomtest(below, len(p)).proportion_ci(0.95, "exact")
    shares = [stats.binomtest(int((tests[c] < 0.05).sum()), len(tests), 0.05).pvalue for c in tests]
    family = np.array([*shares, stats.binomtest(below, len(p), 0.05).pvalue])
    order = np.argsort(family)
    holm = np.minimum(1, np.maximum.accumulate(family[order] * np.arange(5, 0, -1)))
    by_chance = holm[np.flatnonzero(order == 4)[0]] >= 0.05
    rejected = int((np.maximum.accumulate(np.sort(p) * np.arange(len(p), 0, -1)) < 0.05).sum())
    assert by_chance == (name == "drawn")
    said = page(name).prose("randomness")
    assert said.startswith(
        f"Of {len(p)} tests of all point sets, {below} p-values fall below 0.05: "
        f"{100 * below / len(p):.2f} % (95 % interval {100 * low:.2f} % to {100 * high:.2f} %), "
        + ("which is what chance alone" if by_chance else "which chance alone does not explain")
    )
    assert f"About {len(p) * 0.05:.0f} would, even with perfect points." in said
    none = "none rejects" if rejected == 0 else f"{rejected} reject{'' if rejected > 1 else 's'}"
    assert said.endswith(f"{HOLM} {none}.")


@pytest.mark.parametrize("name", ["drawn", "poor points"])
def test_evenness_of_p_values(name):
    tests = point_tests(name)
    names = ["runs of x", "runs of y", "Kolmogorov-Smirnov of x", "Kolmogorov-Smirnov of y"]
    p = [stats.kstest(tests[c], "uniform").pvalue for c in tests]
    odd = [(n, value) for n, value in zip(names, p, strict=True) if value < 0.05]
    said = page(name).finding("figure-uniformity")
    if not odd:
        assert name == "drawn"
        assert said == (
            "For uniform points, all 4 families of p-values are as even as chance allows (lowest p "
            f"of uniformity {p_text(min(p))})."
        )
        return
    assert [label for label, _ in odd] == ["runs of x", "Kolmogorov-Smirnov of y"]
    assert said == (
        "For uniform points, the p-values of runs of x and Kolmogorov-Smirnov of y are less even "
        f"than chance would have them (p {p_text(odd[0][1])} and {p_text(odd[1][1])})."
    )


@pytest.mark.parametrize("name", ["growing", "falling"])
def test_regions(name):
    results = run(name)["results"].query("method == 'incremental' and n_points == 8000")
    regions = run(name)["regions"].query("method == 'incremental'")
    counts = pd.Series(regions["count"].to_numpy(), regions["region_size"]).groupby(level=0).sum()
    pairs = (results["n_type_c"] / results["n_triangles"]).mean()
    size = (results["n_triangles"] / results["n_regions"]).mean()
    said = page(name).prose("region-sizes")
    assert said.startswith(
        "In plain insertion triangulations of 8,000 uniform points, "
        f"{100 * pairs:.1f} % of the triangles stand in a terminal pair: a refinement that starts "
        "there touches nothing else. The triangles whose paths end at one terminal edge make a "
        f"region of {size:.2f} triangles on average; "
    )
    assert f"{results['max_region'].max():,}" in said
    share = counts / counts.sum()
    within = share.cumsum()
    assert page(name).finding("figure-regions") == (
        f"The commonest region has {share.idxmax()} triangles ({100 * share.max():.1f} % of the "
        f"regions); nine in ten have at most {within.index[within >= 0.9][0]}; the largest, of "
        f"all numbers of points, has {counts.index.max():,}."
    )


@pytest.mark.parametrize("name", ["narrowing", "widening"])
def test_spread_between_triangulations(name):
    spread = [s.std(ddof=1) for s in groups(name)]
    change = "shrinks" if spread[0] > spread[-1] else "grows"
    expected = (
        f"The spread between triangulations {change} from {spread[0]:.4f} at 1,000 points to "
        f"{spread[-1]:.4f} at 8,000."
    )
    assert page(name).finding("figure-groups") == expected
    assert (change == "shrinks") == (name == "narrowing")


def test_key_figures():
    samples = groups("growing")
    low, high = stats.t.interval(0.95, 7, samples[-1].mean(), stats.sem(samples[-1]))
    tiles = page("growing").tiles()
    assert tiles["Mean LEPP at 8,000 points"] == (
        f"{samples[-1].mean():.4f}",
        f"95 % interval {low:.4f} to {high:.4f}",
    )
    results = run("growing")["results"].query("method == 'incremental'")
    assert tiles["Longest path"] == (
        str(results["max_lepp"].max()),
        f"among {results['n_triangles'].sum():,} triangles",
    )
    last = results.query("n_points == 8000")
    share = 100 * (last["n_type_c"] / last["n_triangles"]).mean()
    assert tiles["In a terminal pair"][0] == f"{share:.1f}\u00a0%"
