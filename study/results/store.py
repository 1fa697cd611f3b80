"""The results directory: what a run leaves behind, readable and resumable after any death.

While a run goes on, ``manifest.json`` says that it is incomplete, and ``journal.jsonl`` holds what
is finished. At the end the Parquet files are written, then the manifest that says so and holds
their checksums, then the journal is removed (it stays if tasks failed, so that they can be tried
again). Whole files only ever appear by renaming. So at any moment either the manifest is complete
and the Parquet files are the truth, or it is not and the journal is.
"""

import hashlib
import json
import os
import platform
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any, Self

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from lepp import InputError
from study.results import lock
from study.results.schema import MEASURES, SCHEMAS, tables_of
from study.design.design import Design
from study.run.experiment import Outcome, Task, tasks_of
from study.results.journal import Journal, read_journal

FORMAT = 1
MANIFEST = "manifest.json"
JOURNAL = "journal.jsonl"

#: Packages whose versions can change a number, or a byte, of the results or the report.
_PACKAGES = (
    "lepp-study",
    "numpy",
    "scipy",
    "numba",
    "llvmlite",
    "pandas",
    "pyarrow",
    "statsmodels",
    "dask",
    "distributed",
)

#: Files whose bytes the design alone decides; the manifest holds their checksums.
_CHECKED = ("results", "histograms", "regions")


@dataclass(frozen=True)
class Results:
    """What a results directory holds.

    Attributes
    ----------
    results, histograms, regions, timings : pandas.DataFrame
        One row a task; one a task and LEPP size; one a task and region size; one a task.
    manifest : dict
        Design, environment, completeness.
    design : Design
        The design.
    complete : bool
        Whether every task has a row, be it that of a failure.
    """

    results: pd.DataFrame
    histograms: pd.DataFrame
    regions: pd.DataFrame
    timings: pd.DataFrame
    manifest: dict[str, Any]
    design: Design
    complete: bool


def load(directory: Path | str) -> Results:
    """Read a results directory, of a complete or an incomplete run.

    Raises
    ------
    InputError
        If the directory is not a results directory, or a file in it was cut short or edited.
    """
    directory = Path(directory)
    manifest, design = _read_manifest(directory)
    if not (manifest["complete"] or (directory / JOURNAL).exists()):
        # A run may have finished since the manifest was read.
        manifest, design = _read_manifest(directory)
    if manifest["complete"]:
        _check_files(directory, manifest)
        tables = {name: _read_parquet(directory / f"{name}.parquet") for name in SCHEMAS}
    else:
        outcomes = _read_outcomes(directory, design)
        tables = tables_of([outcomes[task] for task in tasks_of(design) if task in outcomes])
    frames = {name: _frame(table) for name, table in tables.items()}
    return Results(**frames, manifest=manifest, design=design, complete=manifest["complete"])


def design_of(directory: Path | str) -> Design | None:
    """Return the design of a results directory, or None if there is no such directory yet."""
    directory = Path(directory)
    return _read_manifest(directory)[1] if (directory / MANIFEST).exists() else None


