"""Run a design: stream its tasks to the workers, keep what comes back, try again what fails."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path
from time import perf_counter, sleep
from typing import Any, NamedTuple, Protocol, cast

from distributed import Future, KilledWorker, as_completed, get_worker

from study.results.store import Store
from study.run.batches import Batch, Batches, Load
from study.run.cluster import ClusterOptions, check_request, connect
from study.run.kinds import Kind, Outcome, Size, StagedTask
from study.run.memory import in_words
from study.run.waiting import RunStoppedError, Waiting
from study.run.workers import Workers

#: Times that a task is tried before its failure is its result.
ATTEMPTS = 3

_POLL_SECONDS = 0.01

#: Where, in a results directory, tasks that are done in stages keep their files.
STAGES = "stages"
#: What a worker is taken to have as long as there is none to be asked.
_TYPICAL_MEMORY = 4e9

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

    def part(self, work: int) -> None:
        """Hear of work that is done of the task that comes next to `advance`."""

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
    repair: bool = False,
    extend: bool = False,
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
    repair : bool
        Whether what is damaged or missing in the directory is to be computed again.
    extend : bool
        Whether to go on from the results of a design that this one contains.

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
    with Store(directory, kind, design, listener.note, repair=repair, extend=extend) as store:
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
    todo = Size.total(kind.size_of(task, design) for task in store.unfinished)
    whole = Size.total(kind.size_of(task, design) for task in store.tasks)
    workers.look()
    staged = _staged(workers, store)
    course = _Course(
        workers, [t for t in store.unfinished if t not in staged], _Tasks(kind, design)
    )
    course.send()
    listener.begin(kind.units, todo, whole, workers.now)
    for outcomes in _arrivals(course, workers, waiting):
        yield from store.add(outcomes)
    for task, parts in staged.items():
        work = kind.size_of(task, design).work
        error = _perform_stages(parts, work, workers, waiting, listener)
        outcome = parts.outcome() if error is None else kind.failed(task, design, error)
        yield from store.add([outcome])
        parts.close()


def _staged(workers: Workers, store: Store) -> dict[Any, StagedTask]:
    """Return the unfinished tasks that are too large for the workers, if they can be parted.

    Raises
    ------
    InputError
        If the disk has no room for one of them; nothing has been computed then.
    """
    largest = workers.largest if workers.now else _TYPICAL_MEMORY
    each = largest if workers.memory is None else min(largest, workers.memory / workers.now)
    staged = {}
    for task in store.unfinished:
        if not store.kind.is_at_once(task, store.design, largest):
            directory = store.directory / STAGES / "-".join(map(str, task))
            parts = store.kind.in_stages(task, store.design, directory, int(each))
            if parts is not None:
                parts.check_disk()
                staged[task] = parts
    return staged


def _perform_stages(
    parts: StagedTask, work: int, workers: Workers, waiting: Waiting, listener: Listener
) -> str | None:
    """Do all jobs of a task of some work; return why one could not be done, None if all were."""
    for stage in parts.stages():
        if stage.jobs:
            listener.note(f"{stage.words}.")
        jobs = [(job,) for job in stage.jobs]
        course = _Course(workers, jobs, _Jobs(parts, stage.name))
        for outcomes in _arrivals(course, workers, waiting):
            for outcome in outcomes:
                if outcome.error is not None:
                    return outcome.error
                listener.part(int(stage.share * work))
    return None


def _arrivals(course: "_Course", workers: Workers, waiting: Waiting) -> Iterator[list[Outcome]]:
    """Send what is left and yield what comes back, until nothing is left."""
    while True:
        missing = workers.look()
        course.send()
        if course.ended:
            return
        arrived = False
        for outcomes in course.arrivals():
            arrived = True
            yield outcomes
        if workers.client.status != "running":
            raise RunStoppedError(_LOST)
        waiting.look(None if arrived else missing or course.missing())
        if not arrived:
            sleep(_POLL_SECONDS)


class Work(Protocol):
    """What a course has workers do; picklable."""

    def perform(self, task: Any) -> Outcome:  # noqa: ANN401 - of the kind's own type, or a job
        """Perform a task."""

    def failed(self, task: Any, error: str) -> Outcome:  # noqa: ANN401 - as above
        """Return the outcome of a task that gave nothing at all."""

    def load_of(self, task: Any) -> Load:  # noqa: ANN401 - as above
        """Return what a task asks of a worker."""


@dataclass(frozen=True)
class _Tasks:
    """Tasks of a design."""

    kind: Kind
    design: Any

    def perform(self, task: Any) -> Outcome:  # noqa: ANN401 - of the kind's own type
        return self.kind.perform(task, self.design)

    def failed(self, task: Any, error: str) -> Outcome:  # noqa: ANN401 - as above
        return self.kind.failed(task, self.design, error)

    def load_of(self, task: Any) -> Load:  # noqa: ANN401 - as above
        memory = self.kind.memory_of(task, self.design).n_bytes
        return Load(self.kind.size_of(task, self.design).work, memory)


@dataclass(frozen=True)
class _Jobs:
    """Jobs of a stage of a task."""

    parts: StagedTask
    stage: str

    def perform(self, task: tuple[int]) -> Outcome:
        self.parts.perform(self.stage, *task)
        return Outcome(task)

    def failed(self, task: tuple[int], error: str) -> Outcome:
        return Outcome(task, error=error)

    def load_of(self, task: tuple[int]) -> Load:
        return Load(1, self.parts.memory)


class _Course:
    """The batches of some tasks on their way to workers and back."""

    def __init__(self, workers: Workers, tasks: Iterable[Any], work: Work) -> None:
        self._workers, self._work = workers, work
        self._batches = Batches(tasks, work.load_of, workers.memory)
        self._attempts: Counter[Any] = Counter()
        # Typed Any because this class of distributed has no annotations.
        self._futures: Any = cast(Any, as_completed)(
            loop=workers.client.loop, with_results=True, raise_errors=False
        )

    @property
    def ended(self) -> bool:
        """Whether nothing is left."""
        return not self._batches.under_way and not self._batches.n_waiting

    def missing(self) -> str | None:
        """Say what keeps the rest from being computed by the workers that there are."""
        memory = self._batches.smallest()
        if memory <= self._workers.largest:
            return None
        return f"a worker that has {in_words(memory)} for one task"

    def send(self) -> None:
        """Send as many batches as are to be under way, and again those that found no worker."""
        workers, under_way = self._workers, self._batches.under_way
        if (above := workers.stranded_above()) is not None:
            for future, batch in list(under_way.items()):
                if batch.memory > above:
                    self._batches.end(future)
                    future.release()
                    self._send(batch)
        largest = workers.largest if workers.now else inf
        while len(under_way) < workers.ahead * max(workers.now, 1):
            next_batch = self._batches.next(workers.now, largest)
            if next_batch is None:
                return
            self._send(next_batch)

    def arrivals(self) -> Iterator[list[Outcome]]:
        """Return what has come back of each batch, without what is tried again."""
        for future, result in self._futures.next_batch(block=False):
            if future not in self._batches.under_way:
                continue  # it was sent once more
            batch = self._batches.end(future)
            done = _done(future, result, batch.tasks, self._work)
            if done is None:
                if self._workers.client.status == "running":
                    self._send(batch)
                continue
            if done.seconds:
                self._batches.learn(len(batch.tasks), done.seconds, self._workers.now)
            yield [outcome for outcome in done.outcomes if not self._again(outcome)]

    def _again(self, outcome: Outcome) -> bool:
        """Have a task that has failed tried again, if it was not often enough."""
        if outcome.error is None:
            return False
        self._attempts[outcome.task] += 1
        if self._attempts[outcome.task] >= ATTEMPTS:
            return False
        self._batches.again(outcome.task)
        return True

    def _send(self, batch: Batch) -> None:
        future = self._workers.client.submit(
            perform_batch,
            batch.tasks,
            self._work,
            pure=False,  # a name of its own, whatever else runs at this scheduler
            resources=self._workers.resources(batch.memory),
        )
        self._batches.begin(future, batch)
        self._futures.add(future)


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


def perform_batch(tasks: Sequence[Any], work: Work) -> Done:
    """Perform tasks one after the other on a worker; an error is the outcome of its task alone."""
    start = perf_counter()
    worker = get_worker().address
    outcomes = []
    for task in tasks:
        try:
            outcome = work.perform(task)
        except Exception as error:
            outcome = work.failed(task, _in_words(error))
        outcomes.append(replace(outcome, worker=worker))
    return Done(outcomes, perf_counter() - start)


def _done(future: Future, result: object, tasks: Sequence[Any], work: Work) -> Done | None:
    """Return what a batch gave; None if its worker left with it, or the scheduler was lost."""
    if future.status == "finished":
        return cast(Done, result)
    if future.status == "error":
        _, error, _ = cast(tuple[type, BaseException, object], result)
        return Done([work.failed(task, _in_words(error)) for task in tasks], 0.0)
    return None


def _in_words(error: BaseException) -> str:
    # Its own words name the worker, and the results of a design must not depend on that.
    if isinstance(error, KilledWorker):
        return "KilledWorker: the workers that computed it died"
    return f"{type(error).__name__}: {error}"
