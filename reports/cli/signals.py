"""Signals: what stops a command stops it once, however often it comes."""

from __future__ import annotations

import signal
import sys
from _thread import interrupt_main
from contextlib import contextmanager, suppress
from threading import Event, Thread, get_ident
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import FrameType

#: What shells add to the number of the signal that ended a program.
_SHELL = 128

_STOPPING = (signal.SIGINT, signal.SIGTERM)
_AGAIN_SECONDS = 0.5


class _Stopped:
    """The signal that has stopped this process."""

    number: signal.Signals = signal.SIGINT


@contextmanager
def stop_once() -> Iterator[None]:
    """Have Ctrl-C and SIGTERM raise `KeyboardInterrupt`, and ignore those that follow.

    What is under way is then closed in peace; whoever cannot wait for that has SIGKILL. What is
    raised may be lost: in a callback, as of the collector of garbage, or to code that takes any
    error. It is raised again until something is done about it. If nothing was stopped, everything
    is afterwards as it was before.
    """
    stopped, ended, this_thread = False, Event(), get_ident()

    def again() -> None:
        while not ended.wait(_AGAIN_SECONDS):
            if sys.platform == "win32":
                interrupt_main(_Stopped.number)
            else:  # wakes it from what it waits for
                signal.pthread_kill(this_thread, _Stopped.number)

    def stop(number: int, frame: FrameType | None) -> None:
        nonlocal stopped
        if stopped and _is_in_hand():
            return
        if not stopped:
            stopped = True
            _Stopped.number = signal.Signals(number)
            with suppress(RuntimeError):  # there can be no more threads
                Thread(target=again, daemon=True).start()
        raise KeyboardInterrupt

    def not_raised(what: sys.UnraisableHookArgs) -> None:
        # It comes again; and objects that it has left half made fail when they are collected.
        if not stopped:
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
        ended.set()
        if not stopped:
            sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, signal.SIG_IGN if stopped else handler)


def _is_in_hand() -> bool:
    """Tell whether a `KeyboardInterrupt` is being handled, as in a ``finally``."""
    error = sys.exc_info()[1]
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__context__
    return error is not None


def exit_code() -> int:
    """Return the exit code of a process that was stopped."""
    return _SHELL + _Stopped.number
