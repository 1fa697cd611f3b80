import gc
import os
import signal
import socket
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from time import sleep

import dask
import psutil
import pytest
from distributed import Client
from faults import DESIGN, TASKS, Heard, contents, worker_processes

from lepp import InputError
from study.results.store import Store, load
from study.run.cluster import ClusterOptions
from study.run.kinds import Size
from study.run.local import LocalWorkers
from study.run.runner import ATTEMPTS, RunStoppedError, compute, run
from study.run.triangulations import TRIANGULATIONS, Triangulations
from study.run.waiting import Waiting


def test_a_failing_task_is_recorded_and_a_shaky_one_tried_again(
    finish, tmp_path, monkeypatch, whole
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
    outcomes = finish(tmp_path, heard)
    assert heard.whole == heard.unfinished == Size(DESIGN.n_triangulations, DESIGN.n_points)
    assert heard.units == ("triangulations", "points")
    assert tries.count(hopeless) == tries.count(shaky) == ATTEMPTS
    assert len(tries) == len(TASKS) + 2 * (ATTEMPTS - 1)
    assert [o.task for o in outcomes if o.error] == [hopeless]
    results = load(tmp_path)["results"]
    assert results["error"].iloc[0] == "MemoryError: no room"
    assert results["error"].notna().sum() == 1

    # The next run tries only what failed, and ends with the same bytes as a run without failures.
    monkeypatch.undo()
    assert [o.task for o in finish(tmp_path, heard)] == [hopeless]
    assert heard.unfinished == (1, hopeless.n_points)
    assert contents(tmp_path) == contents(whole)


def test_what_does_not_fit_side_by_side_runs_one_after_the_other(
    finish, tmp_path, monkeypatch, whole
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
    finish(tmp_path, memory=1)
    assert max(most) == 1
    assert contents(tmp_path) == contents(whole)


def test_a_run_whose_workers_do_not_come_back_ends_with_a_sentence(threads, tmp_path, monkeypatch):
    heard = Heard()

    class Gone(LocalWorkers):
        """Asks for memory that nobody has, so that nothing is computed; counts no worker."""

        def look(self):
            return "new workers, as the old ones died"

        def resources(self, memory):
            return {"nobody's": 1}

    client, cluster = threads
    monkeypatch.setattr(cluster, "scale", lambda n: None)
    gone = Gone(client, cluster, 1)
    waiting = Waiting(0.3, "see what kills them", heard.note)
    with (
        Store(tmp_path, TRIANGULATIONS, DESIGN) as store,
        pytest.raises(RunStoppedError, match=r"Waited .* for new workers, as the old ones died"),
    ):
        list(compute(gone, waiting, store, heard))


@pytest.mark.cluster
def test_a_worker_killed_and_one_lost_for_good_leave_the_same_bytes(tmp_path, whole, monkeypatch):
    clusters = []
    start = LocalWorkers.__init__

    def watched(self, client, cluster, *arguments):
        clusters.append(cluster)
        start(self, client, cluster, *arguments)

    def harm():
        (cluster,) = clusters
        first, second = cluster.workers.values()
        # What a nanny does whose worker dies while it starts.
        cluster.sync(second.close, reason="nanny-instantiate-failed")
        victim = psutil.Process(first.pid)
        victim.kill()

    monkeypatch.setattr(LocalWorkers, "__init__", watched)
    heard = Heard(harm)
    summary = run(
        tmp_path, TRIANGULATIONS, DESIGN, options=ClusterOptions(workers=2), listener=heard
    )
    assert sorted(heard.tasks) == sorted(TASKS)
    assert summary.failures == []
    assert summary.computed == heard.whole
    assert 0 < summary.kernel_seconds < summary.seconds
    assert summary.n_threads == 2
    assert contents(tmp_path) == contents(whole)
    # Nothing is left to do, so no cluster is started.
    nowhere = ClusterOptions(scheduler="tcp://127.0.0.1:1")
    again = run(tmp_path, TRIANGULATIONS, DESIGN, options=nowhere, listener=heard)
    assert again.computed == (0, 0) == (again.n_threads, 0)
    _, alive = psutil.wait_procs(worker_processes(), timeout=30)
    assert alive == []


CLIENT = """
import signal
import sys
from pathlib import Path
from faults import DESIGN, Heard
from reports.cli.signals import stop_once
from study.run.cluster import ClusterOptions
from study.run.runner import run
from study.run.triangulations import TRIANGULATIONS

class Printing(Heard):
    def advance(self, outcome, size):
        super().advance(outcome, size)
        print(outcome.task, flush=True)
        if len(self.tasks) == int(sys.argv[2]):
            signal.pause()  # never at its end before the signal comes

if __name__ == "__main__":
    with stop_once():
        options = ClusterOptions(workers=1)
        run(Path(sys.argv[1]), TRIANGULATIONS, DESIGN, options=options, listener=Printing())
"""


@pytest.mark.cluster
@pytest.mark.parametrize(
    ("number", "after", "times"),
    [(signal.SIGKILL, 20, 1), (signal.SIGINT, 40, 3), (signal.SIGTERM, 10, 1)],
)
def test_a_killed_run_goes_on_and_leaves_no_process(tmp_path, whole, finish, number, after, times):
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
    assert len(orphans) == 1
    if number == signal.SIGKILL:
        process.send_signal(number)
    for _ in range(times if number != signal.SIGKILL else 0):
        os.killpg(process.pid, number)  # as a terminal does, or a cluster's queue
        sleep(0.2)
    _, errors = process.communicate()
    assert process.returncode != 0
    # Only this process has noticed, and only once: no worker complains.
    assert errors.count("Traceback") == (number != signal.SIGKILL)
    _, alive = psutil.wait_procs(orphans, timeout=30)
    assert alive == []
    loaded = load(tmp_path / "results")
    assert not loaded.complete
    assert len(loaded["results"]) >= after
    assert len(finish(tmp_path / "results")) == len(TASKS) - len(loaded["results"])
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
def test_a_scheduler_that_dies_keeps_what_is_finished(tmp_path, whole, finish):
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = str(probe.getsockname()[1])
    address = f"tcp://127.0.0.1:{port}"
    server = ("scheduler", "--host", "127.0.0.1", "--port", port, "--no-dashboard")
    worker = ("worker", address, "--nthreads", "1", "--no-dashboard", "--death-timeout", "20")
    with dask_program(*server) as scheduler, dask_program(*worker):
        heard = Heard(scheduler.kill)
        options = ClusterOptions(scheduler=address)
        with pytest.raises(RunStoppedError, match="connection to the scheduler was lost"):
            run(tmp_path / "results", TRIANGULATIONS, DESIGN, options=options, listener=heard)
    kept = load(tmp_path / "results")
    assert 0 < len(kept["results"]) < len(TASKS)
    finish(tmp_path / "results")
    assert contents(tmp_path / "results") == contents(whole)


def test_a_scheduler_that_does_not_answer_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr("study.run.cluster.CONNECT_SECONDS", 1)
    for address in ("tcp://127.0.0.1:1", "127.0.0.1:1", "nonsense://x", ""):
        options = ClusterOptions(scheduler=address)
        with pytest.raises(InputError, match="No scheduler answers at"):
            run(tmp_path, TRIANGULATIONS, DESIGN, options=options, listener=Heard())


def test_no_client_of_a_failed_connection_is_left_open(tmp_path, monkeypatch):
    # Python would close it in any thread, also in one that another client starts and waits for.
    monkeypatch.setattr("study.run.cluster.CONNECT_SECONDS", 1)
    gc.disable()  # so that it is there to be looked at
    try:
        before = open_clients()
        for address in ("tcp://127.0.0.1:1", "nonsense://x"):
            options = ClusterOptions(scheduler=address)
            with pytest.raises(InputError, match="No scheduler answers at"):
                run(tmp_path, TRIANGULATIONS, DESIGN, options=options, listener=Heard())
        assert open_clients() == before
    finally:
        gc.enable()


def test_the_reason_of_a_client_that_is_not_even_made_is_told(tmp_path):
    options = ClusterOptions(scheduler="tcp://127.0.0.1:1")
    with (
        dask.config.set({"distributed.comm.tls.min-version": 9}),
        pytest.raises(InputError, match="min-version=9 is not supported"),
    ):
        run(tmp_path, TRIANGULATIONS, DESIGN, options=options, listener=Heard())


def open_clients():
    clients = [found for found in gc.get_objects() if isinstance(found, Client)]
    return {id(client): client.status for client in clients if client.status != "closed"}
