"""Theorems 1 and 2, the chance to go on and its law, against the counts of the Parquet files."""

from functools import cache

import naive
import numpy as np
from expected import Sheet, listed
from path_laws import (
    Law,
    constant_law,
    continuation,
    falling_law,
    law_part,
    longest,
    rates_of,
)
from recounts import View, recount
from run_data import INTERIOR, WHOLE, Run, matrix, mean_interval, theorem_1

import lepp

MOMENTS = {
    "mean": "mean_lepp",
    "standard deviation": "sd_lepp",
    "skewness": "skewness_lepp",
    "excess kurtosis": "kurtosis_lepp",
}
_IN = {WHOLE: "in the whole mesh", INTERIOR: "in the interior"}


def share_c(v: View, n: int, kind: str = "c") -> np.ndarray:
    """Share of a type of neighbours, by triangulation."""
    rows = v.run.rows(v.method, v.distribution, n)
    inside = rows["n_interior_longest"]
    return (rows[f"n_type_{kind}"] / inside)[inside > 0].to_numpy()


def _test(law: Law, s: Sheet) -> str:
    return (
        f"F = {s(law.f, 1e-5 * law.f)} on {s(law.df)} and {s(law.df_residual)} degrees of freedom, "
        f"{s.p_is(law.log10_p, 1e-4)}"
    )


def one_chance(v: View, s: Sheet) -> str:
    """Whether one chance fits all steps."""
    part = law_part(v.key)
    law = constant_law(*v.key, part)
    if law is None:
        return "The run is too small to test whether one chance fits all steps."
    if law.rejected:
        return f"No single chance fits the steps ({_test(law, s)}, {_IN[part]}), whichever it is."
    return f"That one chance fits all steps is not rejected ({_test(law, s)}, {_IN[part]})."


_ONE = "(No single chance|That one chance|The run is too small)"


@recount("key-figures", _ONE)
@recount("theorem-1", _ONE)
def one_chance_sentence(v: View, s: Sheet, k: int) -> str:
    return one_chance(v, s)


def off_moments(v: View, n: int) -> tuple[float, float, dict[str, float], dict[str, float]]:
    """p, r, and how far the measured moments are from Theorem 1's with each of them."""
    rows = v.run.rows(v.method, v.distribution, n)
    p, r = float(share_c(v, n).mean()), 1 / (float(rows["mean_lepp"].mean()) - 1)
    by_p, by_r = theorem_1(p), theorem_1(r)
    measured = {name: float(rows[column].mean()) for name, column in MOMENTS.items()}
    return (
        p,
        r,
        {name: measured[name] / by_p[name] - 1 for name in MOMENTS},
        {name: measured[name] / by_r[name] - 1 for name in MOMENTS},
    )


def side(off: float) -> str:
    return "above" if off > 0 else "below"


def _lie(offs: dict[str, float], s: Sheet, but: str = "") -> str:
    return listed([f"the {k} {s.percent(abs(o))} {side(o)}" for k, o in offs.items() if k != but])


@recount("theorem-1", "At ")
def theorem_1_sentence(v: View, s: Sheet, k: int) -> str:
    n = max(v.sizes)
    p, r, by_p, by_r = off_moments(v, n)
    return (
        f"At {s(n)} points, measured are, against the theorem with p = {s(p)} of the first step, "
        f"{_lie(by_p, s)}; against it with r = {s(r)} of all steps, where the mean fits by "
        f"construction, {_lie(by_r, s, 'mean')}."
    )


@recount("key-figures", "With the chance at the first step")
def theorem_1_in_short(v: View, s: Sheet, k: int) -> str:
    _, _, by_p, by_r = off_moments(v, max(v.sizes))
    mean, sd = by_p["mean"], by_r["standard deviation"]
    return (
        f"With the chance at the first step, the mean is {s.percent(abs(mean))} {side(mean)} the "
        f"theorem's; with that of all steps it fits by construction, and the standard deviation is "
        f"{s.percent(abs(sd))} {side(sd)}."
    )


@cache
def premise_by_size(run: Run, method: str, distribution: str) -> dict[int, tuple]:
    """By size: verdict on 1/3 at every step, least chance to end, its place, end; last size."""
    made = {}
    for n, frame in run.histogram(method, distribution).groupby("n_points"):
        if n in run.single_sizes(method):
            continue
        rates = rates_of([matrix(frame)])
        number = rates.n_sure
        if not number:
            made[int(n)] = ("undecided", np.nan, 0, np.nan, 0)
            continue
        ended, half = 1 - rates.rates[:number], rates.half[:number]
        holds, fails = (ended - half >= 1 / 3).all(), (ended + half < 1 / 3).any()
        at = int(ended.argmin())
        word = "no" if fails else "yes" if holds else "undecided"
        high, upto = float((ended + half)[at]), int(rates.sizes[number - 1])
        made[int(n)] = (word, float(ended[at]), int(rates.sizes[at]), high, upto)
    return made


