"""The fine mesh of some consecutive tiles: each by itself, cut off from the others at its sides.

An edge of the fine mesh on a side of a tile is a *port*: paths enter and leave the tile there. A
side has one port, or more where points lie on it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lepp.geometry.lengths import edge_ranks
from lepp.tiles.coarse import CoarseMesh
from lepp.triangulate.plain.edges import link
from lepp.triangulate.plain.subdivision import Mesh, subdivide


class TilePoints(NamedTuple):
    """The points in some consecutive tiles, tile by tile, in the order of insertion.

    Attributes
    ----------
    x, y : (k,) float64 ndarray
    indices : (k,) int64 ndarray
        In the set.
    on_side : (k,) bool ndarray
        Whether the point is on a side of the tile.
    starts : (t + 1,) int64 ndarray
        Bounds of the tiles' points.
    """

    x: np.ndarray
    y: np.ndarray
    indices: np.ndarray
    on_side: np.ndarray
    starts: np.ndarray


class Ports(NamedTuple):
    """Edges on the sides of tiles, in the order of the sides and along each, from its older end.

    Attributes
    ----------
    sides : (p,) int64 ndarray
        3 t + k for a port on side k of tile t, which is across from vertex k.
    triangles : (p,) int32 ndarray
        The fine triangle inside.
    edges : (p,) int8 ndarray
        Which of its edges the port is.
    """

    sides: np.ndarray
    triangles: np.ndarray
    edges: np.ndarray


@dataclass(frozen=True, eq=False)
class FineMesh:
    """The fine mesh of some consecutive tiles.

    Attributes
    ----------
    triangles : (m, 3) int32 ndarray
        Vertices, numbered for each tile by itself, in the order of insertion.
    neighbors : (m, 3) int32 ndarray
        ``~p`` (at most -1) at port p.
    ranks : (m,) uint8 ndarray
        As from `lepp.geometry.lengths.edge_ranks`.
    ports : Ports
    n_repeated : int
        Points inside tiles that are left out, because they repeat another.
    repeated_on_sides : (r,) int64 ndarray
        Indices of those on sides; the tile on the other side has them as well.
    """

    triangles: np.ndarray
    neighbors: np.ndarray
    ranks: np.ndarray
    ports: Ports
    n_repeated: int
    repeated_on_sides: np.ndarray


def collect(blocks: Sequence[tuple[np.ndarray, np.ndarray, int]]) -> TilePoints:
    """Put together what blocks of points have in some consecutive tiles.

    Parameters
    ----------
    blocks : sequence of (placed, counts, first)
        In order: `lepp.tiles.location.PLACED` rows and counts for the tiles in question, and the
        index of the block's first point.

    Returns
    -------
    TilePoints
    """
    counts = np.stack([counts for _, counts, _ in blocks], axis=1)  # by tile, then block
    ends = np.cumsum(counts).reshape(counts.shape)
    total = int(ends[-1, -1])
    x, y = np.empty(total), np.empty(total)
    indices, on_side = np.empty(total, np.int64), np.empty(total, bool)
    for b, (placed, of_tiles, first) in enumerate(blocks):
        before = np.cumsum(of_tiles) - of_tiles
        shift = ends[:, b] - of_tiles - before
        to = np.arange(len(placed)) + np.repeat(shift, of_tiles)
        ident = placed["ident"]
        x[to], y[to], on_side[to] = placed["x"], placed["y"], ident < 0
        indices[to] = first + np.where(ident < 0, ~ident, ident)
    return TilePoints(x, y, indices, on_side, np.append(0, ends[:, -1]))


def fine_mesh(coarse: CoarseMesh, first: int, inside: TilePoints) -> FineMesh:
    """Insert the points of some consecutive tiles.

    Parameters
    ----------
    coarse : CoarseMesh
    first : int
        The first of the tiles.
    inside : TilePoints

    Returns
    -------
    FineMesh
    """
    n_tiles, k = len(inside.starts) - 1, len(inside.x)
    tiles = coarse.triangles[first : first + n_tiles].astype(np.int64)
    corners, numbers = _numbered(coarse, tiles, inside)
    n = k + 3 * n_tiles
    points = np.empty((n, 2))
    points[corners] = coarse.points[tiles]
    points[numbers, 0], points[numbers, 1] = inside.x, inside.y
    roots = np.empty((n_tiles, 6), np.int32)
    roots[:, :3] = corners
    roots[:, 3:] = 2 * np.arange(3 * n_tiles).reshape(-1, 3)  # half-edge 2 e of side e is inside
    room = 2 * int(np.diff(inside.starts).max()) + 8
    lists = np.empty((k + 3 * room, 3))
    lists[:k, 0], lists[:k, 1] = inside.x, inside.y
    lists[:k, 2] = np.where(inside.on_side, ~numbers, numbers)
    split, repeats = np.zeros(4 * n, np.int32), np.full(n, -1, np.int32)
    mesh = Mesh(
        np.empty((2 * n, 3), np.int32),
        np.empty((2 * n, 3), np.int32),
        np.zeros(8 * n, np.int32),
        np.empty(2 * n, np.uint8),
    )
    m, certain = subdivide(
        points, roots, inside.starts, room, lists, 3 * n_tiles, split, repeats, mesh
    )
    triangles, neighbors = mesh.triangles[:m], mesh.half_edges[:m]
    ports = _ports(tiles, split, mesh.owners, neighbors)
    link(neighbors, mesh.owners)
    neighbors[ports.triangles, ports.edges] = ~np.arange(len(ports.sides), dtype=np.int32)
    repeated = repeats[numbers] >= 0
    return FineMesh(
        triangles,
        neighbors,
        mesh.ranks[:m] if certain else edge_ranks(points, triangles),
        ports._replace(sides=ports.sides + 3 * first),
        int(np.count_nonzero(repeated & ~inside.on_side)),
        inside.indices[repeated & inside.on_side],
    )


def _numbered(
    coarse: CoarseMesh, tiles: np.ndarray, inside: TilePoints
) -> tuple[np.ndarray, np.ndarray]:
    """Give the vertices of each tile numbers, in the order of their indices in the set.

    Returns
    -------
    corners : (t, 3) int64 ndarray
    numbers : (k,) int64 ndarray
    """
    n_tiles = len(tiles)
    bases = inside.starts[:-1] + 3 * np.arange(n_tiles)
    ranks = np.argsort(np.argsort(tiles, axis=1), axis=1)
    corners = bases[:, None] + ranks
    tile_of = np.repeat(np.arange(n_tiles), np.diff(inside.starts))
    numbers = np.arange(len(inside.x)) + 3 * (tile_of + 1)
    # A point on a side may be older than a corner, which has extended the hull beyond that side.
    for t in np.unique(tile_of[inside.on_side]):
        span = slice(inside.starts[t], inside.starts[t + 1])
        indices = np.concatenate((coarse.indices[tiles[t]], inside.indices[span]))
        places = bases[t] + np.argsort(np.argsort(indices))
        corners[t], numbers[span] = places[:3], places[3:]
    return corners, numbers


def _ports(
    tiles: np.ndarray, split: np.ndarray, owners: np.ndarray, half_edges: np.ndarray
) -> Ports:
    """Find the edges on the sides of tiles; side k of tile t, from 0, is edge 3 t + k."""
    sides = edges = np.arange(3 * len(tiles))
    if split[edges].any():
        along = [_parts(int(edge), split) for edge in edges]
        for edge, parts in enumerate(along):
            t, k = divmod(edge, 3)
            if tiles[t, (k + 1) % 3] > tiles[t, (k + 2) % 3]:
                parts.reverse()
        sides = np.repeat(edges, [len(parts) for parts in along])
        edges = np.concatenate([np.array(parts) for parts in along])
    triangles = owners[2 * edges] - 1
    which = np.argmax(half_edges[triangles] == 2 * edges[:, None], axis=1)
    return Ports(sides.astype(np.int64), triangles, which.astype(np.int8))


def _parts(edge: int, split: np.ndarray) -> list[int]:
    """Return the edges into which an edge was split, from where its half-edge inside begins."""
    parts, waiting = [], [edge]
    while waiting:
        edge = waiting.pop()
        if split[edge]:
            waiting += [int(split[edge]) + 1, int(split[edge])]
        else:
            parts.append(edge)
    return parts
