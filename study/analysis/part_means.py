"""The mean LEPP size of the whole mesh and of its interior, by size and by layer."""

from collections.abc import Iterator

import numpy as np
import pandas as pd
from scipy import special

from lepp import INTERIOR_LAYER
from study.analysis.building import Population, Study, rows_by_population, rows_of
from study.analysis.measurements import triangulations_by_size
from study.analysis.parts import INTERIOR, INTERIOR_NOTE, INTERVAL, PART, PARTS, interior_shares
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row
from study.statistics.groups import ENOUGH, NotEnough, best_repeated
from study.statistics.homogeneity import homogeneity
from study.statistics.intervals import mean_interval, ratio_of_sums
from study.statistics.multiple_testing import holm
from study.statistics.size_means import SizeMeans
from study.statistics.thresholds import SIGNIFICANCE
from study.statistics.verdicts import NOT_SHOWN, rejected

#: Where the mean of a layer is, against that of the interior.
ABOVE, BELOW = "above", "below"

_SHARE = Column("share", "Share of the triangles", "", "percent2")
_LAYER = Column("layer", "Layer", "", "int")

PART_MEANS = Declaration(
    "part_means",
    "Mean LEPP size of the whole mesh and of its interior",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        N_POINTS,
        Column("triangulations", "Triangulations", "", "int"),
        _SHARE,
        Column("mean_lepp", "Mean LEPP", "triangles", "fixed4"),
        *INTERVAL,
    ),
    note=f"{INTERIOR_NOTE} Each triangulation's mean counts once; one without an interior is left "
    "out. The intervals are t intervals over triangulations.",
)

LAYER_MEANS = Declaration(
    "layer_means",
    "Mean LEPP size by layer",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        _LAYER,
        _SHARE,
        Column("mean_lepp", "Mean LEPP", "triangles", "fixed4"),
        Column("standard_error", "Standard error", "triangles", "g2"),
        *INTERVAL,
        Column("against_interior", "Against the interior"),
        Column("max_lepp", "Largest LEPP", "triangles", "int"),
    ),
    note="The layer of a triangle is the number of steps across edges from it to a triangle at the "
    f"hull; {INTERIOR_LAYER} stands for that and more. The mean is over all triangles of a layer "
    "in all triangulations of a size: the least, the middle and the largest of them, up to the "
    f"largest with {ENOUGH} triangulations or more, if there is one; its standard "
    "error is that of a ratio of sums over triangulations. A layer is above or below the interior "
    f"where a t test rejects at {SIGNIFICANCE}, by Holm's correction over the layers of the size; "
    "the errors of both, which come from the same triangulations, are taken as independent.",
)

LONGEST_PATHS = Declaration(
    "longest_paths",
    "Where the longest paths start",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        Column("lepp_size", "LEPP size of at least", "triangles", "int"),
        Column("paths", "Paths", "triangles", "int"),
        Column("interior_paths", "From the interior", "triangles", "int"),
        Column("edge_share", "Share from the edge", "", "percent2"),
        Column("edge_triangles", "Share of triangles at the edge", "", "percent2"),
        Column("layer", "Commonest layer", "", "int"),
        Column("layer_paths", "Paths from that layer", "triangles", "int"),
    ),
    note=f"{INTERIOR_NOTE} The edge is all other triangles. All triangulations of the largest "
    "number of points together. The commonest layer is that of the edge in which most of these "
    f"paths start, the first of several, or {INTERIOR_LAYER} if more start in the interior.",
)

COMMON_MEANS = Declaration(
    "common_means",
    "Whether all distributions have one mean",
    (
        METHOD,
        PART,
        N_POINTS,
        Column("distributions", "Distributions", "", "int"),
        Column("f", "F", "", "fixed2"),
        Column("df_group", "Df, distributions", "", "int"),
        Column("df_residual", "Df, residuals", "", "int"),
        Column("p", "p", "", "p"),
        Column("log10_p", "log10 p", "", "log10p"),
        Column("one_mean", "One mean", "", "verdict"),
        Column("mean_lepp", "Mean of all", "triangles", "fixed4"),
        *INTERVAL,
        Column("largest_difference", "Largest difference", "triangles", "fixed4"),
        Column("lowest", "Lowest", "", "name"),
        Column("highest", "Highest", "", "name"),
    ),
    note="The means of the distributions weighted by their reciprocal squared standard errors, and "
    "their weighted squares about it; variances are smooth functions of the number of points "
    f"within each distribution. Rejected at {SIGNIFICANCE}. The interval of the mean supposes that "
    "it is one.",
)


@rows_by_population(PART_MEANS, "means of the parts")
def part_means(one: Population) -> Iterator[Row]:
    """Mean of the triangulations' means, for the whole and the interior."""
    for part in PARTS:
        groups = one.data.groups(one.method, one.distribution, part)
        shares = (
            interior_shares(one.data.by_layer(one.method, one.distribution))
            if part == INTERIOR
            else None
        )
        for n, values in zip(groups.n_points, groups.values, strict=True):
            mean, low, high = mean_interval(values)
            yield {
                "part": part,
                "n_points": int(n),
                "triangulations": len(values),
                "share": 1.0 if shares is None else float(shares.loc[n]),
                "mean_lepp": mean,
                "low": low,
                "high": high,
            }


