"""The rest: the view in short, tiles, counts of statements, regions, groups, completeness."""

from functools import cache

import naive
import numpy as np
from expected import Sheet, listed, plural
from growth import NEAR, one_limit, scores, survivors
from of_comparisons import analogous as _analogous
from of_paper import independent
from of_statistics import figure_5, figure_6, table_2, table_3, table_4, table_5, table_6, table_7
from of_theory import (
    bounds_of_theorem_2,
    off_moments,
    premise_of_theorem_1,
    premise_of_theorem_2,
    side,
)
from recounts import View, recount
from run_data import WHOLE, log10_chi2_tail, mean_interval
from scipy.spatial import Delaunay

from study.design.sampling import sample_points


@recount("description")
def description(v: View, s: Sheet, k: int) -> str:
    done, sizes = v.run.results, v.sizes
    return (
        f"{s(len(done))} random triangulations of {s(min(sizes))} to {s(max(sizes))} points, "
        f"{s(done['n_triangles'].sum())} triangles in all: the longest-edge propagation path "
        "(LEPP) of every one of them, measured, and held against the published theory and "
        "statistics."
    )


@recount("source", "This run")
def source(v: View, s: Sheet, k: int) -> str:
    versions = {e["packages"]["lepp-study"] for e in v.run.manifest["environments"]}
    return (
        f"This run: lepp-study {listed(sorted(versions))}, seed {v.run.design['seed']} (how to "
        "cite)."
    )


@recount("source", "The study")
def study(v: View, s: Sheet, k: int) -> str:
    cited = v.run.published["citation"]
    return (
        f"The study: {listed(cited['authors'])}, “{cited['title']}” "
        f"({cited['venue'].partition(',')[0]})."
    )


@recount("key-figures", "The first step of a refinement")
def first_step(v: View, s: Sheet, k: int) -> str:
    n = max(v.sizes)
    mean = v.run.rows(v.method, v.distribution, n)["mean_lepp"].mean()
    return (
        f"The first step of a refinement, from a random triangle of {s(n)} {v.word} points "
        f"triangulated by the {v.method_word} method, follows a path of {s(mean)} triangles on "
        "average; a refinement repeats it until the triangle is gone."
    )


@recount("key-figures", "In ")
def no_longer(v: View, s: Sheet, k: int) -> str:
    rows = v.run.rows(v.method, v.distribution)
    return (
        f"In {s(len(rows))} {plural(len(rows), 'triangulation')} of all sizes, with "
        f"{s(rows['n_triangles'].sum())} triangles, no path was longer than "
        f"{s(rows['max_lepp'].max())}."
    )


@recount("tile", "Mean LEPP at")
def tile_mean(v: View, s: Sheet, k: int) -> str:
    n = max(v.sizes)
    mean, low, high = mean_interval(v.run.rows(v.method, v.distribution, n)["mean_lepp"].to_numpy())
    at = f"Mean LEPP at {s(n)} points | {s(mean)}"
    if np.isnan(low):
        return f"{at} | of one triangulation, too few for an interval"
    return f"{at} | 95 % interval {s(low)} to {s(high)}"


@recount("tile", "Longest path")
def tile_longest(v: View, s: Sheet, k: int) -> str:
    frame = v.run.histogram(v.method, v.distribution)
    return (
        f"Longest path | {s(frame['lepp_size'].max())} | among {s(frame['count'].sum())} triangles"
    )


@recount("tile", "Chance p")
def tile_chance(v: View, s: Sheet, k: int) -> str:
    p, r, _, _ = off_moments(v, max(v.sizes))
    return (
        f"Chance p that a path ends at its first step | {s(p)} | of all steps, a share of "
        f"r = {s(r)}"
    )


@recount("tile", "Mean LEPP by Theorem 1")
def tile_theorem(v: View, s: Sheet, k: int) -> str:
    p, _, by_p, _ = off_moments(v, max(v.sizes))
    off = by_p["mean"]
    return (
        f"Mean LEPP by Theorem 1 | {s((p + 1) / p)} | from p; measured is {s.percent(abs(off))} "
        f"{side(off)}"
    )


