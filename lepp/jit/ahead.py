"""Compiling ahead: what will be needed, by some processes, before many others start.

The kernels fall into parts, each of which a tiny example compiles by itself. They wait in a pipe,
from which each process takes the next one; what another has compiled is loaded from the cache.
"""

import gc
import os
import subprocess
from collections.abc import Callable, Iterable
from contextlib import suppress

import numba
import numpy as np
from numba.core import event

from lepp.geometry.hilbert import hilbert_order
from lepp.geometry.lengths import edge_ranks
from lepp.jit import child
from lepp.jit.options import CACHE_DIRECTORY
from lepp.mesh.triangulation import Triangulation
from lepp.paths.layers import sizes_by_layer, triangle_layers
from lepp.paths.paths import lepp_paths
from lepp.tiles.coarse import coarse_mesh, outside
from lepp.tiles.crossings import crossings
from lepp.tiles.fine import collect, fine_mesh
from lepp.tiles.location import locate
from lepp.triangulate import METHODS
from lepp.triangulate.delaunay.delaunay import inserted, space_for
from lepp.triangulate.plain.cells import settle_by_cells
from lepp.triangulate.plain.hull import Roots, hull_roots
from lepp.triangulate.plain.incremental import subdivided
from lepp.triangulate.plain.waiting import INSIDE, nobody_placed

# Two triangles on either side of edge 1 2, and one with a point inside.
_POINTS = np.array([[0.0, 0.0], [1.0, 0.1], [0.0, 1.3], [1.1, 1.0]])
_TRIANGLES = np.array([[0, 1, 2], [3, 2, 1]], np.int32)
_NEIGHBORS = np.array([[1, -1, -1], [0, -1, -1]], np.int32)
_WITH_ONE_INSIDE = np.array([[0.0, 0.0], [1.0, 0.1], [0.0, 1.3], [0.3, 0.4]])


def _hull() -> None:
    hull_roots(_POINTS)


def _cells() -> None:
    settle_by_cells(_POINTS, 3, np.array([[0, 1, 2, 0, 2, 4]], np.int32), nobody_placed(4))


def _subdivision() -> None:
    places = nobody_placed(4)
    places.state[3], places.of[3], places.beyond[3] = INSIDE, 0, -1
    root = np.array([[0, 1, 2, 0, 2, 4]], np.int32)
    subdivided(_WITH_ONE_INSIDE, Roots(places, root, 3, np.zeros(16, np.int32)))


def _curve() -> None:
    hilbert_order(_POINTS, np.empty(4, np.uint32), np.empty(8, np.uint64))


def _cavities() -> None:
    space = space_for(4)
    space.order[:] = range(4)
    inserted(_POINTS, space)


def _paths() -> object:
    mesh = Triangulation(_POINTS, _TRIANGLES, _NEIGHBORS)
    object.__setattr__(mesh, "_edge_ranks", np.ones(2, np.uint8))  # as of all that is triangulated
    return lepp_paths(mesh).region_counts


def _layers() -> None:
    layers = triangle_layers(Triangulation(_POINTS, _TRIANGLES, _NEIGHBORS))
    sizes_by_layer(layers, np.ones(2, np.int32))


def _meshes() -> object:
    edge_ranks(np.column_stack((_POINTS, np.zeros(4))), _TRIANGLES)
    isosceles = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 2.0], [3.0, 2.0]])
    meshes = [Triangulation.from_arrays(points, _TRIANGLES) for points in (_POINTS, isosceles)]
    return [lepp_paths(mesh).regions for mesh in meshes]


def _tiles() -> None:
    coarse = coarse_mesh(_POINTS, np.arange(4), 4)
    outside(_POINTS[[0, 1, 3, 2]], _WITH_ONE_INSIDE)
    points = np.vstack((_POINTS, _WITH_ONE_INSIDE[3:]))
    located = locate(coarse, points, 0)
    crossings(fine_mesh(coarse, 0, collect([(located.placed, located.counts, 0)])))