def all_of(words: list[str]) -> str:
    return "no" if "no" in words else "yes" if set(words) == {"yes"} else "undecided"


def least_chance(key: tuple) -> tuple[float, int, int] | None:
    """Least chance to end, its size, and the number of points."""
    known = [(rate, size, n) for n, (_, rate, size, *_) in premise_by_size(*key).items() if size]
    return min(known) if known else None


def bounds_hold(v: View) -> bool:
    rows = v.run.rows(v.method, v.distribution)
    return bool(rows["mean_lepp"].between(2, 4).all() and (rows["sd_lepp"] <= 6**0.5).all())


@recount("key-figures", "Theorem 2's bounds")
def theorem_2_in_short(v: View, s: Sheet, k: int) -> str:
    if not bounds_hold(v):
        return "Theorem 2's bounds fail."
    words = [word for word, *_ in premise_by_size(*v.key).values()]
    step = "step ends a path with a chance of at least 1/3"
    opening = "Theorem 2's bounds hold in every triangulation"
    if all_of(words) == "yes":
        return f"{opening}."
    if all_of(words) == "undecided":
        return f"{opening}, while it stays open whether every {step}, from which they would follow."
    failed = words.count("no")
    where = f"at {s(failed)} of {s(len(words))} numbers of points, " if failed < len(words) else ""
    least = s(least_chance(v.key)[0])  # type: ignore[index]
    return (
        f"{opening}, although not every {step} ({where}the least is {least}), from which they "
        "would follow."
    )


@recount("key-figures", "So does what they follow from")
def premise_in_short(v: View, s: Sheet, k: int) -> str:
    words = [word for word, *_ in premise_by_size(*v.key).values()]
    if all_of(words) == "yes":
        upto = [row[4] for row in premise_by_size(*v.key).values() if row[4]]
        known = (
            f"up to size {s(max(upto))}"
            if min(upto) == max(upto)
            else f"up to size {s(min(upto))} to {s(max(upto))}, by the number of points"
        )
        return (
            "So does what they follow from, that every step ends a path with a chance of at least "
            f"1/3, as far as the chances are known to within 0.05 ({known})."
        )
    return "Not every step is known to end a path with a chance of at least 1/3."


@recount("key-figures", "Theorem 1 takes one chance for all steps, ")
def one_chance_in_short(v: View, s: Sheet, k: int) -> str:
    start = "Theorem 1 takes one chance for all steps, which"
    law = constant_law(*v.key, law_part(v.key))
    if law is None:
        return f"{start} this run is too small to test."
    verdict = "rejected" if law.rejected else "not rejected"
    return f"{start} is {verdict} ({s.p_is(law.log10_p, 1e-4)})."


@recount("types", "At ")
def share_of_c(v: View, s: Sheet, k: int) -> str:
    n = max(v.sizes)
    return (
        f"At {s(n)} {v.word} points the share of such neighbours, which is the chance that a path "
        f"ends at its first step, but for the few that end at the boundary there, is "
        f"p = {s(share_c(v, n).mean())}."
    )


@recount("types", "Of all steps")
def share_of_steps(v: View, s: Sheet, k: int) -> str:
    r = off_moments(v, max(v.sizes))[1]
    return f"Of all steps together, a share of r = {s(r)} ends a path."


@recount("types", "(As far as|No step is known)")
def every_step(v: View, s: Sheet, k: int) -> str:
    least = least_chance(v.key)
    if least is None:
        return "No step is known to within 0.05, so that this stays open."
    words = [word for word, *_ in premise_by_size(*v.key).values()]
    holds, fails, total = words.count("yes"), words.count("no"), len(words)
    if total in (holds, fails):
        where = f"{'holds' if holds else 'fails'} in every group"
    elif fails:
        where = f"fails in {s(fails)} of {s(total)} groups"
    else:
        where = f"is clear in {s(holds)} of {s(total)} groups"
    where += " that has a spread" if v.run.single_sizes(v.method) else ""
    return (
        f"As far as the chances are known to within 0.05, this {where}: the least "
        f"chance to end, at a neighbour of type C or at the boundary, is "
        f"{s(least[0])}, at size {s(least[1])} and {s(least[2])} points."
    )


