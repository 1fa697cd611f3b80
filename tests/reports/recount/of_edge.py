"""The edge and the interior: means of the parts and the layers, where the longest paths start."""

from functools import cache

import numpy as np
import pandas as pd
from expected import Sheet, listed, plural
from growth import means_of
from recounts import View, recount
from run_data import (
    INTERIOR,
    INTERIOR_LAYER,
    WHOLE,
    WORDS,
    Run,
    holm,
    log10_f_tail,
    log10_t_tail,
    t95,
)
from scipy import stats


@cache
def layers(run: Run, method: str, distribution: str, n: int) -> pd.DataFrame:
    """Of one size: by layer the share of triangles and the mean with its interval."""
    frame = run.counts("layers", method, distribution)
    frame = frame[frame["n_points"] == n]
    frame = frame.assign(steps=frame["lepp_size"] * frame["count"])
    sums = frame.groupby(["layer", "replicate"])[["steps", "count"]].sum()
    made = []
    for layer, one in sums.groupby("layer"):
        mean = one["steps"].sum() / one["count"].sum()
        r = len(one)
        residuals = one["steps"] - mean * one["count"]
        error = (
            np.sqrt(r / (r - 1) * (residuals**2).sum()) / one["count"].sum() if r > 1 else np.nan
        )
        half = t95(r - 1) * error if r > 1 and error > 0 else np.nan
        made.append((layer, one["count"].sum(), mean, mean - half, mean + half, error))
    table = pd.DataFrame(
        made, columns=["layer", "count", "mean", "low", "high", "error"]
    ).set_index("layer")
    return table.assign(share=table["count"] / table["count"].sum())


def edge_share(run: Run, method: str, distribution: str, n: int) -> float:
    """Share of the triangles that are not in the interior."""
    return 1 - float(layers(run, method, distribution, n)["share"].get(INTERIOR_LAYER, 0.0))


@recount("parts", "At .* points the edge has")
def share_by_method(v: View, s: Sheet, k: int) -> str:
    n = max(v.run.all_groups(v.method, v.distribution, INTERIOR))
    return (
        f"At {s(n)} points the edge has {s.percent2(edge_share(*v.key, n))} of the triangles by "
        f"the {v.method_word} method."
    )


@recount("parts", "No ")
def none_has_an_interior(v: View, s: Sheet, k: int) -> str:
    assert not v.run.all_groups(v.method, v.distribution, INTERIOR)
    of = f"{v.method_word} triangulation of {v.word} points"
    return f"No {of} is large enough here to have an interior."


@recount("parts", "From ")
def changes(v: View, s: Sheet, k: int) -> str:
    whole = {n: g.mean() for n, g in v.run.all_groups(v.method, v.distribution).items()}
    inside = {n: g.mean() for n, g in v.run.all_groups(v.method, v.distribution, INTERIOR).items()}
    a, b = min(inside), max(inside)
    return (
        f"From {s(a)} to {s(b)} points the mean of the whole mesh changes by "
        f"{s(whole[b] - whole[a])}, from {s(whole[a])} to {s(whole[b])}, and that of the interior "
        f"by {s(inside[b] - inside[a])}, from {s(inside[a])} to {s(inside[b])}."
    )


def _change(v: View, part: str) -> tuple[int, int, float, float, float, float]:
    """Welch's test and interval between the ends of the sizes that have an interior."""
    sizes = v.run.all_groups(v.method, v.distribution, INTERIOR)
    a, b = min(sizes), max(sizes)
    groups = v.run.all_groups(v.method, v.distribution, part)
    first, last = groups[a], groups[b]
    parts = np.array([one.var(ddof=1) / len(one) for one in (first, last)])
    df = parts.sum() ** 2 / (parts**2 / [len(first) - 1, len(last) - 1]).sum()
    error, change = np.sqrt(parts.sum()), last.mean() - first.mean()
    half = stats.t.ppf(0.975, df) * error
    return a, b, change, change - half, change + half, 2 * stats.t.sf(abs(change) / error, df)


