"""What the longest-edge propagation paths of one mesh say about it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

import lepp
from study.meshes.hanging_nodes import hanging_nodes
from study.meshes.near_points import NearPoints, near_points
from study.meshes.read import ReadMesh
from study.meshes.topology import Topology, topology

QUANTILES = (0.5, 0.9, 0.99, 0.999)

RANDOM_DELAUNAY = {"pair_share": 0.301, "mean_region": 6.65, "n_points": 200_000}
"""Of Delaunay triangulations of uniform random points, as this project's study measures them: the
share of triangles in terminal pairs, and the triangles in a terminal-edge region."""

_LEAST_COMPARED = 1000  # triangles: in fewer, the boundary's share is too large


@dataclass(frozen=True, eq=False)
class Survey:
    """The paths of a mesh, and what follows from them.

    Attributes
    ----------
    mesh : ReadMesh
    paths : lepp.LeppPaths
    equal_within : float
        What the paths took for equal lengths: as for `lepp.lepp_paths`.
    """

    mesh: ReadMesh
    paths: lepp.LeppPaths
    equal_within: float = 0.0

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
        """Share of the triangles of which a longest edge is a terminal edge."""
        at_once = self.type_counts["C"] + self.type_counts["none"]
        return at_once / len(self.triangulation)

    @cached_property
    def mean_if_equal(self) -> float:
        """The mean LEPP size if lengths that agree to `lepp.NEARLY_EQUAL` count as equal."""
        if self.equal_within >= lepp.NEARLY_EQUAL:
            return self.counts.mean
        if self.paths.n_nearly_equal == 0:
            return self.counts.mean
        sizes = lepp.lepp_sizes(self.triangulation, equal_within=lepp.NEARLY_EQUAL)
        return lepp.LeppCounts.from_sizes(sizes).mean

    @property
    def ties_matter(self) -> bool:
        """Whether the two decimals of the mean depend on nearly equal edges being equal."""
        return f"{self.mean_if_equal:.2f}" != f"{self.counts.mean:.2f}"

    @cached_property
    def n_isolated(self) -> int:
        """Triangles all of whose edges are on the boundary."""
        return int((self.triangulation.neighbors < 0).all(axis=1).sum())

    @property
    def falls_apart(self) -> bool:
        """Whether more than half of the triangles, of two or more, have no neighbour at all."""
        m = len(self.triangulation)
        return m > 1 and 2 * self.n_isolated > m

    @cached_property
    def near_points(self) -> NearPoints:
        """Boundary points that nearly agree with another."""
        return near_points(self.triangulation)

    @cached_property
    def hanging_nodes(self) -> np.ndarray:
        """Points that lie inside a boundary edge, (k,) int64; not looked for in a soup."""
        return np.empty(0, np.int64) if self.falls_apart else hanging_nodes(self.triangulation)

    @property
    def is_like_random(self) -> bool:
        """Whether a comparison with random Delaunay triangulations says something.

        So of unstructured meshes in the plane that hang together: 1,000 triangles or more, in one
        piece, of which one in a hundred at most has nearly equal longest edges.
        """
        m = len(self.triangulation)
        return (
            self.topology.dimensions == 2
            and m >= _LEAST_COMPARED
            and self.topology.n_pieces == 1
            and 100 * self.paths.n_nearly_equal <= m
            and len(self.hanging_nodes) == 0
        )

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
        counts = lepp.count_types(self.paths.neighbor_types)
        return dict(zip(("none", "A", "B", "C"), counts.tolist(), strict=True))

    @property
    def p(self) -> float | None:
        """Share of type C among the longest-edge neighbours; None where there are none."""
        neighbors = len(self.triangulation) - self.type_counts["none"]
        return self.type_counts["C"] / neighbors if neighbors else None

    @cached_property
    def topology(self) -> Topology:
        """Points, edges, boundary, pieces and holes of the mesh."""
        return topology(self.triangulation)


def survey(mesh: ReadMesh, *, equal_within: float = 0.0) -> Survey:
    """Compute the paths of a mesh.

    Parameters
    ----------
    mesh : ReadMesh
    equal_within : float
        As for `lepp.lepp_paths`: a share of a length.

    Returns
    -------
    Survey
        What follows from the paths is computed when it is read.
    """
    paths = lepp.lepp_paths(mesh.triangulation, equal_within=equal_within)
    return Survey(mesh, paths, equal_within)


def quantile(counts: lepp.LeppCounts, share: float) -> int:
    """Return the smallest size that a share of the triangles does not exceed.

    Parameters
    ----------
    counts : lepp.LeppCounts
        Not empty.
    share : float
        At least this share; 0 < share <= 1.

    Returns
    -------
    int
        In triangles.
    """
    return int(np.searchsorted(np.cumsum(counts.counts), share * counts.count))