def _higher(most: float) -> str:
    """Whether the interior keeps to a third where the edge does not, as far as is known."""
    if most < 1 / 3:
        return "It is higher in the interior, but below 1/3 there as well:"
    return "The edge of the mesh has a part in it: in the interior,"


@recount("types", "(It is higher in the interior|Where it is|The edge of the mesh has)")
def of_the_edge(v: View, s: Sheet, k: int) -> str:
    least = least_chance(v.key)
    n, rates = continuation(*v.key, INTERIOR)  # type: ignore[misc]
    number = rates.n_sure
    at = int(rates.rates[:number].argmax())
    ended, half = 1 - rates.rates[at], rates.half[at]
    _, of_whole, _, high, _ = premise_by_size(*v.key)[n]
    if not ended - half > high:
        return "The interior's least is not known to be higher."
    words = _higher(ended + half)
    if n != least[2] and ended + half >= 1 / 3:  # type: ignore[index]
        words = (
            f"Where it is {s(of_whole)}, the edge of the mesh has a part in it: in the interior,"
        )
    return (
        f"{words} at {s(n)} points, the least is {s(ended)}, at size "
        f"{s(rates.sizes[at])}, as far as the chances there are known (up to size "
        f"{s(rates.sizes[number - 1])})."
    )


@recount("types", "The bounds ")
def bounds_sentence(v: View, s: Sheet, k: int) -> str:
    rows = v.run.rows(v.method, v.distribution)
    if not bounds_hold(v):
        kept = rows["mean_lepp"].between(2, 4) & (rows["sd_lepp"] <= 6**0.5)
        by_size = kept.groupby(rows["n_points"]).all()
        return f"The bounds are broken in {s((~by_size).sum())} of {s(len(by_size))} groups."
    return (
        f"The bounds hold in every single triangulation: means from {s(rows['mean_lepp'].min())} "
        f"to {s(rows['mean_lepp'].max())}, standard deviations up to {s(rows['sd_lepp'].max())}, "
        f"where √6 is {s(6**0.5)}."
    )


@recount("figure-types", "At ")
def types(v: View, s: Sheet, k: int) -> str:
    n = max(v.sizes)
    shares = [f"{s.percent(share_c(v, n, kind).mean())} of type {kind.upper()}" for kind in "abc"]
    return f"At {s(n)} points, {listed(shares)}."


@recount("figure-moments")
def moments_inside(v: View, s: Sheet, k: int) -> str:
    inside = cases = 0
    for n in v.sizes:
        by_p = theorem_1(float(share_c(v, n).mean()))
        rows = v.run.rows(v.method, v.distribution, n)
        for name, column in MOMENTS.items():
            _, low, high = mean_interval(rows[column].dropna().to_numpy())
            inside += low <= by_p[name] <= high
            cases += not np.isnan(low)
    some = " that has intervals" if v.run.single_sizes(v.method) else ""
    return (
        "With p of the first step, Theorem 1's value lies inside the 95 % interval of the "
        f"measured one in {s(inside)} of "
        f"{s(cases)} cases (four moments at each number of points{some})."
    )


@recount("figure-continuation", "At .* the chance to go on")
def going_on(v: View, s: Sheet, k: int) -> str:
    part = law_part(v.key)
    n, rates = continuation(*v.key, part)  # type: ignore[misc]
    law = constant_law(*v.key, part)
    level = law is not None and not law.rejected
    number = rates.n_sure if rates.n_sure > 1 else len(rates.sizes)
    c, half, last = rates.rates[:number], rates.half[:number], rates.sizes[number - 1]
    known = "as far as it is known" if rates.n_sure > 1 else "where it is not known"
    upto = f"up to size {s(last)}, {known} to within 0.05"
    why = "" if n == max(v.sizes) else " (the largest number with 16 triangulations or more)"
    start = f"At {s(n)} points{why}, {_IN[part]}, the chance to go on"
    # Marks are set in the order of the sentence's words, whichever they are.
    ends = f"from {s.percent(c[0])} to {s.percent(c[-1])}"
    steps = np.diff(c)
    if (steps <= 0).all() and not level:
        return f"{start} falls with every step, {ends}, {upto}."
    if (steps >= 0).all() and not level:
        return f"{start} rises with every step, {ends}, {upto}."
    rises = (c[1:] - half[1:] > c[:-1]).any()
    falls = (c[1:] + half[1:] < c[:-1]).any()
    if rises != falls and not level:
        return f"{start} {'rises' if rises else 'falls'} {ends}, {upto}."
    return f"{start} moves between {s.percent(c.min())} and {s.percent(c.max())}, {upto}."


