"""What is said of a mesh, in words and rows: the same on the terminal and on the page."""

from collections.abc import Iterable

import numpy as np

import lepp
from lepp.errors import listed
from lepp.theory import LEAST_P_TEXT
from reports.page.blocks import Tile
from study.meshes.near_points import NEAR
from study.meshes.survey import QUANTILES, RANDOM_DELAUNAY, Survey, quantile
from study.text.numbers import count, show

_RANDOM = "Delaunay meshes of random points"
_ROWS = 24  # of a histogram; the sizes beyond share the last
_STEPS = 12  # of a path that are named in a sentence


def headline(survey: Survey) -> str:
    """Say how far one refinement spreads."""
    counts = survey.counts
    mean = show(counts.mean, "fixed2")
    return (
        f"The longest-edge path of a triangle of {survey.mesh.path.name} has {mean} triangles on "
        f"average, itself included, and {count(counts.max, 'triangle')} at most."
    )


def warnings(survey: Survey) -> dict[str, str]:
    """Say why the numbers may not be what they seem; by the kinds of `study.meshes.as_json`."""
    texts = {}
    near = survey.near_points
    if survey.falls_apart:
        texts["isolated triangles"] = (
            f"{survey.n_isolated:,} of the {len(survey.triangulation):,} triangles have no "
            "neighbour at all: no path goes anywhere from them, and the numbers below say nothing "
            "of a surface that they may be meant to make."
        )
    if near.count:
        texts["near points"] = (
            f"{count(near.count, 'point')} on the boundary nearly "
            f"{'agrees' if near.count == 1 else 'agree'} with another (to {NEAR:g} of the mesh's "
            "extent) but not exactly, so that what meets there is not joined: --merge-within "
            f"{near.merge_within:g} joins such points."
        )
    if len(survey.hanging_nodes):
        texts["hanging nodes"] = _hanging(survey.hanging_nodes)
    if survey.ties_matter:
        mean = show(survey.mean_if_equal, "fixed2")
        texts["nearly equal edges"] = (
            f"The two longest edges of {_triangles(survey.paths.n_nearly_equal)} agree to "
            f"{lepp.NEARLY_EQUAL:g} of their length. If such edges are meant to be equal, the mean "
            f"is {mean} (--equal-within {lepp.NEARLY_EQUAL:g})."
        )
    return texts


def _hanging(points: np.ndarray) -> str:
    lie = "lies" if len(points) == 1 else "lie"
    return (
        f"{count(len(points), 'point')} ({listed(points, most=3)}) {lie} inside an edge of another "
        "triangle (hanging nodes: the mesh does not conform there). Paths stop at such edges, and "
        "what is said of boundary, pieces and holes is not to be trusted."
    )


def ties(survey: Survey) -> str:
    """Say how many triangles have longest edges that are equal, or nearly so."""
    paths, within = survey.paths, survey.equal_within
    counted = f", lengths that agree to {within:g} counting as equal" if within else ""
    if paths.n_equal == 0 and paths.n_nearly_equal == 0:
        return f"No triangle has two equal longest edges, or nearly equal ones{counted}."
    equal = (
        f"{_triangles(paths.n_equal, 'has', 'have')} more than one longest edge"
        if paths.n_equal
        else "No triangle has two equal longest edges"
    )
    nearly = (
        f"the two longest edges of {_triangles(paths.n_nearly_equal)} agree to "
        f"{lepp.NEARLY_EQUAL:g} of their length"
    )
    shortest = (
        " Where there are several longest edges, the path is the shortest of those that they give, "
        "so that no size depends on how the mesh is numbered; to which region a triangle belongs "
        "can."
        if paths.n_equal
        else ""
    )
    return f"{equal}{counted}; {nearly}.{shortest}"


def _triangles(number: int, one: str = "", many: str = "") -> str:
    return count(number, f"triangle {one}".strip(), f"triangles {many}".strip())


def spread(survey: Survey) -> str:
    """Say how the sizes are distributed."""
    counts = survey.counts
    half, nine, most = (quantile(counts, share) for share in QUANTILES[:3])
    return (
        f"Half of the triangles have a path of at most {half}, nine in ten of at most {nine}, and "
        f"99 in a hundred of at most {most} triangles; the standard deviation is "
        f"{show(counts.sd, 'fixed2')}. {show(survey.share_at_once, 'percent1')} of the paths end "
        "at once: the triangle's own longest edge is also that of its neighbour, or lies on the "
        "boundary, and a refinement there divides the triangles at that edge and no other."
    )


def worst(survey: Survey) -> str:
    """Name the longest path."""
    path, sizes = survey.worst_path, survey.paths.sizes
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
    in_pair = survey.paths.neighbor_types[path[-2]] == lepp.TYPE_C
    end = "between the last two" if in_pair else "on the boundary"
    a, b = survey.paths.terminal_edges[survey.paths.regions[path[0]]]
    return (
        f"The longest path starts at triangle {path[0]:,} and goes {' → '.join(names)}; its "
        f"terminal edge is {end}, from point {a:,} to point {b:,}; {as_long}."
    )


