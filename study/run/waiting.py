"""Waiting: what a run waits for is said every half minute, and never without end."""

from collections.abc import Callable
from time import monotonic

from lepp import InputError

#: What takes longer is told.
PATIENCE_SECONDS = 3.0
#: Between two lines about the same.
EVERY_SECONDS = 30.0


class RunStoppedError(InputError):
    """A run cannot go on; what was finished is kept."""

    def __init__(self, reason: str) -> None:
        super().__init__(
            f"{reason}; what was finished is kept, and the same command goes on from there."
        )


class Waiting:
    """Follows what is waited for.

    Parameters
    ----------
    limit : float
        Seconds that may pass without anything getting on.
    advice : str
        How the limit is changed, or what else can be done, for the sentence at the end.
    note : callable
        Takes a sentence.
    clock : callable
        Seconds.
    """

    def __init__(
        self,
        limit: float,
        advice: str,
        note: Callable[[str], None],
        clock: Callable[[], float] = monotonic,
    ) -> None:
        self._limit, self._advice, self._note, self._clock = limit, advice, note, clock
        self._since: float | None = None
        self._next = 0.0

    def look(self, what: str | None) -> None:
        """Hear what is waited for now, None for nothing; say so now and then.

        Raises
        ------
        RunStoppedError
            If nothing has got on for the limit.
        """
        if what is None:
            self._since = None
            return
        now = self._clock()
        if self._since is None:
            self._since, self._next = now, PATIENCE_SECONDS
        passed = now - self._since
        if passed >= self._limit:
            raise RunStoppedError(f"Waited {duration(self._limit)} for {what} ({self._advice})")
        if passed >= self._next:
            self._next = passed + EVERY_SECONDS
            self._note(
                f"Waiting for {what}, {duration(passed)} of at most {duration(self._limit)}."
            )


def duration(seconds: float) -> str:
    """Return a time in words, such as ``90 seconds`` or ``1 hour``."""
    for unit, length in (("hour", 3600), ("minute", 60)):
        if seconds >= 2 * length or seconds == length:
            count = round(seconds / length)
            return f"{count} {unit}" + "s" * (count != 1)
    count = round(seconds)
    return f"{count} second" + "s" * (count != 1)
