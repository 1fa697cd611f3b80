"""Compiling ahead, side by side, into one cache."""

import os
import subprocess
import sys
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
import lepp.jit.ahead as ahead
helper = ahead._Helper(["layers", "layers"])
helper.on_start(None)
ahead._PARTS["layers"]()
print(helper._process.wait())
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
    assert run(TWO_AT_ONCE, NUMBA_CACHE_DIR=str(tmp_path)) == ["0"]
    assert run(NOTHING_LEFT, NUMBA_CACHE_DIR=str(tmp_path)) == ["0", "0", "1", "1"]
    kernels = {path.name.split("-")[0] for path in tmp_path.rglob("*.nbi")}
    assert kernels == {"layers.layers_from_boundary", "layers.sizes_by_layer"}


def test_what_lies_in_the_working_directory_is_not_compiled(tmp_path):
    (tmp_path / "lepp").mkdir()
    (tmp_path / "lepp" / "__init__.py").write_text("raise SystemExit('this is another')")
    assert run(TWO_AT_ONCE, cwd=tmp_path, NUMBA_CACHE_DIR=str(tmp_path / "cache")) == ["0"]


class Process:
    """A process that is only said to run."""

    def __init__(self, command, **_):
        self.parts, self.ended = command[4:], []
        Process.started.append(self)

    def terminate(self):
        self.ended.append("terminated")

    def wait(self):
        self.ended.append("waited for")


@pytest.fixture
def processes(monkeypatch):
    monkeypatch.setattr(ahead.subprocess, "Popen", Process)
    monkeypatch.setattr(ahead.os, "cpu_count", lambda: 2)
    monkeypatch.setattr(Process, "started", [], raising=False)
    return Process.started


def parts(monkeypatch, **parts):
    monkeypatch.setattr(ahead, "_PARTS", parts)
    ahead.compile_parts(list(parts))


def compiling():
    with event.trigger_event("numba:compile"):
        pass


def test_another_process_begins_at_the_back(processes, monkeypatch):
    parts(monkeypatch, loaded=lambda: None, one=compiling, two=compiling)
    (helper,) = processes
    assert helper.parts == ["two", "one", "loaded"]
    assert helper.ended == ["terminated", "waited for"]


def test_an_error_ends_the_other_process(processes, monkeypatch):
    def broken():
        compiling()
        raise MemoryError

    with pytest.raises(MemoryError):
        parts(monkeypatch, broken=broken, other=compiling)
    assert processes[0].ended


def test_no_process_is_started_where_none_can_help(processes, monkeypatch):
    parts(monkeypatch, one=lambda: None, two=lambda: None)
    parts(monkeypatch, one=compiling)
    monkeypatch.setattr(ahead.os, "cpu_count", lambda: 1)
    parts(monkeypatch, one=compiling, two=compiling)
    monkeypatch.setattr(ahead.os, "cpu_count", lambda: 2)
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
    assert plain - delaunay == {"hull", "subdivision"}
    assert delaunay - plain == {"curve", "cavities"}
    assert beside - plain == {"tiles", "meshes"}
    assert everything == plain | delaunay | beside == set(ahead._PARTS)


AFTER_PREPARING = """
import sys
from math import inf
import numpy as np
from numba.core import event
from numba.core.dispatcher import Dispatcher
import lepp
from lepp.geometry.lengths import edge_ranks
methods = sys.argv[1:]
lepp.compile_kernels(methods, tiles=False, meshes=False)
lattice = np.indices((9, 9)).reshape(2, -1).T * 0.1
isosceles = np.array([[0, 0], [2, 0], [1, 2], [3, 2], [2, 4]])
with event.install_recorder("numba:compile") as compiled:
    for method in methods:
        for points in (np.random.default_rng(1).random((200, 2)), lattice, isosceles):
            mesh = lepp.triangulate(points, method)
            paths = lepp.lepp_paths(mesh)
            lepp.sizes_by_layer(lepp.triangle_layers(mesh), paths.sizes)
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
    compiled, *kernels = run(AFTER_PREPARING, *methods)
    assert compiled == "0"  # all that was needed was there
    assert {kernel.split(":")[1] for kernel in kernels} == {"1"}
    modules = {kernel.rpartition(".")[0] for kernel in kernels}
    other = {"incremental": "delaunay", "delaunay": "plain"}[methods[0]]
    assert not [module for module in modules if other in module or "tiles" in module]
    assert ("geometry.hilbert" in modules) == (methods[0] == "delaunay")
    assert "mesh.adjacency" not in modules
    assert not [kernel for kernel in kernels if "in_space" in kernel]
