"""Tests of the groups (variances, normality, means, pairs, bounds), and of the points."""

from functools import cache
from itertools import combinations

import numpy as np
from expected import Sheet, listed, plural
from of_growth import adjusted_r2, welch_test
from recounts import View, recount
from run_data import (
    Run,
    holm,
    log10_chi2_tail,
    log10_f_tail,
    log10_t_tail,
    mean_interval,
)
from scipy import stats

HOLM = (
    "After Holm's correction, which lets a false rejection through in one in twenty such studies,"
)
_KINDS = {"runs": "runs", "ks": "Kolmogorov-Smirnov"}


def one_way_f(groups: list[np.ndarray]) -> tuple[float, int, int]:
    """F of the means by sums of squares, with its degrees of freedom."""
    values = np.concatenate(groups)
    center = values.mean()
    between = sum(len(g) * (g.mean() - center) ** 2 for g in groups)
    within = sum(((g - g.mean()) ** 2).sum() for g in groups)
    d1, d2 = len(groups) - 1, len(values) - len(groups)
    return float(between / d1 / (within / d2)), d1, d2


def levene(groups: list[np.ndarray], center: str = "mean") -> tuple[float, int, int]:
    """Levene's F: that of the absolute deviations from the groups' means or medians."""
    middle = np.mean if center == "mean" else np.median
    return one_way_f([np.abs(g - middle(g)) for g in groups])


def values(v: View) -> list[np.ndarray]:
    return list(v.run.groups(v.method, v.distribution).values())


@recount("assumptions", "(The groups' variances are not|Whether the groups'|Equal variances)")
def variances(v: View, s: Sheet, k: int) -> str:
    tests = [levene(values(v), center) for center in ("mean", "median")]
    p = [log10_f_tail(*test) for test in tests]
    f, d1, d2 = tests[0]
    numbers = f"Levene's F({s(d1)}, {s(d2)}) is {s(f)}, {s.p_is(p[0])}"
    unequal = [one < np.log10(0.05) for one in p]
    if all(unequal):
        return f"The groups' variances are not equal: {numbers}."
    if any(unequal):
        return f"Whether the groups' variances are equal depends on the centre: {numbers}."
    return (
        "Equal variances of the groups are not rejected, which does not show that they are equal: "
        f"{numbers}."
    )


@recount("table-7", "Least squares takes")
def equal_variances(v: View, s: Sheet, k: int) -> str:
    p = [log10_f_tail(*levene(values(v), center)) for center in ("mean", "median")]
    unequal = [one < np.log10(0.05) for one in p]
    verb = "rejects" if all(unequal) else "does not reject"
    found = (
        "which Levene's test rejects about one centre of the groups but not the other"
        if any(unequal) and not all(unequal)
        else f"which Levene's test {verb} ({s.p_is(p[0])})"
    )
    return f"Least squares takes all variances to be equal, {found}."


@recount("assumptions", "The spread between triangulations")
def spread(v: View, s: Sheet, k: int) -> str:
    sd = [g.std(ddof=1) for g in values(v)]
    return (
        f"The spread between triangulations {'falls' if sd[-1] < sd[0] else 'rises'} with their "
        f"size, from {s(sd[0])} to {s(sd[-1])}, and the classical analysis of variance supposes "
        "that it does not change; the tests below that do without are the ones to read."
    )


@cache
def normality(run: Run, method: str, distribution: str) -> tuple[int, int, int]:
    """Groups below 0.05, those rejected after Holm, all."""
    p = np.array([stats.shapiro(g).pvalue for g in run.groups(method, distribution).values()])
    return int((p < 0.05).sum()), int((holm(p) < 0.05).sum()), len(p)


@recount("assumptions", "Shapiro-Wilk gives")
def shapiro(v: View, s: Sheet, k: int) -> str:
    below, _, groups = normality(*v.key)
    return (
        f"Shapiro-Wilk gives p below 0.05 in {s(below)} of {s(groups)} groups; by chance alone it "
        f"would in {s(0.05 * groups)}."
    )


@recount("assumptions", "After Holm's")
def shapiro_holm(v: View, s: Sheet, k: int) -> str:
    rejected = normality(*v.key)[1]
    if rejected:
        return f"{HOLM} normality is rejected in {s(rejected)}."
    return f"{HOLM} normality is rejected in {s(0)}, which does not show that they are normal."


