"""The kind of task of the paper: a point set, triangulated by every method of the design."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import NamedTuple

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

import lepp
from study.design.design import Design
from study.design.sampling import Points, sample_points
from study.run.kinds import ERROR, WORKER, Cells, Kind, Memory, Outcome, ResultTable, Size
from study.run.measures import columns_of, fields_of, measure, measured, values_of
from study.run.point_checks import PointChecks, check_randomness

#: Memory that a triangulation takes, checks and paths included, as measured for 4 million points.
BYTES_PER_POINT = {"incremental": 158, "delaunay": 162}


class Task(NamedTuple):
    """What tells one point set of a study from the others."""

    distribution: str
    n_points: int
    replicate: int


@dataclass(frozen=True)
class Measured:
    """What the measures of one triangulation are taken of."""

    triangulation: lepp.Triangulation
    paths: lepp.LeppPaths
    by_layer: NDArray[np.int64]
    counts: lepp.LeppCounts
    region_sizes: NDArray[np.int64]

    @classmethod
    def of(cls, triangulation: lepp.Triangulation) -> "Measured":
        """Follow the paths of a triangulation, and count their sizes layer by layer."""
        paths = lepp.lepp_paths(triangulation)
        by_layer = lepp.sizes_by_layer(lepp.triangle_layers(triangulation), paths.sizes)
        counts = lepp.LeppCounts(by_layer.sum(axis=0))
        return cls(triangulation, paths, by_layer, counts, np.bincount(paths.regions))

    def of_type(self, neighbor_type: int) -> int:
        """Count the triangles whose neighbour across their longest edge is of a type."""
        return int(np.count_nonzero(self.paths.neighbor_types == neighbor_type))


@dataclass(frozen=True)
class Measures:
    """What is measured of a triangulation: the columns of the results, in order."""

    n_triangles: int = measure(
        "Triangles", unit="triangles", format="int", of=lambda m: len(m.triangulation)
    )
    n_hull: int = measure(
        "Points on the hull", unit="points", format="int", of=lambda m: m.triangulation.n_hull
    )
    n_repeated: int = measure(
        "Repeated points",
        unit="points",
        format="int",
        of=lambda m: len(m.triangulation.repeated),
    )
    mean_lepp: float = measure(
        "Mean LEPP", unit="triangles", format="fixed4", of=lambda m: m.counts.mean
    )
    sd_lepp: float = measure(
        "SD of LEPP", unit="triangles", format="fixed4", of=lambda m: m.counts.sd
    )
    skewness_lepp: float = measure(
        "Skewness of LEPP", format="fixed4", of=lambda m: m.counts.skewness
    )
    kurtosis_lepp: float = measure(
        "Excess kurtosis of LEPP", format="fixed4", of=lambda m: m.counts.kurtosis
    )
    max_lepp: int = measure(
        "Largest LEPP", unit="triangles", format="int", of=lambda m: m.counts.max
    )
    n_interior_longest: int = measure(
        "Longest edge inside",
        unit="triangles",
        format="int",
        of=lambda m: np.count_nonzero(m.paths.neighbor_types),
    )
    n_type_a: int = measure(
        "Type A", unit="triangles", format="int", of=lambda m: m.of_type(lepp.TYPE_A)
    )
    n_type_b: int = measure(
        "Type B", unit="triangles", format="int", of=lambda m: m.of_type(lepp.TYPE_B)
    )
    n_type_c: int = measure(
        "Type C", unit="triangles", format="int", of=lambda m: m.of_type(lepp.TYPE_C)
    )
    n_regions: int = measure(
        "Terminal-edge regions", unit="regions", format="int", of=lambda m: len(m.region_sizes)
    )
    max_region: int = measure(
        "Largest region", unit="triangles", format="int", of=lambda m: m.region_sizes.max()
    )
    n_equal_longest: int = measure(
        "Several longest edges", unit="triangles", format="int", of=lambda m: m.paths.n_equal
    )
    n_nearly_equal_longest: int = measure(
        "Nearly equal longest edges",
        unit="triangles",
        format="int",
        of=lambda m: m.paths.n_nearly_equal,
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
        "Loading the kernels; the first time they are compiled, which takes a minute or more."
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

    def order_of(self, design: Design) -> Mapping[str, Sequence[object]]:
        """Order rows by method before all else."""
        return {"method": ("", *design.methods)}

    def size_of(self, task: Task, design: Design) -> Size:
        """Count triangulations, and the points of each."""
        return Size(len(design.methods), len(design.methods) * task.n_points)

    def memory_of(self, task: Task, design: Design) -> Memory:
        """Return what the largest of its triangulations takes; they are made one by one."""
        n = task.n_points
        each = max(BYTES_PER_POINT[method] for method in design.methods)
        return Memory(f"A triangulation of {n:,} points", n * each)

    def prepare(self) -> None:
        """Compile the kernels, or load them."""
        lepp.compile_kernels()

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
        for method in design.methods:
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
        rows = [self._without_measures(method, error) for method in design.methods]
        return Outcome(task, {"results": rows}, error=error)

    def _triangulate(
        self, points: Points, method: str, stages: "_Stages"
    ) -> dict[str, list[Cells]]:
        """Return the rows of one triangulation, which is let go of here."""
        triangulation = lepp.triangulate(points, method=method)
        stages.end(method, "triangulate")
        subject = Measured.of(triangulation)
        rows: dict[str, list[Cells]] = {
            "results": [(method, *values_of(measured(self.measures, subject)), None)],
            "histograms": _bars(method, subject.counts.counts),
            "layers": _bars(method, subject.by_layer),
            "regions": _bars(method, np.bincount(subject.region_sizes)),
        }
        stages.end(method, "lepp")
        return rows

    def _without_measures(self, method: str, error: str) -> Cells:
        return (method, *[None] * len(columns_of(self.measures)), error)


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
