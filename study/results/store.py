"""The results directory: what a run leaves behind, readable and resumable after any death.

While a run goes on, ``manifest.json`` says that it is incomplete, and ``journal.jsonl`` holds what
is finished. At the end the Parquet files are written, then the manifest that says so and holds
their checksums, then the journal is removed (it stays if tasks failed, so that they can be tried
again). Whole files only ever appear by renaming. So at any moment either the manifest is complete
and the Parquet files are the truth, or it is not and the journal is.
"""

import errno
import hashlib
import json
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from filelock import FileLock, Timeout

from lepp import InputError
from study.results.files import leftovers, replacing, write_text
from study.results.journal import Journal, journal_text, read_journal
from study.results.manifest import FORMAT, MANIFEST, Manifest, environment, read_manifest
from study.results.schema import frame_of, outcomes_of, tables_of
from study.run.kinds import Kind, Outcome

JOURNAL = "journal.jsonl"
LOCK = ".lock"

#: What file managers leave wherever they have been.
_NOBODYS = {".DS_Store", "Thumbs.db", "desktop.ini"}

#: What file systems without locks say to a request for one.
_NO_LOCKS = {errno.ENOSYS, errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP}


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
    ) -> None:
        self.directory = directory
        self.kind = kind
        self.design = design
        self.tasks = kind.tasks_of(design)
        self._outcomes: dict[Any, Outcome] = {}
        self._environments = [environment()]
        #: Open while there are tasks to run.
        self._journal: Journal | None = None
        with _writing(directory):
            if directory.exists():
                _check_ours(directory)
            directory.mkdir(parents=True, exist_ok=True)
            self._lock = _locked(directory, note)
        try:
            with _writing(directory):
                self._open()
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
                with _writing(self.directory):
                    self._journal.close()
                self._journal = None
        finally:
            # The file stays: removing it would let two runs hold two locks.
            self._lock.release()

    def _open(self) -> None:
        for name in (MANIFEST, JOURNAL, *map(_file, self.kind.tables)):
            for leftover in leftovers(self.directory / name):
                leftover.unlink()
        complete = False
        if (self.directory / MANIFEST).exists():
            manifest = read_manifest(self.directory)
            self._check_same(manifest)
            now = self._environments[0]
            self._environments += [e for e in manifest.content["environments"] if e != now]
            complete = manifest.complete
        journal = self.directory / JOURNAL
        if complete:
            tables = _read_tables(self.directory, manifest)
            if manifest.content["failed"] == 0:
                journal.unlink(missing_ok=True)
                return
            self._outcomes = outcomes_of(self.kind, tables)
        in_journal = _read_journal(self.directory, self.kind, set(self.tasks))
        for task, outcome in in_journal.items():
            known = self._outcomes.get(task)
            if outcome.error is None or known is None or known.error is not None:
                self._outcomes[task] = outcome
        # From the next manifest on, the journal is the truth: it must hold all.
        if any(in_journal.get(task) is not outcome for task, outcome in self._outcomes.items()):
            write_text(journal, journal_text(self._outcomes.values()))
        self._write_manifest(complete=False)
        self._journal = Journal(journal)

    def _check_same(self, manifest: Manifest) -> None:
        """Refuse to write where the results of another study are."""
        if self._has_nothing(manifest):
            return
        if manifest.kind.name != self.kind.name:
            difference: str | None = f"{manifest.kind.name} there and {self.kind.name} here"
        else:
            difference = manifest.design.difference(self.design)
        if difference:
            raise InputError(
                f"{self.directory} holds the results of another design ({difference}): give "
                "another directory."
            )

    def _has_nothing(self, manifest: Manifest) -> bool:
        """Whether the run of a manifest ended before its first result, for example in an error."""
        journal = self.directory / JOURNAL
        return not manifest.complete and (not journal.exists() or journal.stat().st_size == 0)

    @property
    def unfinished(self) -> list[Any]:
        """The tasks that have no outcome yet or have failed, in the order of the results."""
        if self._journal is None:
            return []
        return [
            task
            for task in self.tasks
            if task not in self._outcomes or self._outcomes[task].error is not None
        ]

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
        new = []
        for outcome in outcomes:
            known = self._outcomes.get(outcome.task)
            if known is None or known.error is not None:
                self._outcomes[outcome.task] = outcome
                new.append(outcome)
        with _writing(self.directory):
            self._journal.append(new)
        return new

    def finish(self) -> None:
        """Write the result files of a run whose tasks all have an outcome."""
        if self._journal is None:
            return
        outcomes = [self._outcomes[task] for task in self.tasks]
        with _writing(self.directory):
            for name, table in tables_of(self.kind, self.design, outcomes).items():
                with replacing(self.directory / _file(name)) as path:
                    pq.write_table(table, path, compression="zstd")
            self._write_manifest(complete=True)
            self._journal.close()
            self._journal = None
            if not self.failures:
                (self.directory / JOURNAL).unlink()

    @property
    def failures(self) -> list[Outcome]:
        """The outcomes of the tasks that failed, in the order of the results."""
        known = (self._outcomes.get(task) for task in self.tasks)
        return [outcome for outcome in known if outcome is not None and outcome.error is not None]

    def _write_manifest(self, *, complete: bool) -> None:
        manifest: dict[str, Any] = {
            "format": FORMAT,
            "kind": self.kind.name,
            "complete": complete,
            "tasks": len(self.tasks),
            "design": self.design.model_dump(mode="json"),
        }
        if complete:
            manifest["failed"] = len(self.failures)
            manifest["sha256"] = {
                _file(name): _sha256(self.directory / _file(name))
                for name, table in self.kind.tables.items()
                if table.reproducible
            }
        manifest["environments"] = self._environments
        write_text(self.directory / MANIFEST, json.dumps(manifest, indent=2) + "\n")


