"""Which tile each point of a set lies in, a block of points at a time."""

from typing import NamedTuple

import numpy as np

from lepp.geometry.predicates import orient
from lepp.jit import inner, kernel
from lepp.jit.memory import for_kernels
from lepp.tiles.coarse import CoarseMesh
from lepp.triangulate.plain.hull import hull_roots
from lepp.triangulate.plain.subdivision import listed, partition, partition_beside

#: A point in a tile: coordinates, and its number in the block; the complement (~) of that where it
#: lies on a side. Such a point is in the tiles on both sides.
PLACED = np.dtype([("x", np.float64), ("y", np.float64), ("ident", np.int32)])


class Located(NamedTuple):
    """The points of a block by tile.

    Attributes
    ----------
    placed : (k,) PLACED ndarray
        Tile by tile, and in each in the order of insertion.
    counts : (c,) int64 ndarray
        How many of them each tile has.
    n_repeated : int
        Points left out, as they repeat a point of the coarse mesh, or another on the hull.
    """

    placed: np.ndarray
    counts: np.ndarray
    n_repeated: int


# A triangle of the coarse mesh, or of one before it was complete, and the points in it.
_JOB = np.dtype([(name, np.int64) for name in ("a", "b", "c", "first", "stop", "top_2", "top_3")])


def locate(coarse: CoarseMesh, points: np.ndarray, first: int) -> Located:
    """Find the tile of each point of a block.

    The coarse mesh is built once more, with the points of the block behind its own: so they are
    partitioned among its triangles, level by level, until only points of the block are left.

    Parameters
    ----------
    coarse : CoarseMesh
    points : (n, 2) float64 ndarray
        Consecutive points of the set.
    first : int
        The index of the first of them.

    Returns
    -------
    Located
    """
    n_coarse = len(coarse.points)
    begin, end = np.searchsorted(coarse.indices, (first, first + len(points)))
    ours = coarse.indices[begin:end]
    numbers = np.delete(np.arange(len(points)), ours - first)
    points = for_kernels(np.concatenate((coarse.points, points[numbers])), np.float64)
    places, rows, *_ = hull_roots(points)
    starts, room, lists = listed(points, places, len(rows))
    placed = np.empty(2 * len(points), PLACED)  # on a side, a point is in two tiles
    corners = np.empty((len(coarse), 3), np.int32)
    ends = np.empty(len(coarse) + 1, np.int64)
    n_tiles = _descend(
        points, n_coarse, rows, starts, room, lists, places.repeats, placed, corners, ends
    )
    tiles = _tiles_of(coarse, corners[:n_tiles])
    counts = np.zeros(len(coarse), np.int64)
    counts[tiles] = np.diff(ends[: n_tiles + 1])
    order = np.argsort(tiles)
    pieces = [placed[ends[k] : ends[k + 1]] for k in order]
    placed = np.concatenate(pieces) if pieces else placed[:0]
    ident = placed["ident"]
    placed["ident"] = np.where(ident < 0, ~numbers[~ident], numbers[ident])
    return Located(placed, counts, int(np.count_nonzero(places.repeats[n_coarse:] >= 0)))


def _tiles_of(coarse: CoarseMesh, corners: np.ndarray) -> np.ndarray:
    """Return the tiles that have given vertices, (k,) int64."""
    keys, wanted = _keys(coarse, coarse.triangles), _keys(coarse, corners)
    order = np.argsort(keys)
    return order[np.searchsorted(keys, wanted, sorter=order)]


def _keys(coarse: CoarseMesh, triangles: np.ndarray) -> np.ndarray:
    """Return a number for each triangle: that of the half-edge from its least vertex to the next.

    Every half-edge has one triangle on its left.
    """
    low = np.argmin(triangles, axis=1)
    rows = np.arange(len(triangles))
    first = triangles[rows, low].astype(np.int64)
    return first * len(coarse.points) + triangles[rows, (low + 1) % 3]


@kernel
def _descend(points, n_coarse, roots, starts, room, lists, repeats, placed, corners, ends):
    """Partition the points of each root triangle among the tiles in it.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
        Those of the coarse mesh first.
    n_coarse : int
        How many these are.
    roots, starts, room, lists, repeats
        As for `lepp.triangulate.plain.subdivision.subdivide`, where the stacks of lists are
        explained.
    placed : PLACED ndarray, output
    corners : (c, 3) int32 ndarray, output
        Vertices of the tiles that have points.
    ends : (c + 1,) int64 ndarray, output
        Bounds of their points.

    Returns
    -------
    n_tiles : int
    """
    second = starts[-1] + room
    third = second + room
    jobs = np.empty(2 * n_coarse + 8, _JOB)
    n_tiles = 0
    end = np.int64(0)
    ends[0] = 0
    for root in range(len(starts) - 2, -1, -1):  # the lists behind are overwritten
        if starts[root] == starts[root + 1]:
            continue
        row = roots[root]
        vertices = (np.int64(row[0]), np.int64(row[1]), np.int64(row[2]))
        _push(jobs, 0, vertices, (starts[root], starts[root + 1], second, third))
        n_jobs = 1
        while n_jobs:
            n_jobs -= 1
            job = jobs[n_jobs]
            a, b, c = job["a"], job["b"], job["c"]
            first, stop, top_2, top_3 = job["first"], job["stop"], job["top_2"], job["top_3"]
            spans = (first, stop, top_2, top_3)
            p = np.int64(lists[first, 2])
            on_side = p < 0
            p = ~p if on_side else p

            # A triangle without a point of the coarse mesh is a tile.
            if p >= n_coarse:
                for k in range(first, stop):
                    place = placed[end]
                    place["x"], place["y"], i = lists[k, 0], lists[k, 1], np.int64(lists[k, 2])
                    place["ident"] = i - n_coarse if i >= 0 else i + n_coarse
                    end += 1
                corners[n_tiles, 0], corners[n_tiles, 1], corners[n_tiles, 2] = a, b, c
                n_tiles += 1
                ends[n_tiles] = end
                continue

            # Any other is split by the first of them.
            first_part = 0
            end_1 = first
            if on_side:
                while orient(points, a, b, p) != 0:
                    a, b, c = b, c, a
                end_2, end_3 = partition_beside(points, lists, repeats, spans, p, c)
                first_part = 1  # the first part is flat
            else:
                p_x, p_y = points[p, 0], points[p, 1]
                end_1, end_2, end_3 = partition(
                    points, lists, repeats, spans, (p, a, b, c),
                    (points[a, 0] - p_x, points[a, 1] - p_y, points[b, 0] - p_x,
                     points[b, 1] - p_y, points[c, 0] - p_x, points[c, 1] - p_y),
                )  # fmt: skip
            for part in range(first_part, 3):
                if part == 0:
                    vertices, spans = (a, b, p), (first, end_1, top_2, top_3)
                elif part == 1:
                    vertices, spans = (p, b, c), (top_2, end_2, top_3, end_1)
                else:
                    vertices, spans = (a, p, c), (top_3, end_3, end_1, end_2)
                if spans[0] < spans[1]:
                    _push(jobs, n_jobs, vertices, spans)
                    n_jobs += 1
    return n_tiles


@inner
def _push(jobs, k, vertices, spans):
    """Write down a triangle whose points are to be partitioned."""
    job = jobs[k]
    job["a"], job["b"], job["c"] = vertices
    job["first"], job["stop"], job["top_2"], job["top_3"] = spans