@rows_by_population(LAYER_MEANS, "means of the layers")
def layer_means(one: Population) -> Iterator[Row]:
    """Mean over the triangles of each layer, at three sizes."""
    rows = one.data.by_layer(one.method, one.distribution)
    if rows.empty:
        return
    sizes = np.unique(rows["n_points"])
    sizes = sizes[sizes <= best_repeated(triangulations_by_size(rows))]
    for n in sizes[sorted({0, len(sizes) // 2, len(sizes) - 1})]:
        of_size = rows[rows["n_points"] == n]
        total = of_size["count"].sum()
        layers: list[Row] = []
        for layer, of_layer in _by_replicate(of_size).groupby(level="layer", sort=True):
            mean, error, low, high = ratio_of_sums(
                *(of_layer[name].to_numpy(dtype=np.int64) for name in ("steps", "count"))
            )
            layers.append(
                {
                    "n_points": int(n),
                    "layer": int(layer),
                    "share": of_layer["count"].sum() / total,
                    "mean_lepp": mean,
                    "standard_error": error,
                    "low": low,
                    "high": high,
                    "max_lepp": int(of_layer["lepp_size"].max()),
                }
            )
        df = of_size["replicate"].nunique() - 1
        for row, words in zip(layers, _against_interior(pd.DataFrame(layers), df), strict=True):
            yield row | {"against_interior": words}


def _against_interior(layers: pd.DataFrame, df: int) -> list[str | None]:
    """Say of each layer whether its mean is above or below that of the interior."""
    inside = layers["layer"] == INTERIOR_LAYER
    if not inside.any() or df < 1:
        return [None] * len(layers)
    interior = layers[inside].iloc[0]
    edge = layers[~inside]
    difference = edge["mean_lepp"].to_numpy() - interior["mean_lepp"]
    error = np.hypot(edge["standard_error"].to_numpy(), interior["standard_error"])
    with np.errstate(divide="ignore", invalid="ignore"):
        p = 2 * special.stdtr(df, -np.abs(difference / error))
    shown = holm(np.where(np.isnan(p), 1.0, p)) < SIGNIFICANCE
    words = np.where(shown, np.where(difference > 0, ABOVE, BELOW), NOT_SHOWN)
    return [*words.tolist(), None]


def _by_replicate(rows: pd.DataFrame) -> pd.DataFrame:
    """Sum up each layer of each triangulation: triangles, their paths, the longest of these."""
    steps = rows.assign(steps=rows["lepp_size"] * rows["count"])
    return steps.groupby(["layer", "replicate"], sort=True).agg(
        {"steps": "sum", "count": "sum", "lepp_size": "max"}
    )


@rows_by_population(LONGEST_PATHS, "layers of the longest paths")
def longest_paths(one: Population) -> Iterator[Row]:
    """Of the paths of a size and more, those that start at the edge and in the interior."""
    rows = one.data.by_layer(one.method, one.distribution)
    if rows.empty:
        return
    n = rows["n_points"].max()
    counts = rows[rows["n_points"] == n].pivot_table(
        index="lepp_size", columns="layer", values="count", aggfunc="sum", fill_value=0
    )
    at_least = counts.iloc[::-1].cumsum().iloc[::-1]
    inside = at_least.get(INTERIOR_LAYER, 0 * at_least.iloc[:, 0])
    total = at_least.sum(axis=1)
    for size in at_least.index:
        yield {
            "n_points": int(n),
            "lepp_size": int(size),
            "paths": int(total[size]),
            "interior_paths": int(inside[size]),
            "edge_share": 1 - inside[size] / total[size],
            "edge_triangles": 1 - inside.iloc[0] / total.iloc[0],
            "layer": int(at_least.loc[size].idxmax()),
            "layer_paths": int(at_least.loc[size].max()),
        }


@rows_of(COMMON_MEANS)
def common_means(study: Study) -> Iterator[Row]:
    """Hold the distributions' means against one another, at each size."""
    design = study.data.design
    for method in design.methods:
        for part in PARTS:
            means = {}
            for distribution in design.distributions:
                try:
                    means[distribution] = SizeMeans.of(
                        study.data.groups(method, distribution, part)
                    )
                except NotEnough:  # told of the fits, which need the same
                    continue
            for n in design.sizes:
                row = _one_mean(means, n)
                if row:
                    yield {"method": method, "part": part, "n_points": n} | row


def _one_mean(means: dict[str, SizeMeans], n: int) -> Row | None:
    at = {name: one.where(one.n_points == n) for name, one in means.items()}
    at = {name: one for name, one in at.items() if len(one)}
    if len(at) < 2:
        return None
    values = np.array([one.means[0] for one in at.values()])
    variances = np.array([one.variances[0] for one in at.values()])
    test = homogeneity(values, variances, sum(one.df for one in at.values()))
    names = list(at)
    return {
        "distributions": len(at),
        "f": test.score.chi_squared / test.score.df,
        "df_group": test.score.df,
        "df_residual": test.score.df_error,
        "p": test.score.p,
        "log10_p": test.score.log10_p,
        "one_mean": rejected(test.score.p < SIGNIFICANCE),
        "mean_lepp": test.mean,
        "low": test.low,
        "high": test.high,
        "largest_difference": float(np.ptp(values)),
        "lowest": names[int(values.argmin())],
        "highest": names[int(values.argmax())],
    }
