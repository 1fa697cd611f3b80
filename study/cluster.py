"""The Dask cluster that a study runs on: one of this computer's cores, or any scheduler's."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import version
from typing import Any, cast

import dask
import psutil
from dask.system import CPU_COUNT
from distributed import Client, LocalCluster
from distributed.system import MEMORY_LIMIT

import lepp
from lepp import InputError
from study.design import Design

#: Most memory that a task takes at a time, measured on Delaunay and incremental triangulations.
BYTES_PER_POINT = 400

CONNECT_SECONDS = 10
#: Workers of a cluster may still be starting when its scheduler answers.
WORKERS_SECONDS = 60

#: Packages that have to be the same on every worker: for the numbers, or to understand each other.
_SHARED = ("numpy", "scipy", "numba", "dask", "distributed", "cloudpickle", "msgpack")

_LOCAL_SETTINGS = {
    # A task that was in a dying worker twice is tried again by itself, not by the scheduler.
    "distributed.scheduler.allowed-failures": 1,
    # The sampling profiler takes its share of every worker's core.
    "distributed.worker.profile.enabled": False,
    # Dask has the C library hand freed memory back at once, so that each task's arrays would be
    # mapped and cleared anew; here one task's arrays are as large as the last one's.
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 1 << 30,
    "distributed.nanny.pre-spawn-environ.MALLOC_MMAP_THRESHOLD_": 1 << 30,
}


@contextmanager
def connect(design: Design, workers: int | None, scheduler: str | None) -> Iterator[Client]:
    """Start a cluster on this computer, or connect to a scheduler.

    Parameters
    ----------
    design : Design
        What is to be run; checked against the memory of the workers.
    workers : int or None
        Worker processes to start, with one thread each; None for one a core.
    scheduler : str or None
        Address of a running scheduler, such as ``tcp://10.0.0.1:8786``; None for this computer.

    Raises
    ------
    InputError
        If the design does not fit into memory, the scheduler does not answer or has no workers,
        or its workers have other versions of what decides the numbers.
    """
    for name in ("distributed", "distributed.client", "distributed.scheduler", "tornado"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    if scheduler is not None:
        if workers is not None:
            raise InputError("Give --workers or --scheduler, not both: a scheduler has its own.")
        with _remote(scheduler) as client:
            _check_workers(client, scheduler, design)
            yield client
        return
    workers = workers or CPU_COUNT
    # In a container, its limit; what other programs hold is not there either.
    check_memory(design, workers, min(MEMORY_LIMIT, psutil.virtual_memory().available))
    # Before the workers start, so that they only load: compiling in all of them at once is slow.
    lepp.compile_kernels()
    with dask.config.set(_LOCAL_SETTINGS), _local(workers) as client:
        yield client


def check_memory(design: Design, workers: int, available: int) -> None:
    """Raise `InputError` if the largest triangulations, one a worker, do not fit into memory.

    Parameters
    ----------
    design : Design
        The design.
    workers : int
        Triangulations at a time.
    available : int
        Memory for all of them, in bytes.
    """
    largest = design.sizes[-1]
    needed = largest * BYTES_PER_POINT
    if needed * workers <= available:
        return
    fits = available // needed
    advice = f"use --workers {fits}" if fits else "use smaller sizes"
    each = f" and {workers} at once {_gigabytes(needed * workers)}" if workers > 1 else ""
    raise InputError(
        f"A triangulation of {largest:,} points takes about {_gigabytes(needed)} of memory{each}, "
        f"but {_gigabytes(available)} are free: {advice}."
    )


def _gigabytes(n_bytes: int) -> str:
    return f"{n_bytes / 1e9:,.1f} GB"


@contextmanager
def _local(workers: int) -> Iterator[Client]:
    try:
        cluster = LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,  # each with a nanny, which replaces it when it dies
            host="127.0.0.1",
            dashboard_address=None,
            silence_logs=logging.CRITICAL,
        )
    except (OSError, RuntimeError, TimeoutError) as error:
        raise InputError(f"The workers did not start: {error}.") from error
    with cluster, Client(cluster) as client:
        yield client


@contextmanager
def _remote(scheduler: str) -> Iterator[Client]:
    try:
        client = Client(scheduler, timeout=CONNECT_SECONDS)
    except (OSError, ValueError, TypeError) as error:
        reason = "" if isinstance(error, TimeoutError) else f" ({error})"
        raise InputError(
            f"No scheduler answers at {scheduler} within {CONNECT_SECONDS} seconds{reason}: check "
            "the address, which looks like tcp://10.0.0.1:8786."
        ) from None
    try:
        yield client
    finally:
        cast(Any, client).close(timeout=CONNECT_SECONDS)


def _check_workers(client: Client, scheduler: str, design: Design) -> None:
    try:
        client.wait_for_workers(1, timeout=WORKERS_SECONDS)
    except TimeoutError:
        raise InputError(
            f"The scheduler at {scheduler} has no workers: start some with dask worker {scheduler}."
        ) from None
    found: Any = client.get_versions(packages=list(_SHARED))
    here = _versions(found["client"])
    for address, report in found["workers"].items():
        _check_versions(address, _versions(report), here)
    workers = client.scheduler_info(n_workers=-1)["workers"]
    for worker in workers.values():
        if worker["memory_limit"]:
            check_memory(design, worker["nthreads"], worker["memory_limit"])
    # One worker a host compiles, the others then load.
    hosts = {worker["host"]: address for address, worker in workers.items()}
    for address in hosts.values():
        _prepare(client, address)


def _versions(report: dict[str, Any]) -> dict[str, str]:
    python = ".".join(report["host"]["python"].split(".")[:2])
    return {"Python": python} | {name: report["packages"].get(name) for name in _SHARED}


def _check_versions(address: str, there: dict[str, str], here: dict[str, str]) -> None:
    for name, expected in here.items():
        if there[name] != expected:
            raise InputError(
                f"The worker {address} has {name} {there[name]} and this computer has {expected}: "
                "the results would depend on which computes them, so install the same on both."
            )


def _prepare(client: Client, address: str) -> None:
    try:
        future = client.submit(prepare_worker, workers=[address], pure=False)
        found, expected = future.result(), version("lepp-study")
    except ModuleNotFoundError as error:
        raise InputError(
            f"The worker {address} does not know {error.name}: install lepp-study on it."
        ) from None
    _check_versions(address, {"lepp-study": found}, {"lepp-study": expected})


def prepare_worker() -> str:
    """Compile or load the kernels on a worker; return its version of this package."""
    lepp.compile_kernels()
    return version("lepp-study")
