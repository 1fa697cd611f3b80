"""Where compiled kernels are kept: never stale, and of the user's own making."""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numba
import pytest

import lepp
from lepp.jit import cache

PACKAGE = Path(lepp.__file__).parent

ORIENTATION = """
import lepp.geometry.predicates as predicates
print(predicates.orientation(0.0, 0.0, 1.0, 0.0, 0.0, 1.0))
print(sum(predicates.orientation.stats.cache_hits.values()))
"""


def run(code, folder, **environment):
    """Run code with the copy of the package in a folder, and with a kernel cache in it."""
    return subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"PYTHONPATH": str(folder), "NUMBA_CACHE_DIR": str(folder)} | environment,
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()


def test_a_change_in_a_subfolder_compiles_kernels_anew(tmp_path):
    copy = tmp_path / "lepp"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    # The package's face would compile nothing here, but import everything.
    (copy / "__init__.py").write_text("")
    assert run(ORIENTATION, tmp_path) == ["1", "0"]
    assert run(ORIENTATION, tmp_path) == ["1", "1"]
    called = copy / "geometry" / "fixed_point.py"
    called.write_text(called.read_text() + "\n# a comment\n")
    assert run(ORIENTATION, tmp_path) == ["1", "0"]


def test_names_and_contents_of_all_files_count(tmp_path):
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "kernel.py").write_text("one")
    first = cache.sources_hash(tmp_path)
    (tmp_path / "inner" / "kernel.py").write_text("two")
    second = cache.sources_hash(tmp_path)
    (tmp_path / "inner" / "kernel.py").rename(tmp_path / "inner" / "other.py")
    assert len({first, second, cache.sources_hash(tmp_path)}) == 3


@pytest.fixture
def homeless(tmp_path, monkeypatch):
    """Only the directory of temporary files is left for a cache."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(
        cache.platformdirs, "user_cache_dir", lambda name: str(tmp_path / "file" / name)
    )
    temporary = tmp_path / "tmp"
    temporary.mkdir(mode=0o777)
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    return temporary


posix = pytest.mark.skipif(not hasattr(os, "getuid"), reason="owners of files are POSIX's")


def test_the_directory_is_for_the_user_alone(homeless):
    directory = cache.cache_directory()
    assert directory.parent.parent == homeless
    assert directory.stat().st_mode & 0o077 == 0
    if hasattr(os, "getuid"):
        assert str(os.getuid()) in directory.parent.name
    assert cache.cache_directory() == directory


@posix
@pytest.mark.parametrize("mode", [0o777, 0o770, 0o707])
def test_a_directory_that_others_can_write_into_is_not_used(homeless, mode):
    cache.cache_directory().chmod(mode)
    assert cache.cache_directory() is None


@posix
def test_a_link_that_another_laid_is_not_followed(homeless, tmp_path):
    directory = cache.cache_directory()
    elsewhere = tmp_path / "elsewhere"
    directory.rename(elsewhere)
    directory.symlink_to(elsewhere)
    assert cache.cache_directory() is None


@posix
def test_a_directory_of_another_user_is_not_used(homeless, monkeypatch):
    cache.cache_directory()
    owner = os.getuid()
    parent = homeless / f"lepp-study-{owner}"
    parent.rename(homeless / f"lepp-study-{owner + 1}")
    monkeypatch.setattr(os, "getuid", lambda: owner + 1)
    assert cache.cache_directory() is None


def test_without_any_directory_kernels_compile_all_the_same(tmp_path):
    code = """
import tempfile, numba, platformdirs
numba.config.CACHE_DIR = ""
platformdirs.user_cache_dir = lambda name: "/dev/null/" + name
tempfile.tempdir = "/dev/null"
import lepp.jit.cache
assert lepp.jit.cache.cache_directory() is None
from lepp.geometry.predicates import orientation
print(orientation(0.0, 0.0, 1.0, 0.0, 0.0, 1.0))
"""
    copy = tmp_path / "lepp"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    (copy / "__init__.py").write_text("")
    assert run(code, tmp_path) == ["1"]
