"""Run a design: stream its tasks to the workers, keep what comes back, try again what fails."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import monotonic, perf_counter, sleep
from typing import Any, Protocol, cast

from distributed import Client, Future, KilledWorker, as_completed, get_worker

from lepp import InputError
from study.results.store import Store
from study.run.batches import Batches, Load
from study.run.cluster import check_request, connect, free_memory
from study.run.kinds import Kind, Outcome, Size

#: Batches under way for each thread of a worker: one computed, one waiting there, one on its way.
_AHEAD = 3

#: Times that a task is tried before its failure is its result.
ATTEMPTS = 3

_POLL_SECONDS = 0.01
_RECOUNT_SECONDS = 2.0

_LOST = (
    "The connection to the scheduler was lost; what was finished is kept, and the same command "
    "goes on from there when the scheduler is back."
)


class RunStoppedError(InputError):
    """The cluster was lost in the middle of a run; what was finished is kept."""


class Listener(Protocol):
    """What follows the progress of a run."""

    def begin(self, units: tuple[str, str], unfinished: Size, whole: Size, n_threads: int) -> None:
        """Hear how much there is to compute, and how much the whole study is, in units.

        The workers, which perform `n_threads` tasks at a time, have their first ones by then, so
        this may take a second.
        """

    def advance(self, outcome: Outcome, size: Size) -> None:
        """Hear of a task that was computed, or has failed for the last time, and of its size."""

    def note(self, sentence: str) -> None:
        """Hear of something out of the ordinary."""


@dataclass(frozen=True)
class Summary:
    """How a run went.

    Attributes
    ----------
    computed : Size
        What was computed in this run.
    units : (str, str)
        What that counts.
    failures : list of Outcome
        Tasks that have failed, this time or before.
    seconds : float
        Duration of the run, the start of the workers included; their end goes on beside the rest.
    kernel_seconds : float
        Sum of the computed tasks' own times.
    n_threads : int
        Most threads that the workers had at a time; 0 if there was nothing to run.
    """

    computed: Size
    units: tuple[str, str]
    failures: list[Outcome]
    seconds: float
    kernel_seconds: float
    n_threads: int


class Threads:
    """The threads of a cluster's workers, counted now and then.

    Parameters
    ----------
    client : distributed.Client
        The cluster.
    """

    def __init__(self, client: Client) -> None:
        self._client = client
        self.now = self.most = 0
        self._counted = -_RECOUNT_SECONDS
        self.count()

    def count(self) -> bool:
        """Count if it is time; return whether the last thread has gone."""
        if monotonic() - self._counted <= _RECOUNT_SECONDS:
            return False
        before, self.now = self.now, sum(cast(Any, self._client).nthreads().values())
        self.most = max(self.most, self.now)
        self._counted = monotonic()
        return before > 0 and self.now == 0


def run(
    directory: Path,
    kind: Kind,
    design: Any,  # noqa: ANN401 - of the kind's own type
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    listener: Listener,
) -> Summary:
    """Compute what a results directory lacks of a design.

    Parameters
    ----------
    directory : Path
        The results directory; made, or taken up where an earlier run was cut short.
    kind : Kind
        The kind of the tasks.
    design : kind.design
        The design.
    workers, scheduler : int or None, str or None
        As in `study.run.cluster.connect`.
    listener : Listener
        Hears of the progress.

    Raises
    ------
    InputError
        If the directory or the cluster cannot be used; `RunStoppedError` if the scheduler is lost.
    """
    start = perf_counter()
    # Somebody else's workers each have room for as many tasks as they have threads.
    memory = free_memory() if scheduler is None else None
    computed, kernel_seconds, n_threads = [Size(0, 0)], 0.0, 0
    if not directory.exists():  # nothing is left of a run that could not begin
        check_request(kind, design, workers, scheduler)
    with Store(directory, kind, design, listener.note) as store:
        if store.unfinished:
            with connect(kind, design, workers, scheduler, listener.note) as client:
                threads = Threads(client)
                for outcome in compute(client, threads, store, listener, memory):
                    size = kind.size_of(outcome.task, design)
                    listener.advance(outcome, size)
                    computed.append(size)
                    kernel_seconds += outcome.seconds
                n_threads = threads.most
                store.finish()
        failures = store.failures
    seconds = perf_counter() - start
    return Summary(Size.total(computed), kind.units, failures, seconds, kernel_seconds, n_threads)


def compute(
    client: Client,
    threads: Threads,
    store: Store,
    listener: Listener,
    memory: int | None = None,
) -> Iterator[Outcome]:
    """Compute the unfinished tasks of a store on a cluster, and keep what comes back.

    Parameters
    ----------
    client : distributed.Client
        The cluster.
    threads : Threads
        Of its workers; counted while this goes on.
    store : Store
        Gives the tasks and takes their outcomes.
    listener : Listener
        Hears of the beginning, and if the workers are gone.
    memory : int, optional
        Bytes for all tasks under way together: what does not fit side by side runs one after the
        other. No limit if not given.

    Yields
    ------
    outcome : Outcome
        As they are kept; of failures the last.
    """
    kind, design = store.kind, store.design
    unfinished = store.unfinished
    sizes = {task: kind.size_of(task, design) for task in store.tasks}
    needs = {task: kind.memory_of(task, design).n_bytes for task in unfinished}
    loads = [(task, Load(sizes[task].work, needs[task])) for task in unfinished]
    batches = Batches(loads, max(threads.now, 1), memory)
    attempts: Counter[Any] = Counter()
    # Typed Any because this class of distributed has no annotations.
    arrivals: Any = cast(Any, as_completed)(loop=client.loop, with_results=True, raise_errors=False)
    begun = not unfinished
    while True:
        while len(batches) < _AHEAD * max(threads.now, 1):
            batch = batches.next()
            if batch is None:
                break
            # Not pure: a name of its own, whatever else runs at this scheduler.
            future = client.submit(perform_batch, batch.tasks, kind, design, pure=False)
            batches.begin(future, batch)
            arrivals.add(future)
        if not begun:
            todo = Size.total([sizes[task] for task in unfinished])
            whole = Size.total(list(sizes.values()))
            listener.begin(kind.units, todo, whole, threads.now)
            begun = True
        if not len(batches):
            return
        arrived = arrivals.next_batch(block=False)
        for future, result in arrived:
            tasks = batches.end(future).tasks
            final = []
            for outcome in _outcomes_of(future, result, tasks, kind, design):
                attempts[outcome.task] += 1
                if outcome.error is None or attempts[outcome.task] >= ATTEMPTS:
                    final.append(outcome)
                else:
                    batches.again(outcome.task, needs[outcome.task])
            yield from store.add(final)
        if client.status != "running":
            raise RunStoppedError(_LOST)
        if not arrived:
            sleep(_POLL_SECONDS)
        if threads.count():
            listener.note("There are no workers any more; waiting for new ones.")


def perform_batch(tasks: Sequence[Any], kind: Kind, design: Any) -> list[Outcome]:  # noqa: ANN401 - of the kind's own type
    """Perform tasks one after the other on a worker; an error is the outcome of its task alone."""
    worker = get_worker().address
    outcomes = []
    for task in tasks:
        try:
            outcome = kind.perform(task, design)
        except Exception as error:
            outcome = kind.failed(task, design, _in_words(error))
        outcomes.append(replace(outcome, worker=worker))
    return outcomes


def _outcomes_of(
    future: Future,
    result: object,
    tasks: Sequence[Any],
    kind: Kind,
    design: Any,  # noqa: ANN401 - of the kind's own type
) -> list[Outcome]:
    if future.status == "finished":
        return cast(list[Outcome], result)
    if future.status == "error":
        _, error, _ = cast(tuple[type, BaseException, object], result)
        return [kind.failed(task, design, _in_words(error)) for task in tasks]
    raise RunStoppedError(_LOST)


def _in_words(error: BaseException) -> str:
    # Its own words name the worker, and the results of a design must not depend on that.
    if isinstance(error, KilledWorker):
        return "KilledWorker: the workers that computed it died"
    return f"{type(error).__name__}: {error}"
