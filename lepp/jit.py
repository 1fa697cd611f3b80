"""The one home of numba's options, and of the on-disk cache of compiled kernels.

Numba's cache looks only at the file in which a kernel stands: a predicate changed in another file
would leave a stale kernel running. The cache directory is therefore named by a hash of all the
sources of this package and of the versions of Numba and NumPy.
"""

import hashlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import llvmlite
import numba
import numpy as np
import platformdirs


def _cache_directory() -> str:
    digest = hashlib.sha256()
    for version in (numba.__version__, llvmlite.__version__, np.__version__):
        digest.update(version.encode())
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.read_bytes())
    base = Path(numba.config.CACHE_DIR or platformdirs.user_cache_dir("lepp-study"))
    try:
        base.mkdir(parents=True, exist_ok=True)
        writable = os.access(base, os.W_OK)
    except OSError:
        writable = False
    if not writable:
        base = Path(tempfile.gettempdir()) / "lepp-study"
    return str(base / f"kernels-{digest.hexdigest()[:16]}")


_CACHE_DIRECTORY = _cache_directory()


def kernel(function: Callable) -> Any:  # noqa: ANN401 - numba's dispatchers have no public type
    """Compile a function on its first call and keep the machine code on disk.

    No ``fastmath`` (predicates rely on IEEE arithmetic, and on no contraction of products and
    sums), no GIL, and NumPy's semantics for division, so that no check stands in an inner loop.
    """
    return _compiled(function, inline="never")


def inlined(function: Callable) -> Any:  # noqa: ANN401 - as above
    """Make a kernel that is copied into its callers.

    For what is called in inner loops with arrays: a call would count their references.
    """
    return _compiled(function, inline="always")


def _compiled(function: Callable, inline: str) -> Any:  # noqa: ANN401 - as above
    cache_directory = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = _CACHE_DIRECTORY
    try:
        return numba.njit(
            cache=True, nogil=True, error_model="numpy", fastmath=False, inline=inline
        )(function)
    finally:
        numba.config.CACHE_DIR = cache_directory
