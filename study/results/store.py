"""The results directory: what a run leaves behind, readable and resumable after any death.

While a run goes on, ``manifest.json`` says that it is incomplete, and ``journal.jsonl`` holds what
is finished. At the end the Parquet files are written, then the manifest that says so and holds
their checksums, then the journal is removed (it stays if tasks failed, so that they can be tried
again). Whole files only ever appear by renaming. So at any moment either the manifest is complete
and the Parquet files are the truth, or it is not and the journal is.
"""

import hashlib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from lepp import InputError
from study.results.directory import check_ours, locked, writing
from study.results.files import leftovers
from study.results.journal import Journal, outcomes_at, read_journal, write_journal
from study.results.manifest import (
    FORMAT,
    MANIFEST,
    Manifest,
    environment,
    read_manifest,
    write_manifest,
)
from study.results.schema import frame_of, outcomes_of, tables_of
from study.results.tables import write_tables
from study.run.kinds import Kind, Outcome, ResultTable

JOURNAL = "journal.jsonl"


@dataclass(frozen=True)
class Results:
    """What a results directory holds.

    Attributes
    ----------
    frames : dict of str to pandas.DataFrame
        By the names of `kind.tables`; ``results["…"]`` is the same.
    manifest : dict
        Design, environment, completeness.
    kind : Kind
        The kind of the tasks.
    design : kind.design
        The design.
    complete : bool
        Whether every task has its rows, be they those of a failure.
    """

    frames: dict[str, pd.DataFrame]
    manifest: dict[str, Any]
    kind: Kind
    design: Any
    complete: bool

    def __getitem__(self, table: str) -> pd.DataFrame:
        return self.frames[table]


def load(directory: Path | str) -> Results:
    """Read a results directory, of a complete or an incomplete run.

    Raises
    ------
    InputError
        If the directory is not a results directory, or a file in it was cut short or edited.
    """
    directory = Path(directory)
    # A run may begin or finish meanwhile: then its manifest changes, and files that go with it.
    while True:
        manifest = read_manifest(directory)
        try:
            tables = _read_tables(directory, manifest)
        except InputError:
            if read_manifest(directory).text == manifest.text:
                raise
            continue
        if read_manifest(directory).text == manifest.text:
            break
    return Results(
        {name: frame_of(table) for name, table in tables.items()},
        manifest.content,
        manifest.kind,
        manifest.design,
        manifest.complete,
    )


def design_of(directory: Path | str) -> tuple[Kind, Any] | None:
    """Return kind and design of a results directory, or None if there is no such directory yet."""
    directory = Path(directory)
    if not (directory / MANIFEST).exists():
        return None
    manifest = read_manifest(directory)
    return manifest.kind, manifest.design