# Long ones first, so that all end at about the same time; the second takes no predicate, which are
# compiled with the first meanwhile.
_PARTS: dict[str, Callable[[], object]] = {
    "hull": _hull,
    "layers": _layers,
    "cavities": _cavities,
    "subdivision": _subdivision,
    "tiles": _tiles,
    "meshes": _meshes,
    "curve": _curve,
    "cells": _cells,
    "paths": _paths,
}
_OF_METHODS = {"incremental": {"hull", "cells", "subdivision"}, "delaunay": {"curve", "cavities"}}
_OF_ALL = {"paths", "layers"}

_MOST_PROCESSES = 4  # the longest part takes a quarter of the time of all
_PATIENCE_SECONDS = 60


def compile_kernels(
    methods: Iterable[str] = tuple(METHODS), *, tiles: bool = True, meshes: bool = True
) -> None:
    """Compile kernels, or load them from the cache.

    All of them take about half a minute on two cores the first time, and again after a change of
    version; then well under a second. Workers that start afterwards load what this has compiled.

    Parameters
    ----------
    methods : iterable of str
        What will triangulate: of `lepp.METHODS`.
    tiles : bool
        Whether there will be triangulations in tiles.
    meshes : bool
        Whether there will be meshes of others, in the plane or in space, with edges that are
        equally long, as no two of random points are, and with regions to look at.
    """
    wanted = _OF_ALL.union(*(_OF_METHODS.get(method, set()) for method in methods))
    wanted |= ({"tiles"} if tiles else set()) | ({"meshes"} if meshes else set())
    compile_parts([part for part in _PARTS if part in wanted])


def compile_parts(parts: list[str]) -> None:
    """Compile some parts, or load them, together with other processes if there is a cache."""
    read, write = os.pipe()
    try:
        os.write(write, bytes(range(len(parts))))
        os.close(write)
        helpers = _Helpers(parts, read)
        try:
            with event.install_listener("numba:compile", helpers):
                made = take_parts(parts, read)
            helpers.wait()
        finally:
            helpers.stop()
        for part in parts:
            if part not in made:
                _PARTS[part]()
    finally:
        os.close(read)


def take_parts(parts: list[str], numbers: int) -> list[str]:
    """Compile the parts whose numbers can be had, a byte each, from a file descriptor."""
    made = []
    # A compiler holds much and lets go of little: collecting garbage takes a twentieth of its time.
    collects = gc.isenabled()
    gc.disable()
    try:
        while number := os.read(numbers, 1):
            part = parts[number[0]]
            _PARTS[part]()
            made.append(part)
    finally:
        if collects:
            gc.enable()
    return made


class _Helpers(event.Listener):  # type: ignore[misc]  # numba has no types
    """Processes that take parts too, as soon as it is seen that there is anything to compile."""

    def __init__(self, parts: list[str], numbers: int) -> None:
        # Without a cache they would help nobody.
        n_processes = min(_n_cores(), len(parts), _MOST_PROCESSES)
        self._n_to_start = n_processes - 1 if CACHE_DIRECTORY is not None else 0
        self._parts = parts
        self._numbers = numbers
        self._processes: list[subprocess.Popen[bytes]] = []

    def on_start(self, event: event.Event) -> None:
        # What the compiler holds is not given back piece by piece, which takes a second.
        code = "import os, sys, lepp.jit.ahead as a; a.take_parts(sys.argv[1:], 0); os._exit(0)"
        n, self._n_to_start = self._n_to_start, 0
        with suppress(OSError):  # there can be no more processes
            for _ in range(n):
                helper = subprocess.Popen(
                    child.command(code, *self._parts),
                    env=child.environment(NUMBA_CACHE_DIR=numba.config.CACHE_DIR),
                    stdin=self._numbers,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,  # what fails there is done, and told, here
                )
                self._processes.append(helper)

    def on_end(self, event: event.Event) -> None:
        pass

    def wait(self) -> None:
        """Wait until each has done its last part, or seems never to do it."""
        with suppress(subprocess.TimeoutExpired):
            for helper in self._processes:
                helper.wait(_PATIENCE_SECONDS)

    def stop(self) -> None:
        """End the processes."""
        for helper in self._processes:
            helper.terminate()
            helper.wait()


def _n_cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