@recount("tile", "(Independent published|Published) numbers")
def tile_met(v: View, s: Sheet, k: int) -> str:
    every = independent(v.run, v.method)
    label = "Independent published numbers met"
    if v.distribution != "uniform":
        every = [one for one in every if one.distribution == v.distribution]
        label = f"Published numbers of {v.word} points met"
    z = np.array([one.z for one in every])
    boot = sum(one.z**2 for one in every if one.kind == "levene")
    p = log10_chi2_tail(float(z @ z), len(z))
    return (
        f"{label} | {s((np.abs(z) <= 3).sum())} of {s(len(z))} | within 3 standard errors; χ² of "
        f"all has {s.p_is(p, 0.0125 * boot + 1e-4)}"
    )


def _pair_share(v: View) -> float:
    rows = v.run.rows(v.method, v.distribution, max(v.sizes))
    return float((rows["n_type_c"] / rows["n_triangles"]).mean())


@recount("tile", "In a terminal pair")
def tile_pair(v: View, s: Sheet, k: int) -> str:
    return (
        f"In a terminal pair | {s.percent(_pair_share(v))} | triangles where a refinement stays "
        "local"
    )


@recount("statement Conclusions", "The cost of a LEPP")
def bounded(v: View, s: Sheet, k: int) -> str:
    means = v.run.rows(v.method, v.distribution)["mean_lepp"]
    return (
        "The cost of a LEPP is constant | "
        f"{'not rejected' if means.max() <= 4 else 'no'} | our criterion, a mean of at most 4: "
        f"it is at most {s(means.max())} in {s(len(means))} "
        "triangulations"
    )


@recount("statement Table 7", "The logistic regression")
def has_limit_4(v: View, s: Sheet, k: int) -> str:
    start = "The logistic regression has an asymptotic limit equal to 4"
    found = one_limit(*v.key)
    if found is None:
        return f"{start} | not tested | the run has too few sizes"
    logistic = scores(*v.key, WHOLE)["logistic"]
    stands = "survives" if "logistic" in survivors(*v.key, WHOLE) else "fits far worse than others"
    model = f"; the logistic model {'is refuted' if logistic.refuted else stands}"
    if found.limit is None:
        seen = f"whether the mean has a limit: {found.word} ({found.reason})"
        return f"{start} | undecided | {seen}{model}"
    value, low, high = found.limit
    near = 2 * NEAR
    where = f"{s(value, near)} (95 % interval {s(low, near)} to {s(high, near)})"
    if np.isnan(value):
        where = f"below {s(high)}"
    return (
        f"{start} | {'not rejected' if low <= 4 <= high else 'no'} | the mean has a limit "
        f"({found.reason}): {where}{model}"
    )


_STATEMENTS = (
    (premise_of_theorem_1, 0), (premise_of_theorem_2, 0), (bounds_of_theorem_2, 0),
    (bounds_of_theorem_2, 1), (table_2, 0), (table_3, 0), (table_4, 0), (figure_5, 0),
    (table_5, 0), (table_6, 0), (figure_6, 0), (table_7, 0), (_analogous, 0), (bounded, 0),
    (has_limit_4, 0),
)  # fmt: skip


@recount("statements", "Of ")
def statements(v: View, s: Sheet, k: int) -> str:
    words = [recounted(v, Sheet(), place).split(" | ")[1] for recounted, place in _STATEMENTS]
    others = ("undecided", "not rejected", "not shown", "not tested")
    counted = [
        f"{s(words.count(key))} {plural(words.count(key), one, more)}"
        for key, one, more in (
            ("yes", "holds", "hold"),
            ("no", "does not", "do not"),
            *((word, f"is {word}", f"are {word}") for word in others),
        )
        if key in words
    ]
    return (
        f"Of {s(len(words))} statements of the paper, for {v.word} points and the {v.method_word} "
        f"method: {listed(counted)}."
    )


@recount("region-sizes", "In ")
def pair_share(v: View, s: Sheet, k: int) -> str:
    return (
        f"In {v.method_word} triangulations of {s(max(v.sizes))} {v.word} points, "
        f"{s.percent(_pair_share(v))} of the triangles stand in a terminal pair: a refinement that "
        "starts there touches nothing else."
    )


@recount("region-sizes", "The triangles whose")
def mean_region(v: View, s: Sheet, k: int) -> str:
    n = max(v.sizes)
    rows = v.run.rows(v.method, v.distribution, n)
    frame = v.run.counts("regions", v.method, v.distribution)
    largest = frame.loc[frame["n_points"] == n, "region_size"].max()
    return (
        "The triangles whose paths end at one terminal edge make a region of "
        f"{s((rows['n_triangles'] / rows['n_regions']).mean())} triangles on average; the largest "
        f"in these triangulations has {s(largest)}."
    )


