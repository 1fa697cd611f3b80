"""The Dask cluster that a study runs on: one of this computer's cores, or any scheduler's."""

import logging
import signal
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing import resource_tracker
from threading import Lock, Thread, Timer
from typing import Any

import dask
import distributed
import psutil
from dask.system import CPU_COUNT
from distributed import Client, LocalCluster
from distributed.system import MEMORY_LIMIT
from distributed.versions import VersionMismatchWarning

from lepp import InputError
from study.run.kinds import Kind

# Few functions of distributed are annotated.
_distributed: Any = distributed

CONNECT_SECONDS = 10
#: What takes longer before the first task is told.
PATIENCE_SECONDS = 3
#: Workers of a cluster may still be starting when its scheduler answers.
WORKERS_SECONDS = 60

#: Compiling all kernels takes a worker less than a minute; it may have work of others to do.
PREPARE_SECONDS = 600

#: Packages that have to be the same to understand each other, and on the workers for the numbers.
_WIRE = ("dask", "distributed", "cloudpickle", "msgpack")
_SHARED = (*_WIRE, "lepp-study", "numpy", "scipy", "numba")

_LOCAL_SETTINGS = {
    # A task that was in a dying worker twice is tried again by itself, not by the scheduler.
    "distributed.scheduler.allowed-failures": 1,
    # The sampling profiler takes its share of every worker's core.
    "distributed.worker.profile.enabled": False,
    # Dask has the C library hand freed memory back at once, so that each task's arrays would be
    # mapped and cleared anew; here one task's arrays are as large as the last one's. The second
    # is the most that the library takes.
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 1 << 28,
    "distributed.nanny.pre-spawn-environ.MALLOC_MMAP_THRESHOLD_": 1 << 25,
}


@contextmanager
def connect(
    kind: Kind,
    design: Any,  # noqa: ANN401 - of the kind's own type
    workers: int | None,
    scheduler: str | None,
    note: Callable[[str], None],
) -> Iterator[Client]:
    """Start a cluster on this computer, or connect to a scheduler.

    Parameters
    ----------
    kind : Kind
        The kind of the tasks; prepares the workers.
    design : kind.design
        What is to be run; checked against the memory of the workers.
    workers : int or None
        Worker processes to start, with one thread each; None for one a core.
    scheduler : str or None
        Address of a running scheduler, such as ``tcp://10.0.0.1:8786``; None for this computer.
    note : callable
        Takes a sentence about what takes long.

    Raises
    ------
    InputError
        If the design does not fit into memory, the scheduler does not answer or has no workers,
        or its workers have other versions of what decides the numbers.
    """
    check_request(kind, design, workers, scheduler)
    with _SILENCE:
        if scheduler is not None:
            with _remote(scheduler) as client:
                _check_workers(client, scheduler, kind, design)
                with _told_if_long(kind.preparing, note):
                    _prepare_hosts(client, kind)
                yield client
            return
        # Before the workers start, so that they only load: compiling in all of them at once is
        # slow.
        with _told_if_long(kind.preparing, note):
            kind.prepare()
        with dask.config.set(_LOCAL_SETTINGS), _local(workers or CPU_COUNT) as client:
            yield client


def check_request(
    kind: Kind,
    design: Any,  # noqa: ANN401 - of the kind's own type
    workers: int | None,
    scheduler: str | None,
) -> None:
    """Raise `InputError` for what `connect` would refuse without asking anybody.

    Parameters
    ----------
    kind, design, workers, scheduler
        As in `connect`.
    """
    if scheduler is None:
        check_memory(kind, design, 1, free_memory())
    elif workers is not None:
        raise InputError("Give --workers or --scheduler, not both: a scheduler has its own.")


def free_memory() -> int:
    """Return the bytes that are free on this computer.

    In a container, at most its limit; what other programs hold is not there either.
    """
    return int(min(MEMORY_LIMIT, psutil.virtual_memory().available))


@contextmanager
def _told_if_long(sentence: str, note: Callable[[str], None]) -> Iterator[None]:
    """Say what is going on, if it goes on for some seconds."""

    def tell() -> None:
        with suppress(BrokenPipeError):  # nobody reads any more, which the run will notice
            note(sentence)

    timer = Timer(PATIENCE_SECONDS, tell)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


class _Silence:
    """Keeps the loggers of distributed quiet while it is entered, however many times."""

    _NAMES = ("distributed", "distributed.client", "distributed.scheduler", "tornado")

    def __init__(self) -> None:
        self._lock = Lock()
        self._depth = 0
        self._levels: dict[str, int] = {}

    def __enter__(self) -> None:
        with self._lock:
            if self._depth == 0:
                self._levels = {name: logging.getLogger(name).level for name in self._NAMES}
                for name in self._NAMES:
                    logging.getLogger(name).setLevel(logging.CRITICAL)
            self._depth += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._depth -= 1
            if self._depth == 0:
                for name, level in self._levels.items():
                    logging.getLogger(name).setLevel(level)


_SILENCE = _Silence()


