"""The one home of numba's options."""

from collections.abc import Callable
from typing import Any

import numba

from lepp.jit.cache import cache_directory

_CACHE_DIRECTORY = cache_directory()


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
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(_CACHE_DIRECTORY or before)
    try:
        return numba.njit(
            cache=_CACHE_DIRECTORY is not None,
            nogil=True,
            error_model="numpy",
            fastmath=False,
            inline=inline,
        )(function)
    finally:
        numba.config.CACHE_DIR = before