@recount("assumptions", "Of .* points there is")
def single(v: View, s: Sheet, k: int) -> str:
    sizes = v.run.single_sizes(v.method)
    return (
        f"Of {listed([s(n) for n in sizes])} points there is one "
        f"triangulation{' each' if len(sizes) > 1 else ''}, which has no spread by itself: no test "
        "of groups, here or below, includes it."
    )


@recount("figure-qq", "The ")
def qq(v: View, s: Sheet, k: int) -> str:
    scores = np.sort(np.concatenate([(g - g.mean()) / g.std(ddof=1) for g in values(v)]))
    at = stats.norm.ppf((np.arange(1, len(scores) + 1) - 0.375) / (len(scores) + 0.25))
    return (
        f"The {s(len(scores))} means, each in its group's standard deviations, lie along the "
        f"diagonal with a correlation of {s(stats.pearsonr(at, scores).statistic)}."
    )


@cache
def three_tests(run: Run, method: str, distribution: str) -> dict[str, float]:
    """Logarithm of p by test of equal means."""
    groups = run.groups(method, distribution)
    one = list(groups.values())
    return {
        "classical": log10_f_tail(*one_way_f(one)),
        "Welch": welch_test(groups)[3],
        "Kruskal-Wallis": log10_chi2_tail(stats.kruskal(*one).statistic, len(one) - 1),
    }


@recount("anova", "(The mean LEPP size does|No test|The tests)")
def equal_means(v: View, s: Sheet, k: int) -> str:
    tests = three_tests(*v.key)
    differ = [p < np.log10(0.05) for p in tests.values()]
    opening = (
        "The mean LEPP size does depend on the number of points"
        if all(differ)
        else "The tests disagree on whether the mean LEPP size depends on the number of points"
        if any(differ)
        else "No test shows that the mean LEPP size depends on the number of points"
    )
    words = listed([f"{name} ({s.p(p)})" for name, p in tests.items()])
    return f"{opening}, for {v.word} points; p by test: {words}."


@recount("anova", "In this design")
def share_of_variance(v: View, s: Sheet, k: int) -> str:
    groups = v.run.groups(v.method, v.distribution)
    f, d1, _, _ = welch_test(groups)
    total = sum(len(g) for g in groups.values())
    omega = max(0.0, d1 * (f - 1) / (d1 * (f - 1) + total))
    return (
        "In this design, with these numbers of points and so many triangulations of each, the "
        f"number of points accounts for {s.percent(omega)} of the variance between triangulations "
        "(ω² of Welch's test, which does without equal variances); another design has another "
        "share."
    )


@recount("anova", "What does not depend")
def span(v: View, s: Sheet, k: int) -> str:
    means = [g.mean() for g in v.run.all_groups(v.method, v.distribution).values()]
    return (
        "What does not depend on the design are the groups' means, which span "
        f"{s(min(means))} to {s(max(means))}."
    )


@cache
def pairs(run: Run, method: str, distribution: str) -> tuple[int, int]:
    """Pairs that differ by Games and Howell, and all pairs; p by SciPy's own distribution."""
    groups = list(run.groups(method, distribution).values())
    differ = number = 0
    for a, b in combinations(groups, 2):
        va, vb = a.var(ddof=1) / len(a), b.var(ddof=1) / len(b)
        df = (va + vb) ** 2 / (va**2 / (len(a) - 1) + vb**2 / (len(b) - 1))
        q = abs(a.mean() - b.mean()) / np.sqrt((va + vb) / 2)
        # Its tail takes a tenth of a second: asked only where it is not plain.
        if q > 3.0:
            differ += q > 8.0 or stats.studentized_range.sf(q, len(groups), df) < 0.05
        number += 1
    return differ, number


@recount("figure-pairs", ".* of groups differ")
def pairs_differ(v: View, s: Sheet, k: int) -> str:
    differ, number = pairs(*v.key)
    return (
        f"{s(differ)} of {s(number)} {plural(number, 'pair')} of groups differ (95 % level for all "
        "together)."
    )