def _whose(v: View) -> str:
    _, _, whole, _, _, p = _change(v, WHOLE)
    _, _, _, low, high, _ = _change(v, INTERIOR)
    assert p < 0.05
    word = "growth" if whole > 0 else "fall"
    least, most = min(low / whole, high / whole), max(low / whole, high / whole)
    if most < 0.5:
        return f"most of the {word} of the whole mesh is the edge's"
    if least > 0.5:
        return f"most of the {word} of the whole mesh is the interior's own"
    return f"how much of the {word} of the whole mesh is the edge's stays open"


@recount("parts", "(Most of the|How much of the)")
def whose_change(v: View, s: Sheet, k: int) -> str:
    whose = _whose(v)
    return f"{whose[0].upper()}{whose[1:]}."


@recount("key-figures", "In the interior, ")
def edge_in_short(v: View, s: Sheet, k: int) -> str:
    a, b, change, low, high, _ = _change(v, INTERIOR)
    return (
        f"In the interior, {INTERIOR_LAYER} steps or more from the hull, it changes by {s(change)} "
        f"(95 % from {s(low)} to {s(high)}) from {s(a)} points to {s(b)}: {_whose(v)}."
    )


def _last_layers(run: Run, method: str, distribution: str) -> tuple[float, np.ndarray] | None:
    """Mean of layers 24 to 29 of the largest meshes, and how far it is off the interior's."""
    frame = run.counts("layers", method, distribution)
    frame = frame[frame["n_points"] == run.layered_size(method, distribution)]

    def means_of_layers(kept: pd.Series) -> pd.Series:
        return pd.Series(
            {
                k: np.average(one["lepp_size"], weights=one["count"])
                for k, one in frame[kept].groupby("replicate")
            },
            dtype=float,
        )

    last = means_of_layers(frame["layer"].between(24, 29))
    both = pd.concat([last, means_of_layers(frame["layer"] == INTERIOR_LAYER)], axis=1).dropna()
    if len(both) < 2:
        return None
    return float(both[0].mean()), (both[0] - both[1]).to_numpy()


def _log10_p(difference: np.ndarray) -> float:
    t = difference.mean() / (difference.std(ddof=1) / np.sqrt(len(difference)))
    return log10_t_tail(abs(t), len(difference) - 1) + np.log10(2)


@recount("layers", "Layers 24 to 29")
def reach(v: View, s: Sheet, k: int) -> str:
    every = {
        (m, d): found
        for m in v.run.methods
        for d in v.run.distributions
        if (found := _last_layers(v.run, m, d)) is not None
    }
    p = dict(
        zip(every, holm(np.array([10 ** _log10_p(off) for _, off in every.values()])), strict=True)
    )
    key = (v.method, v.distribution)
    mean, off = every[key]
    half = t95(len(off) - 1) * off.std(ddof=1) / np.sqrt(len(off))
    interval = f"95 % from {s(off.mean() - half)} to {s(off.mean() + half)}"
    start = f"Layers 24 to 29, the last before the interior, have a mean of {s(mean)} together"
    if p[key] < 0.05:
        return (
            f"{start}, {s(abs(off.mean()))} {'above' if off.mean() > 0 else 'below'} that of the "
            f"interior (difference {interval}; "
            f"{s.p_is(_log10_p(off), 1e-5)}): of {v.word} points the edge, or what the density of "
            "the points has to do with it, reaches further, and some of it is in what is called "
            "the interior here."
        )
    return (
        f"{start}, which is not shown to differ from that of the interior (by {s(off.mean())}, "
        f"{interval}): no reach of the edge beyond them is seen."
    )


