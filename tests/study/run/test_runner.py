import os
import signal
import socket
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import psutil
import pytest
from distributed import Client, LocalCluster

from lepp import InputError
from study.design.design import Design
from study.results.store import Store, load
from study.run.kinds import Size
from study.run.runner import (
    ATTEMPTS,
    RunStoppedError,
    Threads,
    compute,
    run,
)
from study.run.triangulations import TRIANGULATIONS, Triangulations

DESIGN = Design.from_settings({"sizes": [500, 1000, 2000], "repetitions": 6, "seed": 5})
TASKS = TRIANGULATIONS.tasks_of(DESIGN)
FILES = (
    "results.parquet",
    "histograms.parquet",
    "layers.parquet",
    "regions.parquet",
    "point_sets.parquet",
    "manifest.json",
)


class Heard:
    """A listener that remembers, and acts when it has heard of a number of outcomes."""

    def __init__(self, act=None, after=1):
        self.tasks, self.notes, self.act, self.after = [], [], act, after

    def begin(self, units, unfinished, whole, n_threads):
        self.units, self.unfinished, self.whole = units, unfinished, whole

    def advance(self, outcome, size):
        self.tasks.append(outcome.task)
        if self.act and len(self.tasks) == self.after:
            self.act()

    def note(self, sentence):
        self.notes.append(sentence)


def contents(directory):
    return {name: (directory / name).read_bytes() for name in FILES}


def worker_processes(parent=None):
    return [
        child
        for child in psutil.Process(parent).children(recursive=True)
        if "spawn_main" in " ".join(child.cmdline())
    ]


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """What an undisturbed run with one worker leaves."""
    directory = tmp_path_factory.mktemp("whole") / "results"
    heard = Heard()
    summary = run(directory, TRIANGULATIONS, DESIGN, workers=1, listener=heard)
    assert summary.computed == Size(DESIGN.n_triangulations, DESIGN.n_points)
    assert summary.n_threads == 1
    assert 0 < summary.kernel_seconds < summary.seconds
    assert heard.unfinished == heard.whole == summary.computed
    assert heard.units == summary.units == ("triangulations", "points")
    assert sorted(heard.tasks) == sorted(TASKS)
    assert load(directory)["results"]["error"].isna().all()
    return directory


@pytest.fixture(scope="module")
def threads():
    with (
        LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
        ) as cluster,
        Client(cluster) as client,
    ):
        yield client


def test_a_failing_task_is_recorded_and_a_shaky_one_tried_again(
    threads, tmp_path, monkeypatch, whole
):
    hopeless, shaky = TASKS[0], TASKS[40]
    tries = []
    perform = Triangulations.perform

    def sometimes(self, task, design):
        tries.append(task)
        if task == hopeless or (task == shaky and tries.count(task) < ATTEMPTS):
            raise MemoryError("no room")
        return perform(self, task, design)

    monkeypatch.setattr(Triangulations, "perform", sometimes)
    heard = Heard()
    with Store(tmp_path, TRIANGULATIONS, DESIGN) as store:
        outcomes = list(compute(threads, Threads(threads), store, heard))
        store.finish()
    assert tries.count(hopeless) == tries.count(shaky) == ATTEMPTS
    assert len(tries) == len(TASKS) + 2 * (ATTEMPTS - 1)
    assert [o.task for o in outcomes if o.error] == [hopeless]
    results = load(tmp_path)["results"]
    assert results["error"].iloc[0] == "MemoryError: no room"
    assert results["error"].notna().sum() == 1

    # The next run tries only what failed, and ends with the same bytes as a run without failures.
    monkeypatch.undo()
    with Store(tmp_path, TRIANGULATIONS, DESIGN) as store:
        again = compute(threads, Threads(threads), store, heard)
        assert [o.task for o in again] == [hopeless]
        store.finish()
    assert contents(tmp_path) == contents(whole)


def test_what_does_not_fit_side_by_side_runs_one_after_the_other(
    threads, tmp_path, monkeypatch, whole
):
    together, most = [], []
    perform = Triangulations.perform

    def watched(self, task, design):
        together.append(task)
        most.append(len(together))
        try:
            return perform(self, task, design)
        finally:
            together.remove(task)

    monkeypatch.setattr(Triangulations, "perform", watched)
    monkeypatch.setattr("study.run.batches.BATCH_WORK", 1)
    with Store(tmp_path, TRIANGULATIONS, DESIGN) as store:
        list(compute(threads, Threads(threads), store, Heard(), memory=1))
        store.finish()
    assert max(most) == 1
    assert contents(tmp_path) == contents(whole)


