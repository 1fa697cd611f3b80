"""Distributions against each other, and methods on the same points."""

from dataclasses import dataclass
from functools import cache
from itertools import combinations

import numpy as np
import statsmodels.api as sm
from expected import Sheet, listed, plural
from of_theory import shares as shares_of_sizes
from recounts import View, recount
from run_data import INTERIOR, METHODS, WHOLE, WORDS, Run, holm, matrix, t95
from scipy import stats


@dataclass(frozen=True)
class Pair:
    """Two distributions at one size: relative difference, its interval, what it shows."""

    first: str
    second: str
    n: int
    relative: float
    low: float
    high: float
    p: float

    @property
    def within(self) -> bool:
        return self.low > -0.01 and self.high < 0.01


@cache
def pairs(run: Run, method: str, part: str) -> list[tuple[Pair, str]]:
    """All pairs with their verdicts."""
    groups = {d: run.groups(method, d, part) for d in run.distributions}
    made = []
    for n in run.sizes:
        for a, b in combinations(run.distributions, 2):
            if n in groups[a] and n in groups[b]:
                one, two = groups[a][n], groups[b][n]
                test = stats.ttest_ind(two, one, equal_var=False)
                ratio = two.mean() / one.mean()
                v1, v2 = one.var(ddof=1) / len(one), two.var(ddof=1) / len(two)
                half = t95(test.df) * np.sqrt(v2 + ratio**2 * v1) / one.mean()
                off = ratio - 1
                made.append(Pair(a, b, n, off, off - half, off + half, float(test.pvalue)))
    if not made:
        return []
    adjusted = holm(np.array([pair.p for pair in made]))
    words = []
    for pair, p in zip(made, adjusted, strict=True):
        shown = p < 0.05
        word = ("little" if shown else "alike") if pair.within else ("differ" if shown else "open")
        words.append((pair, word))
    return words


_WORDS = {
    "alike": "no difference and leave room for less than 1 %",
    "little": "one, of less than 1 %",
    "differ": "one that may be 1 % or more",
    "open": "none, but leave room for 1 % or more",
}
_PART = (WHOLE, INTERIOR)


def equivalent(of: list[Pair]) -> str:
    if any(pair.low > 0.01 or pair.high < -0.01 for pair in of):
        return "no"
    return "yes" if all(pair.within for pair in of) else "undecided"


@recount("distributions-compared", "Of (whole meshes|their interiors)")
def compared(v: View, s: Sheet, k: int) -> str:
    found = pairs(v.run, v.method, _PART[k])
    each = []
    for word, words in _WORDS.items():
        number = sum(one == word for _, one in found)
        if number:
            each.append(f"{s(number)} {plural(number, 'shows', 'show')} {words}")
    of = ("Of whole meshes", "Of their interiors")[k]
    return (
        f"{of}, triangulated by the {v.method_word} method, {s(len(found))} "
        f"{plural(len(found), 'pair')} of means can be compared: {listed(each)} (95 % intervals; "
        "tests at all sizes together, by Welch and Holm)."
    )


@recount("distributions-compared", "The largest difference")
def furthest(v: View, s: Sheet, k: int) -> str:
    pair = max((one for one, _ in pairs(v.run, v.method, _PART[k])), key=lambda p: abs(p.relative))
    return (
        f"The largest difference is {s.percent(pair.relative)} ({s.percent(pair.low)} to "
        f"{s.percent(pair.high)}): {WORDS[pair.second]} against {WORDS[pair.first]} points, "
        f"{s(pair.n)} of each."
    )


@recount("distributions-compared", "(So the|Whether the)")
def outcome(v: View, s: Sheet, k: int) -> str:
    found = pairs(v.run, v.method, _PART[k])
    word = equivalent([pair for pair, _ in found])
    sentence = {
        "yes": "So the distributions agree within 1 %",
        "no": "So the distributions do not agree within 1 %",
        "undecided": "Whether the distributions agree within 1 % stays open",
    }[word]
    same = all(one == "alike" for _, one in found)
    return f"{sentence}{', and no difference is detected' if same else ''}."