@recount("figure-regions", "The commonest region")
def regions(v: View, s: Sheet, k: int) -> str:
    frame = v.run.counts("regions", v.method, v.distribution)
    counts = frame.groupby("region_size")["count"].sum().sort_index()
    share = counts / counts.sum()
    ninety = int(share.index[np.searchsorted(share.cumsum().to_numpy(), 0.9)])
    return (
        f"The commonest region has {s(share.idxmax())} triangles ({s.percent(share.max())} of the "
        f"regions); nine in ten have at most {s(ninety)}; the largest, of all numbers of points, "
        f"has {s(share.index.max())}."
    )


@recount("figure-triangulations", "The means of")
def triangulations(v: View, s: Sheet, k: int) -> str:
    rows = v.run.rows(v.method, v.distribution)
    low, high = (rows.loc[i] for i in (rows["mean_lepp"].idxmin(), rows["mean_lepp"].idxmax()))
    return (
        f"The means of {s(len(rows))} {plural(len(rows), 'triangulation')} lie between "
        f"{s(low.mean_lepp)}, at {s(low.n_points)} points, and {s(high.mean_lepp)}, at "
        f"{s(high.n_points)}."
    )


@recount("figure-groups", "The spread")
def groups(v: View, s: Sheet, k: int) -> str:
    sd = {n: g.std(ddof=1) for n, g in v.run.groups(v.method, v.distribution).items()}
    a, b = min(sd), max(sd)
    return (
        f"The spread between triangulations {'shrinks' if sd[b] < sd[a] else 'grows'} from "
        f"{s(sd[a])} at {s(a)} points to {s(sd[b])} at {s(b)}."
    )


@recount("figure-points", "400 points")
def points(v: View, s: Sheet, k: int) -> str:
    words = {
        "uniform": "the uniform ones fill the unit square",
        "normal": "the normal ones are a round cloud about the origin",
        "bivariate_normal": "the bivariate normal ones are a cloud stretched by a correlation of "
        f"{v.run.design['correlation']:g} (assumed, as the paper names none)",
        "exponential": "the exponential ones crowd into the corner at the origin",
    }
    each = listed([words[d] for d in v.run.distributions])
    return f"400 points of each distribution: {each}."


@recount("completeness", "All ")
def complete(v: View, s: Sheet, k: int) -> str:
    return f"All {s(len(v.run.results))} triangulations were made; none failed."


@recount("completeness", "(No triangle has|.* triangles? ha)")
def ties(v: View, s: Sheet, k: int) -> str:
    rows = v.run.results
    equal, nearly = int(rows["n_equal_longest"].sum()), int(rows["n_nearly_equal_longest"].sum())
    some = (
        "No triangle has"
        if not equal
        else f"{s(equal)} {plural(equal, 'triangle has', 'triangles have')}"
    )
    return (
        f"{some} longest edges of exactly equal length, and {s(nearly)} of "
        f"{s(rows['n_triangles'].sum())} have two that agree to 10⁻⁶ of their length: lengths are "
        "compared exactly, and where they are equal a path takes the shortest way."
    )


@cache
def _explored(v: View) -> tuple[int, list[int], int]:
    """Triangles, LEPP sizes and terminal edges of the explorer's points, by the slow twins."""
    d = v.run.design
    points = sample_points(
        v.distribution, 60, 0, seed=d["seed"], correlation=d.get("correlation", 0.5)
    )
    if v.method == "incremental":
        triangles = naive.incremental(points)[0]
    else:
        triangles = Delaunay(points).simplices.tolist()
    paths = naive.Paths(points, sorted(map(tuple, triangles)))
    ends = {paths.path(t)[1] for t in range(len(paths.triangles))}
    return len(paths.triangles), paths.sizes(), len(ends)


@recount("figure-path", ".* triangles of 60")
def explored(v: View, s: Sheet, k: int) -> str:
    return (
        f"{s(_explored(v)[0])} triangles of {s(60)} {v.word} points by the {v.method_word} method."
    )


@recount("figure-path", "Their paths")
def explored_paths(v: View, s: Sheet, k: int) -> str:
    _, sizes, ends = _explored(v)
    return (
        f"Their paths are {s(np.mean(sizes))} triangles long on average and {s(max(sizes))} at "
        f"most, and end at {s(ends)} {plural(ends, 'terminal edge')}."
    )
