"""Run a design: stream its tasks to the workers, keep what comes back, try again what fails."""

from collections import Counter, deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import monotonic, perf_counter, sleep
from typing import Any, Protocol, cast

from distributed import Client, Future, KilledWorker, as_completed, get_worker

from lepp import InputError
from study.design.design import Design
from study.results.store import Store
from study.run import experiment
from study.run.cluster import connect
from study.run.experiment import Outcome, Task

#: Tasks that are smaller than this are sent several at a time.
BATCH_POINTS = 2_000_000

#: The last batches are smaller, so that no worker is left with a long one at the end.
_LAST_SHARE = 4

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

Batch = list[Task]


class RunStoppedError(InputError):
    """The cluster was lost in the middle of a run; what was finished is kept."""


class Listener(Protocol):
    """What follows the progress of a run."""

    def begin(self, unfinished: Sequence[Task], n_tasks: int) -> None:
        """Hear of the tasks to compute, and of the number of all tasks of the design.

        The workers have their first tasks by then, so this may take a second.
        """

    def advance(self, outcome: Outcome) -> None:
        """Hear of a task that was computed, or has failed for the last time."""

    def note(self, sentence: str) -> None:
        """Hear of something out of the ordinary."""


@dataclass(frozen=True)
class Summary:
    """How a run went.

    Attributes
    ----------
    n_computed : int
        Tasks that were computed in this run.
    n_points : int
        Points of these.
    failures : list of Outcome
        Tasks that have failed, this time or before.
    seconds : float
        Duration of the run, the start and end of the workers included.
    kernel_seconds : float
        Sum of the computed tasks' own times.
    n_threads : int
        Threads of the workers at the end of the run; 0 if there was nothing to run.
    """

    n_computed: int
    n_points: int
    failures: list[Outcome]
    seconds: float
    kernel_seconds: float
    n_threads: int


def run(
    directory: Path,
    design: Design,
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
    design : Design
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
    n_points, kernel_seconds, n_computed, n_threads = 0, 0.0, 0, 0
    with Store(directory, design) as store:
        if store.unfinished:
            with connect(design, workers, scheduler) as client:
                for outcome in compute(client, store, listener):
                    listener.advance(outcome)
                    n_computed += 1
                    n_points += outcome.task.n_points
                    kernel_seconds += sum(outcome.timings.values())
                n_threads = _n_threads(client)
                store.finish()
        failures = store.failures
    seconds = perf_counter() - start
    return Summary(n_computed, n_points, failures, seconds, kernel_seconds, n_threads)


def compute(client: Client, store: Store, listener: Listener) -> Iterator[Outcome]:
    """Compute the unfinished tasks of a store on a cluster, and keep what comes back.

    Parameters
    ----------
    client : distributed.Client
        The cluster.
    store : Store
        Gives the tasks and takes their outcomes.
    listener : Listener
        Hears of the beginning, and if the workers are gone.

    Yields
    ------
    outcome : Outcome
        As they are kept; of failures the last.
    """
    n_threads, counted = _n_threads(client), monotonic()
    unfinished = store.unfinished
    batches = _batches(unfinished, max(n_threads, 1))
    again: deque[Task] = deque()
    attempts: Counter[Task] = Counter()
    under_way: dict[Future, Batch] = {}
    # Typed Any because this class of distributed has no annotations.
    arrivals: Any = cast(Any, as_completed)(loop=client.loop, with_results=True, raise_errors=False)
    while True:
        while len(under_way) < _AHEAD * max(n_threads, 1):
            batch = [again.popleft()] if again else next(batches, None)
            if batch is None:
                break
            # Not pure: a name of its own, whatever else runs at this scheduler.
            future = client.submit(perform_batch, batch, store.design, pure=False)
            under_way[future] = batch
            arrivals.add(future)
        if unfinished:
            listener.begin(unfinished, store.design.n_tasks)
            unfinished = []
        if not under_way:
            return
        arrived = arrivals.next_batch(block=False)
        for future, result in arrived:
            outcomes = _outcomes_of(future, result, under_way.pop(future))
            final = []
            for outcome in outcomes:
                attempts[outcome.task] += 1
                if outcome.error is None or attempts[outcome.task] >= ATTEMPTS:
                    final.append(outcome)
                else:
                    again.append(outcome.task)
            yield from store.add(final)
        if client.status != "running":
            raise RunStoppedError(_LOST)
        if not arrived:
            sleep(_POLL_SECONDS)
        if monotonic() - counted > _RECOUNT_SECONDS:
            before, n_threads, counted = n_threads, _n_threads(client), monotonic()
            if before and not n_threads:
                listener.note("There are no workers any more; waiting for new ones.")


def perform_batch(tasks: Sequence[Task], design: Design) -> list[Outcome]:
    """Perform tasks one after the other on a worker; an error is the outcome of its task alone."""
    worker = get_worker().address
    outcomes = []
    for task in tasks:
        try:
            outcome = experiment.perform(task, design)
        except Exception as error:
            outcome = Outcome(task, error=_in_words(error))
        outcomes.append(replace(outcome, worker=worker))
    return outcomes


def _batches(tasks: Sequence[Task], n_threads: int) -> Iterator[Batch]:
    """Divide tasks into batches, the largest tasks first."""
    remaining = sum(task.n_points for task in tasks)
    batch: Batch = []
    in_batch = 0
    limit = min(BATCH_POINTS, remaining // (_LAST_SHARE * n_threads))
    for task in sorted(tasks, key=lambda task: -task.n_points):
        if batch and in_batch + task.n_points > limit:
            yield batch
            remaining -= in_batch
            limit = min(BATCH_POINTS, remaining // (_LAST_SHARE * n_threads))
            batch, in_batch = [], 0
        batch.append(task)
        in_batch += task.n_points
    if batch:
        yield batch


def _outcomes_of(future: Future, result: object, batch: Batch) -> list[Outcome]:
    if future.status == "finished":
        return cast(list[Outcome], result)
    if future.status == "error":
        _, error, _ = cast(tuple[type, BaseException, object], result)
        return [Outcome(task, error=_in_words(error)) for task in batch]
    raise RunStoppedError(_LOST)


def _in_words(error: BaseException) -> str:
    # Its own words name the worker, and the results of a design must not depend on that.
    if isinstance(error, KilledWorker):
        return "KilledWorker: the workers that computed it died"
    return f"{type(error).__name__}: {error}"


def _n_threads(client: Client) -> int:
    return sum(cast(Any, client).nthreads().values())
