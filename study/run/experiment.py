"""One task of a study: one triangulation and what is measured of it."""

from dataclasses import asdict, dataclass, field
from time import perf_counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import lepp
from study.design.design import Design
from study.design.sampling import sample_points
from study.run.point_checks import check_randomness

#: Pairs (size, number of times that it occurs), ascending, without zero counts.
Histogram = list[tuple[int, int]]


class Task(NamedTuple):
    """What tells one triangulation of a study from the others."""

    method: str
    distribution: str
    n_points: int
    replicate: int


@dataclass(frozen=True)
class Outcome:
    """What one task gave.

    Attributes
    ----------
    task : Task
        The task.
    measures : dict
        The measured columns of the results by name; empty if the task failed.
    histogram : list of (int, int)
        LEPP sizes and the number of triangles that have them.
    regions : list of (int, int)
        Numbers of triangles in a terminal-edge region, and the number of regions that have them.
    timings : dict
        Seconds by name: sample_s, check_s, triangulate_s, lepp_s; empty if the task failed.
    worker : str
        Address of the worker.
    error : str or None
        Why the task failed.
    """

    task: Task
    measures: dict[str, int | float] = field(default_factory=dict)
    histogram: Histogram = field(default_factory=list)
    regions: Histogram = field(default_factory=list)
    timings: dict[str, float] = field(default_factory=dict)
    worker: str = ""
    error: str | None = None


def tasks_of(design: Design) -> list[Task]:
    """Return the tasks of a design in the order of its results."""
    return [
        Task(method, distribution, n_points, replicate)
        for method in design.methods
        for distribution in design.distributions
        for n_points in design.sizes
        for replicate in range(design.repetitions)
    ]


def perform(task: Task, design: Design) -> Outcome:
    """Draw the points, check their randomness, triangulate them and measure the LEPPs.

    Parameters
    ----------
    task : Task
        The triangulation.
    design : Design
        The design that it belongs to; gives the seed and the correlation.

    Returns
    -------
    outcome : Outcome
        Depends on nothing but the arguments, timings apart.

    Raises
    ------
    InputError
        If the points cannot be triangulated.
    """
    start = perf_counter()
    points = sample_points(
        task.distribution,
        task.n_points,
        task.replicate,
        seed=design.seed,
        correlation=design.correlation,
    )
    sampled = perf_counter()
    checks = check_randomness(points, task.distribution)
    checked = perf_counter()
    triangulation = lepp.triangulate(points, method=task.method)
    triangulated = perf_counter()
    paths = lepp.lepp_paths(triangulation)
    counts = lepp.LeppCounts.from_sizes(paths.sizes)
    region_sizes = np.bincount(paths.regions)
    measures = {
        "n_triangles": len(triangulation),
        "n_hull": int(triangulation.n_hull),
        "n_repeated": len(triangulation.repeated),
        "mean_lepp": counts.mean,
        "sd_lepp": counts.sd,
        "skewness_lepp": counts.skewness,
        "kurtosis_lepp": counts.kurtosis,
        "max_lepp": counts.max,
        "n_interior_longest": int(np.count_nonzero(paths.neighbor_types)),
        "n_type_a": int(np.count_nonzero(paths.neighbor_types == lepp.TYPE_A)),
        "n_type_b": int(np.count_nonzero(paths.neighbor_types == lepp.TYPE_B)),
        "n_type_c": int(np.count_nonzero(paths.neighbor_types == lepp.TYPE_C)),
        "n_regions": len(region_sizes),
        "max_region": int(region_sizes.max()),
        **asdict(checks),
    }
    measured = perf_counter()
    return Outcome(
        task=task,
        measures=measures,
        histogram=_histogram(counts.counts),
        regions=_histogram(np.bincount(region_sizes)),
        timings={
            "sample_s": sampled - start,
            "check_s": checked - sampled,
            "triangulate_s": triangulated - checked,
            "lepp_s": measured - triangulated,
        },
    )


def _histogram(counts: NDArray[np.integer]) -> Histogram:
    sizes = np.flatnonzero(counts)
    return list(zip(sizes.tolist(), counts[sizes].tolist(), strict=True))
