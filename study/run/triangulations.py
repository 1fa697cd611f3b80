"""The kind of task of the paper: a point set, triangulated by every method of the design."""

import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

import lepp
from lepp.mesh.triangulation import MAX_POINTS
from study.design.design import IN_TILES, Design
from study.design.sampling import Points, sample_points
from study.run.counted import Counted
from study.run.kinds import ERROR, WORKER, Cells, Kind, Memory, Outcome, ResultTable, Size, Stage
from study.run.measures import columns_of, fields_of, measure, measured, values_of
from study.run.point_checks import PointChecks, check_randomness
from study.run.tiled_insertion import LEAST_MEMORY, TiledInsertion


class Task(NamedTuple):
    """What tells one point set of a study from the others."""

    distribution: str
    n_points: int
    replicate: int


@dataclass(frozen=True)
class Measures:
    """What is measured of a triangulation: the columns of the results, in order."""

    n_triangles: int = measure(
        "Triangles", unit="triangles", format="int", of=lambda c: c.n_triangles
    )
    n_hull: int = measure("Points on the hull", unit="points", format="int", of=lambda c: c.n_hull)
    n_repeated: int = measure(
        "Repeated points",
        unit="points",
        format="int",
        of=lambda c: c.n_repeated,
    )
    mean_lepp: float = measure(
        "Mean LEPP", unit="triangles", format="fixed4", of=lambda c: c.lepp.mean
    )
    sd_lepp: float = measure(
        "SD of LEPP", unit="triangles", format="fixed4", of=lambda c: c.lepp.sd
    )
    skewness_lepp: float = measure(
        "Skewness of LEPP", format="fixed4", of=lambda c: c.lepp.skewness
    )
    kurtosis_lepp: float = measure(
        "Excess kurtosis of LEPP", format="fixed4", of=lambda c: c.lepp.kurtosis
    )
    max_lepp: int = measure("Largest LEPP", unit="triangles", format="int", of=lambda c: c.lepp.max)
    n_interior_longest: int = measure(
        "Longest edge inside",
        unit="triangles",
        format="int",
        of=lambda c: c.types[lepp.TYPE_A :].sum(),
    )
    n_type_a: int = measure(
        "Type A", unit="triangles", format="int", of=lambda c: c.types[lepp.TYPE_A]
    )
    n_type_b: int = measure(
        "Type B", unit="triangles", format="int", of=lambda c: c.types[lepp.TYPE_B]
    )
    n_type_c: int = measure(
        "Type C", unit="triangles", format="int", of=lambda c: c.types[lepp.TYPE_C]
    )
    n_regions: int = measure(
        "Terminal-edge regions", unit="regions", format="int", of=lambda c: c.regions.sum()
    )
    max_region: int = measure(
        "Largest region", unit="triangles", format="int", of=lambda c: len(c.regions) - 1
    )
    n_equal_longest: int = measure(
        "Several longest edges", unit="triangles", format="int", of=lambda c: c.n_equal
    )
    n_nearly_equal_longest: int = measure(
        "Nearly equal longest edges",
        unit="triangles",
        format="int",
        of=lambda c: c.n_nearly_equal,
    )


