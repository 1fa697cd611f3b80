"""Signals: what stops a command stops it once, however often it comes."""

from __future__ import annotations

import signal
import sys
from _thread import interrupt_main
from contextlib import contextmanager
from threading import Timer
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import FrameType

#: What shells add to the number of the signal that ended a program.
_SHELL = 128

_STOPPING = (signal.SIGINT, signal.SIGTERM)
_AGAIN_SECONDS = 0.05


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

    def not_raised(what: sys.UnraisableHookArgs) -> None:
        # The signal came in a callback, as of the collector of garbage, that can raise nothing.
        if stopped and issubclass(what.exc_type, KeyboardInterrupt):
            signal.signal(_Stopped.number, stop)
            Timer(_AGAIN_SECONDS, interrupt_main, [_Stopped.number]).start()
        else:
            hook(what)

    before = {number: signal.signal(number, stop) for number in _STOPPING}
    hook, sys.unraisablehook = sys.unraisablehook, not_raised
    try:
        yield
    except SystemError as error:
        # The signal came while a kernel ran: "returned a result with an exception set".
        if not stopped:
            raise
        raise KeyboardInterrupt from error
    finally:
        sys.unraisablehook = hook
        if not stopped:
            for number, handler in before.items():
                signal.signal(number, handler)


def exit_code() -> int:
    """Return the exit code of a process that was stopped."""
    return _SHELL + _Stopped.number
