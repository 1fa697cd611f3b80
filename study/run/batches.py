"""Batches: how many tasks are sent to a worker together, and which fit into memory next."""

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf
from typing import Any, NamedTuple

#: A batch is to take about as long: the first result comes soon, a lost worker costs little.
BATCH_SECONDS = 1.0

#: Batches in a second that one client can follow; with more threads they are longer.
_BATCHES_A_SECOND = 100

#: A batch has at most as many times the tasks of one whose time is known.
_GROWTH = 8

#: The last batches are smaller, so that no worker is left with a long one at the end.
_LAST_SHARE = 4


class Load(NamedTuple):
    """What a task asks of a worker.

    Attributes
    ----------
    work : int
        What its time goes with, such as points.
    memory : int
        Bytes.
    """

    work: int
    memory: int


@dataclass(frozen=True)
class Batch:
    """Tasks that a worker performs one after the other.

    Attributes
    ----------
    tasks : list
        Of the study's kind.
    memory : int
        Bytes that the largest of them takes.
    """

    tasks: list[Any]
    memory: int


class Batches:
    """The batches that wait to be sent, the largest tasks first.

    How long tasks take is told by the batches that have ended: as the largest come first, the next
    ones take hardly longer.

    Parameters
    ----------
    tasks : iterable
        The tasks.
    load_of : callable
        Returns the `Load` of a task.
    memory : float, optional
        Bytes for all tasks that are under way together; no limit if not given. A task that is
        larger runs when no other does.
    """

    def __init__(
        self, tasks: Iterable[Any], load_of: Callable[[Any], Load], memory: float | None = None
    ) -> None:
        self._load_of = load_of
        self._limit = inf if memory is None else memory
        #: By what names it, such as a future.
        self.under_way: dict[Any, Batch] = {}
        self._held = 0
        self._n_waiting = 0
        #: What waits once more, each by itself, and the rest, the largest first.
        self._again: deque[Batch] = deque()
        waiting: dict[Load, deque[Any]] = {}
        for task in tasks:
            waiting.setdefault(load_of(task), deque()).append(task)
            self._n_waiting += 1
        self._waiting = dict(sorted(waiting.items(), reverse=True))
        #: Tasks in a batch, so far as known.
        self._n_tasks = 1.0

    @property
    def n_waiting(self) -> int:
        """Tasks that are not under way."""
        return self._n_waiting + len(self._again)

    def smallest(self) -> float:
        """Return the bytes that the least of what is left takes; 0 if nothing is left."""
        batches = (batch.memory for batch in (*self.under_way.values(), *self._again))
        return min((*batches, *(load.memory for load in self._waiting)), default=0)

    def next(self, n_threads: int, largest: float = inf) -> Batch | None:
        """Return the next batch that fits beside those under way; None if none does.

        Parameters
        ----------
        n_threads : int
            Tasks that are performed at a time.
        largest : float
            Bytes that one task may take.
        """
        free = min(self._limit - self._held if self.under_way else inf, largest)
        for batch in self._again:
            if batch.memory <= free:
                self._again.remove(batch)
                return batch
        number = round(min(self._n_tasks, self._n_waiting / (_LAST_SHARE * max(n_threads, 1))))
        tasks: list[Any] = []
        largest_taken = 0
        for load in [load for load in self._waiting if load.memory <= free]:
            waiting = self._waiting[load]
            while waiting and (not tasks or len(tasks) < number):
                tasks.append(waiting.popleft())
                largest_taken = max(largest_taken, load.memory)
            if waiting:
                break
            del self._waiting[load]
        self._n_waiting -= len(tasks)
        return Batch(tasks, largest_taken) if tasks else None

    def begin(self, key: Any, batch: Batch) -> None:  # noqa: ANN401 - whatever names it
        """Note that a batch is under way."""
        self.under_way[key] = batch
        self._held += batch.memory

    def end(self, key: Any) -> Batch:  # noqa: ANN401 - whatever names it
        """Note that a batch is under way no more, and return it."""
        batch = self.under_way.pop(key)
        self._held -= batch.memory
        return batch

    def learn(self, n_tasks: int, seconds: float, n_threads: int) -> None:
        """Hear how long tasks of one batch took on their worker."""
        wanted = BATCH_SECONDS * max(1.0, n_threads / _BATCHES_A_SECOND)
        self._n_tasks = min(wanted / max(seconds, 1e-9), _GROWTH) * n_tasks

    def again(self, task: Any) -> None:  # noqa: ANN401 - of the study's kind
        """Have a task wait once more, by itself and before the others."""
        self._again.append(Batch([task], self._load_of(task).memory))