@recount("parts", "At .* points the interiors")
def one_mean(v: View, s: Sheet, k: int) -> str:
    seen = {d: means_of(v.run.all_groups(v.method, d, INTERIOR)) for d in v.run.distributions}
    x = max(one.x.max() for one in seen.values())
    at = {d: int(np.flatnonzero(one.x == x)[0]) for d, one in seen.items() if x in one.x}
    y = {d: float(seen[d].y[i]) for d, i in at.items()}
    w = np.array([1 / seen[d].v[i] for d, i in at.items()])
    values = np.array(list(y.values()))
    mean = float(w @ values / w.sum())
    df, df_error = len(y) - 1, sum(seen[d].df for d in at)
    p = log10_f_tail(float(w @ (values - mean) ** 2) / df, df, df_error)
    low, high = min(y, key=y.__getitem__), max(y, key=y.__getitem__)
    start = f"At {s(1000 * x)} points the interiors of the {s(len(y))} distributions"
    which = (
        f"the {WORDS[low]} points have the lowest and the {WORDS[high]} ones the highest, "
        f"{s(y[high] - y[low])} apart."
    )
    if p < np.log10(0.05):
        return f"{start} do not have one mean ({s.p_is(p, 1e-5)}): {which}"
    half = t95(df_error) / np.sqrt(w.sum())
    return (
        f"{start} may have one mean ({s.p_is(p, 1e-5)}), {s(mean)} (95 % from {s(mean - half)} to "
        f"{s(mean + half)}): {which}"
    )


@recount("figure-parts", "At ")
def spans(v: View, s: Sheet, k: int) -> str:
    words = []
    for part in (WHOLE, INTERIOR):
        groups = [v.run.all_groups(v.method, d, part) for d in v.run.distributions]
        n = max((n for group in groups for n in group), default=0)
        last = [group[n].mean() for group in groups if n in group]
        where = f"in the {'whole mesh' if part == WHOLE else 'interior'}"
        if len(last) > 1:
            means = f"the means of {s(len(last))} distributions lie between {s(min(last))} and "
            words.append(f"{where} {means}{s(max(last))}")
        elif last:
            words.append(f"{where} the mean is {s(last[0])}")
    return f"At {s(max(v.sizes))} points, {listed(words)}."


@recount("layers", "At ")
def edge_of_largest(v: View, s: Sheet, k: int) -> str:
    n = v.run.layered_size(v.method, v.distribution)
    return f"At {s(n)} points the edge has {s.percent2(edge_share(*v.key, n))} of the triangles."


def off_interior(run: Run, method: str, distribution: str, n: int) -> dict[str, list[int]]:
    """Layers whose means are below and above the interior's: t tests, by Holm's correction."""
    table = layers(run, method, distribution, n)
    frame = run.counts("layers", method, distribution)
    df = frame.loc[frame["n_points"] == n, "replicate"].nunique() - 1
    if INTERIOR_LAYER not in table.index or df < 1:
        return {"below": [], "above": []}
    inside, edge = table.loc[INTERIOR_LAYER], table[table.index < INTERIOR_LAYER]
    away = (edge["mean"] - inside["mean"]).to_numpy()
    errors = edge["error"].where(edge["error"] > 0).to_numpy()
    p = 2 * stats.t.sf(np.abs(away) / np.sqrt(errors**2 + inside["error"] ** 2), df)
    shown = holm(np.nan_to_num(p, nan=1.0)) < 0.05
    at = edge.index.to_numpy()
    return {"below": at[shown & (away < 0)].tolist(), "above": at[shown & (away > 0)].tolist()}


