"""Compiling ahead, side by side, into one cache."""

import os
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest
from numba.core import event

from lepp import METHODS
from lepp.jit import ahead


def run(code, *arguments, cwd=None, **environment):
    """Run code in a process of its own; return the words that it prints."""
    root = str(Path(ahead.__file__).parents[2])
    return subprocess.run(
        [sys.executable, "-P", "-c", code, *arguments],
        env=os.environ | {"PYTHONPATH": root} | environment,
        cwd=cwd,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()


TWO_AT_ONCE = """
import os
import lepp.jit.ahead as ahead
read, write = os.pipe()
os.write(write, bytes([0]))
os.close(write)
ahead._n_cores = lambda: 2
helpers = ahead._Helpers(["layers", "layers"], read)
helpers.on_start(None)
ahead._PARTS["layers"]()
(helper,) = helpers._processes
print(helper.wait(), os.read(read, 1))
"""

NOTHING_LEFT = """
from numba.core import event
import lepp.jit.ahead as ahead
from lepp.paths.layers import layers_from_boundary, sizes_by_layer
started = []
ahead.subprocess.Popen = started.append
with event.install_recorder("numba:compile") as compiled:
    ahead.compile_parts(["layers", "layers"])
print(len(compiled.buffer), len(started))
print(*(sum(k.stats.cache_hits.values()) for k in (layers_from_boundary, sizes_by_layer)))
"""


def test_two_processes_that_compile_the_same_leave_a_sound_cache(tmp_path):
    assert run(TWO_AT_ONCE, NUMBA_CACHE_DIR=str(tmp_path)) == ["0", "b''"]
    assert run(NOTHING_LEFT, NUMBA_CACHE_DIR=str(tmp_path)) == ["0", "0", "1", "1"]
    kernels = {path.name.split("-")[0] for path in tmp_path.rglob("*.nbi")}
    assert kernels == {"layers.layers_from_boundary", "layers.sizes_by_layer"}


def test_what_lies_in_the_working_directory_is_not_compiled(tmp_path):
    (tmp_path / "lepp").mkdir()
    (tmp_path / "lepp" / "__init__.py").write_text("raise SystemExit('this is another')")
    assert run(TWO_AT_ONCE, cwd=tmp_path, NUMBA_CACHE_DIR=str(tmp_path / "cache")) == ["0", "b''"]


class Process:
    """A process that takes one part, if there is one."""

    ending = None

    def __init__(self, command, stdin, **_):
        self.parts, self.ended = command[4:], []
        self.took = os.read(stdin, 1)
        Process.started.append(self)

    def wait(self, timeout=None):
        if timeout is not None and self.ending is not None:
            raise self.ending
        self.ended.append("waited for")

    def terminate(self):
        self.ended.append("terminated")


@pytest.fixture
def processes(monkeypatch):
    monkeypatch.setattr(ahead.subprocess, "Popen", Process)
    monkeypatch.setattr(ahead, "_n_cores", lambda: 2)
    monkeypatch.setattr(Process, "started", [], raising=False)
    return Process.started


def parts(monkeypatch, **parts):
    """Compile parts; return their names as they were made here."""
    made = []

    def noted(name):
        made.append(name)
        parts[name]()

    monkeypatch.setattr(ahead, "_PARTS", {name: partial(noted, name) for name in parts})
    ahead.compile_parts(list(parts))
    return made


def compiling():
    with event.trigger_event("numba:compile"):
        pass


def test_another_process_takes_parts_too(processes, monkeypatch):
    made = parts(monkeypatch, loaded=lambda: None, one=compiling, two=compiling, three=compiling)
    assert made == ["loaded", "one", "three", "two"]  # the last to have what the other has made
    (helper,) = processes
    assert helper.parts == ["loaded", "one", "two", "three"]
    assert helper.took == bytes([2])
    assert helper.ended == ["waited for", "terminated", "waited for"]


def test_there_are_no_more_processes_than_cores_and_parts_and_longest_parts(processes, monkeypatch):
    for cores, n_parts, others in ((2, 9, 1), (3, 9, 2), (9, 9, 3), (9, 3, 2), (9, 1, 0)):
        processes.clear()
        monkeypatch.setattr(ahead, "_n_cores", lambda cores=cores: cores)
        assert sorted(parts(monkeypatch, **dict.fromkeys("abcdefghi"[:n_parts], compiling)))
        assert len(processes) == others


@pytest.mark.parametrize("ending", [None, subprocess.TimeoutExpired("python", 60)])
def test_what_another_process_takes_and_does_not_make_is_made(processes, monkeypatch, ending):
    monkeypatch.setattr(Process, "ending", ending)
    assert parts(monkeypatch, one=compiling, two=compiling) == ["one", "two"]
    assert processes[0].ended[-2:] == ["terminated", "waited for"]


def test_an_error_ends_the_other_process(processes, monkeypatch):
    def broken():
        compiling()
        raise MemoryError

    with pytest.raises(MemoryError):
        parts(monkeypatch, broken=broken, other=compiling)
    assert processes[0].ended == ["terminated", "waited for"]


def test_no_process_is_started_where_none_can_help(processes, monkeypatch):
    parts(monkeypatch, one=lambda: None, two=lambda: None)
    parts(monkeypatch, one=compiling)
    monkeypatch.setattr(ahead, "_n_cores", lambda: 1)
    parts(monkeypatch, one=compiling, two=compiling)
    monkeypatch.setattr(ahead, "_n_cores", lambda: 2)
    monkeypatch.setattr(ahead, "CACHE_DIRECTORY", None)
    parts(monkeypatch, one=compiling, two=compiling)
    assert processes == []


def test_what_is_not_asked_for_is_left_out(monkeypatch):
    asked = []
    monkeypatch.setattr(ahead, "compile_parts", lambda parts: asked.append(set(parts)))
    ahead.compile_kernels(("incremental",), tiles=False, meshes=False)
    ahead.compile_kernels(("delaunay",), tiles=False, meshes=False)
    ahead.compile_kernels((), tiles=True, meshes=True)
    ahead.compile_kernels()
    plain, delaunay, beside, everything = asked
    assert set(ahead._OF_METHODS) == set(METHODS)
    assert plain - delaunay == {"hull", "cells", "subdivision"}
    assert delaunay - plain == {"curve", "cavities"}
    assert beside - plain == {"tiles", "meshes"}
    assert everything == plain | delaunay | beside == set(ahead._PARTS)


AFTER_PREPARING = """
import sys
import numpy as np
from numba.core import event
from numba.core.dispatcher import Dispatcher
import lepp
from lepp.geometry.lengths import edge_ranks
meshes, *methods = sys.argv[1:]
lepp.compile_kernels(methods, tiles=False, meshes=bool(meshes))
random = np.random.default_rng(1).random((9000, 2))
lattice = np.indices((9, 9)).reshape(2, -1).T * 0.1
isosceles = np.array([[0, 0], [2, 0], [1, 2], [3, 2], [2, 4]])
with event.install_recorder("numba:compile") as compiled:
    for method in methods:
        for points in (random, lattice, isosceles) if meshes else (random,):
            mesh = lepp.triangulate(points, method)
            paths = lepp.lepp_paths(mesh)
            paths.region_counts
            lepp.sizes_by_layer(lepp.triangle_layers(mesh), paths.sizes)
            if meshes:
                paths.regions
                edge_ranks(mesh.points, mesh.triangles)
print(len(compiled.buffer))
for name, module in list(sys.modules.items()):
    if name.startswith("lepp."):
        for kernel in vars(module).values():
            if isinstance(kernel, Dispatcher) and kernel.__module__ == name and kernel.signatures:
                print(f"{name.removeprefix('lepp.')}.{kernel.__name__}:{len(kernel.signatures)}")
"""


@pytest.mark.parametrize("methods", [[method] for method in METHODS])
def test_a_method_needs_its_own_kernels_and_each_once(methods):
    compiled, *kernels = run(AFTER_PREPARING, "", *methods)
    assert compiled == "0"  # all that was needed was there
    assert {kernel.split(":")[1] for kernel in kernels} == {"1"}
    modules = {kernel.rpartition(".")[0] for kernel in kernels}
    other = {"incremental": "delaunay", "delaunay": "plain"}[methods[0]]
    assert not [module for module in modules if other in module or "tiles" in module]
    assert ("geometry.hilbert" in modules) == (methods[0] == "delaunay")
    assert not modules & {"mesh.adjacency", "paths.ties"}
    assert not [kernel for kernel in kernels if "rank_edges" in kernel or "regions_of" in kernel]


def test_for_meshes_of_others_there_is_the_rest():
    compiled, *kernels = run(AFTER_PREPARING, "meshes", *METHODS)
    assert compiled == "0"
    assert {kernel.split(":")[1] for kernel in kernels} == {"1"}
    assert "mesh.adjacency" in {kernel.rpartition(".")[0] for kernel in kernels}
