"""Terminal edges and the regions of triangles whose paths end at one of them."""

from collections.abc import Iterator

import numpy as np

from study.analysis.measurements import (
    Measurements,
    Missing,
    NotEnough,
    Row,
    for_each_population,
    select,
)
from study.analysis.paths import counts_by_task
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Table
from study.statistics.intervals import mean_interval

_REGIONS = (
    METHOD,
    DISTRIBUTION,
    N_POINTS,
    Column("triangulations", "Triangulations", "", "int"),
    Column("edges_per_triangle", "Terminal edges per triangle", "", "fixed4"),
    Column("edges_low", "95 % from", "", "fixed4"),
    Column("edges_high", "95 % to", "", "fixed4"),
    Column("pair_share", "Triangles in terminal pairs", "", "percent2"),
    Column("pair_low", "95 % from", "", "percent2"),
    Column("pair_high", "95 % to", "", "percent2"),
    Column("mean_region", "Mean region", "triangles", "fixed3"),
    Column("mean_region_low", "95 % from", "triangles", "fixed3"),
    Column("mean_region_high", "95 % to", "triangles", "fixed3"),
    Column("mean_max_region", "Mean largest region", "triangles", "fixed1"),
    Column("max_region", "Largest region", "triangles", "int"),
)

_REGION_SIZES = (
    METHOD,
    DISTRIBUTION,
    Column("region_size", "Size of the region", "triangles", "int"),
    Column("count", "Regions", "regions", "int"),
    Column("share", "Share of the regions", "", "percent3"),
    Column("share_of_triangles", "Share of the triangles", "", "percent3"),
)


def regions(data: Measurements) -> tuple[Table, list[Missing]]:
    """Measure the number of terminal edges, the share in terminal pairs and the mean region."""

    def rows(method: str, distribution: str) -> Iterator[Row]:
        triangulations = data.triangulations(method, distribution)
        if triangulations.empty:
            raise NotEnough("no triangulation has succeeded")
        for size, group in triangulations.groupby("n_points", sort=True):
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

    found, missing = for_each_population(data, "terminal-edge regions", rows)
    note = (
        "A terminal edge is where paths end: the longest edge of both its triangles (a terminal "
        "pair), or of the one triangle at the boundary. Its region is all triangles whose paths "
        "end there. Means over the triangulations, with t intervals between them."
    )
    title = "Terminal edges and their regions"
    return Table.from_rows("regions", title, _REGIONS, found, note), missing


def region_sizes(data: Measurements) -> tuple[Table, list[Missing]]:
    """Count the regions by their number of triangles."""

    def rows(method: str, distribution: str) -> Iterator[Row]:
        frame = select(data.regions, method, distribution)
        if frame.empty:
            raise NotEnough("no triangulation has succeeded")
        counts = counts_by_task(frame, "region_size").sum(axis=0)
        triangles = counts * np.arange(len(counts))
        for size in np.flatnonzero(counts):
            yield {
                "region_size": int(size),
                "count": int(counts[size]),
                "share": counts[size] / counts.sum(),
                "share_of_triangles": triangles[size] / triangles.sum(),
            }

    found, missing = for_each_population(data, "sizes of terminal-edge regions", rows)
    note = "All triangulations of a method and distribution together."
    title = "Sizes of terminal-edge regions"
    return Table.from_rows("region_sizes", title, _REGION_SIZES, found, note), missing
