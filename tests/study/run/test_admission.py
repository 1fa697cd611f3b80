"""Runs at a scheduler whose workers come, are not fit, and go."""

from contextlib import contextmanager
from threading import Thread, current_thread, main_thread
from time import sleep

import dask
import psutil
import pytest
from distributed import Client, LocalCluster, Worker
from faults import DESIGN, TASKS, Heard, contents

from lepp import InputError
from study.run import admission, waiting
from study.run.admission import AdmittedWorkers, difference
from study.run.cluster import ClusterOptions
from study.run.runner import run
from study.run.triangulations import TRIANGULATIONS, Triangulations
from study.run.waiting import RunStoppedError

OLD = "old"


@pytest.fixture(scope="module")
def scheduler():
    """A cluster in this process, without workers."""
    with LocalCluster(
        n_workers=0,
        threads_per_worker=1,
        processes=False,
        protocol="tcp",
        dashboard_address=None,
        scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
    ) as cluster:
        yield cluster


@pytest.fixture
def cluster(scheduler):
    yield scheduler
    scheduler.scale(0)
    while scheduler.scheduler.workers:
        sleep(0.02)


@pytest.fixture(autouse=True)
def _other_versions(monkeypatch):
    """Have workers with a certain name say that they have another version of NumPy."""
    tell = admission.versions

    def told(report):
        versions = tell(report)
        return versions | {"numpy": "1.0"} if OLD in report.get("name", "") else versions

    def report(self, **options):
        return Worker_versions(self, **options) | {"name": str(self.name)}

    Worker_versions = Worker.versions
    monkeypatch.setattr(Worker, "versions", report)
    monkeypatch.setattr(admission, "versions", told)
    monkeypatch.setattr(waiting, "PATIENCE_SECONDS", 0.0)


@contextmanager
def worker(cluster, name, pause=False, **options):
    # It measures the memory of this process, which has all the tests in it.
    shares = {"target": False, "spill": False, "pause": pause}

    async def start():
        memory = {f"distributed.worker.memory.{what}": share for what, share in shares.items()}
        with dask.config.set(memory):
            return await Worker(cluster.scheduler_address, nthreads=1, name=name, **options)

    started = cluster.sync(start)
    try:
        yield started
    finally:
        cluster.sync(started.close)


@pytest.fixture
def computed_by(monkeypatch):
    """The names of the workers that computed, task by task."""
    from distributed import get_worker

    names = []
    perform = Triangulations.perform

    def watched(self, task, design):
        names.append(get_worker().name)
        return perform(self, task, design)

    monkeypatch.setattr(Triangulations, "perform", watched)
    return names


def run_at(cluster, directory, heard, wait=60.0):
    options = ClusterOptions(scheduler=cluster.scheduler_address, wait=wait)
    return run(directory, TRIANGULATIONS, DESIGN, options=options, listener=heard)


def test_a_cluster_that_starts_from_nothing_grows_for_a_run(cluster, tmp_path, whole):
    adaptive = cluster.adapt(minimum=0, maximum=2, interval="200ms")
    heard = Heard()
    try:
        summary = run_at(cluster, tmp_path, heard)
    finally:
        adaptive.stop()
    assert summary.n_threads in (1, 2)
    assert sorted(heard.tasks) == sorted(TASKS)
    assert contents(tmp_path) == contents(whole)
    # At it, or of it: the unfit one may be looked at by then.
    assert any(note.startswith("Waiting for workers ") for note in heard.notes)


def test_no_workers_for_too_long_end_a_run_with_a_sentence(cluster, tmp_path):
    heard = Heard()
    with pytest.raises(RunStoppedError, match=r"Waited 1 second for workers at tcp://.*--wait"):
        run_at(cluster, tmp_path, heard, wait=1.0)
    assert heard.tasks == []


def test_a_late_worker_with_other_versions_gets_no_tasks_and_is_named_once(
    cluster, tmp_path, whole, computed_by
):
    with worker(cluster, "right"), worker(cluster, OLD), worker(cluster, f"{OLD} too"):
        heard = Heard()
        run_at(cluster, tmp_path, heard)
        computed = sorted(heard.tasks)
    assert computed == sorted(TASKS)
    assert set(computed_by) == {"right"}
    (note,) = (note for note in heard.notes if "gets no tasks" in note)
    assert "and any like it, gets no tasks: it has numpy 1.0, and this computer has" in note
    assert contents(tmp_path) == contents(whole)


