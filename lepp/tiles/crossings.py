"""What a tile tells the others of the paths that enter it, before anything is known of these."""

from typing import NamedTuple

import numpy as np

from lepp.geometry.lengths import SHORTEST_SHIFT
from lepp.jit import kernel
from lepp.paths.layers import INTERIOR_LAYER
from lepp.tiles.fine import FineMesh


class Crossings(NamedTuple):
    """What becomes of paths at the p ports of some tiles.

    Attributes
    ----------
    sides : (p,) int64 ndarray
        As of `lepp.tiles.fine.Ports`.
    longest, shortest : (p,) bool ndarray
        Whether the port is a longest edge, and the shortest, of the triangle inside.
    ways : (w, 3) int64 ndarray
        A port; a port by which a path that starts at the triangle inside can leave, or -1 where it
        ends in the tile; the triangles on it until then. More than one a port only where edges are
        equally long.
    steps : (s, 3) int64 ndarray
        Two ports of a tile, and the steps across edges from the triangle inside one to that inside
        the other; none where these are `lepp.INTERIOR_LAYER` or more.
    """

    sides: np.ndarray
    longest: np.ndarray
    shortest: np.ndarray
    ways: np.ndarray
    steps: np.ndarray


def crossings(mesh: FineMesh) -> Crossings:
    """Follow the paths that begin at the ports of a fine mesh."""
    _, triangles, edges = mesh.ports
    ranks = mesh.ranks[triangles]
    tiles = mesh.ports.sides // 3
    together = np.bincount(tiles - tiles[0])[tiles - tiles[0]]
    return Crossings(
        mesh.ports.sides,
        (ranks >> edges.astype(np.uint8)) & 1 == 1,
        (ranks >> SHORTEST_SHIFT) & 3 == edges,
        _ways(mesh.neighbors, mesh.ranks, triangles),
        _steps(mesh.neighbors, triangles, together, INTERIOR_LAYER),
    )


@kernel
def _ways(neighbors, ranks, triangles):
    """Return `Crossings.ways`, breadth first: of two ways to one end the shorter comes first."""
    seen = np.full(len(neighbors), -1, np.int32)
    queue = np.empty((len(neighbors), 2), np.int32)
    ways = [(np.int64(0), np.int64(0), np.int64(0))]
    for port in range(len(triangles)):
        queue[0, 0], queue[0, 1] = triangles[port], 1
        at, end = 0, 1
        while at < end:
            t, size = queue[at, 0], queue[at, 1]
            at += 1
            for k in range(3):
                if not (ranks[t] >> k) & 1:
                    continue
                s = neighbors[t, k]
                if s < 0:
                    ways.append((np.int64(port), np.int64(~s), np.int64(size)))
                    continue
                back = 0 if neighbors[s, 0] == t else (1 if neighbors[s, 1] == t else 2)
                if (ranks[s] >> back) & 1:
                    ways.append((np.int64(port), np.int64(-1), np.int64(size + 1)))
                elif seen[s] != port:
                    seen[s] = port
                    queue[end, 0], queue[end, 1] = s, size + 1
                    end += 1
    return _rows(ways)


@kernel
def _steps(neighbors, triangles, together, last):
    """Return `Crossings.steps`, where `together` says how many ports the tile of each has."""
    reached_by = np.full(len(neighbors), -1, np.int32)
    queue = np.empty((len(neighbors), 2), np.int32)
    steps = [(np.int64(0), np.int64(0), np.int64(0))]
    for port in range(len(triangles)):
        queue[0, 0], queue[0, 1] = triangles[port], 0
        reached_by[triangles[port]] = port
        at, end, n_found = 0, 1, 0
        while at < end and n_found < together[port]:
            t, so_far = queue[at, 0], queue[at, 1]
            at += 1
            for k in range(3):
                s = neighbors[t, k]
                if s < 0:
                    n_found += 1
                    if ~s != port:
                        steps.append((np.int64(port), np.int64(~s), np.int64(so_far)))
                elif reached_by[s] != port and so_far + 1 < last:
                    reached_by[s] = port
                    queue[end, 0], queue[end, 1] = s, so_far + 1
                    end += 1
    return _rows(steps)


@kernel
def _rows(entries):
    """Return a list of triples, without the first, as an array."""
    rows = np.empty((len(entries) - 1, 3), np.int64)
    for i in range(1, len(entries)):
        for j in range(3):
            rows[i - 1, j] = entries[i][j]
    return rows
