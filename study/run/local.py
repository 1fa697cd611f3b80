"""A cluster of this computer's cores, whose workers are replaced when they die."""

import logging
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from math import inf
from multiprocessing import resource_tracker
from threading import Thread, current_thread, main_thread
from time import monotonic
from typing import Any

import dask
import distributed
from distributed import Client, Status

from lepp import InputError
from study.run.client import connected
from study.run.loggers import SILENCE
from study.run.memory import free_memory
from study.run.workers import Workers

# Few functions of distributed are annotated.
_distributed: Any = distributed

#: How long to try to have a worker again.
REPLACE_SECONDS = 300.0
_LOOK_SECONDS = 0.5
_CONNECT_SECONDS = 30
_CLOSE_SECONDS = 20

_SETTINGS = {
    # A task that was in a dying worker twice is tried again by itself, not by the scheduler.
    "distributed.scheduler.allowed-failures": 1,
    # The sampling profiler takes its share of every worker's core.
    "distributed.worker.profile.enabled": False,
    # A new worker may take longer than the 15 seconds after which Dask gives it up; those that
    # will never come are found below.
    "distributed.deploy.lost-worker-timeout": f"{REPLACE_SECONDS}s",
}

#: Dask has the C library hand freed memory back at once, so that each task's arrays would be
#: mapped and cleared anew; here one task's arrays are as large as the last one's. The second is the
#: most that the library takes. Not where memory is scarce.
_KEEPING_MEMORY = {
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 1 << 28,
    "distributed.nanny.pre-spawn-environ.MALLOC_MMAP_THRESHOLD_": 1 << 25,
}


class LocalWorkers(Workers):
    """The workers of a `distributed.LocalCluster`.

    Parameters
    ----------
    client : distributed.Client
        Connected to it.
    cluster : distributed.LocalCluster
        The cluster.
    n_workers : int
        Workers that it is to have.
    memory : int, optional
        Bytes for all tasks together.
    largest : float
        Bytes for a task.
    """

    ahead = 3

    def __init__(
        self,
        client: Client,
        cluster: Any,  # noqa: ANN401 - as `_distributed`
        n_workers: int,
        memory: int | None = None,
        largest: float = inf,
    ) -> None:
        self.client, self.memory, self.largest = client, memory, largest
        self._cluster, self._n_workers = cluster, n_workers
        self._looked = -_LOOK_SECONDS

    def look(self) -> str | None:
        """Count the threads, and have what died for good replaced."""
        if monotonic() - self._looked >= _LOOK_SECONDS:
            self._looked = monotonic()
            self._replace()
            self.now = sum(w.nthreads for w in list(self._cluster.scheduler.workers.values()))
            self.most = max(self.most, self.now)
        return None if self.now else "new workers, as the old ones died"

    def _replace(self) -> None:
        """Start anew what nobody else does.

        A nanny starts a worker again that dies, but gives up if the worker dies while it starts.
        """
        workers = self._cluster.workers
        for name, nanny in list(workers.items()):
            if nanny.status in (Status.closed, Status.failed):
                workers.pop(name, None)
        if len(workers) < self._n_workers:
            self._cluster.scale(self._n_workers)


@contextmanager
def local(
    n_workers: int,
    memory: int,
    *,
    worker_memory: int | None = None,
    dashboard: bool,
    note: Callable[[str], None],
) -> Iterator[LocalWorkers]:
    """Start workers with one thread each.

    Parameters
    ----------
    n_workers : int
        Worker processes.
    memory : int
        Bytes for all tasks together, or for one if workers have a limit.
    worker_memory : int, optional
        Limit of each worker in bytes; none if not given.
    dashboard : bool
        Whether to serve Dask's dashboard.
    note : callable
        Takes a sentence.

    Raises
    ------
    InputError
        If they do not start.
    """
    keeping = _KEEPING_MEMORY if worker_memory is None else {}
    with dask.config.set(_SETTINGS | keeping):
        cluster = client = None
        try:
            with _explained(), _without_interrupts(), _before_it_is_terminated():
                cluster = _distributed.LocalCluster(
                    n_workers=n_workers,
                    threads_per_worker=1,
                    processes=True,  # each with a nanny, which replaces it when it dies
                    host="127.0.0.1",
                    # How many tasks fit side by side is planned: a large one may have it all.
                    memory_limit=worker_memory or free_memory(),
                    silence_logs=logging.CRITICAL,
                    **_dashboard_options(dashboard),
                )
            client = connected(cluster, _CONNECT_SECONDS)
            if dashboard:
                note(f"Dask's dashboard: {cluster.dashboard_link}")
            if worker_memory is None:
                yield LocalWorkers(client, cluster, n_workers, memory, memory)
            else:
                yield LocalWorkers(client, cluster, n_workers, None, memory)
        finally:
            # The workers take a while to end, in which the report can be written; Python waits
            # for this thread before it exits.
            closing = Thread(target=_close, args=(client, cluster))
            try:
                closing.start()
            except RuntimeError:  # there can be no more threads
                _close(client, cluster)


def check_dashboard() -> None:
    """Raise `InputError` if what Dask's dashboard needs is not installed."""
    try:
        import distributed.dashboard.scheduler  # noqa: F401 - only to see whether it is there
    except ImportError:
        raise InputError(
            "--dashboard needs bokeh: install it with pip install 'lepp-study[dashboard]'."
        ) from None


def _dashboard_options(dashboard: bool) -> dict[str, Any]:
    if dashboard:
        return {"dashboard_address": "127.0.0.1:8787"}
    # Without a dashboard there still is a server of metrics, by default on port 8787.
    return {
        "dashboard_address": None,
        "scheduler_kwargs": {"dashboard_address": "127.0.0.1:0"},
    }


@contextmanager
def _explained() -> Iterator[None]:
    """Raise an `InputError` where the workers do not start."""
    try:
        yield
    except (OSError, RuntimeError, TimeoutError) as error:
        raise InputError(
            f"The workers did not start: {_reason(error)}. Try fewer (--workers), and see "
            "what limits this process (ulimit -a, /dev/shm)."
        ) from error


def _reason(error: BaseException) -> str:
    """Return what an error comes from: distributed wraps them several times."""
    while (cause := error.__cause__ or error.__context__) is not None:
        error = cause
    return str(error).rstrip(".") or type(error).__name__


@contextmanager
def _without_interrupts() -> Iterator[None]:
    """Keep Ctrl-C, which a terminal sends to all processes, from the workers started herein.

    Threads and processes inherit the mask of signals, so the workers that replace dead ones, which
    a thread of the cluster starts later, have it too. Here, an interrupt waits for the end.
    """
    if not hasattr(signal, "pthread_sigmask"):  # as on Windows
        yield
        return
    # Whatever starts this helper of multiprocessing first loses its mask.
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _before_it_is_terminated() -> Iterator[None]:
    """Have SIGTERM wait for the end, as what is half started cannot be closed.

    Not by the mask: the workers would never hear of theirs.
    """
    if current_thread() is not main_thread():  # which signals do not come to
        yield
        return
    held: list[int] = []
    before = signal.signal(signal.SIGTERM, lambda number, _: held.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
        if held:
            signal.raise_signal(signal.SIGTERM)


def _close(client: Any, cluster: Any) -> None:  # noqa: ANN401 - as `_distributed`
    # What does not end in time ends with this process.
    with SILENCE:
        for one in (client, cluster):
            with suppress(TimeoutError, RuntimeError):
                if one is not None:
                    one.close(timeout=_CLOSE_SECONDS)
