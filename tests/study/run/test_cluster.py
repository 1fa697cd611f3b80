import logging
from threading import Event

import pytest

from lepp import InputError
from study.design.design import Design
from study.run.cluster import _SILENCE, check_memory, check_versions, connect
from study.run.triangulations import BYTES_PER_POINT, TRIANGULATIONS, Triangulations

DESIGN = Design.from_settings({"sizes": [1000, 1_000_000], "repetitions": 1})
ONE = 1_000_000 * BYTES_PER_POINT


def test_memory_is_checked_for_the_largest_triangulations_at_once():
    check_memory(TRIANGULATIONS, DESIGN, 4, 4 * ONE)
    with pytest.raises(InputError, match=r"1,000,000 points .* and 4 at once .*with --nthreads 3"):
        check_memory(TRIANGULATIONS, DESIGN, 4, 4 * ONE - 1)
    with pytest.raises(InputError, match="are free: use smaller sizes"):
        check_memory(TRIANGULATIONS, DESIGN, 1, ONE - 1)


def test_a_design_larger_than_this_computer_is_refused_before_anything_starts():
    huge = Design.from_settings({"sizes": [268_000_000], "repetitions": 1})
    with (
        pytest.raises(InputError, match="A triangulation of 268,000,000 points takes about"),
        connect(TRIANGULATIONS, huge, 1000, None, print),
    ):
        pass


def test_workers_and_scheduler_exclude_each_other():
    with (
        pytest.raises(InputError, match="--workers or --scheduler, not both"),
        connect(TRIANGULATIONS, DESIGN, 2, "tcp://127.0.0.1:8786", print),
    ):
        pass


def test_other_versions_are_named():
    here = {"Python": "3.11", "dask": "2026.8.0", "lepp-study": "0.1.0", "numpy": "2.4.6"}
    check_versions("worker w", here, here, ("lepp-study", "numpy"))
    check_versions("scheduler", here | {"numpy": "2.4.5"}, here, ("dask",))
    with pytest.raises(InputError, match=r"worker w has numpy 2\.4\.5, and .* has numpy 2\.4\.6"):
        check_versions("worker w", here | {"numpy": "2.4.5"}, here, ("lepp-study", "numpy"))
    with pytest.raises(InputError, match="worker w does not have lepp-study, and this"):
        check_versions("worker w", here | {"lepp-study": None}, here, ("lepp-study",))
    with pytest.raises(InputError, match=r"scheduler has Python 3\.12, and"):
        check_versions("scheduler", here | {"Python": "3.12"}, here, ("dask",))


def test_loggers_are_quiet_only_meanwhile():
    logger = logging.getLogger("distributed.client")
    before = logger.level
    logger.setLevel(logging.WARNING)
    try:
        with _SILENCE:
            with _SILENCE:
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
        def prepare(self):
            told.wait(30)
            raise InputError("prepared")

    monkeypatch.setattr("study.run.cluster.PATIENCE_SECONDS", 0.01)
    small = Design.from_settings({"sizes": [10], "repetitions": 1})
    with pytest.raises(InputError, match="prepared"), connect(Slow(), small, 1, None, note):
        pass
    assert notes == [Triangulations.preparing]


def test_a_client_that_cannot_connect_leaves_no_cluster(monkeypatch):
    closed = Event()

    class Cluster:
        def __init__(self, **options):
            pass

        def close(self):
            closed.set()

    def fail(cluster):
        raise RuntimeError("no client")

    monkeypatch.setattr("distributed.LocalCluster", Cluster)
    monkeypatch.setattr("distributed.Client", fail)
    monkeypatch.setattr(Triangulations, "prepare", lambda self: None)
    small = Design.from_settings({"sizes": [10], "repetitions": 1})
    with (
        pytest.raises(RuntimeError, match="no client"),
        connect(TRIANGULATIONS, small, 1, None, print),
    ):
        pass
    assert closed.wait(10)
