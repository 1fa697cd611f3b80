import json
import logging
import signal
from threading import Event

import dask
import pytest

import lepp
from lepp import InputError
from study.design.design import Design
from study.run import cluster as cluster_module
from study.run import memory as memory_module
from study.run.cluster import ClusterOptions, check_request, connect
from study.run.loggers import SILENCE
from study.run.memory import check_memory
from study.run.triangulations import TRIANGULATIONS, Triangulations
from study.run.waiting import RunStoppedError

DESIGN = Design.from_settings(
    {"methods": ["delaunay"], "sizes": [1000, 1_000_000], "repetitions": 1}
)
SMALL = Design.from_settings({"sizes": [10], "repetitions": 1})
ONE = 1_000_000 * lepp.METHODS["delaunay"].bytes_per_point
BASE = TRIANGULATIONS.base_memory


def test_memory_is_checked_for_the_largest_triangulation():
    check_memory(TRIANGULATIONS, DESIGN, ONE, "here it may take")
    with pytest.raises(InputError) as caught:
        check_memory(TRIANGULATIONS, DESIGN, ONE - 1e8, "the largest worker has")
    assert str(caught.value) == (
        "A triangulation of 1,000,000 points takes about 442 MB of memory, but the largest worker "
        "has 342 MB: use smaller sizes."
    )


def test_the_memory_of_the_processes_is_counted(monkeypatch):
    monkeypatch.setattr(cluster_module, "free_memory", lambda: 3 * BASE + ONE)
    check_request(TRIANGULATIONS, DESIGN, ClusterOptions(workers=3))
    with pytest.raises(InputError, match="takes about 442 MB of memory, but here it may take"):
        check_request(TRIANGULATIONS, DESIGN, ClusterOptions(workers=4))


@pytest.mark.parametrize(("free", "workers"), [(1, 1), (2 * BASE, 1), (4 * BASE, 2), (1e15, 8)])
def test_there_are_not_more_workers_than_half_the_memory_is_for(monkeypatch, free, workers):
    monkeypatch.setattr(cluster_module, "CPU_COUNT", 8)
    monkeypatch.setattr(cluster_module, "free_memory", lambda: int(free))
    assert ClusterOptions().n_workers(TRIANGULATIONS) == workers
    assert ClusterOptions(workers=5).n_workers(TRIANGULATIONS) == 5


def test_a_design_larger_than_this_computer_is_refused_before_anything_starts():
    settings = {"methods": ["delaunay"], "sizes": [268_000_000], "repetitions": 1}
    huge = Design.from_settings(settings)
    with (
        pytest.raises(InputError, match="A triangulation of 268,000,000 points takes about"),
        connect(TRIANGULATIONS, huge, ClusterOptions(workers=1000), print),
    ):
        pass


@pytest.mark.parametrize(
    "options",
    [
        ClusterOptions(workers=2, scheduler="tcp://127.0.0.1:8786"),
        ClusterOptions(workers=2, scheduler_file="scheduler.json"),
        ClusterOptions(scheduler="tcp://127.0.0.1:8786", scheduler_file="scheduler.json"),
    ],
)
def test_workers_and_schedulers_exclude_each_other(options):
    with (
        pytest.raises(InputError, match="one of --workers, --scheduler and --scheduler-file"),
        connect(TRIANGULATIONS, DESIGN, options, print),
    ):
        pass


def test_the_scheduler_of_dasks_configuration_is_taken_and_told(monkeypatch):
    monkeypatch.setattr(cluster_module, "CONNECT_SECONDS", 0.2)
    notes = []
    with dask.config.set({"scheduler-address": "tcp://127.0.0.1:1"}):
        assert ClusterOptions(workers=1).local
        assert not ClusterOptions().local
        with (
            pytest.raises(InputError, match="No scheduler answers at tcp"),
            connect(TRIANGULATIONS, SMALL, ClusterOptions(), notes.append),
        ):
            pass
    assert notes == [
        "Running at the scheduler that DASK_SCHEDULER_ADDRESS names, tcp://127.0.0.1:1."
    ]
    assert ClusterOptions().local


def test_a_scheduler_with_certificates_is_told_what_it_needs(monkeypatch):
    monkeypatch.setattr(cluster_module, "CONNECT_SECONDS", 0.2)
    with (
        pytest.raises(InputError, match=r"give the certificates .* DASK_DISTRIBUTED__COMM__TLS"),
        connect(TRIANGULATIONS, SMALL, ClusterOptions(scheduler="tls://127.0.0.1:1"), print),
    ):
        pass


def test_the_file_of_a_scheduler_names_it(tmp_path, monkeypatch):
    monkeypatch.setattr(cluster_module, "CONNECT_SECONDS", 0.2)
    path = tmp_path / "scheduler.json"
    options = ClusterOptions(scheduler_file=path, wait=0.1)

    def connected():
        with connect(TRIANGULATIONS, SMALL, options, print):
            pass

    with pytest.raises(RunStoppedError, match=r"for the scheduler to write .*scheduler\.json"):
        connected()
    path.write_text(json.dumps({"address": "tcp://127.0.0.1:1"}))
    with pytest.raises(InputError, match="No scheduler answers at tcp"):
        connected()
    for text in ("", "{}", "[]"):
        path.write_text(text)
        with pytest.raises(InputError, match=r"scheduler\.json names no scheduler: give the file"):
            connected()