@recount("figure-pairs", "The largest difference")
def largest_difference(v: View, s: Sheet, k: int) -> str:
    means = {n: g.mean() for n, g in v.run.groups(v.method, v.distribution).items()}
    low, high = min(means, key=means.__getitem__), max(means, key=means.__getitem__)
    first, second = min(low, high), max(low, high)
    return (
        f"The largest difference, {s(means[second] - means[first])}, is that of {s(second)} and "
        f"{s(first)} points."
    )


@cache
def bound_tests(run: Run, method: str, distribution: str) -> dict[int, list[float]]:
    """Logarithms of p of the t tests, corrected for all tests of the run, by bound."""
    tests = 2 * sum(len(run.sizes_of(method)) for method in run.methods) * len(run.distributions)
    made: dict[int, list[float]] = {4: [], 2: []}
    for group in run.groups(method, distribution).values():
        for bound, sign in ((4, -1), (2, 1)):
            t = sign * (group.mean() - bound) / stats.sem(group)
            tail = log10_t_tail(t, len(group) - 1) if t > 0 else 0.0
            made[bound].append(min(0.0, tail + np.log10(tests)))
    return made


@recount("bounds", "In .* points (that has a spread )?the mean is significantly")
def bound(v: View, s: Sheet, k: int) -> str:
    at, side = ((4, "below"), (2, "above"))[k]
    p = bound_tests(*v.key)[at]
    rejected = sum(one < np.log10(0.05) for one in p)
    where = "every group" if rejected == len(p) else f"{s(rejected)} of {s(len(p))} groups"
    has_spread = " that has a spread" if v.run.single_sizes(v.method) else ""
    return (
        f"In {where} of {v.word} points{has_spread} the mean is significantly {side} {at}; "
        f"the largest p is {s.p(max(p))}, corrected for all tests."
    )


@recount("bounds", "A p-value says")
def bound_intervals(v: View, s: Sheet, k: int) -> str:
    ends = [mean_interval(g) for g in values(v)]
    return (
        "A p-value says only that the mean is not the bound; its interval says how far it is: over "
        f"all groups they reach from {s(min(e[1] for e in ends))} to {s(max(e[2] for e in ends))}."
    )


def families(run: Run, distribution: str) -> dict[str, np.ndarray]:
    frame = run.point_sets
    frame = frame[frame["distribution"] == distribution]
    return {
        f"{name} of {c}": frame[f"{kind}_p_{c}"].dropna().to_numpy()
        for kind, name in _KINDS.items()
        for c in "xy"
    }


@recount("randomness", "Of ")
def all_tests(v: View, s: Sheet, k: int) -> str:
    every = [p for d in v.run.distributions for p in families(v.run, d).values()]
    p = np.concatenate(every)
    below, n = int((p < 0.05).sum()), len(p)
    low = stats.beta.ppf(0.025, below, n - below + 1)
    high = stats.beta.ppf(0.975, below + 1, n - below)
    shares = [stats.binomtest(int((f < 0.05).sum()), len(f), 0.05).pvalue for f in [*every, p]]
    chance = (
        "which chance alone does not explain"
        if holm(np.array(shares))[-1] < 0.05
        else "which is what chance alone leads one to expect"
    )
    return (
        f"Of {s(n)} tests of all point sets, {s(below)} p-values fall below 0.05: "
        f"{s.percent(below / n)} (95 % interval {s.percent(low)} to {s.percent(high)}), {chance}."
    )


@recount("randomness", "About ")
def had_to(v: View, s: Sheet, k: int) -> str:
    n = sum(len(p) for d in v.run.distributions for p in families(v.run, d).values())
    return f"About {s(0.05 * n)} would, even with perfect points."


@recount("randomness", "After Holm's")
def all_holm(v: View, s: Sheet, k: int) -> str:
    p = np.concatenate([p for d in v.run.distributions for p in families(v.run, d).values()])
    rejected = int((holm(p) < 0.05).sum())
    return f"{HOLM} {s(rejected)} {'reject' if rejected > 1 else 'rejects'}."


@recount("figure-uniformity", "For ")
def even(v: View, s: Sheet, k: int) -> str:
    p = {
        name: stats.kstest(f, "uniform").pvalue
        for name, f in families(v.run, v.distribution).items()
    }
    odd = {name: one for name, one in p.items() if one < 0.05}
    if not odd:
        return (
            f"For {v.word} points, all {s(len(p))} families of p-values are as even as chance "
            f"allows (lowest p of uniformity {s(min(p.values()))})."
        )
    shown = listed([s.p(np.log10(one)) for one in odd.values()])
    return (
        f"For {v.word} points, the p-values of {listed(list(odd))} are less even than chance would "
        f"have them (p {shown})."
    )