class Triangulations(Kind[Task, Design]):
    """Point sets, each drawn and checked once and triangulated by every method of the design.

    Its tables: ``results``, a row a triangulation with its `measures`; ``histograms`` and
    ``regions``, a row a triangulation and LEPP size or size of a terminal-edge region; ``layers``,
    the histograms parted by the layer of the triangle, `lepp.INTERIOR_LAYER` the last;
    ``point_sets``, a row a point set with its `PointChecks`; ``timings``, a row a stage of a
    triangulation, or with the method "" of its point set.
    """

    name = "triangulations"
    design = Design
    task = Task
    units = ("triangulations", "points")
    preparing = (
        "Loading the kernels; the first time they are compiled, which takes up to half a minute."
    )
    #: As measured with distributed and the kernels loaded, and memory kept between small tasks.
    base_memory = 280_000_000
    #: The class of measures.
    measures: type = Measures

    @property
    def tables(self) -> Mapping[str, ResultTable]:  # type: ignore[override]  # one that is computed
        """The tables, by name."""
        task = fields_of(Task)
        method = pa.field("method", pa.string())
        lepp_size = pa.field("lepp_size", pa.int64())
        count = pa.field("count", pa.int64())
        measures = [column.field for column in columns_of(self.measures)]
        checks = [column.field for column in columns_of(PointChecks)]
        columns = {
            "results": [method, *task, *measures, pa.field(ERROR, pa.string())],
            "histograms": [method, *task, lepp_size, count],
            "layers": [method, *task, pa.field("layer", pa.int64()), lepp_size, count],
            "regions": [method, *task, pa.field("region_size", pa.int64()), count],
            "point_sets": [*task, *checks],
            "timings": [
                method,
                *task,
                pa.field("stage", pa.string()),
                pa.field("seconds", pa.float64()),
                pa.field(WORKER, pa.string()),
            ],
        }
        return {
            name: ResultTable(pa.schema(fields), reproducible=name != "timings")
            for name, fields in columns.items()
        }

    def tasks_of(self, design: Design) -> list[Task]:
        """Return the point sets of a design."""
        return [
            Task(distribution, n_points, replicate)
            for distribution in design.distributions
            for n_points, repetitions in design.repetitions_by_size.items()
            for replicate in range(repetitions)
        ]

    def contains(self, design: Design, other: Design) -> bool:
        """Tell whether a design has the point sets of another, by the same methods."""
        return design.contains(other)

    def order_of(self, design: Design) -> Mapping[str, Sequence[object]]:
        """Order rows by method before all else."""
        return {"method": ("", *design.methods)}

    def size_of(self, task: Task, design: Design) -> Size:
        """Count triangulations, and the points of each."""
        methods = len(design.methods_of(task.n_points))
        return Size(methods, methods * task.n_points)

    def memory_of(self, task: Task, design: Design) -> Memory:
        """Return what the largest of its triangulations takes; they are made one by one."""
        n = task.n_points
        each = max(lepp.METHODS[method].bytes_per_point for method in design.methods_of(n))
        return Memory(f"A triangulation of {n:,} points", n * each)

    def is_at_once(self, task: Task, design: Design, memory: float) -> bool:
        """Tell whether a mesh can have the points, and fits into memory."""
        return task.n_points <= MAX_POINTS and super().is_at_once(task, design, memory)

    def least_memory_of(self, task: Task, design: Design) -> Memory:
        """Return what a job of it takes, where plain insertion alone is asked for."""
        whole = self.memory_of(task, design)
        if not _goes_in_tiles(task, design) or whole.n_bytes <= LEAST_MEMORY:
            return whole
        return Memory("A triangulation in tiles", LEAST_MEMORY)

    def in_stages(
        self, task: Task, design: Design, directory: Path, memory: int
    ) -> "StagedTriangulation | None":
        """Return a plain insertion in tiles; None for other methods."""
        if not _goes_in_tiles(task, design):
            return None
        return StagedTriangulation(task, design, directory, max(memory, LEAST_MEMORY))

    def prepare(self, design: Design, memory: float) -> None:
        """Compile the kernels that the design needs, or load them."""
        largest = Task("", design.sizes[-1], 0)
        tiles = _goes_in_tiles(largest, design) and not self.is_at_once(largest, design, memory)
        lepp.compile_kernels(design.methods, tiles=tiles, meshes=False)
        check_randomness(sample_points("uniform", 4, 0, seed=0), "uniform")

    def perform(self, task: Task, design: Design) -> Outcome[Task]:
        """Draw the points, check their randomness, triangulate them and measure the LEPPs.

        Parameters
        ----------
        task : Task
            The point set.
        design : Design
            The design that it belongs to; gives methods, seed and correlation.

        Returns
        -------
        outcome : Outcome
            A method that fails has a row with its error, and the others have theirs.
        """
        stages = _Stages()
        points = sample_points(
            task.distribution,
            task.n_points,
            task.replicate,
            seed=design.seed,
            correlation=design.correlation,
        )
        stages.end("", "sample")
        checks = check_randomness(points, task.distribution)
        stages.end("", "check")
        rows: dict[str, list[Cells]] = {"point_sets": [values_of(checks)]}
        errors = []
        for method in design.methods_of(task.n_points):
            try:
                made = self._triangulate(points, method, stages)
            except Exception as error:
                words = f"{type(error).__name__}: {error}"
                errors.append(f"{method}: {words}")
                made = {"results": [self._without_measures(method, words)]}
            for name, more in made.items():
                rows.setdefault(name, []).extend(more)
        rows["timings"] = stages.rows
        seconds = sum(row[-1] for row in stages.rows)
        return Outcome(task, rows, seconds, error="; ".join(errors) or None)

    def failed(self, task: Task, design: Design, error: str) -> Outcome[Task]:
        """Return a row without measures for each method."""
        methods = design.methods_of(task.n_points)
        rows = [self._without_measures(method, error) for method in methods]
        return Outcome(task, {"results": rows}, error=error)

    def _triangulate(
        self, points: Points, method: str, stages: "_Stages"
    ) -> dict[str, list[Cells]]:
        """Return the rows of one triangulation, which is let go of here."""
        triangulation = lepp.triangulate(points, method=method)
        stages.end(method, "triangulate")
        rows = self.rows_of(method, Counted.of(triangulation))
        stages.end(method, "lepp")
        return rows

    def rows_of(self, method: str, counted: Counted) -> dict[str, list[Cells]]:
        """Return the rows of one triangulation in each table."""
        return {
            "results": [(method, *values_of(measured(self.measures, counted)), None)],
            "histograms": _bars(method, counted.lepp.counts),
            "layers": _bars(method, counted.by_layer),
            "regions": _bars(method, counted.regions),
        }

    def _without_measures(self, method: str, error: str) -> Cells:
        return (method, *[None] * len(columns_of(self.measures)), error)