@recount("figure-continuation", "In the whole mesh it falls")
def rises_again(v: View, s: Sheet, k: int) -> str:
    whole, inside = (continuation(*v.key, part)[1] for part in (WHOLE, INTERIOR))  # type: ignore[index]
    c, half = whole.rates[: whole.n_sure], whole.half[: whole.n_sure]
    least = int(c.argmin())
    most = least + 1 + int(c[least + 1 :].argmax())
    end = inside.n_sure - 1
    low = c[most] - half[most]
    if not (low > c[least] + half[least] and low > inside.rates[end] + inside.half[end]):
        return "In the whole mesh it is not known to rise again."
    return (
        f"In the whole mesh it falls to {s.percent(c[least])} after {s(whole.sizes[least])} "
        f"triangles and rises again, to {s.percent(c[most])} after {s(whole.sizes[most])}: the "
        "longest paths are those along the edge."
    )


@recount("figure-continuation", "One chance for all steps")
def level_law(v: View, s: Sheet, k: int) -> str:
    law = constant_law(*v.key, law_part(v.key))
    assert law is not None
    return f"One chance for all steps is not rejected ({_test(law, s)})."


@recount("figure-continuation", "The law ")
def fitted_law(v: View, s: Sheet, k: int) -> str:
    law = falling_law(*v.key, law_part(v.key))
    assert law is not None
    words = [
        f"{sign} = {s(value, 1e-6 * abs(value))} ± {s(error, 1e-5 * error)}"
        for sign, value, error in zip("λba", law.coefficients, law.errors, strict=True)
    ]
    known = continuation(*v.key, law_part(v.key))[1]  # type: ignore[index]
    further = known.sizes[known.n_sure - 1] > law.upto
    why = " (no more sizes than a third of the covariance's degrees of freedom)" if further else ""
    return (
        f"The law λ / (k + b)ᵃ with {listed(words)}, fitted up to size {s(law.upto)}{why}, is "
        f"{'rejected' if law.rejected else 'not rejected'} ({_test(law, s)})."
    )


@recount("figure-continuation", "The longest of")
def longest_seen(v: View, s: Sheet, k: int) -> str:
    part = law_part(v.key)
    n, rates = continuation(*v.key, part)  # type: ignore[misc]
    paths = rates.reached[0]
    told = (
        f"The longest of {s(paths)} such paths at {s(n)} points has {s(rates.sizes[-1])} triangles"
    )
    constant = constant_law(*v.key, part)
    falling = falling_law(*v.key, part) if constant and constant.rejected else None
    expected = []
    if falling:
        scale, b, a = falling.coefficients
        size = longest(lambda at: scale / (at + b) ** a, paths)
        if size:
            although = " (which is rejected)" if falling.rejected else ""
            expected.append(f"{s(size)} by this law{although}")
    all_steps = float(rates.rates @ rates.reached / rates.reached.sum())
    for chance, words in (
        (rates.rates[0], "Theorem 1 with the chance at the first step"),
        (all_steps, "Theorem 1 with that of all steps"),
    ):
        size = longest(lambda _, c=chance: c, paths)
        if size:
            expected.append(f"{s(size)} by {words}")
    return f"{told}; expected are {listed(expected)}." if expected else f"{told}."


def shares(v: View) -> tuple[np.ndarray, float]:
    """Shares of all sizes, and the pooled p."""
    counts = matrix(v.run.histogram(v.method, v.distribution)).sum(axis=0)
    rows = v.run.rows(v.method, v.distribution)
    return counts / counts.sum(), float(rows["n_type_c"].sum() / rows["n_interior_longest"].sum())


@recount("figure-law", "The commonest size")
def commonest(v: View, s: Sheet, k: int) -> str:
    share, p = shares(v)
    most = 2 + int(share[2:].argmax())
    return (
        f"The commonest size is {s(most)} ({s.percent(share[most])} of the triangles; the law has "
        f"{s.percent((1 - p) ** (most - 2) * p)})."
    )


