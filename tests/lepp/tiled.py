"""A whole triangulation counted in tiles, and at once."""

from dataclasses import dataclass, fields

import numpy as np

import lepp
from lepp.tiles.coarse import coarse_mesh, hull_of, outside
from lepp.tiles.crossings import crossings
from lepp.tiles.fine import collect, fine_mesh
from lepp.tiles.joining import Outer, beyond, joined, region_sizes
from lepp.tiles.location import locate
from lepp.tiles.measuring import tile_counts


@dataclass
class Counts:
    n_triangles: int
    n_hull: int
    n_repeated: int
    by_layer: np.ndarray
    types: np.ndarray
    n_equal: int
    n_nearly_equal: int
    regions: np.ndarray


def assert_same(counts, others):
    for field in fields(Counts):
        one, other = getattr(counts, field.name), getattr(others, field.name)
        np.testing.assert_array_equal(one, other, err_msg=field.name)


def trimmed(array):
    """An array without zeros behind."""
    stops = [places.max(initial=-1) + 1 for places in np.nonzero(array)]
    return array[tuple(slice(stop) for stop in stops)]


def added(arrays):
    """The sum of arrays of different shapes."""
    total = np.zeros(np.max([array.shape for array in arrays], axis=0), np.int64)
    for array in arrays:
        total[tuple(slice(stop) for stop in array.shape)] += array
    return trimmed(total)


def at_once(points):
    mesh = lepp.triangulate(points)
    paths = lepp.lepp_paths(mesh)
    return Counts(
        len(mesh),
        mesh.n_hull,
        len(mesh.repeated),
        lepp.sizes_by_layer(lepp.triangle_layers(mesh), paths.sizes),
        np.bincount(paths.neighbor_types, minlength=4),
        paths.n_equal,
        paths.n_nearly_equal,
        np.bincount(np.bincount(paths.regions)),
    )


def coarse_of(points, n_first, opening):
    opening = min(opening, len(points))
    later = opening + np.flatnonzero(outside(hull_of(points[:opening]), points[opening:]))
    indices = np.concatenate((np.arange(opening), later))
    return coarse_mesh(points[indices], indices, min(n_first, opening))


def in_tiles(points, *, n_first, opening, block, together):
    """Counts of a plain insertion, of blocks of points and so many tiles together."""
    coarse = coarse_of(points, n_first, opening)
    blocks = range(0, len(points), block)
    located = [locate(coarse, points[first : first + block], first) for first in blocks]
    meshes = []
    for tile in range(0, len(coarse), together):
        span = slice(tile, tile + together)
        pieces = []
        for part, first in zip(located, blocks, strict=True):
            start, inside = part.counts[:tile].sum(), part.counts[span]
            pieces.append((part.placed[start : start + inside.sum()], inside, first))
        meshes.append(fine_mesh(coarse, tile, collect(pieces)))
    crossed = joined([crossings(mesh) for mesh in meshes])
    outer = beyond(coarse, crossed)
    parts, port = [], 0
    for mesh in meshes:
        ports = slice(port, port + len(mesh.ports.sides))
        parts.append(tile_counts(mesh, Outer(*(column[ports] for column in outer))))
        port = ports.stop
    shared = region_sizes(coarse, crossed, [part.ends for part in parts])
    on_sides = np.unique(np.concatenate([mesh.repeated_on_sides for mesh in meshes]))
    return Counts(
        sum(len(mesh.triangles) for mesh in meshes),
        int(np.count_nonzero(~outer.exists)),
        coarse.n_repeated
        + sum(part.n_repeated for part in located)
        + sum(mesh.n_repeated for mesh in meshes)
        + len(on_sides),
        added([part.by_layer for part in parts]),
        sum(part.types for part in parts),
        sum(part.n_equal for part in parts),
        sum(part.n_nearly_equal for part in parts),
        added([*(part.regions for part in parts), np.bincount(shared)]),
    )
