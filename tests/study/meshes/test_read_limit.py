"""What counts as too long for a reader: its own processor time, not what others take."""

import signal
import subprocess
import sys

import pytest

import lepp
from study.meshes import meshio_process

BURN = """
import time
from study.meshes.meshio_reader import limit_processor_time
def burn(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass
"""


def run(code):
    return subprocess.run(
        [sys.executable, "-c", BURN + code], capture_output=True, text=True, check=False
    )


@pytest.fixture(autouse=True)
def _where_it_can_be_limited():
    pytest.importorskip("resource")


def test_a_reader_that_computes_too_long_is_ended():
    assert run("limit_processor_time(1); burn(5)").returncode == -signal.SIGXCPU


def test_waiting_does_not_count():
    done = run("limit_processor_time(1); time.sleep(2.5); print('read')")
    assert (done.returncode, done.stdout) == (0, "read\n")


def test_what_was_done_before_reading_does_not_count():
    done = run("burn(1.6); limit_processor_time(1); burn(0.3); print('read')")
    assert (done.returncode, done.stdout) == (0, "read\n")


def test_a_reader_that_waits_for_ever_is_stopped_by_the_clock(tmp_path, monkeypatch):
    path = tmp_path / "mesh.off"
    path.write_text("OFF\n")
    monkeypatch.setattr(meshio_process, "_START_SECONDS", 0.5)
    monkeypatch.setattr(meshio_process, "_WAIT_TIMES", 0.5)

    def wait(command, **options):
        sleep = [sys.executable, "-c", "import time; time.sleep(60)"]
        return original(sleep, **options)

    original = subprocess.run
    monkeypatch.setattr(subprocess, "run", wait)
    with pytest.raises(lepp.InputError, match=r"not done after 1 s, which.*--read-limit"):
        meshio_process.read_file(path, 1.0)