def test_a_dashboard_that_cannot_be_served_says_what_to_install(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "distributed.dashboard.scheduler", None)
    with (
        pytest.raises(InputError, match=r"needs bokeh: .* pip install 'lepp-study\[dashboard\]'"),
        connect(TRIANGULATIONS, SMALL, ClusterOptions(dashboard=True), print),
    ):
        pass


def test_loggers_are_quiet_only_meanwhile():
    logger = logging.getLogger("distributed.client")
    before = logger.level
    logger.setLevel(logging.WARNING)
    try:
        with SILENCE:
            with SILENCE:
                assert logger.level == logging.CRITICAL
            assert logger.level == logging.CRITICAL
        assert logger.level == logging.WARNING
    finally:
        logger.setLevel(before)


def test_what_takes_long_is_told(monkeypatch):
    notes = []
    told = Event()

    def note(sentence):
        notes.append(sentence)
        told.set()

    class Slow(Triangulations):
        def prepare(self, design, memory):
            told.wait(30)
            raise InputError("prepared")

    monkeypatch.setattr(cluster_module, "PATIENCE_SECONDS", 0.01)
    one = ClusterOptions(workers=1)
    with pytest.raises(InputError, match="prepared"), connect(Slow(), SMALL, one, note):
        pass
    assert notes == [Triangulations.preparing]


class Cluster:
    """A cluster that starts nothing."""

    def __init__(self, **options):
        self.closed = Event()
        Cluster.last = self

    def close(self, timeout):
        self.closed.set()


def test_a_client_that_cannot_connect_leaves_nothing(monkeypatch):
    closed = []

    class Client:
        def __init__(self, to, timeout):
            raise RuntimeError("no client")

        def close(self, timeout):
            closed.append(self)
            raise TimeoutError  # which is not what is told

    monkeypatch.setattr("distributed.LocalCluster", Cluster)
    monkeypatch.setattr("distributed.Client", Client)
    monkeypatch.setattr(Triangulations, "prepare", lambda self, design, memory: None)
    with (
        pytest.raises(RuntimeError, match="no client"),
        connect(TRIANGULATIONS, SMALL, ClusterOptions(workers=1), print),
    ):
        pass
    assert Cluster.last.closed.wait(10)
    assert len(closed) == 1


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("starts", [True, False])
def test_a_signal_while_workers_start_waits_until_they_can_be_closed(monkeypatch, number, starts):
    stages = []

    def stop(number, frame):
        stages.append(number)
        raise KeyboardInterrupt

    class Starting(Cluster):
        def __init__(self, **options):
            super().__init__(**options)
            signal.raise_signal(number)
            stages.append("whole")
            if not starts:  # as its workers had the signal too
                raise RuntimeError("Nanny failed to start.")

    monkeypatch.setattr("distributed.LocalCluster", Starting)
    monkeypatch.setattr(Triangulations, "prepare", lambda self, design, memory: None)
    before = signal.signal(number, stop)
    try:
        with (
            pytest.raises(KeyboardInterrupt),
            connect(TRIANGULATIONS, SMALL, ClusterOptions(workers=1), print),
        ):
            pass
        assert signal.getsignal(number) is stop
    finally:
        signal.signal(number, before)
    assert stages == ["whole", number]
    if starts:
        assert Cluster.last.closed.wait(10)


def test_workers_that_do_not_start_say_why(monkeypatch):
    def fail(**options):
        try:
            raise PermissionError(13, "Permission denied", "/dev/shm")
        except PermissionError as error:
            raise RuntimeError("Nanny failed to start.") from error

    monkeypatch.setattr("distributed.LocalCluster", fail)
    monkeypatch.setattr(Triangulations, "prepare", lambda self, design, memory: None)
    with (
        pytest.raises(InputError, match=r"did not start: .*denied: '/dev/shm'\. Try few"),
        connect(TRIANGULATIONS, SMALL, ClusterOptions(workers=1), print),
    ):
        pass


def test_a_cluster_is_closed_also_when_its_client_does_not_close_in_time(monkeypatch):
    class Client:
        def __init__(self, to, timeout):
            pass

        def close(self, timeout):
            raise TimeoutError

    monkeypatch.setattr("distributed.LocalCluster", Cluster)
    monkeypatch.setattr("distributed.Client", Client)
    monkeypatch.setattr(Triangulations, "prepare", lambda self, design, memory: None)
    with connect(TRIANGULATIONS, SMALL, ClusterOptions(workers=1), print):
        pass
    assert Cluster.last.closed.wait(10)


def test_where_there_can_be_no_more_threads_the_cluster_is_closed_all_the_same(monkeypatch):
    class Client:
        def __init__(self, to, timeout):
            pass

        def close(self, timeout):
            pass

    def no_thread(self):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr("distributed.LocalCluster", Cluster)
    monkeypatch.setattr("distributed.Client", Client)
    monkeypatch.setattr(Triangulations, "prepare", lambda self, design, memory: None)
    with connect(TRIANGULATIONS, SMALL, ClusterOptions(workers=1), print):
        monkeypatch.setattr("study.run.local.Thread.start", no_thread)
    assert Cluster.last.closed.is_set()


def test_free_memory_is_what_a_container_and_other_programs_leave(monkeypatch):
    monkeypatch.setattr(memory_module, "MEMORY_LIMIT", 1000)
    assert memory_module.free_memory() == 1000