@dataclass(frozen=True)
class StagedTriangulation:
    """A point set whose plain insertion takes more memory than a worker has.

    Attributes
    ----------
    task : Task
    design : Design
    directory : Path
    memory : int
        As for `Triangulations.in_stages`.
    """

    task: Task
    design: Design
    directory: Path
    memory: int

    @property
    def _insertion(self) -> TiledInsertion:
        seed, correlation = self.design.seed, self.design.correlation
        return TiledInsertion(*self.task, seed, correlation, self.directory, self.memory)

    def check_disk(self) -> None:
        """Raise `InputError` if there is no room for its files."""
        self._insertion.check_disk()

    def stages(self) -> Iterator[Stage]:
        """Yield the stages."""
        self.directory.mkdir(parents=True, exist_ok=True)
        yield from self._insertion.stages()

    def perform(self, name: str, job: int) -> None:
        """Do a job."""
        self._insertion.perform(name, job)

    def outcome(self) -> Outcome[Task]:
        """Return the same rows as `Triangulations.perform`."""
        checks, counted, spent = self._insertion.result()
        rows = TRIANGULATIONS.rows_of("incremental", counted)
        rows["point_sets"] = [values_of(checks)]
        rows["timings"] = [
            ("" if stage in ("sample", "check") else "incremental", stage, seconds)
            for stage, seconds in spent.items()
        ]
        return Outcome(self.task, rows, sum(spent.values()))

    def close(self) -> None:
        """Remove the files, and the directory of all such tasks with the last of them."""
        shutil.rmtree(self.directory, ignore_errors=True)
        with suppress(OSError):
            self.directory.parent.rmdir()


def _goes_in_tiles(task: Task, design: Design) -> bool:
    """Tell whether every method of a point set can do without the whole mesh."""
    return design.methods_of(task.n_points) == IN_TILES


class _Stages:
    """Seconds of the stages of a task, as rows of its timings."""

    def __init__(self) -> None:
        self.rows: list[Cells] = []
        self._last = perf_counter()

    def end(self, method: str, stage: str) -> None:
        now = perf_counter()
        self.rows.append((method, stage, now - self._last))
        self._last = now


def _bars(method: str, counts: NDArray[np.integer]) -> list[Cells]:
    """Rows of a histogram: the places of its counts that are not 0, ascending, and the counts."""
    places = np.nonzero(counts)
    return [
        (method, *place, count)
        for *place, count in zip(
            *(p.tolist() for p in places), counts[places].tolist(), strict=True
        )
    ]


#: The kind; it has no state.
TRIANGULATIONS = Triangulations()