def test_workers_that_come_and_go_leave_the_same_bytes(cluster, tmp_path, whole, computed_by):
    """The first leaves, an unfit one takes its place, then a fit one does."""
    with worker(cluster, "first") as first:

        def leave():
            cluster.sync(first.close)
            Thread(target=others).start()

        def others():
            with worker(cluster, OLD):
                sleep(1.5)
                with worker(cluster, "second"):
                    while current.is_alive() and not done:
                        sleep(0.05)

        current, done = current_thread(), []
        assert current is main_thread()
        heard = Heard(leave, after=10)
        run_at(cluster, tmp_path, heard)
        done.append(True)
    assert set(computed_by) == {"first", "second"}
    # At it, or of it: the unfit one may be looked at by then.
    assert any(note.startswith("Waiting for workers ") for note in heard.notes)
    assert any(OLD not in note and "gets no tasks" in note for note in heard.notes)
    assert contents(tmp_path) == contents(whole)


def test_workers_that_are_all_unfit_refuse_a_run(cluster, tmp_path):
    with (
        worker(cluster, OLD),
        pytest.raises(InputError, match=r"The worker tcp://.* has numpy 1\.0, and this computer"),
    ):
        run_at(cluster, tmp_path, Heard())


def test_a_worker_with_less_memory_than_a_process_takes_is_refused(cluster, tmp_path):
    with (
        worker(cluster, "small", memory_limit="150MB"),
        pytest.raises(InputError, match="may take 150 MB of memory, and a process takes 280 MB"),
    ):
        run_at(cluster, tmp_path, Heard())


def need(n_bytes):
    """A kind whose tasks take that much memory, the largest ten times as much."""

    def memory_of(self, task, design):
        memory = Triangulations_memory_of(self, task, design)
        return memory._replace(n_bytes=n_bytes * (10 if task == TASKS[-1] else 1))

    Triangulations_memory_of = Triangulations.memory_of
    return memory_of


def room(n_bytes):
    """The limit of a worker that has so many bytes for tasks."""
    return int((n_bytes + TRIANGULATIONS.base_memory) / 0.9) + 1


def test_a_large_task_runs_alone_on_a_worker_and_small_ones_side_by_side(
    cluster, tmp_path, whole, monkeypatch
):
    together, most, beside = [], [], []
    perform = Triangulations.perform

    def watched(self, task, design):
        together.append(task)
        most.append(len(together))
        if TASKS[-1] in together:
            beside.append(len(together))
        sleep(0.01)
        try:
            return perform(self, task, design)
        finally:
            together.remove(task)

    monkeypatch.setattr(Triangulations, "memory_of", need(100_000_000))
    monkeypatch.setattr(Triangulations, "perform", watched)
    with worker(cluster, "threads", memory_limit=room(1_050_000_000)) as threads:
        threads.state.nthreads = 3
        cluster.scheduler.workers[threads.address].nthreads = 3
        run_at(cluster, tmp_path, Heard())
    assert max(beside) == 1
    assert contents(tmp_path) == contents(whole)


def test_a_task_that_fits_into_no_worker_is_refused(cluster, tmp_path, monkeypatch):
    monkeypatch.setattr(Triangulations, "memory_of", need(100_000_000))
    monkeypatch.setattr(Triangulations, "least_memory_of", Triangulations.memory_of)
    with (
        worker(cluster, "small", memory_limit=room(900_000_000)),
        pytest.raises(InputError, match=r"takes about 1\.3 GB .* the largest worker has 1\.2 GB"),
    ):
        run_at(cluster, tmp_path, Heard())


def test_a_task_that_fits_into_no_worker_any_more_waits_for_one(
    cluster, tmp_path, whole, monkeypatch
):
    """The large worker leaves before the largest task, of the last size, was computed."""
    monkeypatch.setattr(Triangulations, "memory_of", need(100_000_000))
    monkeypatch.setattr(AdmittedWorkers, "ahead", 1)
    with worker(cluster, "small", memory_limit=room(200_000_000)):
        with worker(cluster, "large", memory_limit=room(1_000_000_000)) as large:
            heard = Heard(lambda: cluster.sync(large.close))
            monkeypatch.setattr(
                Triangulations,
                "size_of",
                smallest_last(Triangulations.size_of),
            )
            with pytest.raises(RunStoppedError, match=r"a worker that has 1\.0 GB for one task"):
                run_at(cluster, tmp_path, heard, wait=1.0)
        assert len(set(heard.tasks)) == len(TASKS) - 1
        with worker(cluster, "large", memory_limit=room(1_000_000_000)):
            run_at(cluster, tmp_path, Heard())
    assert contents(tmp_path) == contents(whole)


