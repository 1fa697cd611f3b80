"""The longest-edge propagation path (LEPP) of every triangle of a mesh.

A path steps across the longest edge of each triangle into the neighbour there, as long as the
neighbour's longest edge is *greater* (M. C. Rivara, "New longest-edge algorithms for the
refinement and/or improvement of unstructured triangulations", 1997). An edge that no triangle
beside it exceeds is *terminal*. Where a triangle has several equal longest edges, its path is the
shortest that they give; so sizes do not depend on how the mesh is numbered.
"""

from dataclasses import dataclass
from functools import cached_property
from numbers import Real

import numpy as np

from lepp.errors import InputError
from lepp.geometry.lengths import LONGEST, NEARLY_EQUAL_BIT
from lepp.jit.memory import for_kernels
from lepp.mesh.triangulation import Triangulation
from lepp.paths.neighbor_types import neighbor_types
from lepp.paths.regions import count_regions, regions_of_edges, regions_of_triangles
from lepp.paths.successors import follow, single_edges, step_over
from lepp.paths.ties import choose_edges


@dataclass(frozen=True, eq=False)
class LeppPaths:
    """The longest-edge propagation path of every triangle of a mesh.

    Attributes
    ----------
    sizes : (m,) int32 ndarray
        Triangles on Lepp(t), t and the terminal triangles included: Lepp(t) is the first
        ``sizes[t]`` of t, ``successors[t]``, its successor, and so on.
    successors : (m,) int32 ndarray
        The neighbour across the longest edge; -1 where that is on the boundary.
    neighbor_types : (m,) int8 ndarray
        Of that neighbour: TYPE_A, TYPE_B, TYPE_C; TYPE_NONE at the boundary.
    n_equal : int
        Triangles with more than one longest edge; their successor is, of those that give the
        shortest path, one across a terminal edge, and else across the edge with the largest vertex
        numbers. So sizes, and who is of type C, do not depend on how the mesh is numbered; the
        other types, successors and regions can.
    n_nearly_equal : int
        Triangles whose two longest edges agree to a relative `lepp.NEARLY_EQUAL`: in a mesh whose
        coordinates are rounded, equal edges that rounding has made different are among them.
    """

    sizes: np.ndarray
    successors: np.ndarray
    neighbor_types: np.ndarray
    n_equal: int
    n_nearly_equal: int
    _triangles: np.ndarray
    _edges: np.ndarray | None  # the longest edge of each triangle, where each has one
    _ends: np.ndarray  # of each path: its last triangle, or where edges are equal its last edge

    @property
    def terminal_edges(self) -> np.ndarray:
        """Vertices of the edges at which paths end, (k, 2) int32.

        Ordered by their (first) terminal triangle.
        """
        return self._terminal[0]

    @property
    def regions(self) -> np.ndarray:
        """Which terminal edge the path of each triangle ends at, (m,) int32."""
        return self._terminal[1]

    @cached_property
    def _terminal(self) -> tuple[np.ndarray, np.ndarray]:
        if self._edges is None:
            return regions_of_edges(self._triangles, self._ends)
        return regions_of_triangles(self._triangles, self._edges, self._ends)

    @property
    def region_counts(self) -> np.ndarray:
        """Terminal-edge regions by size, (k,) int64: ``region_counts[s]`` have s triangles."""
        return count_regions(self._ends, len(self.sizes) * (3 if self._edges is None else 1))


def lepp_sizes(triangulation: Triangulation, *, equal_within: float = 0.0) -> np.ndarray:
    """Return the number of triangles on the longest-edge propagation path of each triangle.

    Parameters
    ----------
    triangulation : Triangulation
    equal_within : float
        Edges whose lengths differ by at most this share count as equal. 0, which compares them
        exactly, is right where coordinates are exact; 1e-6 where they come from single precision.

    Returns
    -------
    (m,) int32 ndarray
        1 where a longest edge is on the boundary; in time linear in m, however long the paths.

    Raises
    ------
    InputError
        If `equal_within` is not a share, at least 0 and below 1, or something else than a
        Triangulation is given.
    """
    _check_type(triangulation)
    neighbors = for_kernels(triangulation.neighbors, np.int32)
    ranks = _ranks(triangulation, equal_within)
    if _n_equal(ranks):
        triangles = for_kernels(triangulation.triangles, np.int32)
        return _checked(choose_edges(triangles, neighbors, ranks)[0])
    successors = step_over(neighbors, single_edges(ranks))
    return _checked(follow(successors)[0])


def lepp_paths(triangulation: Triangulation, *, equal_within: float = 0.0) -> LeppPaths:
    """Return the longest-edge propagation paths of all triangles.

    Parameters
    ----------
    triangulation : Triangulation
    equal_within : float
        As for `lepp_sizes`.

    Returns
    -------
    LeppPaths

    Raises
    ------
    InputError
        As `lepp_sizes`.
    """
    _check_type(triangulation)
    triangles = for_kernels(triangulation.triangles, np.int32)
    neighbors = for_kernels(triangulation.neighbors, np.int32)
    ranks = _ranks(triangulation, equal_within)
    n_equal = _n_equal(ranks)
    if n_equal:
        sizes, edges, ends = choose_edges(triangles, neighbors, ranks)
        successors = step_over(neighbors, edges)
    else:
        edges = single_edges(ranks)
        successors = step_over(neighbors, edges)
        sizes, ends = follow(successors)
    return LeppPaths(
        _checked(sizes),
        successors,
        neighbor_types(neighbors, successors, ranks),
        n_equal,
        int(np.count_nonzero(ranks & NEARLY_EQUAL_BIT)),
        triangles,
        None if n_equal else edges,
        ends,
    )


def _check_type(triangulation: object) -> None:
    if not isinstance(triangulation, Triangulation):
        raise InputError(
            f"A {type(triangulation).__name__} is no lepp.Triangulation: make one of it by "
            "lepp.Triangulation.from_object, or from_arrays(points, triangles)."
        )


def _ranks(triangulation: Triangulation, equal_within: float) -> np.ndarray:
    if not (isinstance(equal_within, Real) and 0.0 <= equal_within < 1.0):
        raise InputError(
            f"equal_within is {equal_within!r}: give a share of a length, at least 0 and below 1."
        )
    return triangulation.edge_ranks(equal_within)


def _n_equal(ranks: np.ndarray) -> int:
    """Count the triangles with more than one longest edge."""
    longest = ranks & LONGEST
    return int(np.count_nonzero(longest & (longest - np.uint8(1))))


def _checked(sizes: np.ndarray) -> np.ndarray:
    if len(sizes) == 0:
        raise InputError(
            "A path does not end: the neighbors of the mesh are not those of its triangles. Make "
            "the mesh by Triangulation.from_arrays."
        )
    return sizes
