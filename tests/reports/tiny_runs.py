"""Tiny real runs, made in this process."""

from collections.abc import Callable
from pathlib import Path

from lepp import METHODS
from study.design.design import Design
from study.results.store import Store
from study.run.kinds import Outcome
from study.run.triangulations import TRIANGULATIONS, Task

DESIGN = Design(
    methods=tuple(METHODS),
    distributions=("uniform", "bivariate_normal"),
    sizes=(300, 600, 1200, 2400, 4800),
    repetitions=6,
)


def store_run(
    directory: Path, design: Design, outcome_of: Callable[[Task, Design], Outcome | None]
) -> Path:
    """Run a design in this process; a task without an outcome leaves the run unfinished."""
    outcomes = [outcome_of(task, design) for task in TRIANGULATIONS.tasks_of(design)]
    done = [outcome for outcome in outcomes if outcome is not None]
    with Store(directory, TRIANGULATIONS, design) as store:
        store.add(done)
        if len(done) == len(outcomes):
            store.finish()
    return directory
