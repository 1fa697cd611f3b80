"""Run a design: stream its tasks to the workers, keep what comes back, try again what fails."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter, sleep
from typing import Any, NamedTuple, Protocol, cast

from distributed import Future, KilledWorker, as_completed, get_worker

from study.results.store import Store
from study.run.batches import Batch, Batches, Load
from study.run.cluster import ClusterOptions, check_request, connect
from study.run.kinds import Kind, Outcome, Size
from study.run.memory import in_words
from study.run.waiting import RunStoppedError, Waiting
from study.run.workers import Workers

#: Times that a task is tried before its failure is its result.
ATTEMPTS = 3

_POLL_SECONDS = 0.01

_LOST = "The connection to the scheduler was lost"


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


def run(
    directory: Path,
    kind: Kind,
    design: Any,  # noqa: ANN401 - of the kind's own type
    *,
    options: ClusterOptions,
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
    options : ClusterOptions
        Where.
    listener : Listener
        Hears of the progress.

    Raises
    ------
    InputError
        If the directory or the cluster cannot be used; `RunStoppedError` if the scheduler is lost,
        or there are no workers for too long.
    """
    start = perf_counter()
    computed, kernel_seconds, n_threads = Size(0, 0), 0.0, 0
    if not directory.exists():  # nothing is left of a run that could not begin
        check_request(kind, design, options)
    with Store(directory, kind, design, listener.note) as store:
        if store.unfinished:
            with connect(kind, design, options, listener.note) as workers:
                waiting = options.waiting(listener.note)
                for outcome in compute(workers, waiting, store, listener):
                    size = kind.size_of(outcome.task, design)
                    listener.advance(outcome, size)
                    computed = Size.total((computed, size))
                    kernel_seconds += outcome.seconds
                n_threads = workers.most
                store.finish()
        failures = store.failures
    seconds = perf_counter() - start
    return Summary(computed, kind.units, failures, seconds, kernel_seconds, n_threads)


def compute(
    workers: Workers, waiting: Waiting, store: Store, listener: Listener
) -> Iterator[Outcome]:
    """Compute the unfinished tasks of a store on a cluster, and keep what comes back.

    Parameters
    ----------
    workers : Workers
        What computes them.
    waiting : Waiting
        Hears of what is waited for.
    store : Store
        Open for writing; gives the kind, the design and the tasks.
    listener : Listener
        Hears when the first tasks are sent.

    Yields
    ------
    outcome : Outcome
        As they are kept; of failures the last.
    """
    kind, design = store.kind, store.design

    def load_of(task: Any) -> Load:  # noqa: ANN401 - of the kind's own type
        return Load(kind.size_of(task, design).work, kind.memory_of(task, design).n_bytes)

    unfinished = store.unfinished
    todo = Size.total(kind.size_of(task, design) for task in unfinished)
    whole = Size.total(kind.size_of(task, design) for task in store.tasks)
    batches = Batches(unfinished, load_of, workers.memory)
    del unfinished  # there may be a million
    attempts: Counter[Any] = Counter()
    # Typed Any because this class of distributed has no annotations.
    arrivals: Any = cast(Any, as_completed)(
        loop=workers.client.loop, with_results=True, raise_errors=False
    )

    def send(batch: Batch) -> None:
        future = workers.client.submit(
            perform_batch,
            batch.tasks,
            kind,
            design,
            pure=False,  # a name of its own, whatever else runs at this scheduler
            resources=workers.resources(batch.memory),
        )
        batches.begin(future, batch)
        arrivals.add(future)

    begun = False
    while True:
        missing = workers.look()
        if (above := workers.stranded_above()) is not None:
            for future, batch in list(batches.under_way.items()):
                if batch.memory > above:
                    batches.end(future)
                    future.release()
                    send(batch)
        while len(batches.under_way) < workers.ahead * max(workers.now, 1):
            largest = workers.largest if workers.now else float("inf")
            next_batch = batches.next(workers.now, largest)
            if next_batch is None:
                break
            send(next_batch)
        if not begun:
            listener.begin(kind.units, todo, whole, workers.now)
            begun = True
        if not batches.under_way and not batches.n_waiting:
            return
        arrived = arrivals.next_batch(block=False)
        for future, result in arrived:
            if future not in batches.under_way:
                continue  # it was sent once more
            final = []
            done = _done(future, result, batches.end(future).tasks, kind, design)
            if done.seconds:
                batches.learn(len(done.outcomes), done.seconds, workers.now)
            for outcome in done.outcomes:
                if outcome.error is not None:
                    attempts[outcome.task] += 1
                    if attempts[outcome.task] < ATTEMPTS:
                        batches.again(outcome.task)
                        continue
                final.append(outcome)
            yield from store.add(final)
        if workers.client.status != "running":
            raise RunStoppedError(_LOST)
        if missing is None and (memory := batches.smallest()) > workers.largest:
            missing = f"a worker that has {in_words(memory)} for one task"
        waiting.look(None if arrived else missing)
        if not arrived:
            sleep(_POLL_SECONDS)


class Done(NamedTuple):
    """What a batch gave.

    Attributes
    ----------
    outcomes : list of Outcome
        Of its tasks.
    seconds : float
        How long it took on its worker; 0 if that is not known.
    """

    outcomes: list[Outcome]
    seconds: float


def perform_batch(tasks: Sequence[Any], kind: Kind, design: Any) -> Done:  # noqa: ANN401 - of the kind's own type
    """Perform tasks one after the other on a worker; an error is the outcome of its task alone."""
    start = perf_counter()
    worker = get_worker().address
    outcomes = []
    for task in tasks:
        try:
            outcome = kind.perform(task, design)
        except Exception as error:
            outcome = kind.failed(task, design, _in_words(error))
        outcomes.append(replace(outcome, worker=worker))
    return Done(outcomes, perf_counter() - start)


def _done(
    future: Future,
    result: object,
    tasks: Sequence[Any],
    kind: Kind,
    design: Any,  # noqa: ANN401 - of the kind's own type
) -> Done:
    if future.status == "finished":
        return cast(Done, result)
    if future.status == "error":
        _, error, _ = cast(tuple[type, BaseException, object], result)
        return Done([kind.failed(task, design, _in_words(error)) for task in tasks], 0.0)
    raise RunStoppedError(_LOST)


def _in_words(error: BaseException) -> str:
    # Its own words name the worker, and the results of a design must not depend on that.
    if isinstance(error, KilledWorker):
        return "KilledWorker: the workers that computed it died"
    return f"{type(error).__name__}: {error}"
