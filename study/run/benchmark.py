"""How fast this machine is: rates, memory, and what Dask costs, beside `scipy.spatial.Delaunay`."""

import subprocess
from collections.abc import Callable, Iterator
from dataclasses import astuple, dataclass, fields
from itertools import takewhile
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import process_time
from typing import TypeVar

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import scipy.spatial
from dask.system import CPU_COUNT

import lepp
from lepp import InputError
from lepp.jit import child
from study.design.design import Design
from study.design.sampling import sample_points
from study.results.files import replacing
from study.results.manifest import environment
from study.run.cluster import ClusterOptions
from study.run.counted import Counted
from study.run.point_checks import check_randomness
from study.run.runner import Listener, run
from study.run.triangulations import TRIANGULATIONS

YARDSTICK = "scipy.spatial.Delaunay"
_SEED = 0
_SIZES = (1_000, 10_000, 100_000, 200_000, 1_000_000)
_MOST_OF_YARDSTICK = 200_000  # points: it takes tens of seconds for a million
_POINTS_IN_MEMORY = 4_000_000

T = TypeVar("T")


@dataclass(frozen=True)
class Quantity:
    """What is measured.

    Attributes
    ----------
    title, unit : str
    format : str
        As for `study.text.numbers.show`.
    more_is_better : bool
    """

    title: str
    unit: str
    format: str
    more_is_better: bool = False


QUANTITIES = {
    "sampling": Quantity("Drawing points", "ns a point", "fixed1"),
    "checks": Quantity("Checking their randomness", "ns a point", "fixed1"),
    "triangulation": Quantity("Triangulation", "ns a point", "fixed1"),
    "sizes": Quantity("LEPP sizes", "ns a point", "fixed1"),
    "counts": Quantity("All that a study counts of the paths", "ns a point", "fixed1"),
    "times_scipy": Quantity(
        f"Triangulation and LEPP sizes: times as fast as {YARDSTICK} alone", "", "fixed1", True
    ),
    "memory": Quantity("Memory of a triangulation and its paths", "bytes a point", "fixed1"),
    "rate": Quantity("Points of a run, report apart", "million points a second", "fixed2", True),
    "overhead": Quantity("Time of that run beyond its tasks' own", "", "percent1"),
}


@dataclass(frozen=True)
class Measurement:
    """One number.

    Attributes
    ----------
    quantity : str
        One of `QUANTITIES`.
    method : str
        Of triangulation; empty where none has part in it.
    n_points : int
        Points of a set, or of all sets of a run.
    cores : int
    value : float
    """

    quantity: str
    method: str
    n_points: int
    cores: int
    value: float


COLUMNS = tuple(field.name for field in fields(Measurement))
KEY = COLUMNS[:-1]
"""What tells measurements apart."""


@dataclass(frozen=True)
class Benchmark:
    """Measurements, and what they were made with.

    Attributes
    ----------
    measurements : DataFrame
        The columns of `Measurement`.
    environment : dict of str to str
        Versions, as in a manifest, and the processor.
    """

    measurements: pd.DataFrame
    environment: dict[str, str]

    def write(self, path: Path) -> None:
        """Write the measurements as Parquet, with the environment in the file's metadata."""
        table = pa.Table.from_pandas(self.measurements, preserve_index=False)
        with replacing(path) as temporary:
            pq.write_table(table.replace_schema_metadata(self.environment), temporary)

    @classmethod
    def read(cls, path: Path) -> "Benchmark":
        """Read what `write` has written.

        Raises
        ------
        InputError
            If the file is no such file.
        """
        try:
            table = pq.read_table(path)
        except (OSError, pa.ArrowException) as error:
            raise InputError(f"Cannot read {path} as a benchmark: {error}") from None
        if tuple(table.column_names) != COLUMNS:
            raise InputError(f"{path} is no benchmark: give a file that bench --full wrote.")
        metadata = table.schema.metadata or {}
        words = {key.decode(): value.decode() for key, value in metadata.items()}
        return cls(table.replace_schema_metadata().to_pandas(), words)


