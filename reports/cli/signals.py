"""Signals: what stops a run stops it once, however often it comes."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

#: What shells add to the number of the signal that ended a program.
_SHELL = 128

_STOPPING = (signal.SIGINT, signal.SIGTERM)


class _Stopped:
    """The signal that has stopped this process."""

    number: int = signal.SIGINT


@contextmanager
def stop_once() -> Iterator[None]:
    """Have Ctrl-C and SIGTERM raise `KeyboardInterrupt`, and ignore those that follow.

    What is under way is then closed in peace; whoever cannot wait for that has SIGKILL. If nothing
    was stopped, everything is afterwards as it was before.
    """
    stopped = False

    def stop(number: int, frame: FrameType | None) -> None:
        nonlocal stopped
        stopped = True
        for other in _STOPPING:
            signal.signal(other, signal.SIG_IGN)
        _Stopped.number = number
        raise KeyboardInterrupt

    before = {number: signal.signal(number, stop) for number in _STOPPING}
    try:
        yield
    finally:
        if not stopped:
            for number, handler in before.items():
                signal.signal(number, handler)


def exit_code() -> int:
    """Return the exit code of a process that was stopped."""
    return _SHELL + _Stopped.number
