"""Batches: tasks that are sent to a worker together, and which of them fits into memory next."""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

#: Tasks of less work (such as points) than this are sent several at a time.
BATCH_WORK = 2_000_000

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

    Parameters
    ----------
    tasks : sequence of (task, Load)
    n_threads : int
        Tasks that are performed at a time, so far as memory allows.
    memory : int, optional
        Bytes for all tasks that are under way together; no limit if not given. A task that is
        larger runs when no other does.
    """

    def __init__(
        self, tasks: Sequence[tuple[Any, Load]], n_threads: int, memory: int | None = None
    ) -> None:
        self._limit = memory
        self._under_way: dict[Any, Batch] = {}
        #: By memory, the largest first; few tasks differ in it.
        self._waiting: dict[int, deque[Batch]] = {}
        for batch in _divided(tasks, n_threads):
            self._waiting.setdefault(batch.memory, deque()).append(batch)

    def __len__(self) -> int:
        """Count the batches under way."""
        return len(self._under_way)

    def next(self) -> Batch | None:
        """Return the first waiting batch that fits beside those under way; None if none does."""
        held = sum(batch.memory for batch in self._under_way.values())
        for memory, waiting in self._waiting.items():
            fits = self._limit is None or not held or held + memory <= self._limit
            if waiting and fits:
                return waiting.popleft()
        return None

    def begin(self, key: Any, batch: Batch) -> None:  # noqa: ANN401 - whatever names it
        """Note that a batch is under way."""
        self._under_way[key] = batch

    def end(self, key: Any) -> Batch:  # noqa: ANN401 - whatever names it
        """Note that a batch is under way no more, and return it."""
        return self._under_way.pop(key)

    def again(self, task: Any, memory: int) -> None:  # noqa: ANN401 - of the study's kind
        """Have a task wait once more, by itself and before the others of its size."""
        self._waiting.setdefault(memory, deque()).appendleft(Batch([task], memory))


def _divided(tasks: Sequence[tuple[Any, Load]], n_threads: int) -> Iterator[Batch]:
    """Divide tasks into batches, the largest tasks first."""
    remaining = sum(load.work for _, load in tasks)
    batch: list[Any] = []
    in_batch = memory = 0
    limit = min(BATCH_WORK, remaining // (_LAST_SHARE * n_threads))
    for task, load in sorted(tasks, key=lambda entry: -entry[1].work):
        if batch and in_batch + load.work > limit:
            yield Batch(batch, memory)
            remaining -= in_batch
            limit = min(BATCH_WORK, remaining // (_LAST_SHARE * n_threads))
            batch, in_batch, memory = [], 0, 0
        batch.append(task)
        in_batch += load.work
        memory = max(memory, load.memory)
    if batch:
        yield Batch(batch, memory)
