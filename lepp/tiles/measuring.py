"""The counts of some tiles, among what surrounds them.

A triangle is put beyond each port whose path, and whose way to the boundary, are as long as those
of the true one. So the kernels for whole meshes measure tiles as well, and what is counted of a
tile's triangles is what they have in the whole.
"""

from typing import NamedTuple

import numpy as np

from lepp.geometry.lengths import LONGEST, NEARLY_EQUAL_BIT, SHORTEST_SHIFT
from lepp.paths.layers import INTERIOR_LAYER, layers_from_boundary, sizes_by_layer
from lepp.paths.neighbor_types import count_types, neighbor_types
from lepp.paths.successors import follow, single_edges, step_over
from lepp.paths.ties import choose_edges
from lepp.tiles.fine import FineMesh
from lepp.tiles.joining import Outer, PortEnds


class TileCounts(NamedTuple):
    """What is counted of the triangles of some tiles.

    Attributes
    ----------
    by_layer : (layers, sizes) int64 ndarray
        As from `lepp.sizes_by_layer`.
    types : (4,) int64 ndarray
        Triangles by the type of their successor, from `lepp.TYPE_NONE`.
    n_equal, n_nearly_equal : int
        As of `lepp.LeppPaths`.
    regions : (k,) int64 ndarray
        How many terminal-edge regions have each size, without those of `ends`.
    ends : PortEnds
        What other tiles add to.
    """

    by_layer: np.ndarray
    types: np.ndarray
    n_equal: int
    n_nearly_equal: int
    regions: np.ndarray
    ends: PortEnds


def tile_counts(mesh: FineMesh, outer: Outer) -> TileCounts:
    """Follow the paths of all triangles of some tiles, and count.

    Parameters
    ----------
    mesh : FineMesh
    outer : Outer
        What lies beyond its ports.

    Returns
    -------
    TileCounts
    """
    m = len(mesh.triangles)
    neighbors, ranks, ports = _with_paths(mesh, outer)
    n_equal = _n_equal(mesh.ranks)
    if n_equal:
        triangles = np.zeros((len(neighbors), 3), np.int32)
        triangles[:m] = mesh.triangles
        sizes, edges, ends = choose_edges(triangles, neighbors, ranks)
        successors = step_over(neighbors, edges)
        last, across = np.divmod(ends, 3)
        past = neighbors[last, across]
    else:
        successors = step_over(neighbors, single_edges(ranks))
        sizes, ends = follow(successors)
        last, past = ends, successors[ends]
    # A path leaves by a port if it ends in what was put beyond, or with it.
    outermost = np.maximum(last, past)[:m]
    leaves_by = np.full(m, -1, np.int64)
    leaving = outermost >= m
    leaves_by[leaving] = ports[outermost[leaving] - m]
    regions, port_ends = _regions(mesh, ends[:m], leaves_by)
    layers = layers_from_boundary(_with_ways_out(mesh, outer), INTERIOR_LAYER)[:m]
    types = neighbor_types(neighbors, successors, ranks)[:m]
    return TileCounts(
        sizes_by_layer(layers, sizes[:m]),
        count_types(types),
        n_equal,
        int(np.count_nonzero(mesh.ranks & NEARLY_EQUAL_BIT)),
        regions,
        port_ends,
    )


def _n_equal(ranks: np.ndarray) -> int:
    longest = ranks & LONGEST
    return int(np.count_nonzero(longest & (longest - np.uint8(1))))


