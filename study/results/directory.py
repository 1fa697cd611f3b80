"""A directory that a run writes into: its own, and its alone."""

import errno
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from lepp import InputError
from study.results.files import leftovers
from study.results.manifest import MANIFEST

LOCK = ".lock"

#: What file managers leave wherever they have been.
_NOBODYS = {".DS_Store", "Thumbs.db", "desktop.ini"}

#: What file systems without locks say to a request for one.
_NO_LOCKS = {errno.ENOSYS, errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP}


def locked(directory: Path, note: Callable[[str], None]) -> FileLock:
    """Keep every other run out of a directory until the lock is released or its holder dies."""
    # No file that only means to be a lock: it would outlive a run that is killed.
    lock = FileLock(directory / LOCK, blocking=False, thread_local=False, fallback_to_soft=False)
    try:
        lock.acquire()
    except Timeout:
        raise InputError(
            f"Another run is writing into {directory}: wait for its end, or give another directory."
        ) from None
    except OSError as error:
        if error.errno not in _NO_LOCKS:
            raise
        note(
            f"The file system of {directory} has no locks: see to it that no other run writes "
            "there meanwhile."
        )
    return lock


def check_ours(directory: Path) -> None:
    """Refuse a directory with files in it that no run has left there."""
    if not directory.is_dir():
        raise InputError(f"{directory} is a file: give a directory for the results.")
    names = {path.name for path in directory.iterdir()}
    # A run that is killed before it has written its manifest leaves these.
    ours = {LOCK, *(path.name for path in leftovers(directory / MANIFEST))}
    if MANIFEST not in names and names - ours - _NOBODYS:
        raise InputError(
            f"{directory} is not empty and holds no results of lepp-study: give another directory."
        )


@contextmanager
def writing(directory: Path) -> Iterator[None]:
    """Turn failures to write into sentences."""
    try:
        yield
    except OSError as error:
        raise InputError(f"Cannot write into {directory}: {error.strerror or error}.") from None
