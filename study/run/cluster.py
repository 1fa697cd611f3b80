"""The Dask cluster that a study runs on: one of this computer's cores, or any scheduler's."""

import json
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Timer
from time import sleep
from typing import Any

import dask
from dask.system import CPU_COUNT
from distributed.versions import VersionMismatchWarning

from lepp import InputError
from study.run.admission import AdmittedWorkers
from study.run.client import connected
from study.run.kinds import Kind
from study.run.local import REPLACE_SECONDS, check_dashboard, local
from study.run.loggers import SILENCE
from study.run.memory import USABLE, check_memory, free_memory
from study.run.waiting import PATIENCE_SECONDS, Waiting
from study.run.workers import Workers

CONNECT_SECONDS = 30
_POLL_SECONDS = 0.2

_TLS = (
    "give the certificates as Dask wants them, in DASK_DISTRIBUTED__COMM__TLS__CA_FILE, "
    "DASK_DISTRIBUTED__COMM__TLS__CLIENT__CERT and DASK_DISTRIBUTED__COMM__TLS__CLIENT__KEY"
)


@dataclass(frozen=True)
class ClusterOptions:
    """Where a design is run.

    Attributes
    ----------
    workers : int or None
        Worker processes to start here, with one thread each; None for one a core.
    scheduler : str or None
        Address of a running scheduler, such as ``tcp://10.0.0.1:8786``.
    scheduler_file : Path or None
        The file that a running scheduler has written its address into. If none of these is given,
        the scheduler that Dask's configuration names, if it does, or else this computer.
    wait : float
        Seconds to wait at most when a scheduler has no workers.
    dashboard : bool
        Whether to serve Dask's dashboard of the workers started here.
    worker_memory : int or None
        Bytes that each worker started here may take; None for all that is free, together.
    """

    workers: int | None = None
    scheduler: str | None = None
    scheduler_file: Path | None = None
    wait: float = 3600.0
    dashboard: bool = False
    worker_memory: int | None = None

    @property
    def from_dask(self) -> str | None:
        """The scheduler that Dask's configuration names and nothing here stands against."""
        if (self.workers, self.scheduler, self.scheduler_file) != (None, None, None):
            return None
        address: str | None = dask.config.get("scheduler-address", None)
        return address

    @property
    def local(self) -> bool:
        """Whether workers are started here."""
        return (self.scheduler, self.scheduler_file, self.from_dask) == (None, None, None)

    def n_workers(self, kind: Kind) -> int:
        """Return how many worker processes to start: one a core, if half the memory stays free."""
        room = free_memory() // (2 * kind.base_memory) if kind.base_memory else CPU_COUNT
        return self.workers or max(1, min(CPU_COUNT, room))

    def waiting(self, note: Callable[[str], None]) -> Waiting:
        """Return what tells of waiting for workers, and ends it."""
        if self.local:
            return Waiting(REPLACE_SECONDS, "see what kills them: memory, a limit", note)
        return Waiting(self.wait, "--wait says how long", note)


@contextmanager
def connect(
    kind: Kind,
    design: Any,  # noqa: ANN401 - of the kind's own type
    options: ClusterOptions,
    note: Callable[[str], None],
) -> Iterator[Workers]:
    """Start a cluster on this computer, or connect to a scheduler.

    Parameters
    ----------
    kind : Kind
        The kind of the tasks; prepares the workers.
    design : kind.design
        What is to be run; checked against the memory of the workers.
    options : ClusterOptions
        Where.
    note : callable
        Takes a sentence about what takes long.

    Raises
    ------
    InputError
        If the design does not fit into memory, or the scheduler does not answer.
    """
    check_request(kind, design, options)
    with SILENCE:
        if options.local:
            # Before the workers start, so that they only load: compiling in all of them at once
            # is slow.
            with _told_if_long(kind.preparing, note):
                kind.prepare(design, _for_tasks(kind, options))
            with local(
                options.n_workers(kind),
                _for_tasks(kind, options),
                worker_memory=options.worker_memory,
                dashboard=options.dashboard,
                note=note,
            ) as workers:
                yield workers
            return
        with _remote(_address(options, note), note) as client:
            if options.dashboard:
                note(f"Dask's dashboard: {client.dashboard_link}")
            admitted = AdmittedWorkers(client, client.scheduler.address, kind, design, note)
            try:
                yield admitted
            finally:
                admitted.close()


def check_request(
    kind: Kind,
    design: Any,  # noqa: ANN401 - of the kind's own type
    options: ClusterOptions,
) -> None:
    """Raise `InputError` for what `connect` would refuse without asking anybody.

    Parameters
    ----------
    kind, design, options
        As in `connect`.
    """
    places = (options.workers, options.scheduler, options.scheduler_file)
    if sum(place is not None for place in places) > 1:
        raise InputError(
            "Give one of --workers, --scheduler and --scheduler-file: a scheduler has its own "
            "workers."
        )
    if options.worker_memory is not None and not options.local:
        raise InputError("--worker-memory is for workers here: those of a scheduler have a limit.")
    if options.local:
        whose = "here it may take" if options.worker_memory is None else "a worker may take"
        check_memory(kind, design, _for_tasks(kind, options), whose)
        if options.dashboard:
            check_dashboard()


def _for_tasks(kind: Kind, options: ClusterOptions) -> int:
    """Return the bytes that a task may take here, beside the processes of the workers."""
    if options.worker_memory is not None:
        return int(USABLE * options.worker_memory) - kind.base_memory
    return free_memory() - options.n_workers(kind) * kind.base_memory


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


def _address(options: ClusterOptions, note: Callable[[str], None]) -> str:
    """Find the address of the scheduler that the options mean."""
    if options.scheduler is not None:
        return options.scheduler
    path = options.scheduler_file
    if path is None:
        address = str(options.from_dask)
        note(f"Running at the scheduler that DASK_SCHEDULER_ADDRESS names, {address}.")
        return address
    waiting = options.waiting(note)
    while not path.exists():
        waiting.look(f"the scheduler to write {path}")
        sleep(_POLL_SECONDS)
    try:
        return str(json.loads(path.read_text(encoding="utf-8"))["address"])
    except (OSError, ValueError, KeyError, TypeError):
        raise InputError(
            f"{path} names no scheduler: give the file of dask scheduler --scheduler-file."
        ) from None


@contextmanager
def _remote(scheduler: str, note: Callable[[str], None]) -> Iterator[Any]:
    try:
        with (
            _told_if_long(f"Connecting to the scheduler at {scheduler}.", note),
            warnings.catch_warnings(action="ignore", category=VersionMismatchWarning),
        ):
            client = connected(scheduler, CONNECT_SECONDS)
    except Exception as error:  # what listens there may be anything, and send anything
        advice = "check the address, which looks like tcp://10.0.0.1:8786, or tls:// where " + (
            "certificates are asked for"
        )
        if scheduler.startswith("tls://"):
            advice = f"check the address, and {_TLS}"
        raise InputError(
            f"No scheduler answers at {scheduler} within {CONNECT_SECONDS} seconds ({error}): "
            f"{advice}."
        ) from None
    try:
        yield client
    finally:
        client.close(timeout=CONNECT_SECONDS)
