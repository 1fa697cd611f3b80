"""The join of all tiles: what lies beyond each port, and which terminal edge its paths end at."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from lepp.paths.layers import INTERIOR_LAYER
from lepp.tiles.coarse import CoarseMesh
from lepp.tiles.crossings import Crossings

_NOT_YET = np.iinfo(np.int64).max // 2


class Outer(NamedTuple):
    """The triangle outside each of p ports.

    Attributes
    ----------
    exists : (p,) bool ndarray
        False on the hull.
    longest, shortest : (p,) bool ndarray
        Whether the port is a longest edge, and the shortest, of that triangle.
    sizes : (p,) int64 ndarray
        Its LEPP size.
    layers : (p,) int64 ndarray
        Its layer, as from `lepp.triangle_layers`.
    """

    exists: np.ndarray
    longest: np.ndarray
    shortest: np.ndarray
    sizes: np.ndarray
    layers: np.ndarray


def joined(parts: Sequence[Crossings]) -> Crossings:
    """Put the crossings of all tiles together, given in order; ports are numbered on."""
    offset = 0
    ways, steps = [], []
    for part in parts:
        ends_inside = part.ways[:, 1] < 0
        ways.append(part.ways + np.array([offset, offset, 0]))
        ways[-1][ends_inside, 1] = -1
        steps.append(part.steps + np.array([offset, offset, 0]))
        offset += len(part.sides)
    return Crossings(
        np.concatenate([part.sides for part in parts]),
        np.concatenate([part.longest for part in parts]),
        np.concatenate([part.shortest for part in parts]),
        np.concatenate(ways),
        np.concatenate(steps),
    )


def twins(coarse: CoarseMesh, sides: np.ndarray) -> np.ndarray:
    """Return the port on the other side of each port, (p,) int64; -1 on the hull.

    Parameters
    ----------
    coarse : CoarseMesh
    sides : (p,) int64 ndarray
        Of all ports, in order.
    """
    t, k = np.divmod(sides, 3)
    other = coarse.neighbors[t, k].astype(np.int64)
    back = np.argmax(coarse.neighbors[other] == t[:, None], axis=1)
    position = np.arange(len(sides)) - np.searchsorted(sides, sides)
    return np.where(other < 0, -1, np.searchsorted(sides, 3 * other + back) + position)


def beyond(coarse: CoarseMesh, crossings: Crossings) -> Outer:
    """Find what lies beyond each port.

    Parameters
    ----------
    coarse : CoarseMesh
    crossings : Crossings
        Of all tiles.

    Returns
    -------
    Outer
    """
    twin = twins(coarse, crossings.sides)
    exists = twin >= 0
    return Outer(
        exists,
        exists & crossings.longest[twin],
        exists & crossings.shortest[twin],
        np.where(exists, _sizes(crossings, twin)[twin], 0),
        np.where(exists, _layers(crossings, twin)[twin], 0),
    )


def _sizes(crossings: Crossings, twin: np.ndarray) -> np.ndarray:
    """Return the LEPP size of the triangle inside each port, (p,) int64.

    A path goes over ever longer edges, so that it comes by no port twice, and the rounds end.
    """
    port, way, length = crossings.ways.T
    outer = twin[way]
    ends = (way < 0) | (outer < 0)
    terminal = ~ends & crossings.longest[outer]
    sizes = np.full(len(twin), _NOT_YET)
    while True:
        rest = np.where(ends, 0, np.where(terminal, 1, sizes[outer]))
        found = np.full(len(twin), _NOT_YET)
        np.minimum.at(found, port, np.minimum(length + rest, _NOT_YET))
        if (found == sizes).all():
            return sizes
        sizes = found


def _layers(crossings: Crossings, twin: np.ndarray) -> np.ndarray:
    """Return the layer of the triangle inside each port, (p,) int64."""
    crossed = np.flatnonzero(twin >= 0)
    over = np.column_stack((crossed, twin[crossed], np.ones_like(crossed)))
    steps = np.concatenate((crossings.steps, over))
    steps = steps[np.argsort(steps[:, 0], kind="stable")]
    first = np.searchsorted(steps[:, 0], np.arange(len(twin) + 1))
    layers = np.where(twin < 0, 0, INTERIOR_LAYER)
    for layer in range(INTERIOR_LAYER):
        at = np.flatnonzero(layers == layer)
        while len(at):  # steps of length 0 reach ports of the same triangle
            rows = _ranges(first[at], first[at + 1])
            before = layers.copy()
            np.minimum.at(layers, steps[rows, 1], layer + steps[rows, 2])
            at = np.flatnonzero((layers == layer) & (before > layer))
    return layers


def _ranges(starts: np.ndarray, stops: np.ndarray) -> np.ndarray:
    """Return the numbers of several ranges, one after the other."""
    counts = stops - starts
    return np.repeat(stops - np.cumsum(counts), counts) + np.arange(counts.sum())


class PortEnds(NamedTuple):
    """Where the paths of a tile's triangles end, for those that other tiles' paths may join.

    Attributes
    ----------
    regions : (r,) int64 ndarray
        Triangles of the tiles in each region that a path from a port ends in.
    leaving : (p,) int64 ndarray
        Triangles of the tiles whose paths leave by each port.
    ends : (p,) int64 ndarray
        The region that the path of the triangle inside each port ends in, or the complement (~) of
        the port by which it leaves.
    """

    regions: np.ndarray
    leaving: np.ndarray
    ends: np.ndarray


def region_sizes(coarse: CoarseMesh, crossings: Crossings, parts: Sequence[PortEnds]) -> np.ndarray:
    """Return the sizes of the terminal-edge regions that are not of one tile's triangles alone.

    Parameters
    ----------
    coarse : CoarseMesh
    crossings : Crossings
        Of all tiles.
    parts : sequence of PortEnds
        Of all tiles, in order.

    Returns
    -------
    (k,) int64 ndarray
        Of those, too, that a port's path ends in though no other tile's does.
    """
    twin = twins(coarse, crossings.sides)
    n_ports = len(twin)
    regions = np.concatenate([part.regions for part in parts])
    leaving = np.concatenate([part.leaving for part in parts])
    ends = np.empty(n_ports, np.int64)
    first_port = first_region = 0
    for part in parts:
        span = slice(first_port, first_port + len(part.ends))
        ends[span] = np.where(part.ends < 0, part.ends - first_port, part.ends + first_region)
        first_port, first_region = span.stop, first_region + len(part.regions)
    # Where a path that crosses a port ends: in a region, or, behind these, at a terminal edge that
    # is a side, for which the lower of its two ports stands.
    crossed = twin >= 0
    terminal = crossed & crossings.longest[twin]
    beyond_it = ends[twin]
    place = np.full(n_ports, -1)
    place[terminal] = len(regions) + np.minimum(np.arange(n_ports), twin)[terminal]
    inside = crossed & ~terminal & (beyond_it >= 0)
    place[inside] = beyond_it[inside]
    through = np.flatnonzero(crossed & ~terminal & (beyond_it < 0))
    next_port = ~beyond_it[through]
    while (place[through] < 0).any():
        place[through] = place[next_port]
    sizes = np.append(regions, np.zeros(n_ports, np.int64))
    left = leaving > 0
    np.add.at(sizes, place[left], leaving[left])
    return sizes[sizes > 0]
