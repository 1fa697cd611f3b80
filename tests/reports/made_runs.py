"""Made runs of two methods, turned this way and that, and what their reports say."""

from collections.abc import Callable
from functools import cache

import numpy as np
import pandas as pd
from frames import design
from page_text import PageText, drawn, page_text

from lepp import INTERIOR_LAYER
from study.results.store import Results

DESIGN = design(
    methods=("incremental", "delaunay"), distributions=("uniform",), sizes=(1000, 2000, 4000, 8000),
    repetitions=8,
)  # fmt: skip
METHODS = {"incremental": "plain insertion", "delaunay": "Delaunay"}

Frame = pd.DataFrame


def with_means(mean: Callable, spread: Callable = lambda n: 0.004 + 0 * n) -> Callable:
    """Give every triangulation a mean LEPP size: a function of n, and scores times a spread."""

    def change(results: Frame) -> Frame:
        n = results["n_points"].to_numpy(float)
        rng = np.random.default_rng(11)
        scores = np.tile(rng.permuted(np.linspace(-1.5, 1.5, 8)), len(results) // 8)
        return results.assign(mean_lepp=mean(n) + spread(n) * scores)

    return change


def with_shares(share_c: float) -> Callable:
    """Give every triangulation about this share of type C neighbours, and A and B half the rest."""

    def change(results: Frame) -> Frame:
        inside = results["n_interior_longest"]
        noise = 1 + 0.001 * np.cos(np.arange(len(results)))
        c = (inside * share_c * noise / 2).astype(int) * 2
        a = (inside - c) // 3
        return results.assign(n_type_c=c, n_type_a=a, n_type_b=inside - c - a)

    return change


def falling_shares(results: Frame) -> Frame:
    """Give large sets a share of type C below 1/3, small ones one above."""
    large = results["n_points"] > 2000
    high, low = (with_shares(share)(results) for share in (0.4, 0.3))
    return high.where(~large, low)


def level(n: np.ndarray) -> np.ndarray:
    return 3.05 + 0 * n


def growing(n: np.ndarray) -> np.ndarray:
    return 3.0 + 0.02 * np.log2(n / 1000)


def falling(n: np.ndarray) -> np.ndarray:
    return 3.6 - 0.02 * np.log2(n / 1000)


def histogram_of(sizes: dict[int, int]) -> Callable:
    """Give every triangulation the same histogram of LEPP sizes, n / 1000 times, and a little."""

    def change(histograms: Frame) -> Frame:
        keys = histograms[["method", "distribution", "n_points", "replicate"]].drop_duplicates()
        rows = [
            {**key, "lepp_size": size, "count": count * key["n_points"] // 1000 + key["replicate"]}
            for key in keys.to_dict("records")
            for size, count in sizes.items()
        ]
        return pd.DataFrame(rows)

    return change


@cache
def run(name: str) -> Results:
    """One of the made runs, by what is special about it."""
    return drawn(DESIGN, **CHANGES[name])


@cache
def page(name: str) -> PageText:
    """What the report of a made run says."""
    return page_text(run(name))


#: Paths of each triangulation whose chances to go on are made; far more than it has triangles.
PATHS = 400_000


def going_on(chance: Callable, layered: bool = False) -> Callable:
    """Draw every histogram anew, of paths that go on after k triangles with a chance of k."""
    rates = chance(np.arange(2.0, 14))
    law = np.append(1, np.cumprod(rates)) * np.append(1 - rates, 1)

    def change(frame: Frame) -> Frame:
        keys = frame[["method", "distribution", "n_points", "replicate"]].drop_duplicates()
        rows = []
        for place, key in enumerate(keys.to_dict("records")):
            counts = np.random.default_rng(place).multinomial(PATHS, law)
            rows += [{**key, "lepp_size": 2 + k, "count": c} for k, c in enumerate(counts) if c]
        made = pd.DataFrame(rows)
        return made.assign(layer=INTERIOR_LAYER) if layered else made

    return change


def no_interior(layers: Frame) -> Frame:
    return layers[layers["layer"] < INTERIOR_LAYER]


def with_chance(chance: Callable) -> dict[str, Callable]:
    return {"histograms": going_on(chance), "layers": going_on(chance, layered=True)}


def falling_law(k: np.ndarray) -> np.ndarray:
    return 0.9 / (k + 0.35) ** 0.5


def short_or_long(histograms: Frame) -> Frame:
    """Give small sets the sizes of short paths, large ones those of long paths."""
    large = histograms["n_points"] > 2000
    parts = (histogram_of(SHORT)(histograms[~large]), histogram_of(LONG)(histograms[large]))
    return pd.concat(parts, ignore_index=True)


def skewed(results: Frame) -> Frame:
    """Spread the means alike, but for large sets: most near one value, and one far away."""
    scores = np.array([0, 0.05, 0.1, 0.15, 0.2, 0.25, 7, 14])[results["replicate"]]
    even = with_means(level)(results)
    large = results["n_points"] == results["n_points"].max()
    return even.assign(mean_lepp=even["mean_lepp"].where(~large, 3.05 + 0.004 * scores))


def out_of_bounds(results: Frame) -> Frame:
    first = (results["replicate"] == 0) & (results["n_points"] == 2000)
    return results.assign(mean_lepp=results["mean_lepp"].where(~first, 4.5))


def moments(**factors: float) -> Callable:
    """Set the moments to Theorem 1's of the triangulation's own p, times factors."""

    def change(results: Frame) -> Frame:
        p = results["n_type_c"] / results["n_interior_longest"]
        wanted = {
            "mean_lepp": 1 / p + 1,
            "sd_lepp": np.sqrt(1 - p) / p,
            "skewness_lepp": (2 - p) / np.sqrt(1 - p),
            "kurtosis_lepp": 6 + p * p / (1 - p),
        }
        return results.assign(**{k: v * factors.get(k, 1.0) for k, v in wanted.items()})

    return change


def poor_points(sets: Frame) -> Frame:
    low = sets["replicate"] % 2 == 0
    return sets.assign(**{c: sets[c].where(~low, 0.001) for c in ("runs_p_x", "ks_p_y")})


def large_regions(regions: Frame) -> Frame:
    return regions.assign(region_size=regions["region_size"] * 3)


LONG = {1: 10, 2: 300, 3: 300, 4: 300, 5: 200, 9: 250, 12: 160}
SHORT = {1: 10, 2: 1200, 3: 600, 4: 150, 5: 30, 6: 6}

CHANGES: dict[str, dict[str, Callable]] = {
    "drawn": {},
    "level": {"results": with_means(level)},
    "growing": {"results": with_means(growing)},
    "falling": {"results": with_means(falling), "regions": large_regions},
    "narrowing": {"results": with_means(growing, lambda n: 40 / n)},
    "widening": {"results": with_means(level, lambda n: n / 1e6)},
    "skewed": {"results": skewed},
    "p falls": {"results": falling_shares, "histograms": short_or_long},
    "low p": {"results": with_shares(0.30), "histograms": histogram_of(LONG)},
    "high p": {"results": with_shares(0.50), "histograms": histogram_of(SHORT)},
    "rare long paths": {
        "results": with_shares(0.50),
        "histograms": histogram_of(SHORT | {9: 8}),
    },
    "constant chance": with_chance(lambda k: 0.5 + 0 * k),
    "falling chance": with_chance(falling_law),
    "falling chance, no interior": {
        "histograms": going_on(falling_law),
        "layers": no_interior,
    },
    "rising chance": with_chance(lambda k: 0.4 + 0.03 * k),
    "crooked chance": with_chance(lambda k: falling_law(k) + 0.02 * (k % 2)),
    "uneven chance": with_chance(lambda k: 0.5 + 0.05 * (k % 2)),
    "nearly falling chance": with_chance(lambda k: np.where(k < 6, 0.7 - 0.05 * k, 0.45)),
    "out of bounds": {"results": out_of_bounds},
    "near 4": {"results": with_means(lambda n: 3.99 + 0 * n, lambda n: 0.05 + 0 * n)},
    "Theorem 1": {"results": moments(mean_lepp=1.001, sd_lepp=0.999)},
    "above Theorem 1": {
        "results": moments(mean_lepp=1.2, sd_lepp=1.3, skewness_lepp=1.1, kurtosis_lepp=1.1)
    },
    "mixed Theorem 1": {"results": moments(mean_lepp=1.05, sd_lepp=0.9)},
    "straight": {"results": with_means(lambda n: 3.0 + n / 1e5 + 5e-4 * np.cos(n))},
    "upwards": {"results": with_means(lambda n: 3.0 + 0.01 * (n / 8000) ** 2)},
    "bent": {"results": with_means(lambda n: 3.1 - 0.05 * np.cos(n / 1500))},
    "poor points": {"point_sets": poor_points},
}