def check_memory(kind: Kind, design: Any, at_once: int, available: int) -> None:  # noqa: ANN401 - of the kind's own type
    """Raise `InputError` if the largest tasks do not fit into memory.

    Parameters
    ----------
    kind : Kind
        The kind of the tasks.
    design : kind.design
        The design.
    at_once : int
        Tasks at a time.
    available : int
        Memory for all of them, in bytes.
    """
    tasks = kind.tasks_of(design)
    what, needed = max((kind.memory_of(task, design) for task in tasks), key=lambda m: m.n_bytes)
    if needed * at_once <= available:
        return
    fits = available // needed
    advice = f"start the workers with --nthreads {fits}" if fits else "use smaller sizes"
    each = f" and {at_once} at once {_gigabytes(needed * at_once)}" if at_once > 1 else ""
    raise InputError(
        f"{what} takes about {_gigabytes(needed)} of memory{each}, "
        f"but {_gigabytes(available)} are free: {advice}."
    )


def _gigabytes(n_bytes: int) -> str:
    return f"{n_bytes / 1e9:,.1f} GB"


@contextmanager
def _local(workers: int) -> Iterator[Client]:
    try:
        with _without_interrupts():
            cluster = _distributed.LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,  # each with a nanny, which replaces it when it dies
                host="127.0.0.1",
                # How many tasks fit side by side is planned: a large one may have it all.
                memory_limit=free_memory(),
                dashboard_address=None,
                # Without a dashboard there still is a server of metrics, by default on port 8787.
                scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
                silence_logs=logging.CRITICAL,
            )
    except (OSError, RuntimeError, TimeoutError) as error:
        raise InputError(f"The workers did not start: {error}.") from error
    client = None
    try:
        client = _distributed.Client(cluster)
        yield client
    finally:
        # The workers take a while to end, in which the report can be written; Python waits for
        # this thread before it exits.
        Thread(target=_close, args=(client, cluster)).start()


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


def _close(client: Any, cluster: LocalCluster) -> None:  # noqa: ANN401 - as `_distributed`
    with _SILENCE:
        if client is not None:
            client.close()
        cluster.close()


@contextmanager
def _remote(scheduler: str) -> Iterator[Client]:
    try:
        with warnings.catch_warnings(action="ignore", category=VersionMismatchWarning):
            client = _distributed.Client(scheduler, timeout=CONNECT_SECONDS)
    except Exception as error:  # what listens there may be anything, and send anything
        raise InputError(
            f"No scheduler answers at {scheduler} within {CONNECT_SECONDS} seconds ({error}): "
            "check the address, which looks like tcp://10.0.0.1:8786."
        ) from None
    try:
        yield client
    finally:
        client.close(timeout=CONNECT_SECONDS)


def _check_workers(client: Client, scheduler: str, kind: Kind, design: Any) -> None:  # noqa: ANN401 - of the kind's own type
    try:
        client.wait_for_workers(1, timeout=WORKERS_SECONDS)
    except TimeoutError:
        raise InputError(
            f"The scheduler at {scheduler} has no workers: start some with dask worker {scheduler}."
        ) from None
    found: Any = client.get_versions(packages=list(_SHARED))
    here = _versions(found["client"])
    check_versions("scheduler", _versions(found["scheduler"]), here, _WIRE)
    for address, report in found["workers"].items():
        check_versions(f"worker {address}", _versions(report), here, _SHARED)
    workers = client.scheduler_info(n_workers=-1)["workers"]
    for worker in workers.values():
        if worker["memory_limit"]:
            check_memory(kind, design, worker["nthreads"], worker["memory_limit"])


def _prepare_hosts(client: Client, kind: Kind) -> None:
    """Have one worker a host prepare: it compiles the kernels that the others then load."""
    workers = client.scheduler_info(n_workers=-1)["workers"]
    hosts = {worker["host"]: address for address, worker in workers.items()}
    for host, address in hosts.items():
        future = client.submit(kind.prepare, workers=[address], pure=False)
        try:
            future.result(timeout=PREPARE_SECONDS)
        except Exception as error:  # whatever befalls a worker
            raise InputError(
                f"The worker {address} on {host} could not compile the kernels ({error!r}): try "
                'python -c "import lepp; lepp.compile_kernels()" there.'
            ) from None


def _versions(report: dict[str, Any]) -> dict[str, str | None]:
    python = ".".join(report["host"]["python"].split(".")[:2])
    return {"Python": python} | {name: report["packages"].get(name) for name in _SHARED}


def check_versions(
    who: str, there: dict[str, str | None], here: dict[str, str | None], names: Sequence[str]
) -> None:
    """Raise `InputError` if a part of a cluster has other versions than this computer.

    Parameters
    ----------
    who : str
        The part, in words.
    there, here : dict
        Versions by name, of Python and of packages; None for a package that is not installed.
    names : sequence of str
        The packages that matter, beside Python.
    """
    for name in ("Python", *names):
        if there[name] != here[name]:
            has = f"has {name} {there[name]}" if there[name] else f"does not have {name}"
            raise InputError(
                f"The {who} {has}, and this computer has {name} {here[name]}: install the same "
                "version on both."
            )