def _with_paths(mesh: FineMesh, outer: Outer) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Put a path beyond each port, as long as that of the triangle there.

    Returns
    -------
    neighbors : (m + g, 3) int32 ndarray
    ranks : (m + g,) uint8 ndarray
    ports : (g,) int64 ndarray
        Beyond which port each of the added triangles is.
    """
    m = len(mesh.triangles)
    ports = np.flatnonzero(outer.exists)
    # One triangle will do where the port is a longest edge of it: nobody goes on from there.
    lengths = np.where(outer.longest[ports], 1, outer.sizes[ports])
    neighbors, firsts, lasts = _with_chains(mesh, ports, lengths)
    ranks = np.empty(len(neighbors), np.uint8)
    ranks[:m] = mesh.ranks
    ranks[m:] = 2 | 1 << SHORTEST_SHIFT  # edge 1, which leads on, is the longest
    shortest = np.where(outer.shortest[ports], 0, 1) << SHORTEST_SHIFT
    ranks[firsts] = np.where(outer.longest[ports], 1, 2) | shortest
    alone = firsts == lasts
    neighbors[lasts[alone], 1] = -1
    ranks[lasts[~alone]] = 1 | 1 << SHORTEST_SHIFT  # and the triangle before: a terminal pair
    neighbors[mesh.ports.triangles[~outer.exists], mesh.ports.edges[~outer.exists]] = -1
    return neighbors, ranks, np.repeat(ports, lengths)


def _with_ways_out(mesh: FineMesh, outer: Outer) -> np.ndarray:
    """Put a way to the boundary beyond each port, as long as from the triangle there.

    Returns
    -------
    neighbors : (m + g, 3) int32 ndarray
        A port beyond which the interior begins leads nowhere.
    """
    near = np.flatnonzero(outer.exists & (outer.layers < INTERIOR_LAYER))
    neighbors, _, lasts = _with_chains(mesh, near, outer.layers[near] + 1)
    neighbors[lasts, 1] = -1
    triangles, edges = mesh.ports.triangles, mesh.ports.edges
    neighbors[triangles[~outer.exists], edges[~outer.exists]] = -1
    deep = outer.exists & (outer.layers >= INTERIOR_LAYER)
    neighbors[triangles[deep], edges[deep]] = triangles[deep]
    return neighbors


def _with_chains(
    mesh: FineMesh, ports: np.ndarray, lengths: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Put a chain of triangles beyond some ports: edge 0 leads back, edge 1 on, edge 2 nowhere.

    Returns
    -------
    neighbors : (m + g, 3) int32 ndarray
    firsts, lasts : (k,) int64 ndarray
        The ends of the chains.
    """
    m = len(mesh.triangles)
    stops = m + np.cumsum(lengths)
    firsts, lasts = stops - lengths, stops - 1
    added = np.arange(m, m + lengths.sum(), dtype=np.int32)
    chains = np.column_stack((added - 1, added + 1, added))
    neighbors = np.concatenate((mesh.neighbors, chains.astype(np.int32)))
    triangles = mesh.ports.triangles[ports]
    neighbors[triangles, mesh.ports.edges[ports]] = firsts
    neighbors[firsts, 0] = triangles
    neighbors[lasts, 1] = lasts
    return neighbors, firsts, lasts


def _regions(
    mesh: FineMesh, ends: np.ndarray, leaves_by: np.ndarray
) -> tuple[np.ndarray, PortEnds]:
    """Count the regions of some tiles by size, those apart that paths from ports end in.

    Parameters
    ----------
    mesh : FineMesh
    ends : (m,) int32 ndarray
        Something that tells the terminal edges of the tiles from each other.
    leaves_by : (m,) int64 ndarray
        The port by which a path leaves, or -1.
    """
    n_ports = len(mesh.ports.sides)
    leaves = leaves_by >= 0
    sizes = np.bincount(ends[~leaves])
    first, first_leaves_by = ends[mesh.ports.triangles], leaves_by[mesh.ports.triangles]
    stays = first_leaves_by < 0
    shared, which = np.unique(first[stays], return_inverse=True)
    port_ends = np.empty(n_ports, np.int64)
    port_ends[stays], port_ends[~stays] = which, ~first_leaves_by[~stays]
    leaving = np.bincount(leaves_by[leaves], minlength=n_ports)
    shared_sizes = sizes[shared]
    sizes[shared] = 0
    return np.bincount(sizes[sizes > 0]), PortEnds(shared_sizes, leaving, port_ends)