def _file(table: str) -> str:
    return f"{table}.parquet"


def _locked(directory: Path, note: Callable[[str], None]) -> FileLock:
    """Keep every other run out of a directory until the lock is released or its holder dies."""
    # No file that only means to be a lock: it would outlive a run that is killed.
    lock = FileLock(directory / LOCK, blocking=False, thread_local=False, fallback_to_soft=False)
    try:
        lock.acquire()
    except Timeout:
        raise InputError(
            f"Another run is writing into {directory}: wait for its end, or give another directory."
        ) from None
    except OSError as error:
        if error.errno not in _NO_LOCKS:
            raise
        note(
            f"The file system of {directory} has no locks: see to it that no other run writes "
            "there meanwhile."
        )
    return lock


def _check_ours(directory: Path) -> None:
    """Refuse a directory with files in it that no run has left there."""
    if not directory.is_dir():
        raise InputError(f"{directory} is a file: give a directory for the results.")
    names = {path.name for path in directory.iterdir()}
    # A run that is killed before it has written its manifest leaves these.
    ours = {LOCK, *(path.name for path in leftovers(directory / MANIFEST))}
    if MANIFEST not in names and names - ours - _NOBODYS:
        raise InputError(
            f"{directory} is not empty and holds no results of lepp-study: give another directory."
        )


def _read_tables(directory: Path, manifest: Manifest) -> dict[str, pa.Table]:
    if manifest.complete:
        _check_files(directory, manifest.content["sha256"])
        return {
            name: _read_parquet(directory / _file(name), table.schema)
            for name, table in manifest.kind.tables.items()
        }
    tasks = manifest.kind.tasks_of(manifest.design)
    outcomes = _read_journal(directory, manifest.kind, set(tasks))
    in_order = [outcomes[task] for task in tasks if task in outcomes]
    return tables_of(manifest.kind, manifest.design, in_order)


def _read_journal(directory: Path, kind: Kind, tasks: set[Any]) -> dict[Any, Outcome]:
    """Read the outcomes of a journal, of each task the first success or the last failure."""
    path = directory / JOURNAL
    try:
        lines = read_journal(path, kind)
    except FileNotFoundError:
        return {}
    outcomes: dict[Any, Outcome] = {}
    for outcome in lines:
        if outcome.task not in tasks:
            raise InputError(
                f"{path} holds a task that is not in the design ({outcome.task}): run the study in "
                "a new directory."
            )
        known = outcomes.get(outcome.task)
        if known is None or known.error is not None:
            outcomes[outcome.task] = outcome
    return outcomes


def _check_files(directory: Path, sha256: dict[str, str]) -> None:
    for name, expected in sha256.items():
        path = directory / name
        if not path.exists():
            raise InputError(f"{path} is missing: restore it, or run the study in a new directory.")
        if _sha256(path) != expected:
            raise InputError(
                f"{path} was cut short or edited since its run (its checksum differs): restore it, "
                "or run the study in a new directory."
            )


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _read_parquet(path: Path, schema: pa.Schema) -> pa.Table:
    try:
        return pq.read_table(path, schema=schema)
    except (OSError, pa.ArrowException) as error:
        raise InputError(
            f"{path} cannot be read ({str(error).splitlines()[0]}): restore it, or run the study "
            "in a new directory."
        ) from None


@contextmanager
def _writing(directory: Path) -> Iterator[None]:
    """Turn failures to write into sentences."""
    try:
        yield
    except OSError as error:
        raise InputError(f"Cannot write into {directory}: {error.strerror or error}.") from None
