"""Kinds of task: what a study can be made of, and what each of its tasks leaves in tables.

The runner, the store and the progress know a study by its kind alone: they name no measure and no
table. A kind is one module with a task, measures and a way to perform the task, and a line in
`study.run.registry`.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Generic, NamedTuple, Protocol, Self, TypeVar

import pyarrow as pa

#: The column that says why a row could not be had; null in a row that could.
ERROR = "error"
#: The column that says which worker made a row.
WORKER = "worker"

Cells = tuple[Any, ...]
"""The cells of a row: those of the table's columns, in order, without the columns that are fields
of the task and without that of the worker."""


class StudyDesign(Protocol):
    """What the runner and the store need of a design, whatever its kind."""

    def model_dump(self, *, mode: str) -> dict[str, Any]:
        """Return the settings by name, as JSON has them."""

    def difference(self, other: Any) -> str | None:  # noqa: ANN401 - a design of the same kind
        """Say how another design of this kind differs; None if it does not."""

    @classmethod
    def from_settings(cls, settings: dict[str, Any], where: str = ...) -> Self:
        """Check settings and make a design of them, or raise `InputError`."""


Task = TypeVar("Task", bound=tuple)
D = TypeVar("D", bound=StudyDesign)


@dataclass(frozen=True)
class Outcome(Generic[Task]):
    """What one task gave.

    Attributes
    ----------
    task : Task
        The task, a named tuple.
    rows : dict of str to list of tuple
        Rows by the name of their table, each the `Cells` of one.
    seconds : float
        The task's own time.
    worker : str
        Address of the worker.
    error : str or None
        Why something of the task, or all of it, could not be had; it is then tried again.
    """

    task: Task
    rows: dict[str, list[Cells]] = field(default_factory=dict)
    seconds: float = 0.0
    worker: str = ""
    error: str | None = None


@dataclass(frozen=True)
class ResultTable:
    """One of the tables that the tasks of a kind fill.

    Attributes
    ----------
    schema : pyarrow.Schema
        Its columns, all fields of the task among them.
    reproducible : bool
        Whether the design alone decides its bytes, so that a checksum can be kept of them.
    """

    schema: pa.Schema
    reproducible: bool = True


class Size(NamedTuple):
    """How much there is of something: in `Kind.units`.

    Attributes
    ----------
    parts : int
        What the user counts, such as triangulations.
    work : int
        What the time goes with, such as points.
    """

    parts: int
    work: int

    @classmethod
    def total(cls, sizes: Iterable["Size"]) -> "Size":
        """Add sizes."""
        parts = work = 0
        for size in sizes:
            parts += size.parts
            work += size.work
        return cls(parts, work)


class Memory(NamedTuple):
    """Memory that a task takes.

    Attributes
    ----------
    what : str
        What takes it, as the beginning of a sentence.
    n_bytes : int
    """

    what: str
    n_bytes: int


class Stage(NamedTuple):
    """Jobs of a task that can be done in any order, and side by side.

    Attributes
    ----------
    name : str
    words : str
        What is done, as a sentence without its full stop.
    jobs : list of int
        Those that are left to do.
    share : float
        The share of the task's time that each of them takes.
    """

    name: str
    words: str
    jobs: list[int]
    share: float


class StagedTask(Protocol):
    """A task that takes more memory than a worker has, in stages of jobs.

    Workers do the jobs, so it has to be picklable. What jobs leave to each other are files.
    """

    @property
    def memory(self) -> int:
        """Bytes that each job takes."""

    def check_disk(self) -> None:
        """Raise `InputError` if there is no room for the files that are not there yet."""

    def stages(self) -> Iterator[Stage]:
        """Yield the stages; the next is asked for when all jobs of the last are done."""

    def perform(self, name: str, job: int) -> None:
        """Do a job of a stage."""

    def outcome(self) -> Outcome:
        """Return the outcome of the task, when all is done."""

    def close(self) -> None:
        """Remove the files."""


class Kind(ABC, Generic[Task, D]):
    """A kind of task. It has no state: workers know it by its name.

    Attributes
    ----------
    name : str
        In manifests.
    design : type
        Of its designs.
    task : type
        Of its tasks, a named tuple.
    tables : mapping of str to ResultTable
        What its tasks fill, by name.
    units : (str, str)
        Plurals of what a `Size` counts.
    preparing : str
        A sentence that says what `prepare` does, for when it takes long.
    base_memory : int
        Bytes that a worker takes beside its task.
    """

    name: ClassVar[str]
    design: type[D]
    task: type[Task]
    tables: Mapping[str, ResultTable]
    units: ClassVar[tuple[str, str]]
    preparing: ClassVar[str]
    base_memory: ClassVar[int] = 0

    @abstractmethod
    def tasks_of(self, design: D) -> list[Task]:
        """Return the tasks of a design in the order of its results."""

    def contains(self, design: D, other: D) -> bool:
        """Tell whether a design has all tasks of another, with the same outcomes."""
        return False

    @abstractmethod
    def perform(self, task: Task, design: D) -> Outcome[Task]:
        """Perform a task; what comes out depends on the arguments alone, times apart."""

    @abstractmethod
    def failed(self, task: Task, design: D, error: str) -> Outcome[Task]:
        """Return the outcome of a task that gave nothing at all."""

    @abstractmethod
    def size_of(self, task: Task, design: D) -> Size:
        """Return the size of a task."""

    @abstractmethod
    def memory_of(self, task: Task, design: D) -> Memory:
        """Return the memory that a task takes, without that of the process."""

    def is_at_once(self, task: Task, design: D, memory: float) -> bool:
        """Tell whether a task can be done at once where it may take some bytes."""
        return self.memory_of(task, design).n_bytes <= memory

    def least_memory_of(self, task: Task, design: D) -> Memory:
        """Return the memory that a task can do with: where it can be done in stages, of a job."""
        return self.memory_of(task, design)

    def in_stages(self, task: Task, design: D, directory: Path, memory: int) -> StagedTask | None:
        """Return a task as stages of jobs; None if it can only be done at once.

        Parameters
        ----------
        task : Task
        design : D
        directory : Path
            For its files; of this task alone, and there.
        memory : int
            Bytes that a job may take.
        """
        return None

    @abstractmethod
    def prepare(self, design: D, memory: float) -> None:
        """Do what is done once on a computer, before its workers start.

        Parameters
        ----------
        design : D
            What will be run.
        memory : float
            Bytes that a task may take.
        """

    def order_of(self, design: D) -> Mapping[str, Sequence[object]]:
        """Return columns by which the rows of all tables are ordered before the tasks.

        Returns
        -------
        mapping of str to sequence
            The values of each column, in order.
        """
        return {}