def _named(numbers: list[int], s: Sheet) -> str:
    """Layers in words, those in a row by their ends."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    words = [f"{s(run[0])} to {s(run[-1])}" if len(run) > 1 else s(run[0]) for run in runs]
    return f"{plural(len(numbers), 'layer')} {listed(words)}"


@recount("layers", "The mean of the interior is")
def layers_off_interior(v: View, s: Sheet, k: int) -> str:
    n = v.run.layered_size(v.method, v.distribution)
    table, off = layers(*v.key, n), off_interior(*v.key, n)
    inside = s(table.loc[INTERIOR_LAYER, "mean"])
    words = [f"below it in {_named(off['below'], s)}"] if off["below"] else []
    if off["above"]:
        top = table.loc[off["above"], "mean"].idxmax()
        row = table.loc[top]
        interval = f" (95 % from {s(row.low)} to {s(row.high)})" if row.low == row.low else ""
        words.append(
            f"above it in {_named(off['above'], s)}, most in layer {s(top)}, at "
            f"{s(row['mean'])}{interval}"
        )
    where = f"is {' and '.join(words)}" if words else "is not shown to differ from it in any layer"
    return (
        f"The mean of the interior is {inside}; by tests of all layers, with Holm's correction, "
        f"that of the edge {where}."
    )


@recount("figure-layers", "(The layer furthest above|No layer)")
def furthest_layers(v: View, s: Sheet, k: int) -> str:
    words = []
    for d in v.run.distributions:
        n = v.run.layered_size(v.method, d)
        above = off_interior(v.run, v.method, d, n)["above"]
        layer = "none"
        if above:
            means = layers(v.run, v.method, d, n).loc[above, "mean"]
            layer = f"{s(means.idxmax())} ({s(means.max())})"
        words.append(f"{WORDS[d]} points, {layer}")
    begins = f"which begins at layer {INTERIOR_LAYER}"
    if all(word.endswith(", none") for word in words):
        return f"No layer is shown to lie above the interior, {begins}, for any distribution."
    return f"The layer furthest above the interior, {begins}: {'; '.join(words)}."


@cache
def long_paths(run: Run, method: str, distribution: str) -> pd.DataFrame:
    """Counts of paths of a size (rows) by layer (columns), at the largest number of points."""
    frame = run.counts("layers", method, distribution)
    frame = frame[frame["n_points"] == frame["n_points"].max()]
    return frame.groupby(["lepp_size", "layer"])["count"].sum().unstack(fill_value=0)


def _hundred(counts: pd.DataFrame) -> tuple[int, int, int] | None:
    """The largest size that 100 paths have or pass, how many do, and of them start at the edge."""
    for size in sorted(counts.index, reverse=True):
        of = counts[counts.index >= size]
        total = int(of.to_numpy().sum())
        if total >= 100:
            inside = int(of[INTERIOR_LAYER].sum()) if INTERIOR_LAYER in of else 0
            return size, total, total - inside
    return None


@recount("longest", "Of the ")
def longest_start(v: View, s: Sheet, k: int) -> str:
    counts = long_paths(*v.key)
    size, total, at_edge = _hundred(counts)  # type: ignore[misc]
    n = max(v.sizes)
    edge = edge_share(*v.key, n)
    return (
        f"Of the {s(total)} paths of {s(size)} triangles and more at {s(n)} points, {s(at_edge)} "
        f"{plural(max(at_edge, 1), 'starts', 'start')} at the edge; by its share of the triangles, "
        f"{s.percent2(edge)}, {s(total * edge)} would."
    )


@recount("longest", "At this number of points")
def very_longest(v: View, s: Sheet, k: int) -> str:
    counts = long_paths(*v.key)
    size = int(max(counts.index))
    row = counts.loc[size]
    total, layer = int(row.sum()), int(row.idxmax())
    where = "in the interior" if layer == INTERIOR_LAYER else f"in layer {s(layer)}"
    inside = int(row[INTERIOR_LAYER]) if INTERIOR_LAYER in row else 0
    if total == 1:
        start = f"starts {where}"
    elif row.max() == total:
        start = f"all start {where}"
    elif 2 * row.max() > total:
        start = f"most start {where}"
    else:
        start = f"{s(inside)} of them {plural(max(inside, 1), 'starts', 'start')} in the interior"
    return (
        f"At this number of points {s(total)} {plural(total, 'path has', 'paths have')} the "
        f"largest size of all, {s(size)}, and {start}."
    )


@recount("figure-longest", "Of the longest paths")
def longest_by_distribution(v: View, s: Sheet, k: int) -> str:
    words = []
    for d in v.run.distributions:
        found = _hundred(long_paths(v.run, v.method, d))
        if found:
            size, total, at_edge = found
            chance = total * edge_share(v.run, v.method, d, max(v.sizes))
            words.append(
                f"{s(at_edge)} and {s(chance)} of {s(total)} for {WORDS[d]} points (of {s(size)} "
                "triangles and more)"
            )
    return (
        "Of the longest paths, so many start at the edge, and so many would by its share of the "
        f"triangles: {'; '.join(words)}."
    )