class Store:
    """A results directory that a run writes into; a context manager.

    Parameters
    ----------
    directory : Path
        Made if it does not exist. A run that was cut short is taken up again.
    kind : Kind
        The kind of the tasks.
    design : kind.design
        The design of the run.
    note : callable, optional
        Takes a sentence about something out of the ordinary.
    repair : bool
        Whether what is damaged or missing is to be computed again.
    extend : bool
        Whether the results of a design that this one contains are to be gone on from.

    Raises
    ------
    InputError
        If the directory holds something else, another design or damaged files, if another run is
        writing into it, or if it cannot be written.
    """

    def __init__(
        self,
        directory: Path,
        kind: Kind,
        design: Any,  # noqa: ANN401 - of the kind's own type
        note: Callable[[str], None] = lambda sentence: None,
        *,
        repair: bool = False,
        extend: bool = False,
    ) -> None:
        self.directory = directory
        self.kind = kind
        self.design = design
        self.tasks = kind.tasks_of(design)
        #: Where in the journal each outcome begins; they may be too many to hold.
        self._places: dict[Any, int] = {}
        self._failed: dict[Any, Outcome] = {}
        self._environments = [environment()]
        #: Open while there are tasks to run.
        self._journal: Journal | None = None
        with writing(directory):
            if directory.exists():
                check_ours(directory)
            directory.mkdir(parents=True, exist_ok=True)
            self._lock = locked(directory, note)
        try:
            with writing(directory):
                self._open(note, repair=repair, extend=extend)
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the directory; what was added stays in it."""
        try:
            if self._journal is not None:
                with writing(self.directory):
                    self._journal.close()
                self._journal = None
        finally:
            # The file stays: removing it would let two runs hold two locks.
            self._lock.release()

    def _open(self, note: Callable[[str], None], *, repair: bool, extend: bool) -> None:
        for name in (MANIFEST, JOURNAL, *map(_file, self.kind.tables)):
            for leftover in leftovers(self.directory / name):
                leftover.unlink()
        complete = extended = False
        if (self.directory / MANIFEST).exists():
            manifest = read_manifest(self.directory)
            extended = self._is_extended(manifest, extend=extend)
            now = self._environments[0]
            self._environments += [e for e in manifest.content["environments"] if e != now]
            complete = manifest.complete
        journal = self.directory / JOURNAL
        if complete:
            try:
                _check_files(self.directory, manifest.content["sha256"])
            except InputError as error:
                if not repair:
                    raise
                note(f"{error} Its study is computed again.")
                complete = False
        if complete and manifest.content["failed"] == 0 and not extended:
            journal.unlink(missing_ok=True)
            return
        self._read_journal(note if repair else None)
        if complete and len(self._places) < len(self.tasks):
            # From the next manifest on, the journal is the truth: it must hold all.
            outcomes = outcomes_of(self.kind, _read_tables(self.directory, manifest))
            outcomes |= _outcomes_in(self.directory, self.kind, set(self.tasks))
            write_journal(journal, outcomes.values())
            self._read_journal(None)
        self._write_manifest(complete=False)
        self._journal = Journal(journal)

    def _read_journal(self, note: Callable[[str], None] | None) -> None:
        """Learn what the journal holds; with a note, its damaged lines are left out for good."""
        journal = self.directory / JOURNAL
        if not journal.exists():
            return
        damaged: list[str] = []
        hear = None if note is None else damaged.append
        for place, outcome in _kept(journal, self.kind, set(self.tasks), hear):
            self._keep(outcome, place)
        if damaged and note is not None:
            note(f"{len(damaged):,} damaged lines of {journal} are left out and computed again.")
            write_journal(journal, outcomes_at(journal, self.kind, self._places.values()))
            self._places, self._failed = {}, {}
            self._read_journal(None)

    def _keep(self, outcome: Outcome, place: int) -> None:
        self._places[outcome.task] = place
        if outcome.error is not None:
            self._failed[outcome.task] = outcome
        else:
            self._failed.pop(outcome.task, None)

    def _is_extended(self, manifest: Manifest, *, extend: bool) -> bool:
        """Tell whether the results are of a design that this one contains.

        Raises
        ------
        InputError
            If they are of another study, or are not to be gone on from.
        """
        if self._has_nothing(manifest):
            return False
        contained = False
        if manifest.kind.name != self.kind.name:
            difference: str | None = f"{manifest.kind.name} there and {self.kind.name} here"
        else:
            difference = manifest.design.difference(self.design)
            contained = self.kind.contains(self.design, manifest.design)
        if difference and not (extend and contained):
            what_to_do = (
                "give another directory, or --extend to go on from them."
                if contained
                else "give another directory."
            )
            raise InputError(
                f"{self.directory} holds the results of another design ({difference}): {what_to_do}"
            )
        return difference is not None

    def _has_nothing(self, manifest: Manifest) -> bool:
        """Whether the run of a manifest ended before its first result, for example in an error."""
        journal = self.directory / JOURNAL
        return not manifest.complete and (not journal.exists() or journal.stat().st_size == 0)

    @property
    def unfinished(self) -> list[Any]:
        """The tasks that have no outcome yet or have failed, in the order of the results."""
        if self._journal is None:
            return []
        return [task for task in self.tasks if not self._succeeded(task)]

    def _succeeded(self, task: Any) -> bool:  # noqa: ANN401 - of the kind's own type
        return task in self._places and task not in self._failed

    def add(self, outcomes: Iterable[Outcome]) -> list[Outcome]:
        """Keep outcomes; they are in the journal when this returns.

        Parameters
        ----------
        outcomes : iterable of Outcome
            In any order. A task that has succeeded before is not kept again.

        Returns
        -------
        new : list of Outcome
            Those that were kept.
        """
        assert self._journal is not None, "a finished store takes no outcomes"
        new: dict[Any, Outcome] = {}
        for outcome in outcomes:
            known = new.get(outcome.task)
            if not self._succeeded(outcome.task) and (known is None or known.error is not None):
                new[outcome.task] = outcome
        with writing(self.directory):
            places = self._journal.append(new.values())
        for outcome, place in zip(new.values(), places, strict=True):
            self._keep(outcome, place)
        return list(new.values())

    def finish(self) -> None:
        """Write the result files of a run whose tasks all have an outcome."""
        if self._journal is None:
            return
        places = [self._places[task] for task in self.tasks]
        outcomes = outcomes_at(self.directory / JOURNAL, self.kind, places)
        paths = {name: self.directory / _file(name) for name in self.kind.tables}
        with writing(self.directory):
            write_tables(self.kind, self.design, outcomes, paths)
            self._write_manifest(complete=True)
            self._journal.close()
            self._journal = None
            if not self._failed:
                (self.directory / JOURNAL).unlink()

    @property
    def failures(self) -> list[Outcome]:
        """The outcomes of the tasks that failed, in the order of the results."""
        if not self._failed:
            return []
        return [self._failed[task] for task in self.tasks if task in self._failed]

    def _write_manifest(self, *, complete: bool) -> None:
        manifest: dict[str, Any] = {
            "format": FORMAT,
            "kind": self.kind.name,
            "complete": complete,
            "tasks": len(self.tasks),
            "design": self.design.model_dump(mode="json"),
        }
        if complete:
            manifest["failed"] = len(self._failed)
            manifest["sha256"] = {
                _file(name): _sha256(self.directory / _file(name))
                for name, table in self.kind.tables.items()
                if table.reproducible
            }
        manifest["environments"] = self._environments
        write_manifest(self.directory, manifest)


def _file(table: str) -> str:
    return f"{table}.parquet"


def _read_tables(directory: Path, manifest: Manifest) -> dict[str, pa.Table]:
    if manifest.complete:
        _check_files(directory, manifest.content["sha256"])
        return {
            name: _read_parquet(directory / _file(name), table)
            for name, table in manifest.kind.tables.items()
        }
    tasks = manifest.kind.tasks_of(manifest.design)
    outcomes = _outcomes_in(directory, manifest.kind, set(tasks))
    in_order = [outcomes[task] for task in tasks if task in outcomes]
    return tables_of(manifest.kind, manifest.design, in_order)


def _outcomes_in(directory: Path, kind: Kind, tasks: set[Any]) -> dict[Any, Outcome]:
    """Read the outcomes of a journal; none if there is none."""
    path = directory / JOURNAL
    try:
        return {outcome.task: outcome for _, outcome in _kept(path, kind, tasks)}
    except FileNotFoundError:
        return {}


def _kept(
    path: Path, kind: Kind, tasks: set[Any], damaged: Callable[[str], None] | None = None
) -> Iterator[tuple[int, Outcome]]:
    """Read places and outcomes of a journal, without those that follow a success of their task.

    The last that comes of a task is the one that counts: its first success, or its last failure.
    """
    succeeded = set()
    for place, outcome in read_journal(path, kind, damaged):
        if outcome.task not in tasks:
            raise InputError(
                f"{path} holds a task that is not in the design ({outcome.task}): run the study in "
                "a new directory."
            )
        if outcome.task not in succeeded:
            yield place, outcome
        if outcome.error is None:
            succeeded.add(outcome.task)


def _check_files(directory: Path, sha256: dict[str, str]) -> None:
    for name, expected in sha256.items():
        path = directory / name
        if not path.exists():
            raise InputError(f"{path} is missing: restore it, or run with --repair.")
        if _sha256(path) != expected:
            raise InputError(
                f"{path} was cut short or edited since its run (its checksum differs): restore it, "
                "or run with --repair."
            )


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _read_parquet(path: Path, table: ResultTable) -> pa.Table:
    """Read a table; one that no result depends on may be lost."""
    try:
        return pq.read_table(path, schema=table.schema)
    except (OSError, pa.ArrowException) as error:
        if not table.reproducible:
            return table.schema.empty_table()
        raise InputError(
            f"{path} cannot be read ({str(error).splitlines()[0]}): restore it, or run with "
            "--repair."
        ) from None
