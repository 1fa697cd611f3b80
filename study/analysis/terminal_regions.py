"""Terminal edges and the regions of triangles whose paths end at one of them."""

from collections.abc import Iterator

import numpy as np

from study.analysis.building import Population, rows_by_population
from study.analysis.path_lengths import counts_by_task
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row, select
from study.statistics.groups import NotEnough
from study.statistics.intervals import mean_interval, ratio_interval
from study.statistics.thresholds import LEVEL

REGIONS = Declaration(
    "regions",
    "Terminal edges and their regions",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        Column("triangulations", "Triangulations", "", "int"),
        Column("edges_per_triangle", "Terminal edges per triangle", "", "fixed4"),
        Column("edges_low", f"{LEVEL} from", "", "fixed4"),
        Column("edges_high", f"{LEVEL} to", "", "fixed4"),
        Column("pair_share", "Triangles in terminal pairs", "", "percent2"),
        Column("pair_low", f"{LEVEL} from", "", "percent2"),
        Column("pair_high", f"{LEVEL} to", "", "percent2"),
        Column("mean_region", "Mean region", "triangles", "fixed3"),
        Column("mean_region_low", f"{LEVEL} from", "triangles", "fixed3"),
        Column("mean_region_high", f"{LEVEL} to", "triangles", "fixed3"),
        Column("mean_max_region", "Mean largest region", "triangles", "fixed1"),
        Column("max_region", "Largest region", "triangles", "int"),
    ),
    note="A terminal edge is where paths end: the longest edge of both its triangles (a terminal "
    "pair), or of the one triangle at the boundary. Its region is all triangles whose paths "
    "end there. Means over the triangulations, with t intervals between them.",
)

REGION_SIZES = Declaration(
    "region_sizes",
    "Sizes of terminal-edge regions",
    (
        METHOD,
        DISTRIBUTION,
        Column("region_size", "Size of the region", "triangles", "int"),
        Column("count", "Regions", "regions", "int"),
        Column("share", "Share of the regions", "", "percent3"),
        Column("share_low", f"{LEVEL} from", "", "percent3"),
        Column("share_high", f"{LEVEL} to", "", "percent3"),
        Column("share_of_triangles", "Share of the triangles", "", "percent3"),
    ),
    note="All triangulations of a method and distribution together; the intervals are of ratios of "
    "sums over triangulations.",
)


@rows_by_population(REGIONS, "terminal-edge regions")
def regions(one: Population) -> Iterator[Row]:
    """Measure the number of terminal edges, the share in terminal pairs and the mean region."""
    for size, group in one.by_size():
        triangles = group["n_triangles"].to_numpy()
        edges = mean_interval(group["n_regions"].to_numpy() / triangles)
        pairs = mean_interval(group["n_type_c"].to_numpy() / triangles)
        means = mean_interval(triangles / group["n_regions"].to_numpy())
        row: Row = {"n_points": size, "triangulations": len(group)}
        row |= zip(("edges_per_triangle", "edges_low", "edges_high"), edges, strict=True)
        row |= zip(("pair_share", "pair_low", "pair_high"), pairs, strict=True)
        row |= zip(("mean_region", "mean_region_low", "mean_region_high"), means, strict=True)
        row["mean_max_region"] = group["max_region"].mean()
        row["max_region"] = int(group["max_region"].max())
        yield row


@rows_by_population(REGION_SIZES, "sizes of terminal-edge regions")
def region_sizes(one: Population) -> Iterator[Row]:
    """Count the regions by their number of triangles."""
    frame = select(one.data.regions, one.key)
    if frame.empty:
        raise NotEnough("no triangulation has succeeded")
    by_task = counts_by_task(frame, "region_size")
    regions = by_task.sum(axis=1)
    counts = by_task.sum(axis=0)
    triangles = counts * np.arange(len(counts))
    for size in np.flatnonzero(counts):
        share, _, low, high = ratio_interval(by_task[:, size], regions)
        yield {
            "region_size": int(size),
            "count": int(counts[size]),
            "share": share,
            "share_low": low,
            "share_high": high,
            "share_of_triangles": triangles[size] / triangles.sum(),
        }
