"""A small design, what hears of its runs, and what is compared of them."""

import psutil

from study.design.design import Design
from study.run.triangulations import TRIANGULATIONS

DESIGN = Design.from_settings({"sizes": [200, 300, 500], "repetitions": 6, "seed": 5})
TASKS = TRIANGULATIONS.tasks_of(DESIGN)
FILES = (
    "results.parquet",
    "histograms.parquet",
    "layers.parquet",
    "regions.parquet",
    "point_sets.parquet",
    "manifest.json",
)


class Heard:
    """A listener that remembers, and acts when it has heard of a number of outcomes."""

    def __init__(self, act=None, after=1):
        self.tasks, self.notes, self.act, self.after = [], [], act, after
        self.parts = 0

    def begin(self, units, unfinished, whole, n_threads):
        self.units, self.unfinished, self.whole = units, unfinished, whole

    def advance(self, outcome, size):
        self.tasks.append(outcome.task)
        if self.act and len(self.tasks) == self.after:
            self.act()

    def part(self, work):
        self.parts += work

    def note(self, sentence):
        self.notes.append(sentence)


def contents(directory):
    return {name: (directory / name).read_bytes() for name in FILES}


def worker_processes(parent=None):
    return [
        child
        for child in psutil.Process(parent).children(recursive=True)
        if "spawn_main" in " ".join(child.cmdline())
    ]
