"""Where compiled kernels are kept on disk.

Numba's cache looks only at the file in which a kernel stands: a predicate changed in another file
would leave a stale kernel running. The cache directory is therefore named by a hash of all the
sources of this package and of the versions of Numba and NumPy.

Numba unpickles what it finds there, so the directory must be of the user's own making: one that
another user could have laid, or could write into, is not used.
"""

import hashlib
import os
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path

import llvmlite
import numba
import numpy as np
import platformdirs

PACKAGE = Path(__file__).parents[1]


def cache_directory() -> Path | None:
    """Return a directory for compiled kernels; None where none can be trusted and written to.

    The first that will do of: `NUMBA_CACHE_DIR`, the user's cache, the directory of temporary
    files.
    """
    name = f"kernels-{sources_hash(PACKAGE)}"
    for base in _bases():
        try:
            base.mkdir(mode=0o700, parents=True, exist_ok=True)
            directory = base / name
            directory.mkdir(mode=0o700, exist_ok=True)
        except OSError:
            continue
        if _is_private(directory) and os.access(directory, os.W_OK | os.X_OK):
            return directory
    return None


def sources_hash(package: Path) -> str:
    """Return a hash of all that decides the machine code of a package's kernels.

    Parameters
    ----------
    package : Path
        A folder of Python files; those in its subfolders count.

    Returns
    -------
    str
        16 hexadecimal digits, of the files' names and texts and the versions of numba, llvmlite and
        NumPy.
    """
    digest = hashlib.sha256()
    for version in (numba.__version__, llvmlite.__version__, np.__version__):
        digest.update(version.encode())
    for source in sorted(package.rglob("*.py")):
        digest.update(source.relative_to(package).as_posix().encode())
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def _bases() -> Iterator[Path]:
    user = f"-{os.getuid()}" if hasattr(os, "getuid") else ""
    if numba.config.CACHE_DIR:  # may be one for many users
        yield Path(numba.config.CACHE_DIR) / f"lepp-study{user}"
    yield Path(platformdirs.user_cache_dir("lepp-study"))
    yield Path(tempfile.gettempdir()) / f"lepp-study{user}"


def _is_private(directory: Path) -> bool:
    """Tell whether a directory and the one above it are this user's, for nobody else to write."""
    if not hasattr(os, "getuid"):  # as on Windows, where the cache is in the user's profile
        return True
    for path in (directory, directory.parent):
        status = path.lstat()
        if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.getuid():
            return False
        if status.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
            return False
    return True
