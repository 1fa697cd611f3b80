"""What is said of a mesh, in words and rows: the same on the terminal and on the page."""

from collections.abc import Iterable

import numpy as np

import lepp
from reports.page.blocks import Tile
from reports.text.numbers import count, show
from study.meshes.survey import QUANTILES, RANDOM_DELAUNAY, Survey, quantile

_ROWS = 24  # of a histogram; the sizes beyond share the last
_STEPS = 12  # of a path that are named in a sentence


def headline(found: Survey) -> str:
    """Say how far one refinement spreads."""
    counts = found.counts
    mean = show(counts.mean, "fixed2")
    return (
        f"The longest-edge path of a triangle of {found.mesh.path.name} has {mean} triangles on "
        f"average, itself included, and {count(counts.max, 'triangle')} at most."
    )


def spread(found: Survey) -> str:
    """Say how the sizes are distributed."""
    counts = found.counts
    half, nine, most = (quantile(counts, share) for share in QUANTILES[:3])
    return (
        f"Half of the triangles have a path of at most {half}, nine in ten of at most {nine}, and "
        f"99 in a hundred of at most {most} triangles; the standard deviation is "
        f"{show(counts.sd, 'fixed2')}. {show(found.share_at_once, 'percent1')} of the paths end at "
        "once: the triangle's own longest edge is also that of its neighbour, or is on the "
        "boundary, and a refinement there touches nothing else."
    )


def worst(found: Survey) -> str:
    """Name the longest path."""
    path, sizes = found.worst_path, found.paths.sizes
    others = int((sizes == len(path)).sum()) - 1
    as_long = (
        "no other path is as long"
        if others == 0
        else f"{count(others, 'other path is', 'other paths are')} as long"
    )
    if len(path) == 1:
        return "Every path has one triangle only: all longest edges are on the boundary."
    names = [f"{t:,}" for t in path]
    if len(names) > _STEPS:
        names = [*names[: _STEPS - 2], f"… {len(names) - _STEPS + 1:,} more …", names[-1]]
    in_pair = found.paths.neighbor_types[path[-2]] == lepp.TYPE_C
    end = "between the last two" if in_pair else "on the boundary"
    a, b = found.paths.terminal_edges[found.paths.regions[path[0]]]
    return (
        f"The longest path starts at triangle {path[0]:,} and goes {' → '.join(names)}; its "
        f"terminal edge is {end}, from point {a:,} to point {b:,}; {as_long}."
    )


def regions(found: Survey) -> str:
    """Say where the paths end."""
    sizes = found.region_sizes
    boundary = found.type_counts["none"]
    pairs = found.type_counts["C"] / len(found.triangulation)
    return (
        f"The paths end at {count(len(sizes), 'terminal edge')}, {boundary:,} of them on the "
        f"boundary. {show(pairs, 'percent1')} of the triangles stand in a terminal pair, and the "
        "triangles whose paths end at one terminal edge make a region of "
        f"{show(float(sizes.mean()), 'fixed2')} triangles on average (standard deviation "
        f"{show(float(sizes.std()), 'fixed2')}, at most {int(sizes.max()):,}). In large random "
        f"Delaunay triangulations the share tends to about "
        f"{show(RANDOM_DELAUNAY['pair_share'], 'percent1')} and the region to about "
        f"{RANDOM_DELAUNAY['mean_region']} triangles, as this project's study measures them."
    )


def theory(found: Survey) -> str:
    """Hold Theorem 1 against the mesh."""
    p = found.p
    if not p:
        return (
            "No triangle has a longest-edge neighbour of type C (one whose longest edge is the "
            "same), so that the published Theorem 1 says nothing of this mesh."
        )
    premise = "is" if p >= 1 / 3 else "is not"
    mean, sd = show(lepp.theory.mean(p), "fixed2"), show(lepp.theory.sd(p), "fixed2")
    return (
        f"{show(p, 'fixed3')} of the longest-edge neighbours are of type C: their longest edge is "
        "the same, and the path ends. If each step ended a path with this probability, as the "
        f"published Theorem 1 has it, sizes would have mean {mean} and standard deviation {sd}; "
        "measured are "
        f"{show(found.counts.mean, 'fixed2')} and {show(found.counts.sd, 'fixed2')}. The premise "
        f"of Theorem 2, a share of at least 1/3, {premise} met."
    )


def tiles(found: Survey) -> list[Tile]:
    """Make the key figures."""
    counts, sizes = found.counts, found.region_sizes
    return [
        Tile(
            show(counts.mean, "fixed2"),
            "Mean LEPP size",
            f"triangles; standard deviation {show(counts.sd, 'fixed2')}",
        ),
        Tile(
            f"{counts.max:,}",
            "Longest path",
            f"triangles, from triangle {int(found.worst_path[0]):,}",
        ),
        Tile(
            show(found.share_at_once, "percent1"),
            "Paths that end at once",
            "its longest edge is terminal: refining touches no more",
        ),
        Tile(
            show(found.type_counts["C"] / len(found.triangulation), "percent1"),
            "Triangles in terminal pairs",
            f"about {show(RANDOM_DELAUNAY['pair_share'], 'percent1')} in random Delaunay meshes",
        ),
        Tile(
            show(float(sizes.mean()), "fixed2"),
            "Mean terminal-edge region",
            f"triangles; about {RANDOM_DELAUNAY['mean_region']} in random Delaunay meshes",
        ),
        Tile(
            show(found.p, "fixed3"),
            "Neighbours of type C",
            "of all across longest edges; Theorem 2 takes at least 1/3",
        ),
    ]


def facts(found: Survey) -> list[tuple[str, str]]:
    """Describe the mesh itself."""
    shape = found.shape
    pieces = shape["n_pieces"]
    boundary = (
        f"{count(shape['n_boundary_edges'], 'edge')} in "
        f"{count(shape['n_boundary_loops'], 'closed line')}"
        if shape["n_boundary_edges"]
        else "none: the surface is closed"
    )
    rows = [
        ("Triangles", f"{shape['n_triangles']:,}"),
        ("Points", f"{shape['n_points']:,}"),
        ("Edges", f"{shape['n_edges']:,}"),
        ("Boundary", boundary),
        ("Pieces", f"{pieces:,}" + (", between which no path goes" if pieces > 1 else "")),
    ]
    if shape["n_holes"] is None:
        rows.append(("Euler number", show(shape["euler_number"], "int")))
        rows.insert(0, ("Mesh", "a surface in space"))
    else:
        rows.append(("Holes", f"{shape['n_holes']:,}"))
        rows.insert(0, ("Mesh", "in the plane"))
    return rows


def size_rows(counts: np.ndarray) -> list[tuple[str, int, float, float]]:
    """Make the rows of a histogram: sizes, number, share, and share of all up to these sizes.

    Parameters
    ----------
    counts : (k,) ndarray of int
        ``counts[s]`` things have the size s.
    """
    total, below = int(counts.sum()), np.cumsum(counts)
    return [
        (name, number, number / total, int(below[last]) / total)
        for name, number, last in _classes(counts)
    ]


def _classes(counts: np.ndarray) -> Iterable[tuple[str, int, int]]:
    sizes = np.flatnonzero(counts)
    alone = sizes if len(sizes) <= _ROWS else sizes[: _ROWS - 1]
    for size in alone:
        yield f"{size:,}", int(counts[size]), int(size)
    rest = sizes[len(alone) :]
    if len(rest):
        yield f"{rest[0]:,}–{rest[-1]:,}", int(counts[rest].sum()), int(rest[-1])