@pytest.mark.cluster
def test_two_workers_one_of_them_killed_leave_the_same_bytes(tmp_path, whole):
    def kill():
        victim, _ = worker_processes()
        victim.kill()

    heard = Heard(kill)
    summary = run(tmp_path, TRIANGULATIONS, DESIGN, workers=2, listener=heard)
    assert sorted(heard.tasks) == sorted(TASKS)
    assert summary.failures == []
    assert contents(tmp_path) == contents(whole)
    # Nothing is left to do, so no cluster is started.
    again = run(tmp_path, TRIANGULATIONS, DESIGN, scheduler="tcp://127.0.0.1:1", listener=heard)
    assert again.computed == (0, 0) == (again.n_threads, 0)
    _, alive = psutil.wait_procs(worker_processes(), timeout=10)
    assert alive == []


CLIENT = """
import signal
import sys
from pathlib import Path
from test_runner import DESIGN, TRIANGULATIONS, Heard, run

class Printing(Heard):
    def advance(self, outcome, size):
        super().advance(outcome, size)
        print(outcome.task, flush=True)
        if len(self.tasks) == int(sys.argv[2]):
            signal.pause()  # never at its end before the signal comes

if __name__ == "__main__":
    run(Path(sys.argv[1]), TRIANGULATIONS, DESIGN, workers=2, listener=Printing())
"""


@pytest.mark.cluster
@pytest.mark.parametrize(("number", "after"), [(signal.SIGKILL, 20), (signal.SIGINT, 40)])
def test_a_killed_run_goes_on_and_leaves_no_process(tmp_path, whole, number, after):
    script = tmp_path / "client.py"
    script.write_text(CLIENT)
    process = subprocess.Popen(
        [sys.executable, str(script), str(tmp_path / "results"), str(after)],
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(Path(__file__).parent), *sys.path])},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        text=True,
    )
    for _ in range(after):
        assert process.stdout.readline()
    orphans = worker_processes(process.pid)
    assert len(orphans) == 2
    if number == signal.SIGINT:
        os.killpg(process.pid, number)  # as a terminal does
    else:
        process.send_signal(number)
    _, errors = process.communicate()
    assert process.returncode != 0
    # Only this process has noticed: no worker complains.
    assert errors.count("Traceback") == (number == signal.SIGINT)
    _, alive = psutil.wait_procs(orphans, timeout=10)
    assert alive == []
    loaded = load(tmp_path / "results")
    assert not loaded.complete
    assert len(loaded["results"]) >= after
    heard = Heard()
    run(tmp_path / "results", TRIANGULATIONS, DESIGN, workers=1, listener=heard)
    assert len(heard.tasks) == len(TASKS) - len(loaded["results"])
    assert contents(tmp_path / "results") == contents(whole)


@contextmanager
def dask_program(*arguments):
    process = subprocess.Popen(
        [sys.executable, "-m", "dask", *arguments],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


@pytest.mark.cluster
def test_a_scheduler_that_dies_keeps_what_is_finished(tmp_path, whole):
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = str(probe.getsockname()[1])
    address = f"tcp://127.0.0.1:{port}"
    server = ("scheduler", "--host", "127.0.0.1", "--port", port, "--no-dashboard")
    worker = ("worker", address, "--nthreads", "1", "--no-dashboard", "--death-timeout", "20")
    with dask_program(*server) as scheduler, dask_program(*worker):
        heard = Heard(scheduler.kill)
        with pytest.raises(RunStoppedError, match="connection to the scheduler was lost"):
            run(tmp_path / "results", TRIANGULATIONS, DESIGN, scheduler=address, listener=heard)
    kept = load(tmp_path / "results")
    assert 0 < len(kept["results"]) < len(TASKS)
    run(tmp_path / "results", TRIANGULATIONS, DESIGN, workers=1, listener=heard)
    assert contents(tmp_path / "results") == contents(whole)


def test_a_scheduler_that_does_not_answer_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr("study.run.cluster.CONNECT_SECONDS", 1)
    for address in ("tcp://127.0.0.1:1", "127.0.0.1:1", "nonsense://x", ""):
        with pytest.raises(InputError, match="No scheduler answers at"):
            run(tmp_path, TRIANGULATIONS, DESIGN, scheduler=address, listener=Heard())
