"""The one way in which files are written: whole, or not at all."""

import errno
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from secrets import token_hex

from lepp import InputError


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a path to write to, and put what is there in a file's place once it is on the disk.

    A file that is not there yet gets the permissions that the umask leaves, one that is keeps its
    own. Of a symbolic link the target is written. A device or a pipe is written through: it stays
    what it is.

    Parameters
    ----------
    path : Path
        The file.

    Yields
    ------
    temporary : Path
        An empty file beside it. Write to it by its name, and close it.

    Raises
    ------
    InputError
        If the file cannot be written; it is then as it was before, and nothing is left beside it.
    """
    try:
        if _is_written_through(path):
            with tempfile.TemporaryDirectory(prefix="lepp-study-") as folder:
                temporary = Path(folder) / "whole"
                temporary.touch()
                yield temporary
                with temporary.open("rb") as source, path.open("ab", buffering=0) as target:
                    shutil.copyfileobj(source, target)
            return
        target_path = path.resolve()
        temporary = target_path.with_name(f".{target_path.name}.{token_hex(4)}.tmp")
        _make_like(temporary, target_path)
        try:
            yield temporary
            # A handle that can write: Windows flushes no other.
            with temporary.open("r+b") as file:
                os.fsync(file.fileno())
            os.replace(temporary, target_path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
        _flush_directory(target_path.parent)
    except OSError as error:
        raise InputError(f"Cannot write {path}: {error.strerror or error}.") from None


def write_text(path: Path, text: str) -> None:
    """Write a text file in UTF-8, with line ends as they are in the text.

    Raises
    ------
    InputError
        As `replacing`.
    """
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="")


def leftovers(path: Path) -> list[Path]:
    """Return what writers of a file have left beside it that were killed."""
    return sorted(path.parent.glob(f".{path.name}.*.tmp"))


def _is_written_through(path: Path) -> bool:
    """Tell whether a path names no file on a disk: a device, a pipe, or an open descriptor."""
    try:
        mode = path.stat().st_mode
    except FileNotFoundError:
        return False
    # These names lead by links to what is open already, be it a regular file.
    opened = ("/dev/stdin", "/dev/stdout", "/dev/stderr", "/dev/fd/", "/proc/")
    return not stat.S_ISREG(mode) or str(path.absolute()).startswith(opened)


def _make_like(temporary: Path, target: Path) -> None:
    """Make an empty file with the permissions of another, or with a new file's."""
    os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    if target.exists():
        try:
            temporary.chmod(stat.S_IMODE(target.stat().st_mode))
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise


def _flush_directory(directory: Path) -> None:
    """Have the new name on the disk, where the system can say so."""
    try:
        handle = os.open(directory, os.O_RDONLY)
    except OSError:  # as on Windows
        return
    try:
        os.fsync(handle)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.EBADF):  # file systems that have no such thing
            raise
    finally:
        os.close(handle)
