"""How fast this machine triangulates and follows paths, beside `scipy.spatial.Delaunay`."""

from collections.abc import Callable
from statistics import median
from time import process_time
from typing import TypeVar

import scipy.spatial

import lepp
from study.design.sampling import Points, sample_points

_SEED = 0
_YARDSTICK = "scipy.spatial.Delaunay"

T = TypeVar("T")


def run(n_points: int, repeats: int) -> list[dict[str, str]]:
    """Measure each method of triangulation and its LEPP sizes, on the same uniform points.

    Everything is measured in turn, `repeats` times, and each ratio is the median of those within a
    turn: a machine whose speed drifts does not bend it. Times are of one core's processor.

    Parameters
    ----------
    n_points : int
        Points of the set.
    repeats : int
        Turns.

    Returns
    -------
    list of dict
        A row for each thing measured, ready to be printed.
    """
    points = sample_points("uniform", n_points, 0, seed=_SEED)
    lepp.compile_kernels()
    turns = [_turn(points) for _ in range(repeats)]
    rows = []
    for name in turns[0]:
        seconds = median(turn[name] for turn in turns)
        ratio = median(turn[_YARDSTICK] / turn[name] for turn in turns)
        rows.append(
            {
                "": name,
                "seconds": f"{seconds:.4f}",
                "ns a point": f"{1e9 * seconds / n_points:,.0f}",
                "million points a second": f"{n_points / seconds / 1e6:.2f}",
                "times as fast as SciPy": f"{ratio:.1f}",
            }
        )
    return rows


def _turn(points: Points) -> dict[str, float]:
    """Measure everything once, in seconds."""
    seconds = {_YARDSTICK: _time(scipy.spatial.Delaunay, points)[0]}
    for method in lepp.METHODS:
        triangulating, triangulation = _time(lepp.triangulate, points, method)
        following, _ = _time(lepp.lepp_sizes, triangulation)
        seconds[f"{method}: triangulation"] = triangulating
        seconds[f"{method}: LEPP sizes"] = following
        seconds[f"{method}: both"] = triangulating + following
    return seconds


def _time(work: Callable[..., T], *arguments: object) -> tuple[float, T]:
    start = process_time()
    result = work(*arguments)
    return process_time() - start, result
