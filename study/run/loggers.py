"""The loggers of distributed, whose tracebacks stand beside what is said in a sentence."""

import logging
from threading import Lock


class _Silence:
    """Keeps the loggers of distributed quiet while it is entered, however many times."""

    #: Those to which distributed's configuration gives levels of their own, and the event loop's.
    _NAMES = (
        "distributed",
        "distributed.client",
        "distributed.nanny",
        "distributed.scheduler",
        "tornado",
        "tornado.application",
        "asyncio",
    )

    def __init__(self) -> None:
        self._lock = Lock()
        self._depth = 0
        self._levels: dict[str, int] = {}

    def __enter__(self) -> None:
        with self._lock:
            if self._depth == 0:
                self._levels = {name: logging.getLogger(name).level for name in self._NAMES}
                for name in self._NAMES:
                    logging.getLogger(name).setLevel(logging.CRITICAL)
            self._depth += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._depth -= 1
            if self._depth == 0:
                for name, level in self._levels.items():
                    logging.getLogger(name).setLevel(level)


SILENCE = _Silence()
