"""The progress of a run: a bar on a terminal, a line now and then elsewhere."""

from collections.abc import Callable, Iterator
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

#: The share of the work, and the seconds, from which on the rest can be told.
_KNOWN_SHARE, _KNOWN_SECONDS = 0.03, 20.0
#: Results of several workers that come together.
_SOON_SECONDS = 1.0
#: A run of which more is left is a long one.
_LONG_SECONDS = 300.0
#: How many times the workers a cluster is said to have.
_CLUSTER = 16


def _load_report() -> None:
    """Import what writes the report, while the workers compute: it takes a second."""
    import reports.study_page.page  # noqa: F401 - only to have it loaded


def _plan(units: tuple[str, str], unfinished: Size, whole: Size) -> str:
    parts, work = units
    there = whole.parts - unfinished.parts
    goes_on = f", {there:,} of {whole.parts:,} are there" if there else ""
    return f"{unfinished.parts:,} {parts} to compute, {unfinished.work:,} {work}{goes_on}"


class Pace:
    """How fast a run computes, from the first result on: what was before it is no work.

    Parameters
    ----------
    work : int
        What there is to do.
    clock : callable
        Seconds.

    Attributes
    ----------
    done : int
        What is done.
    """

    def __init__(self, work: int, clock: Callable[[], float] = monotonic) -> None:
        self.work, self.done = work, 0
        self._clock = clock
        self._start = self._last = clock()
        #: When the first result came, and what came with it or soon after, from other workers.
        self._first: float | None = None
        self._with_first = 0

    def advance(self, work: int) -> None:
        """Hear of work that is done."""
        self._last = self._clock()
        self.done += work
        if self._first is None:
            self._first = self._last
        if self._last - self._first < _SOON_SECONDS:
            self._with_first = self.done

    @property
    def seconds(self) -> float:
        """Since the start."""
        return self._clock() - self._start

    @property
    def rate(self) -> float | None:
        """Work a second; None as long as it is not known."""
        if self._first is None or self.done == self._with_first:
            return None
        return (self.done - self._with_first) / (self._last - self._first)

    @property
    def left(self) -> float | None:
        """Seconds that the rest takes at this rate."""
        return None if self.rate is None else (self.work - self.done) / self.rate


class Prospect:
    """Says once how long a long run takes, and how long with more workers.

    Parameters
    ----------
    pace : Pace
        Of the run.
    n_threads : int
        Tasks at a time.
    """

    def __init__(self, pace: Pace, n_threads: int) -> None:
        self._pace, self._n_threads = pace, n_threads
        self._told = False

    def sentence(self) -> str | None:
        """Return the sentence; None if it is not time for it."""
        pace = self._pace
        known = pace.done >= _KNOWN_SHARE * pace.work and pace.seconds >= _KNOWN_SECONDS
        if self._told or not known or (left := pace.left) is None:
            return None
        self._told = True
        if left < _LONG_SECONDS or not self._n_threads:
            return None
        more = _CLUSTER * self._n_threads
        return (
            f"About {_minutes(left)} are left with {self._n_threads} tasks at a time; a cluster "
            f"with {more} (--scheduler) would take about {_minutes(left / _CLUSTER)}. A run that "
            "is stopped goes on by the same command."
        )


def _minutes(seconds: float) -> str:
    minutes = max(round(seconds / 60), 2)
    return f"{minutes} minutes" if minutes < 120 else f"{round(minutes / 60)} hours"


class _Rate(ProgressColumn):
    """Work per second, and the time that the rest takes at this rate.

    Tasks arrive many at a time: the rate between arrivals, which rich would show, means nothing.
    """

    def render(self, task: Bar) -> Text:
        pace: Pace = task.fields["pace"]
        if pace.rate is None or pace.left is None:
            return Text("")
        left = timedelta(seconds=round(pace.left))
        return Text(f"{pace.rate / 1e6:.2f} million {task.fields['work']}/s, {left} left")


class TerminalProgress:
    """A bar with rate and time left."""

    def __init__(self, bars: Progress) -> None:
        self._bars = bars
        self._bar: TaskID | None = None
        #: Work of the next task that is done.
        self._of_next = 0

    def begin(self, units: tuple[str, str], unfinished: Size, whole: Size, n_threads: int) -> None:
        """Start the bar."""
        self._pace = Pace(unfinished.work)
        self._prospect = Prospect(self._pace, n_threads)
        self._bars.console.print(_plan(units, unfinished, whole), highlight=False)
        self._bar = self._bars.add_task(
            "Computing", total=unfinished.work, work=units[1], pace=self._pace
        )
        _load_report()

    def advance(self, outcome: Outcome, size: Size) -> None:
        """Move the bar by the work of a task."""
        self._advance(size.work - self._of_next)
        self._of_next = 0

    def part(self, work: int) -> None:
        """Move the bar by a part of the next task."""
        self._of_next += work
        self._advance(work)

    def _advance(self, work: int) -> None:
        assert self._bar is not None, "begin comes first"
        self._pace.advance(work)
        self._bars.update(self._bar, completed=self._pace.done)
        if sentence := self._prospect.sentence():
            self.note(sentence)

    def note(self, sentence: str) -> None:
        """Print a sentence above the bar."""
        self._bars.console.print(sentence, highlight=False)


class PlainProgress:
    """A line at the start, then one for every tenth of the work and at least every 30 s."""

    def begin(self, units: tuple[str, str], unfinished: Size, whole: Size, n_threads: int) -> None:
        """Print the first line."""
        self._pace = Pace(unfinished.work)
        self._prospect = Prospect(self._pace, n_threads)
        self._work = units[1]
        self._printed, self._last = 0, monotonic()
        self._of_next = 0  # work of the next task that is done
        click.echo(_plan(units, unfinished, whole))
        _load_report()

    def advance(self, outcome: Outcome, size: Size) -> None:
        """Count the work of a task; print a line if it is time."""
        self._advance(size.work - self._of_next)
        self._of_next = 0

    def part(self, work: int) -> None:
        """Count a part of the next task."""
        self._of_next += work
        self._advance(work)

    def _advance(self, work: int) -> None:
        pace = self._pace
        pace.advance(work)
        if sentence := self._prospect.sentence():
            self.note(sentence)
        now = monotonic()
        share = (pace.done - self._printed) / pace.work
        if pace.done < pace.work and (share >= _LINE_SHARE or now - self._last >= _LINE_SECONDS):
            self._printed, self._last = pace.done, now
            line = f"{pace.done / pace.work:.0%}"
            if pace.rate is not None:
                line += f", {pace.rate / 1e6:.2f} million {self._work}/s, {pace.left:.0f} s left"
            click.echo(line)

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
