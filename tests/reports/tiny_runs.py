"""Tiny real runs, made in this process."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from lepp import METHODS, Method
from study.design.design import Design
from study.results.store import Store
from study.run.experiment import Outcome, Task, tasks_of

DESIGN = Design(
    methods=tuple(METHODS),
    distributions=("uniform", "bivariate_normal"),
    sizes=(300, 600, 1200, 2400, 4800),
    repetitions=6,
)

#: A small design with enough sizes for every statistic.
SMALL = Design(distributions=("uniform",), sizes=(200, 300, 400, 600, 800), repetitions=4)


def other_orders() -> list[Method]:
    """Methods that no registry has: plain insertion of the points in two other orders."""

    def inserting(order_of: Callable[[np.ndarray], np.ndarray]) -> Callable:
        def build(points: np.ndarray) -> tuple:
            order = order_of(points).astype(np.int32)
            triangles, neighbors, repeated, _ = METHODS["incremental"].build(points[order])
            return order[triangles], neighbors, order[repeated], None

        return build

    return [
        Method(
            "by_x",
            "Swept",
            "swept",
            "inserts the points from left to right",
            inserting(lambda points: np.argsort(points[:, 0], kind="stable")),
        ),
        Method(
            "backwards",
            "Reversed insertion",
            "reversed",
            "inserts the points in reverse order",
            inserting(lambda points: np.arange(len(points))[::-1]),
        ),
    ]


def store_run(
    directory: Path, design: Design, outcome_of: Callable[[Task, Design], Outcome | None]
) -> Path:
    """Run a design in this process; a task without an outcome leaves the run unfinished."""
    outcomes = [outcome_of(task, design) for task in tasks_of(design)]
    done = [outcome for outcome in outcomes if outcome is not None]
    with Store(directory, design) as store:
        store.add(done)
        if len(done) == len(outcomes):
            store.finish()
    return directory
