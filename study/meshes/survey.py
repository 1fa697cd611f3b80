"""What the longest-edge propagation paths of one mesh say about it."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

import lepp
from study.meshes.read import ReadMesh, unused_points

QUANTILES = (0.5, 0.9, 0.99, 0.999)

RANDOM_DELAUNAY = {"pair_share": 0.303, "mean_region": 6.6}
"""What large random Delaunay triangulations tend to: the share of triangles in terminal pairs, and
the triangles in a terminal-edge region. Known from measurement; no theorem gives them."""


@dataclass(frozen=True, eq=False)
class Survey:
    """The paths of a mesh, and what follows from them.

    Attributes
    ----------
    mesh : ReadMesh
    paths : lepp.LeppPaths
    """

    mesh: ReadMesh
    paths: lepp.LeppPaths

    @property
    def triangulation(self) -> lepp.Triangulation:
        """The triangulation surveyed."""
        return self.mesh.triangulation

    @cached_property
    def counts(self) -> lepp.LeppCounts:
        """Histogram of the LEPP sizes."""
        return lepp.LeppCounts.from_sizes(self.paths.sizes)

    @property
    def share_at_once(self) -> float:
        """Share of the triangles whose own longest edge is a terminal edge."""
        at_once = self.type_counts["C"] + self.type_counts["none"]
        return at_once / len(self.triangulation)

    @cached_property
    def worst_path(self) -> np.ndarray:
        """Triangles of the longest path, in order; of several the one whose triangle is first."""
        path = [int(self.paths.sizes.argmax())]
        for _ in range(int(self.paths.sizes[path[0]]) - 1):
            path.append(int(self.paths.successors[path[-1]]))
        return np.array(path, np.int64)

    @cached_property
    def region_sizes(self) -> np.ndarray:
        """Triangles in the region of each terminal edge, (k,) int64."""
        return np.bincount(self.paths.regions, minlength=len(self.paths.terminal_edges))

    @cached_property
    def type_counts(self) -> dict[str, int]:
        """Triangles by the type of their longest-edge neighbour: none, A, B, C."""
        counts = np.bincount(self.paths.neighbor_types, minlength=4)
        return dict(zip(("none", "A", "B", "C"), counts.tolist(), strict=True))

    @property
    def p(self) -> float | None:
        """Share of type C among the longest-edge neighbours; None where there are none."""
        neighbors = len(self.triangulation) - self.type_counts["none"]
        return self.type_counts["C"] / neighbors if neighbors else None

    @cached_property
    def shape(self) -> dict[str, Any]:
        """Points, edges, boundary, pieces and holes of the mesh."""
        return _shape(self.triangulation)


def survey(mesh: ReadMesh) -> Survey:
    """Compute the paths of a mesh."""
    return Survey(mesh, lepp.lepp_paths(mesh.triangulation))


def quantile(counts: lepp.LeppCounts, share: float) -> int:
    """Return the smallest size that at least this share of the triangles does not exceed."""
    return int(np.searchsorted(np.cumsum(counts.counts), share * counts.count))


def as_json(found: Survey) -> dict[str, Any]:
    """Make JSON values of a survey; the keys stand in the same order always.

    Returns
    -------
    dict
        ``file``: name of the file. ``notes``: what was done to the mesh while reading it.

        ``mesh``: dimensions (2 or 3), n_points (those in use), n_unused_points, n_merged_points,
        n_triangles, n_edges, n_boundary_edges, n_boundary_loops, n_pieces (joined across edges),
        euler_number, n_holes (null in space).

        ``lepp``: mean, sd (over the triangles), skewness, kurtosis (excess), max, quantiles, the
        share of triangles that end_at_once (their longest edge is terminal), and the histogram as
        pairs of a size and its number of triangles.

        ``worst``: the longest path: its size, the number of triangles with one as long, and path,
        an entry a triangle: its index in this survey, its block and cell in the file (the halves
        of a quad have the same), vertices, and centroid.

        ``neighbor_types``: triangles by the type of the neighbour across their longest edge.
        ``theory``: p, the share of type C among those, and what Theorem 1 makes of it (null where
        it says nothing).

        ``regions``: number of terminal edges, those on the boundary, the share of triangles in
        terminal pairs, mean, sd and max of the triangles in a region, the largest region's
        terminal edge (points and their coordinates), and the histogram of the sizes.

        ``random_delaunay``: what large random Delaunay triangulations tend to, to compare.
    """
    counts, paths = found.counts, found.paths
    return {
        "file": found.mesh.path.name,
        "notes": list(found.mesh.notes),
        "mesh": found.shape,
        "lepp": {
            "mean": counts.mean,
            "sd": counts.sd,
            "skewness": _number(counts.skewness),
            "kurtosis": _number(counts.kurtosis),
            "max": counts.max,
            "quantiles": {str(share): quantile(counts, share) for share in QUANTILES},
            "end_at_once": found.share_at_once,
            "histogram": _pairs(counts.counts),
        },
        "worst": {
            "size": counts.max,
            "n_as_long": int((paths.sizes == counts.max).sum()),
            "path": [_place(found, int(t)) for t in found.worst_path],
        },
        "neighbor_types": found.type_counts,
        "theory": _theory(found.p),
        "regions": _regions(found),
        "random_delaunay": RANDOM_DELAUNAY,
    }


def _place(found: Survey, t: int) -> dict[str, Any]:
    vertices = found.triangulation.triangles[t]
    return {
        "triangle": t,
        "block": int(found.mesh.blocks[t]),
        "cell": int(found.mesh.cells[t]),
        "vertices": vertices.tolist(),
        "centroid": found.triangulation.points[vertices].mean(axis=0).tolist(),
    }


def _theory(p: float | None) -> dict[str, float | None]:
    return {
        "p": p,
        "mean": lepp.theory.mean(p) if p else None,
        "sd": lepp.theory.sd(p) if p else None,
    }


def _regions(found: Survey) -> dict[str, Any]:
    sizes, edges = found.region_sizes, found.paths.terminal_edges
    largest = int(sizes.argmax())
    return {
        "n": len(sizes),
        "n_on_boundary": found.type_counts["none"],
        "pair_share": found.type_counts["C"] / len(found.triangulation),
        "mean": float(sizes.mean()),
        "sd": float(sizes.std()),
        "max": int(sizes.max()),
        "largest": {
            "points": edges[largest].tolist(),
            "coordinates": found.triangulation.points[edges[largest]].tolist(),
        },
        "histogram": _pairs(np.bincount(sizes)),
    }


def _pairs(counts: np.ndarray) -> list[list[int]]:
    sizes = np.flatnonzero(counts)
    return np.column_stack((sizes, counts[sizes])).tolist()


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _shape(triangulation: lepp.Triangulation) -> dict[str, Any]:
    triangles, neighbors = triangulation.triangles, triangulation.neighbors
    m, n = len(triangles), len(triangulation.points)
    unused, merged = len(unused_points(triangulation)), len(triangulation.repeated)
    used = n - unused - merged
    n_boundary = triangulation.n_hull
    n_edges = (3 * m + n_boundary) // 2
    euler = used - n_edges + m
    row, side = np.nonzero(neighbors >= 0)
    n_pieces = _n_groups(row, neighbors[row, side], m)
    row, side = np.nonzero(neighbors < 0)
    start, end = triangles[row, (side + 1) % 3], triangles[row, (side + 2) % 3]
    loops = _n_groups(start, end, n) - (n - len(np.unique(np.concatenate((start, end)))))
    touching = _n_groups(triangles[:, [0, 1]].ravel(), triangles[:, [1, 2]].ravel(), n)
    in_plane = triangulation.points.shape[1] == 2
    return {
        "dimensions": triangulation.points.shape[1],
        "n_points": used,
        "n_unused_points": unused,
        "n_merged_points": merged,
        "n_triangles": m,
        "n_edges": n_edges,
        "n_boundary_edges": n_boundary,
        "n_boundary_loops": loops,
        "n_pieces": n_pieces,
        "euler_number": euler,
        # In the plane, b0 - b1 is the Euler number, and b1 counts the holes.
        "n_holes": touching - (n - used) - euler if in_plane else None,
    }


def _n_groups(start: np.ndarray, end: np.ndarray, n: int) -> int:
    """Return into how many connected groups some edges join n nodes."""
    graph = coo_array((np.ones(len(start), bool), (start, end)), shape=(n, n))
    return int(connected_components(graph, directed=False, return_labels=False))