class Store:
    """A results directory that a run writes into; a context manager.

    Parameters
    ----------
    directory : Path
        Made if it does not exist. A run that was cut short is taken up again.
    design : Design
        The design of the run.

    Raises
    ------
    InputError
        If the directory holds something else, another design or damaged files, if another run is
        writing into it, or if it cannot be written.
    """

    def __init__(self, directory: Path, design: Design) -> None:
        self.directory = directory
        self.design = design
        self._outcomes: dict[Task, Outcome] = {}
        self._environments = [_environment()]
        #: Open while there are tasks to run.
        self._journal: Journal | None = None
        with _writing(directory):
            if directory.exists():
                _check_ours(directory)
            directory.mkdir(parents=True, exist_ok=True)
            self._lock = lock.DirectoryLock(directory)
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
            self._lock.release()

    def _open(self) -> None:
        manifest: dict[str, Any] = {"complete": False}
        if (self.directory / MANIFEST).exists():
            manifest, found = _read_manifest(self.directory)
            difference = found.difference(self.design)
            if difference and not self._has_nothing(manifest):
                raise InputError(
                    f"{self.directory} holds the results of another design ({difference}): give "
                    "another directory."
                )
            now = self._environments[0]
            self._environments += [e for e in manifest["environments"] if e != now]
        if manifest["complete"]:
            _check_files(self.directory, manifest)
            if manifest["failed"] == 0:
                (self.directory / JOURNAL).unlink(missing_ok=True)
                return
        self._outcomes = _read_outcomes(self.directory, self.design)
        self._write_manifest(complete=False)
        self._journal = Journal(self.directory / JOURNAL)

    def _has_nothing(self, manifest: dict[str, Any]) -> bool:
        """Whether the run of a manifest ended before its first result, for example in an error."""
        journal = self.directory / JOURNAL
        return not manifest["complete"] and (not journal.exists() or journal.stat().st_size == 0)

    @property
    def unfinished(self) -> list[Task]:
        """The tasks that have no outcome yet or have failed, in the order of the results."""
        if self._journal is None:
            return []
        return [
            task
            for task in tasks_of(self.design)
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
        outcomes = [self._outcomes[task] for task in tasks_of(self.design)]
        with _writing(self.directory):
            for name, table in tables_of(outcomes).items():
                with _replacing(self.directory / f"{name}.parquet") as path:
                    pq.write_table(table, path, compression="zstd")
            self._write_manifest(complete=True)
            self._journal.close()
            self._journal = None
            if not self.failures:
                (self.directory / JOURNAL).unlink()

    @property
    def failures(self) -> list[Outcome]:
        """The outcomes of the tasks that failed, in the order of the results."""
        known = (self._outcomes.get(task) for task in tasks_of(self.design))
        return [outcome for outcome in known if outcome is not None and outcome.error is not None]

    def _write_manifest(self, *, complete: bool) -> None:
        manifest: dict[str, Any] = {
            "format": FORMAT,
            "complete": complete,
            "tasks": self.design.n_tasks,
            "design": self.design.model_dump(mode="json"),
        }
        if complete:
            manifest["failed"] = len(self.failures)
            manifest["sha256"] = {
                f"{name}.parquet": _sha256(self.directory / f"{name}.parquet") for name in _CHECKED
            }
        manifest["environments"] = self._environments
        with _replacing(self.directory / MANIFEST) as path:
            path.write_text(json.dumps(manifest, indent=2) + "\n", encoding="utf-8")


def _environment() -> dict[str, Any]:
    """Describe what the numbers are computed with."""
    return {
        "python": platform.python_version(),
        "implementation": platform.python_implementation(),
        "system": platform.system(),
        "machine": platform.machine(),
        "packages": {name: version(name) for name in _PACKAGES},
    }


def _check_ours(directory: Path) -> None:
    """Refuse a directory with files in it that no run has left there."""
    if not directory.is_dir():
        raise InputError(f"{directory} is a file: give a directory for the results.")
    names = {path.name for path in directory.iterdir()}
    # A run that is killed before it has written its manifest leaves these.
    if MANIFEST not in names and names - {lock.NAME, _temporary(directory / MANIFEST).name}:
        raise InputError(
            f"{directory} is not empty and holds no results of lepp-study: give another directory."
        )


def _read_manifest(directory: Path) -> tuple[dict[str, Any], Design]:
    path = directory / MANIFEST
    try:
        manifest = json.loads(path.read_text(encoding="utf-8"))
        form = manifest["format"]
        if form == FORMAT:
            needed = {"complete", "tasks", "environments"}
            if manifest["complete"]:
                needed |= {"failed", "sha256"}
            if not needed <= manifest.keys():
                raise KeyError(needed)
            return manifest, Design.from_settings(manifest["design"], f"{path}: the design")
    except FileNotFoundError:
        raise InputError(
            f"{directory} holds no results of lepp-study ({MANIFEST} is missing)."
        ) from None
    except OSError as error:
        raise InputError(f"Cannot read {path}: {error.strerror}.") from None
    except (ValueError, KeyError, TypeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"{path} was cut short or edited: restore it, or run the study in a new directory."
        ) from None
    raise InputError(
        f"{path} is of format {form}, and this version of lepp-study reads format {FORMAT}: use "
        "the version that wrote it."
    )


def _read_outcomes(directory: Path, design: Design) -> dict[Task, Outcome]:
    """Read the journal of a run; a later success replaces a failure."""
    path = directory / JOURNAL
    if not path.exists():
        return {}
    tasks = set(tasks_of(design))
    outcomes: dict[Task, Outcome] = {}
    for outcome in read_journal(path):
        if outcome.task not in tasks:
            raise InputError(
                f"{path} holds a triangulation that is not in the design ({outcome.task}): run the "
                "study in a new directory."
            )
        known = outcomes.get(outcome.task)
        if known is None or known.error is not None:
            outcomes[outcome.task] = outcome
    return outcomes


def _check_files(directory: Path, manifest: dict[str, Any]) -> None:
    for name, expected in manifest["sha256"].items():
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


def _read_parquet(path: Path) -> pa.Table:
    try:
        return pq.read_table(path, schema=SCHEMAS[path.stem])
    except (OSError, pa.ArrowException) as error:
        raise InputError(
            f"{path} cannot be read ({str(error).splitlines()[0]}): restore it, or run the study "
            "in a new directory."
        ) from None


def _frame(table: pa.Table) -> pd.DataFrame:
    frame = table.to_pandas()
    # pandas turns integers with gaps into floats; failed tasks leave gaps.
    for name, kind in MEASURES.items():
        if name in frame and pa.types.is_integer(kind) and table[name].null_count:
            frame[name] = pd.array(table[name].to_pylist(), dtype="Int64")
    return frame.astype({"error": "str"}) if "error" in frame else frame


@contextmanager
def _writing(directory: Path) -> Iterator[None]:
    """Turn failures to write into sentences."""
    try:
        yield
    except OSError as error:
        raise InputError(f"Cannot write into {directory}: {error.strerror or error}.") from None


def _temporary(path: Path) -> Path:
    return path.with_name(f".{path.name}.tmp")


@contextmanager
def _replacing(path: Path) -> Iterator[Path]:
    """Give a path to write to, and put the file in its place when it is whole on the disk."""
    temporary = _temporary(path)
    yield temporary
    with temporary.open("rb") as file:
        os.fsync(file.fileno())
    temporary.replace(path)
    if os.name == "posix":  # elsewhere a directory cannot be opened
        directory = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(directory)
        finally:
            os.close(directory)
