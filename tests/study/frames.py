"""Results as a run would leave them, drawn from a seeded generator."""

import numpy as np
import pandas as pd

from lepp import INTERIOR_LAYER
from study.analysis.table import Tables
from study.design.design import Design
from study.run.measures import columns_of
from study.run.point_checks import PointChecks
from study.run.triangulations import Measures, Task

MEASURES = columns_of(Measures)
CHECKS = columns_of(PointChecks)
SET = list(Task._fields)
KEY = ["method", *SET]


def design(**changes):
    settings = {
        "methods": ("incremental",),
        "distributions": ("uniform", "exponential"),
        "sizes": (1000, 2000, 4000, 8000),
        "repetitions": 6,
        "seed": 1,
    }
    # Not validated: the statistics take any names of methods and distributions.
    return Design.model_construct(**settings | changes)


def long_counts(key, name, counts):
    return [
        dict(zip(KEY, key, strict=True)) | {name: size, "count": int(count)}
        for size, count in enumerate(counts)
        if count
    ]


def layers_of(key, counts, rng):
    """The counts parted at random among the hull, the layer next to it, and the interior."""
    parts = [rng.binomial(counts, share) for share in (0.1, 0.1)]
    parts.append(counts - sum(parts))
    return [
        row | {"layer": layer}
        for layer, part in zip((0, 1, INTERIOR_LAYER), parts, strict=True)
        for row in long_counts(key, "lepp_size", part)
    ]


def frames(design, seed=0):
    """Results, histograms, regions, layers, point sets: sizes drawn from near-geometric laws."""
    results, histograms, regions, layers = [], [], [], []
    for method in design.methods:
        share_c = {"incremental": 0.486, "delaunay": 0.303}[method]
        for distribution in design.distributions:
            for n, repetitions in design.repetitions_by_size.items():
                for replicate in range(repetitions):
                    place = (seed, len(method), len(distribution), n, replicate)
                    rng = np.random.default_rng(place)
                    key = (method, distribution, n, replicate)
                    hull = int(rng.integers(10, 30))
                    m = 2 * n - 2 - hull
                    boundary = hull // 2
                    share = share_c - 0.3 / np.log2(n) / 100 + rng.normal(0, 0.1 / np.sqrt(n))
                    type_c = 2 * int((m - boundary) * share / 2)
                    type_a = int((m - boundary - type_c) * 0.4)
                    sizes = 1 + rng.geometric(share, m - boundary)
                    counts = np.bincount(np.concatenate([np.ones(boundary, int), sizes]))
                    k = np.arange(len(counts))
                    mean = (k * counts).sum() / m
                    central = [((k - mean) ** e * counts).sum() / m for e in (2, 3, 4)]
                    ends = type_c // 2 + boundary
                    region = np.bincount(rng.multinomial(m - ends, np.full(ends, 1 / ends)) + 1)
                    histograms += long_counts(key, "lepp_size", counts)
                    regions += long_counts(key, "region_size", region)
                    layers += layers_of(key, counts, rng)
                    results.append(
                        dict.fromkeys(column.name for column in MEASURES)
                        | dict(zip(KEY, key, strict=True))
                        | {
                            "n_triangles": m,
                            "n_hull": hull,
                            "n_repeated": 0,
                            "mean_lepp": mean,
                            "sd_lepp": central[0] ** 0.5,
                            "skewness_lepp": central[1] / central[0] ** 1.5,
                            "kurtosis_lepp": central[2] / central[0] ** 2 - 3,
                            "max_lepp": len(counts) - 1,
                            "n_interior_longest": m - boundary,
                            "n_type_a": type_a,
                            "n_type_b": m - boundary - type_c - type_a,
                            "n_type_c": type_c,
                            "n_regions": ends,
                            "max_region": len(region) - 1,
                            "n_equal_longest": 0,
                            "n_nearly_equal_longest": 0,
                            "error": None,
                        }
                    )
    count_columns = {name: [*KEY, name, "count"] for name in ("lepp_size", "region_size")}
    return (
        pd.DataFrame(results)[[*KEY, *(column.name for column in MEASURES), "error"]],
        pd.DataFrame(histograms, columns=count_columns["lepp_size"]),
        pd.DataFrame(regions, columns=count_columns["region_size"]),
        pd.DataFrame(layers, columns=[*KEY, "layer", "lepp_size", "count"]),
        _point_sets(design, seed),
    )


def _point_sets(design, seed):
    """p-values of the checks, uniform as those of random points."""
    sets = [
        (distribution, n, replicate)
        for distribution in design.distributions
        for n, repetitions in design.repetitions_by_size.items()
        for replicate in range(repetitions)
    ]
    values = np.random.default_rng((seed, 1)).random((len(sets), len(CHECKS)))
    checks = pd.DataFrame(values, columns=[column.name for column in CHECKS])
    return pd.concat([pd.DataFrame(sets, columns=SET), checks], axis=1)


def failed(results, rows, error="InputError: all points lie on one line"):
    """The results with some rows as a failed task leaves them."""
    results = results.copy()
    for column in MEASURES:
        results[column.name] = results[column.name].astype(column.dtype.replace("int", "Int"))
    results.loc[rows, [column.name for column in MEASURES]] = pd.NA
    results["error"] = results["error"].astype(object)
    results.loc[rows, "error"] = error
    return results


class adding(Tables):  # noqa: N801 - a verb where it is used
    """Tables with some in the place of those of their names; the others are made when needed."""

    def __init__(self, tables, *changed):
        super().__init__(changed)
        self.others = tables

    def __getitem__(self, name):
        return self._tables[name] if name in self._tables else self.others[name]

    def __iter__(self):
        return iter(dict.fromkeys((*self.others, *self._tables)))

    def __len__(self):
        return len(list(iter(self)))
