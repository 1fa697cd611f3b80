"""A lock on a results directory, released by the operating system when its holder dies."""

import sys
from pathlib import Path
from typing import IO

from lepp import InputError

NAME = ".lock"


class DirectoryLock:
    """Keep every other run out of a directory until `release` or the end of this process.

    Parameters
    ----------
    directory : Path
        An existing directory.

    Raises
    ------
    InputError
        If another run holds the directory.
    """

    def __init__(self, directory: Path) -> None:
        # The file stays when the lock is released: removing it would let two runs hold two locks.
        self._file = (directory / NAME).open("ab")
        try:
            _lock(self._file)
        except OSError:
            self._file.close()
            raise InputError(
                f"Another run is writing into {directory}: wait for its end, or give another "
                "directory."
            ) from None

    def release(self) -> None:
        """Let other runs in."""
        self._file.close()


if sys.platform == "win32":
    import msvcrt

    def _lock(file: IO[bytes]) -> None:
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _lock(file: IO[bytes]) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
