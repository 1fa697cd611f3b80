"""The progress of a run: a bar on a terminal, a line now and then elsewhere."""

from collections.abc import Iterator
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

from study.run.kinds import Outcome, Size
from study.run.runner import Listener

_LINE_SHARE = 0.1
_LINE_SECONDS = 30.0


def _load_report() -> None:
    """Import what writes the report, while the workers compute: it takes a second."""
    import reports.study_page.page  # noqa: F401 - only to have it loaded


def _plan(units: tuple[str, str], unfinished: Size, whole: Size) -> str:
    parts, work = units
    there = whole.parts - unfinished.parts
    goes_on = f", {there:,} of {whole.parts:,} are there" if there else ""
    return f"{unfinished.parts:,} {parts} to compute, {unfinished.work:,} {work}{goes_on}"


class _Rate(ProgressColumn):
    """Work per second since the start, and the time that the rest takes at this rate.

    Tasks arrive many at a time: the rate between arrivals, which rich would show, means nothing.
    """

    def render(self, task: Bar) -> Text:
        if not task.completed or not task.elapsed:
            return Text("")
        rate = task.completed / (task.finished_time or task.elapsed)
        left = timedelta(seconds=round((task.remaining or 0) / rate))
        return Text(f"{rate / 1e6:.2f} million {task.fields['work']}/s, {left} left")


class TerminalProgress:
    """A bar with rate and time left."""

    def __init__(self, bars: Progress) -> None:
        self._bars = bars
        self._bar: TaskID | None = None

    def begin(self, units: tuple[str, str], unfinished: Size, whole: Size) -> None:
        """Start the bar."""
        self._bars.console.print(_plan(units, unfinished, whole), highlight=False)
        self._bar = self._bars.add_task("Computing", total=unfinished.work, work=units[1])
        _load_report()

    def advance(self, outcome: Outcome, size: Size) -> None:
        """Move the bar by the work of a task."""
        assert self._bar is not None, "begin comes first"
        self._bars.advance(self._bar, size.work)

    def note(self, sentence: str) -> None:
        """Print a sentence above the bar."""
        self._bars.console.print(sentence, highlight=False)


class PlainProgress:
    """A line at the start, then one for every tenth of the work and at least every 30 s."""

    def begin(self, units: tuple[str, str], unfinished: Size, whole: Size) -> None:
        """Print the first line."""
        self._total, self._work = unfinished.work, units[1]
        self._done = self._printed = 0
        self._start = self._last = monotonic()
        click.echo(_plan(units, unfinished, whole))
        _load_report()

    def advance(self, outcome: Outcome, size: Size) -> None:
        """Count the work of a task; print a line if it is time."""
        self._done += size.work
        now = monotonic()
        share = (self._done - self._printed) / self._total
        if self._done < self._total and (share >= _LINE_SHARE or now - self._last >= _LINE_SECONDS):
            self._printed, self._last = self._done, now
            rate = self._done / max(now - self._start, 1e-9)
            click.echo(
                f"{self._done / self._total:.0%}, {rate / 1e6:.2f} million {self._work}/s, "
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
