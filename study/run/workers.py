"""What a run needs of its workers, be they this computer's or a cluster's."""

from abc import ABC, abstractmethod
from typing import ClassVar

from distributed import Client


class Workers(ABC):
    """The workers of a run, looked at again and again while it goes on.

    Attributes
    ----------
    client : distributed.Client
        The cluster.
    ahead : int
        Batches that a thread has before it: one computed, one waiting there, one on its way; more
        where a cluster grows with what waits.
    memory : int or None
        Bytes for all tasks that are under way together; None if each worker has its own.
    largest : float
        Bytes for a task: what the largest of the workers has that are there.
    now, most : int
        Threads that take tasks, at the moment and at most so far.
    """

    ahead: ClassVar[int]
    client: Client
    memory: int | None = None
    largest: float = float("inf")
    now: int = 0
    most: int = 0

    @abstractmethod
    def look(self) -> str | None:
        """Look after the workers; return what has to be waited for, None if some can compute.

        Raises
        ------
        InputError
            If the design cannot be run on the workers that there are.
        """

    def resources(self, memory: int) -> dict[str, float]:
        """Return what a task that takes some bytes asks of a worker, as Dask has it."""
        return {}

    def stranded_above(self) -> float | None:
        """Return the bytes above which tasks sent so far had no worker, since this was last asked.

        Such tasks have to be sent once more, as the scheduler does not look at them again when a
        worker becomes fit for them. None if all had one.
        """
        return None
