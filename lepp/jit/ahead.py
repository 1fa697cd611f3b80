"""Compiling ahead: what will be needed, by two processes, before many others start.

The kernels fall into parts, each of which a tiny example compiles by itself. They stand in such an
order that one process can begin at the front and another at the back: what one has done the other
loads from the cache, and they meet among the small parts in the middle.
"""

import gc
import os
import subprocess
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress

import numba
import numpy as np
from numba.core import event

from lepp.geometry.hilbert import hilbert_order
from lepp.geometry.lengths import edge_ranks
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
    roots = hull_roots(_POINTS)
    settle_by_cells(_POINTS, 3, roots.rows, roots.places)


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


def _lengths() -> None:
    edge_ranks(_POINTS, _TRIANGLES)


def _paths(points: np.ndarray = _POINTS) -> object:
    paths = lepp_paths(Triangulation(points, _TRIANGLES, _NEIGHBORS))
    return paths.regions, paths.region_counts


def _equal_lengths() -> None:
    _paths(np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 2.0], [3.0, 2.0]]))


def _layers() -> None:
    layers = triangle_layers(Triangulation(_POINTS, _TRIANGLES, _NEIGHBORS))
    sizes_by_layer(layers, np.ones(2, np.int32))


def _meshes() -> None:
    Triangulation.from_arrays(_POINTS, _TRIANGLES)
    edge_ranks(np.column_stack((_POINTS, np.zeros(4))), _TRIANGLES)


def _tiles() -> None:
    coarse = coarse_mesh(_POINTS, np.arange(4), 4)
    outside(_POINTS[[0, 1, 3, 2]], _WITH_ONE_INSIDE)
    points = np.vstack((_POINTS, _WITH_ONE_INSIDE[3:]))
    located = locate(coarse, points, 0)
    crossings(fine_mesh(coarse, 0, collect([(located.placed, located.counts, 0)])))


_PARTS: dict[str, Callable[[], object]] = {
    "hull": _hull,
    "curve": _curve,
    "tiles": _tiles,
    "equal lengths": _equal_lengths,
    "paths": _paths,
    "meshes": _meshes,
    "lengths": _lengths,
    "subdivision": _subdivision,
    "cavities": _cavities,
    "layers": _layers,  # takes no predicate: those are compiled meanwhile
}
_OF_METHODS = {"incremental": {"hull", "subdivision"}, "delaunay": {"curve", "cavities"}}
_OF_ALL = {"lengths", "paths", "equal lengths", "layers"}


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
        Whether there will be meshes of others, in the plane or in space.
    """
    wanted = _OF_ALL.union(*(_OF_METHODS.get(method, set()) for method in methods))
    wanted |= ({"tiles"} if tiles else set()) | ({"meshes"} if meshes else set())
    compile_parts([part for part in _PARTS if part in wanted])


def compile_parts(parts: list[str]) -> None:
    """Compile some parts, from the front here and from the back in another process."""
    helper = _Helper(parts[::-1])
    try:
        with event.install_listener("numba:compile", helper):
            _make(parts)
    finally:
        helper.stop()


def _make(parts: Iterable[str]) -> None:
    # A compiler holds much and lets go of little: collecting garbage takes a twentieth of its time.
    collects = gc.isenabled()
    gc.disable()
    try:
        for part in parts:
            _PARTS[part]()
    finally:
        if collects:
            gc.enable()


class _Helper(event.Listener):  # type: ignore[misc]  # numba has no types
    """A process that compiles parts, as soon as it is seen that there is anything to compile."""

    def __init__(self, parts: list[str]) -> None:
        # Without a cache it would help nobody.
        wanted = CACHE_DIRECTORY is not None and (os.cpu_count() or 1) > 1 and len(parts) > 1
        self._parts = parts if wanted else None
        self._process: subprocess.Popen[bytes] | None = None

    def on_start(self, event: event.Event) -> None:
        if self._parts is None:
            return
        code = "import sys, lepp.jit.ahead as a; a._make(sys.argv[1:])"
        path = os.pathsep.join(filter(None, sys.path))
        environment = {"PYTHONPATH": path, "NUMBA_CACHE_DIR": numba.config.CACHE_DIR}
        with suppress(OSError):  # there can be no more processes
            self._process = subprocess.Popen(
                # Not from the working directory, which may hold the sources of what is installed.
                [sys.executable, "-P", "-c", code, *self._parts],
                env=os.environ | environment,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,  # what fails there is done, and told, here
            )
        self._parts = None

    def on_end(self, event: event.Event) -> None:
        pass

    def stop(self) -> None:
        """End the process: all is done, or nothing will be."""
        if self._process is not None:
            self._process.terminate()
            self._process.wait()
