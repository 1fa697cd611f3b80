"""A survey as JSON values."""

from dataclasses import asdict
from typing import Any

import numpy as np

import lepp
from study.meshes.near_points import NEAR
from study.meshes.survey import QUANTILES, RANDOM_DELAUNAY, Survey, quantile


def as_json(survey: Survey) -> dict[str, Any]:
    """Make JSON values of a survey; the keys stand in the same order always.

    Returns
    -------
    dict
        ``file``: name of the file. ``notes``: what was done to the mesh while reading it.

        ``warnings``: why the numbers may not be what they seem, an entry a reason, with its kind:
        "isolated triangles" (n_triangles all of whose edges are on the boundary, being more than
        half), "near points" (n_points on the boundary that nearly agree with another, as counted
        within a share of the mesh's extent, and merge_within, a share that joins them), "hanging
        nodes" (n_points that lie inside an edge of another triangle, and the first of them), and
        "nearly equal edges" (the mean differs in its second decimal if they count as equal).

        ``mesh``: the attributes of `study.meshes.topology.Topology`.

        ``lepp``: mean, sd (over the triangles), skewness, kurtosis (excess), max, quantiles, the
        share of triangles that end_at_once (of which a longest edge is terminal), and the
        histogram as pairs of a size and its number of triangles.

        ``ties``: triangles with more than one longest edge (n_equal), those whose two longest
        edges agree to nearly_equal_within (n_nearly_equal), the share of a length up to which
        edges counted as equal (equal_within), and the mean if all nearly equal ones did.

        ``worst``: the longest path: its size, the number of triangles with one as long, and path,
        an entry a triangle: its index in this survey, its block and cell in the file (the halves
        of a quad have the same), vertices, and centroid.

        ``neighbor_types``: triangles by the type of the neighbour across their longest edge.
        ``theory``: p, the share of type C among those, and what Theorem 1 makes of it (null where
        it says nothing).

        ``regions``: number of terminal edges, those on the boundary, the share of triangles in
        terminal pairs, mean, sd and max of the triangles in a region, the largest region's
        terminal edge (points and their coordinates), and the histogram of the sizes.

        ``random_delaunay``: the same share and mean of Delaunay triangulations of n_points random
        points, to compare; null where that says nothing of the mesh (`Survey.is_like_random`).
    """
    counts, paths = survey.counts, survey.paths
    return {
        "file": survey.mesh.path.name,
        "notes": list(survey.mesh.notes),
        "warnings": _warnings(survey),
        "mesh": asdict(survey.topology),
        "lepp": {
            "mean": counts.mean,
            "sd": counts.sd,
            "skewness": _number(counts.skewness),
            "kurtosis": _number(counts.kurtosis),
            "max": counts.max,
            "quantiles": {str(share): quantile(counts, share) for share in QUANTILES},
            "end_at_once": survey.share_at_once,
            "histogram": size_counts(counts.counts),
        },
        "ties": {
            "n_equal": paths.n_equal,
            "n_nearly_equal": paths.n_nearly_equal,
            "equal_within": survey.equal_within,
            "nearly_equal_within": lepp.NEARLY_EQUAL,
            "mean_if_equal": survey.mean_if_equal,
        },
        "worst": {
            "size": counts.max,
            "n_as_long": int((paths.sizes == counts.max).sum()),
            "path": [_place(survey, int(t)) for t in survey.worst_path],
        },
        "neighbor_types": survey.type_counts,
        "theory": _theory(survey.p),
        "regions": _regions(survey),
        "random_delaunay": RANDOM_DELAUNAY if survey.is_like_random else None,
    }


def _warnings(survey: Survey) -> list[dict[str, Any]]:
    near, hanging = survey.near_points, survey.hanging_nodes
    entries: list[dict[str, Any]] = []
    if survey.falls_apart:
        entries.append({"kind": "isolated triangles", "n_triangles": survey.n_isolated})
    if near.count:
        entries.append(
            {
                "kind": "near points",
                "n_points": near.count,
                "within": NEAR,
                "merge_within": near.merge_within,
            }
        )
    if len(hanging):
        entries.append(
            {"kind": "hanging nodes", "n_points": len(hanging), "points": hanging[:5].tolist()}
        )
    if survey.ties_matter:
        entries.append({"kind": "nearly equal edges", "n_triangles": survey.paths.n_nearly_equal})
    return entries


def _place(survey: Survey, t: int) -> dict[str, Any]:
    vertices = survey.triangulation.triangles[t]
    return {
        "triangle": t,
        "block": int(survey.mesh.blocks[t]),
        "cell": int(survey.mesh.cells[t]),
        "vertices": vertices.tolist(),
        "centroid": survey.triangulation.points[vertices].mean(axis=0).tolist(),
    }


def _theory(p: float | None) -> dict[str, float | None]:
    return {
        "p": p,
        "mean": lepp.theory.mean(p) if p else None,
        "sd": lepp.theory.sd(p) if p else None,
    }


def _regions(survey: Survey) -> dict[str, Any]:
    sizes, edges = survey.region_sizes, survey.paths.terminal_edges
    largest = int(sizes.argmax())
    return {
        "n": len(sizes),
        "n_on_boundary": survey.type_counts["none"],
        "pair_share": survey.type_counts["C"] / len(survey.triangulation),
        "mean": float(sizes.mean()),
        "sd": float(sizes.std()),
        "max": int(sizes.max()),
        "largest": {
            "points": edges[largest].tolist(),
            "coordinates": survey.triangulation.points[edges[largest]].tolist(),
        },
        "histogram": size_counts(np.bincount(sizes)),
    }


def size_counts(counts: np.ndarray) -> list[list[int]]:
    """Return the sizes that occur, each with its number.

    Parameters
    ----------
    counts : (k,) ndarray of int
        ``counts[s]`` things have the size s.

    Returns
    -------
    list of [int, int]
        Pairs of a size and its number, ascending.
    """
    sizes = np.flatnonzero(counts)
    return np.column_stack((sizes, counts[sizes])).tolist()


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