def smallest_last(size_of):
    """Sizes of tasks with that of the largest memory the least."""

    def of(self, task, design):
        size = size_of(self, task, design)
        return size._replace(work=1) if task == TASKS[-1] else size

    return of


def test_a_worker_that_cannot_compile_is_refused(cluster, tmp_path, monkeypatch):
    def prepare(self, design, memory):
        raise RuntimeError("no compiler")

    monkeypatch.setattr(Triangulations, "prepare", prepare)
    with (
        worker(cluster, "right"),
        pytest.raises(InputError, match=r"compile the kernels \(RuntimeError\('no compiler'\)\)"),
    ):
        run_at(cluster, tmp_path, Heard())


def test_a_scheduler_that_does_not_answer_is_told_and_not_waited_for_without_end(
    cluster, tmp_path, monkeypatch
):
    monkeypatch.setattr(admission, "SILENT_SECONDS", 1.0)
    frozen = []

    def freeze():
        async def block():
            sleep(6)  # the loop of the scheduler, and here of its workers

        cluster.loop.add_callback(block)
        frozen.append(True)

    with worker(cluster, "right"):
        heard = Heard(freeze)
        with pytest.raises(RunStoppedError, match=r"the scheduler at .*, which does not answer"):
            run_at(cluster, tmp_path, heard, wait=1.5)
    assert frozen


def test_a_worker_that_is_short_of_memory_is_told_and_not_counted(cluster, tmp_path):
    """It pauses at once: this process has more than half of the limit."""
    heard = Heard()
    limit = 2 * psutil.Process().memory_info().rss
    with (
        worker(cluster, "short", memory_limit=limit, pause=0.1),
        pytest.raises(RunStoppedError, match=r"Waited 3 seconds for workers .* have paused"),
    ):
        run_at(cluster, tmp_path, heard, wait=3.0)


def test_other_versions_are_named():
    here = {"Python": "3.11", "dask": "2026.8.0", "lepp-study": "0.1.0", "numpy": "2.4.6"}
    names = ("lepp-study", "numpy")
    assert difference(here, here, names) is None
    assert difference(here | {"numpy": "2.4.5"}, here, ("dask",)) is None
    assert difference(here | {"numpy": "2.4.5"}, here, names) == (
        "has numpy 2.4.5, and this computer has numpy 2.4.6: install the same version on both"
    )
    assert difference(here | {"lepp-study": None}, here, names).startswith(
        "does not have lepp-study, and this"
    )
    assert difference(here | {"Python": "3.12"}, here, ()).startswith("has Python 3.12, and")


def test_what_a_worker_that_came_as_another_left_can_do_is_sent_once_more(cluster, tmp_path):
    """Between two looks: the largest room is less than before, and tasks have waited meanwhile."""

    up = {"host": "a", "status": "running"}

    def fit(key, room):
        return {"id": key, "nthreads": 1, "resources": {admitted._resource: room}, **up}

    with worker(cluster, "any"), Client(cluster) as client:
        admitted = AdmittedWorkers(client, "tcp://x", TRIANGULATIONS, DESIGN, print)
        admitted.close()
        assert admitted._closed.wait(5)
        sleep(1)  # until its thread has seen that
        admitted.stranded_above()
        admitted._count({"a": fit("large", 9.0)})
        assert admitted.stranded_above() == 0
        admitted._count({"a": fit("large", 9.0)})
        assert admitted.stranded_above() is None
        admitted._count({"a": fit("large", 9.0), "b": fit("small", 2.0)})
        assert admitted.stranded_above() == 9.0
        admitted._count({"b": fit("small", 2.0)})
        assert admitted.stranded_above() is None
        admitted._count({"c": fit("other", 1.0)})
        assert admitted.stranded_above() == 0