@recount("statement Section 4")
def analogous(v: View, s: Sheet, k: int) -> str:
    of = [
        (pair, word)
        for pair, word in pairs(v.run, v.method, WHOLE)
        if v.distribution in (pair.first, pair.second)
    ]
    start = "Results and conclusions are analogous for all the distributions"
    if not of:
        return f"{start} | not tested | the run has too few triangulations"
    far = max((pair for pair, _ in of), key=lambda pair: abs(pair.relative))
    other = far.second if far.first == v.distribution else far.first
    each = []
    for key, words in _WORDS.items():
        number = sum(word == key for _, word in of)
        if number:
            words = words.removesuffix(" and leave room for less than 1 %")
            each.append(f"{s(number)} {plural(number, 'shows', 'show')} {words}")
    return (
        f"{start} | {equivalent([pair for pair, _ in of])} | our criterion, means that "
        f"differ by less than 1 %: of {s(len(of))} comparisons with the others, "
        f"{listed(each)}; the largest difference is {s.percent(abs(far.relative))}, "
        f"from the {WORDS[other]} distribution at {s(far.n)} points"
    )


def _each(v: View) -> list[View]:
    return [View(v.run, method, v.distribution) for method in v.run.methods]


@recount("same-points", "On the same ")
def on_the_same(v: View, s: Sheet, k: int) -> str:
    n = max(v.run.sizes_of_all)
    rows = {one.method_word: v.run.rows(one.method, v.distribution, n) for one in _each(v)}
    means = [f"{s(r['mean_lepp'].mean())} ({name})" for name, r in rows.items()]
    p = [f"{s((r['n_type_c'] / r['n_interior_longest']).mean())} ({m})" for m, r in rows.items()]
    return (
        f"On the same {s(n)} {v.word} points the mean LEPP sizes are {listed(means)}, and the "
        f"shares p of type C neighbours {listed(p)}."
    )


@recount("same-points", "(That of|Those of|Both|All)")
def premise(v: View, s: Sheet, k: int) -> str:
    n, below = max(v.run.sizes_of_all), []
    for one in _each(v):
        rows = v.run.rows(one.method, v.distribution, n)
        if (rows["n_type_c"] / rows["n_interior_longest"]).mean() < 1 / 3:
            below.append(one.method_word)
    if not below:
        return "Both are above the 1/3 that Theorem 2 supposes."
    return (
        f"{plural(len(below), 'That of the', 'Those of the')} {listed(below)} triangulations "
        f"{plural(len(below), 'is', 'are')} below the 1/3 that Theorem 2 supposes."
    )


@recount("same-points", "With each doubling")
def doubling(v: View, s: Sheet, k: int) -> str:
    one, two = (
        v.run.rows(method, v.distribution).set_index(["n_points", "replicate"])["mean_lepp"]
        for method in v.run.methods
    )
    x = sm.add_constant(np.log2(one.index.get_level_values(0).to_numpy() / 1000))
    slopes = [float(np.polyfit(x[:, 1], y, 1)[0]) for y in (one, two)]
    fit = sm.OLS((two - one).to_numpy(), x).fit(cov_type="HC3", use_t=True)
    low, high = fit.conf_int()[1]
    words = [f"{s(b)} ({w.method_word})" for b, w in zip(slopes, _each(v), strict=True)]
    differs = "is not shown to differ" if low <= 0 <= high else "differs"
    return (
        f"With each doubling of the points the mean changes by {listed(words)}; the growth "
        f"{differs}."
    )


@recount("figure-methods", "From few points")
def ends(v: View, s: Sheet, k: int) -> str:
    words = []
    for one in _each(v):
        groups = v.run.all_groups(one.method, v.distribution)
        a, b = min(groups), max(groups)
        words.append(
            f"{one.method_word} means go from {s(groups[a].mean())} at {s(a)} to "
            f"{s(groups[b].mean())} at {s(b)}"
        )
    return f"From few points to many, {listed(words)}."


@recount("figure-rates", r".* that reach size 2")
def rates(v: View, s: Sheet, k: int) -> str:
    words = []
    for one in _each(v):
        c = matrix(v.run.histogram(one.method, v.distribution)).sum(axis=0)
        words.append(
            f"{s.percent(c[2] / c[2:].sum())} of the {one.method_word} paths that reach size 2 end "
            f"there, and {s.percent(c[5] / c[5:].sum())} of those that reach size 5"
        )
    return f"{'; '.join(words)}."


@recount("figure-sizes", r".* have a LEPP of 8 or more")
def long_ones(v: View, s: Sheet, k: int) -> str:
    words = []
    for one in _each(v):
        share, _ = shares_of_sizes(one)
        longest = int(np.flatnonzero(share).max())
        words.append(
            f"{s.percent(share[8:].sum())} of the {METHODS[one.method]} triangles have a LEPP of 8 "
            f"or more, and the longest is {s(longest)}"
        )
    return f"{'; '.join(words)}."