def _f_test(s: Sheet, statement: str, f: float, d1: int, d2: int) -> str:
    p = log10_f_tail(f, d1, d2)
    return (
        f"{statement} | {'yes' if p < np.log10(0.05) else 'not shown'} | F = {s(f)} ({s(d1)} and "
        f"{s(d2)} degrees of freedom), {s.p_is(p)}"
    )


@recount("statement Table 2")
def table_2(v: View, s: Sheet, k: int) -> str:
    return _f_test(s, "The variances of the groups differ", *levene(values(v)))


@recount("statement Table 5")
def table_5(v: View, s: Sheet, k: int) -> str:
    return _f_test(s, "The means of the groups differ", *one_way_f(values(v)))


@recount("statement Table 3")
def table_3(v: View, s: Sheet, k: int) -> str:
    below, rejected, groups = normality(*v.key)
    return (
        "The data within each group are nearly normal | "
        f"{'no' if rejected else 'not rejected'} | {s(below)} of "
        f"{s(groups)} groups below 0.05, where {s(0.05 * groups)} would be by chance; "
        f"{s(rejected)} after Holm's correction"
    )


def _grows(v: View, s: Sheet, statement: str, at: dict[int, float], sign: int) -> str:
    n, column = list(at), list(at.values())
    rho = stats.spearmanr(n, column).statistic
    one, other = (
        stats.spearmanr(n, column, alternative=side).pvalue
        for side in (("greater", "less") if sign > 0 else ("less", "greater"))
    )
    word = "yes" if one < 0.05 else "no" if other < 0.05 else "not shown"
    return (
        f"{statement} | {word} | {s(column[0])} at {s(n[0])} points, {s(column[-1])} at "
        f"{s(n[-1])}; Spearman's ρ = {s(rho)}"
    )


@recount("statement Table 4")
def table_4(v: View, s: Sheet, k: int) -> str:
    rows = v.run.rows(v.method, v.distribution)
    largest = rows.groupby("n_points")["max_lepp"].mean().to_dict()
    return _grows(v, s, "The largest LEPP grows with the number of points", largest, 1)


@recount("statement Figure 5")
def figure_5(v: View, s: Sheet, k: int) -> str:
    sd = {n: g.std(ddof=1) for n, g in v.run.groups(v.method, v.distribution).items()}
    statement = "The mean varies less from mesh to mesh as the number of points grows"
    return _grows(v, s, statement, sd, -1)


@recount("statement Figure 6")
def figure_6(v: View, s: Sheet, k: int) -> str:
    means = {n: g.mean() for n, g in v.run.all_groups(v.method, v.distribution).items()}
    return _grows(
        v, s, "The mean LEPP size has a very weak upward trend with the number of points", means, 1
    )


@recount("statement Table 6")
def table_6(v: View, s: Sheet, k: int) -> str:
    tests = bound_tests(*v.key)
    p = [*tests[4], *tests[2]]
    rejected = sum(one < np.log10(0.05) for one in p)
    ends = [mean_interval(g) for g in values(v)]
    beyond = any(low > 4 or high < 2 for _, low, high in ends)
    word = "no" if beyond else "yes" if rejected == len(p) else "not shown"
    return (
        f"The mean is significantly below 4 and above 2 in every group | {word} | {s(rejected)} of "
        f"{s(len(p))} tests significant after Bonferroni's correction, the largest {s.p_is(max(p))}"
        "; above 2 says nothing, since a path inside has two triangles by definition"
    )


@recount("statement Table 7", "Of the four models")
def table_7(v: View, s: Sheet, k: int) -> str:
    start = "Of the four models the logarithmic one has the highest adjusted R²"
    r2 = adjusted_r2(*v.key)
    if len(r2) < 4:
        return f"{start} | not tested | not all four models could be fitted"
    ranked = sorted(r2, key=lambda name: -r2[name])
    words = ", ".join(f"{name} {s(r2[name])}" for name in ranked)
    return f"{start} | {'yes' if ranked[0] == 'logarithmic' else 'no'} | {words}"