@recount("figure-law", "Sizes of ")
def long_paths(v: View, s: Sheet, k: int) -> str:
    share, p = shares(v)
    measured, law = float(share[8:].sum()), (1 - p) ** 6
    if measured < law:
        return f"Sizes of 8 and more are {s(law / measured)} times rarer than in the law."
    return f"Sizes of 8 and more are {s(measured / law)} times as common as in the law."


@recount("figure-worst-case", "A strip of ")
def strip(v: View, s: Sheet, k: int) -> str:
    return (
        f"A strip of {s(12)} triangles; the number in each is its LEPP size, from {s(12)} at the "
        f"narrow end to {s(1)}."
    )


@recount("figure-worst-case", "Strips of up to")
def strips(v: View, s: Sheet, k: int) -> str:
    """The sentence is of kernels; here the slow twin walks through a short strip."""
    strip = lepp.worst_case_strip(50)
    sizes = naive.Paths(strip.points, strip.triangles.tolist()).sizes()
    exactly = sorted(sizes) == list(range(1, 51))
    words = (
        "all have the mean (n + 1) / 2 and the maximum n exactly."
        if exactly
        else "do not all have the mean (n + 1) / 2: see the table."
    )
    return (
        f"Strips of up to {s(1_000_000)} triangles, measured by the same kernels as the study, "
        f"{words}"
    )


@recount("statement Premise of Theorem 1")
def premise_of_theorem_1(v: View, s: Sheet, k: int) -> str:
    start = (
        "Every step of a path ends with the same probability p, and so the sizes are geometric: "
        "mean (p + 1) / p, standard deviation √(1 − p) / p, skewness (2 − p) / √(1 − p), excess "
        "kurtosis (p² − 6 p + 6) / (1 − p)"
    )
    # The interior where it can be tested, else the whole.
    part = INTERIOR if constant_law(*v.key, INTERIOR) else WHOLE
    law = constant_law(*v.key, part)
    if law is None:
        return f"{start} | not tested | the run has too few triangulations"
    n, rates = continuation(*v.key, part)  # type: ignore[misc]
    at = int(np.flatnonzero(rates.sizes == law.upto)[0])
    largest = max(v.sizes)
    p, r, by_p, by_r = off_moments(v, largest)

    def are(offs: dict[str, float], but: str = "") -> str:
        return listed(
            [f"the {k} is {s.percent(abs(o))} {side(o)}" for k, o in offs.items() if k != but]
        )

    return (
        f"{start} | {'no' if law.rejected else 'not rejected'} | The chance to go on is "
        f"{s.percent(rates.rates[0])} after {s(2)} triangles and {s.percent(rates.rates[at])} "
        f"after {s(law.upto)} ({part}, {s(n)} points). One chance for all: "
        f"{s.p_is(law.log10_p, 1e-4)}. What follows, in whole meshes of {s(largest)} "
        f"points: with p = {s(p)} of the first step, {are(by_p)} Theorem 1's; with r = {s(r)} of "
        f"all steps the mean fits by construction, {are(by_r, 'mean')} Theorem 1's"
    )


@recount("statement Premise of Theorem 2", "The probability p")
def premise_of_theorem_2(v: View, s: Sheet, k: int) -> str:
    shares_by_size = [share_c(v, n).mean() for n in v.sizes]
    word = all_of([word for word, *_ in premise_by_size(*v.key).values()])
    least = least_chance(v.key)
    seen = f"share p of type C from {s(min(shares_by_size))} to {s(max(shares_by_size))}; "
    told = (
        "no step is known to within 0.05"
        if least is None
        else "the least chance to end at any step, at a neighbour of type C or at the boundary, is "
        f"{s(least[0])}, at size {s(least[1])} ({s(least[2])} points)"
    )
    return (
        f"The probability p of a type C neighbour is at least 1/3, at every step | {word} | "
        f"{seen}{told}"
    )


@recount("statement Theorem 2", "The (mean|standard deviation)")
def bounds_of_theorem_2(v: View, s: Sheet, k: int) -> str:
    rows = v.run.rows(v.method, v.distribution)
    if k == 0:
        start, kept = "The mean LEPP size is between 2 and 4", rows["mean_lepp"].between(2, 4)
        seen = f"{s(rows['mean_lepp'].min())} to {s(rows['mean_lepp'].max())}"
    else:
        start, kept = "The standard deviation is at most √6", rows["sd_lepp"] <= 6**0.5
        seen = f"up to {s(rows['sd_lepp'].max())}"
    return (
        f"{start} | {'yes' if kept.all() else 'no'} | {seen}; {s(kept.sum())} of {s(len(kept))} "
        "triangulations"
    )