def measure(listener: Listener) -> Benchmark:
    """Measure everything: for some minutes, with all cores.

    Parameters
    ----------
    listener : Listener
        Hears what is being measured, and of the progress of the runs.
    """
    found: list[Measurement] = []
    listener.note("Measuring one core.")
    lepp.compile_kernels(meshes=False, tiles=False)
    for n_points in _SIZES:
        found += rates(n_points, repeats=max(3, min(15, 1_000_000 // n_points)))
    listener.note("Measuring memory.")
    found += [memory(method, _POINTS_IN_MEMORY) for method in lepp.METHODS]
    paper = Design.from_preset("paper")
    most = ClusterOptions().n_workers(TRIANGULATIONS)
    for cores in takewhile(lambda k: k < most, (2**k for k in range(20))):
        words = "one core" if cores == 1 else f"{cores} cores"
        listener.note(f"Running a fifth of the paper's study on {words}.")
        found += runs(paper, cores, listener, share=5)
    listener.note(f"Running the paper's study on {most} cores.")
    found += runs(paper, most, listener)
    frame = pd.DataFrame([astuple(one) for one in found], columns=COLUMNS)
    return Benchmark(frame, _environment())


def rates(n_points: int, repeats: int) -> list[Measurement]:
    """Measure one core, with the same uniform points for all methods.

    Everything is measured in turn, `repeats` times, and each ratio is the median of those within a
    turn: a machine whose speed drifts does not bend it. Times are of one core's processor.

    Parameters
    ----------
    n_points : int
        Points of the set.
    repeats : int
        Turns.
    """
    turns = [dict(_turn(n_points)) for _ in range(repeats)]
    found = []
    for quantity, method in turns[0]:
        values = [turn[quantity, method] for turn in turns]
        found.append(Measurement(quantity, method, n_points, 1, median(values)))
    return found


def _turn(n_points: int) -> Iterator[tuple[tuple[str, str], float]]:
    """Measure everything once: quantity and method, and ns a point or a ratio."""
    points, drawn = _time(sample_points, "uniform", n_points, 0, seed=_SEED)
    per_point = 1e9 / n_points
    yield ("sampling", ""), drawn * per_point
    yield ("checks", ""), _time(check_randomness, points, "uniform")[1] * per_point
    with_yardstick = n_points <= _MOST_OF_YARDSTICK
    theirs = _time(scipy.spatial.Delaunay, points)[1] if with_yardstick else None
    for method in lepp.METHODS:
        triangulation, triangulating = _time(lepp.triangulate, points, method)
        sizing = _time(lepp.lepp_sizes, triangulation)[1]
        yield ("triangulation", method), triangulating * per_point
        yield ("sizes", method), sizing * per_point
        yield ("counts", method), _time(Counted.of, triangulation)[1] * per_point
        if theirs is not None:
            yield ("times_scipy", method), theirs / (triangulating + sizing)


def _time(work: Callable[..., T], *arguments: object, **options: object) -> tuple[T, float]:
    start = process_time()
    result = work(*arguments, **options)
    return result, process_time() - start


# In a process of its own: what others have taken before is not counted, nor given back.
_TAKEN = """
import sys
from threading import Event, Thread

import psutil

import lepp
from study.design.sampling import sample_points
from study.run.counted import Counted

def taken():
    return psutil.Process().memory_info().rss

def watch():
    while not done.wait(0.001):
        seen.append(taken())

method, n = sys.argv[1], int(sys.argv[2])
Counted.of(lepp.triangulate(sample_points("uniform", 1000, 0, seed=0), method))
seen, done = [taken()], Event()
thread = Thread(target=watch)
thread.start()
Counted.of(lepp.triangulate(sample_points("uniform", n, 0, seed=0), method))
done.set()
thread.join()
print((max(seen) - seen[0]) / n)
"""


def memory(method: str, n_points: int) -> Measurement:
    """Measure the memory that a point set, its triangulation and its paths take at a time."""
    done = subprocess.run(
        child.command(_TAKEN, method, str(n_points)),
        env=child.environment(),
        capture_output=True,
        text=True,
        check=True,
    )
    return Measurement("memory", method, n_points, 1, float(done.stdout))


def runs(design: Design, cores: int, listener: Listener, share: int = 1) -> list[Measurement]:
    """Measure a run of a design, or of one in `share` of its repetitions, report apart."""
    fewer = tuple(-(-k // share) for k in design.repetitions_by_size.values())
    design = design.model_copy(update={"repetitions": fewer})
    with TemporaryDirectory() as directory:
        summary = run(
            Path(directory) / "run",
            TRIANGULATIONS,
            design,
            options=ClusterOptions(workers=cores),
            listener=listener,
        )
    points = summary.computed.work
    own = summary.kernel_seconds / summary.n_threads
    return [
        Measurement("rate", "", points, cores, points / summary.seconds / 1e6),
        Measurement("overhead", "", points, cores, summary.seconds / own - 1),
    ]


def compared(new: Benchmark, old: Benchmark) -> pd.DataFrame:
    """Put two benchmarks side by side.

    Returns
    -------
    DataFrame
        The measurements of the new one, with `before`, and `gain`: how many times as good the new
        one is, whether more or less is better. NaN where the old one has no such measurement.
    """
    both = new.measurements.merge(
        old.measurements.rename(columns={"value": "before"}), on=list(KEY), how="left"
    )
    ratio = both["value"] / both["before"]
    more = both["quantity"].map({name: q.more_is_better for name, q in QUANTITIES.items()})
    return both.assign(gain=np.where(more, ratio, 1 / ratio))


def _environment() -> dict[str, str]:
    """Flatten what a manifest says of the versions, and add the number of cores."""
    known = environment()
    packages = known.pop("packages")
    return known | packages | {"cores": str(CPU_COUNT)}