def regions(survey: Survey) -> str:
    """Say where the paths end."""
    sizes = survey.region_sizes
    boundary = survey.type_counts["none"]
    pairs = survey.type_counts["C"] / len(survey.triangulation)
    return (
        f"The paths end at {count(len(sizes), 'terminal edge')}, {boundary:,} of them on the "
        f"boundary. {show(pairs, 'percent1')} of the triangles stand in a terminal pair, and the "
        "triangles whose paths end at one terminal edge make a region of "
        f"{show(float(sizes.mean()), 'fixed2')} triangles on average (standard deviation "
        f"{show(float(sizes.std()), 'fixed2')}, at most {int(sizes.max()):,}).{_random(survey)}"
    )


def _random(survey: Survey) -> str:
    if not survey.is_like_random:
        return ""
    return (
        f" In Delaunay triangulations of {RANDOM_DELAUNAY['n_points']:,} uniform random points, "
        "which this project's study measures, the share is "
        f"{show(RANDOM_DELAUNAY['pair_share'], 'percent1')} and the region has "
        f"{RANDOM_DELAUNAY['mean_region']} triangles."
    )


def theory(survey: Survey) -> str:
    """Hold Theorem 1 against the mesh."""
    p = survey.p
    if not p:
        return (
            "No triangle has a longest-edge neighbour of type C (one whose longest edge is the "
            "same), so that the published Theorem 1 says nothing of this mesh."
        )
    mean, sd = show(lepp.theory.mean(p), "fixed2"), show(lepp.theory.sd(p), "fixed2")
    return (
        f"{show(p, 'fixed3')} of the longest-edge neighbours are of type C: their longest edge is "
        "the same, and the path ends. If each step ended a path with this probability, as the "
        f"published Theorem 1 has it, sizes would have mean {mean} and standard deviation {sd}; "
        "measured are "
        f"{show(survey.counts.mean, 'fixed2')} and {show(survey.counts.sd, 'fixed2')}. "
        f"{_theorem_2(survey.counts, p)}"
    )


def _theorem_2(counts: lepp.LeppCounts, p: float) -> str:
    (least, most), (_, most_sd) = lepp.theory.bounds()
    met = p >= lepp.theory.LEAST_P
    kept = least <= counts.mean <= most and counts.sd <= most_sd
    premise = "is met" if met else "is not met"
    link = "and" if met == kept else "but"
    hold = f"{'hold' if kept else 'do not hold'}{' all the same' if kept and not met else ''}"
    return (
        f"The premise of Theorem 2, a share of at least {LEAST_P_TEXT}, {premise}, {link} its "
        f"bounds (a mean from {least:g} to {most:g}, a standard deviation of at most "
        f"{show(most_sd, 'fixed2')}) {hold}."
    )


def tiles(survey: Survey) -> list[Tile]:
    """Make the key figures."""
    counts, sizes = survey.counts, survey.region_sizes
    return [
        Tile(
            show(counts.mean, "fixed2"),
            "Mean LEPP size",
            f"triangles; standard deviation {show(counts.sd, 'fixed2')}",
        ),
        Tile(
            f"{counts.max:,}",
            "Longest path",
            f"triangles, from triangle {int(survey.worst_path[0]):,}",
        ),
        Tile(
            show(survey.share_at_once, "percent1"),
            "Paths that end at once",
            "the triangle's own longest edge is terminal",
        ),
        Tile(
            show(survey.type_counts["C"] / len(survey.triangulation), "percent1"),
            "Triangles in terminal pairs",
            f"{show(RANDOM_DELAUNAY['pair_share'], 'percent1')} in {_RANDOM}"
            if survey.is_like_random
            else "two that have their longest edge in common",
        ),
        Tile(
            show(float(sizes.mean()), "fixed2"),
            "Mean terminal-edge region",
            f"triangles; {RANDOM_DELAUNAY['mean_region']} in {_RANDOM}"
            if survey.is_like_random
            else "triangles whose paths end at one edge",
        ),
        Tile(
            show(survey.p, "fixed3"),
            "Neighbours of type C",
            f"of all across longest edges; Theorem 2 takes at least {LEAST_P_TEXT}",
        ),
    ]


def facts(survey: Survey) -> list[tuple[str, str]]:
    """Describe the mesh itself, as the file joins its triangles."""
    shape = survey.topology
    cut = " (as cut at the hanging nodes)" if len(survey.hanging_nodes) else ""
    pieces = shape.n_pieces
    boundary = (
        f"{count(shape.n_boundary_edges, 'edge')} in {count(shape.n_boundary_loops, 'closed line')}"
        if shape.n_boundary_edges
        else "none: the surface is closed"
    )
    rows = [
        ("Triangles", f"{shape.n_triangles:,}"),
        ("Points", f"{shape.n_points:,}"),
        ("Edges", f"{shape.n_edges:,}"),
        ("Boundary", boundary + cut),
        ("Pieces", f"{pieces:,}" + (", between which no path goes" if pieces > 1 else "") + cut),
    ]
    if shape.n_holes is None:
        rows.append(("Euler number", show(shape.euler_number, "int") + cut))
        rows.insert(0, ("Mesh", "a surface in space"))
    else:
        rows.append(("Holes", f"{shape.n_holes:,}" + cut))
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
