"""The progress of a run: a bar on a terminal, a line now and then elsewhere."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import timedelta
from time import monotonic

import click
from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    ProgressColumn,
    TaskID,
    TextColumn,
)
from rich.progress import Task as Bar
from rich.text import Text

from study.run.experiment import Outcome, Task
from study.run.runner import Listener

_LINE_SHARE = 0.1
_LINE_SECONDS = 30.0


def _load_report() -> None:
    """Import what writes the report, while the workers compute: it takes a second."""
    import reports.study_page.page  # noqa: F401 - only to have it loaded


def _plan(unfinished: Sequence[Task], n_tasks: int) -> str:
    points = sum(task.n_points for task in unfinished)
    there = n_tasks - len(unfinished)
    goes_on = f", {there:,} of {n_tasks:,} are there" if there else ""
    return f"{len(unfinished):,} triangulations to compute, {points:,} points{goes_on}"


class _Rate(ProgressColumn):
    """Points per second since the start, and the time that the rest takes at this rate.

    Tasks arrive many at a time: the rate between arrivals, which rich would show, means nothing.
    """

    def render(self, task: Bar) -> Text:
        if not task.completed or not task.elapsed:
            return Text("")
        rate = task.completed / (task.finished_time or task.elapsed)
        left = timedelta(seconds=round((task.remaining or 0) / rate))
        return Text(f"{rate / 1e6:.2f} million points/s, {left} left")


class TerminalProgress:
    """A bar with rate and time left."""

    def __init__(self, bars: Progress) -> None:
        self._bars = bars
        self._bar: TaskID | None = None

    def begin(self, unfinished: Sequence[Task], n_tasks: int) -> None:
        """Start the bar."""
        self._bars.console.print(_plan(unfinished, n_tasks), highlight=False)
        total = sum(task.n_points for task in unfinished)
        self._bar = self._bars.add_task("Computing", total=total)
        _load_report()

    def advance(self, outcome: Outcome) -> None:
        """Move the bar by the points of a task."""
        assert self._bar is not None, "begin comes first"
        self._bars.advance(self._bar, outcome.task.n_points)

    def note(self, sentence: str) -> None:
        """Print a sentence above the bar."""
        self._bars.console.print(sentence, highlight=False)


class PlainProgress:
    """A line at the start, then one for every tenth of the points and at least every 30 s."""

    def begin(self, unfinished: Sequence[Task], n_tasks: int) -> None:
        """Print the first line."""
        self._total = sum(task.n_points for task in unfinished)
        self._done = self._printed = 0
        self._start = self._last = monotonic()
        click.echo(_plan(unfinished, n_tasks))
        _load_report()

    def advance(self, outcome: Outcome) -> None:
        """Count the points of a task; print a line if it is time."""
        self._done += outcome.task.n_points
        now = monotonic()
        share = (self._done - self._printed) / self._total
        if self._done < self._total and (share >= _LINE_SHARE or now - self._last >= _LINE_SECONDS):
            self._printed, self._last = self._done, now
            rate = self._done / max(now - self._start, 1e-9)
            click.echo(
                f"{self._done / self._total:.0%}, {rate / 1e6:.2f} million points/s, "
                f"{(self._total - self._done) / rate:.0f} s left"
            )

    def note(self, sentence: str) -> None:
        """Print a sentence."""
        click.echo(sentence)


@contextmanager
def progress() -> Iterator[Listener]:
    """Give what shows the progress of a run on the standard output."""
    console = Console()
    if not console.is_terminal:
        yield PlainProgress()
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f}%"),
        _Rate(),
    )
    with Progress(*columns, console=console) as bars:
        yield TerminalProgress(bars)
