"""The one home of numba's options."""

from collections.abc import Callable
from typing import Any

import numba
from numba.core.types.misc import unliteral

from lepp.jit.cache import cache_directory

CACHE_DIRECTORY = cache_directory()
"""Where machine code is kept; None if nowhere."""


def kernel(function: Callable) -> Any:  # noqa: ANN401 - numba's dispatchers have no public type
    """Compile a function on its first call and keep the machine code on disk.

    No ``fastmath`` (predicates rely on IEEE arithmetic, and on no contraction of products and
    sums), no GIL, and NumPy's semantics for division, so that no check stands in an inner loop.
    """
    return _compiled(function)


def inner(function: Callable) -> Any:  # noqa: ANN401 - as above
    """Make a kernel for kernels alone: to call it from Python would end the process.

    What a call from Python takes is an eighth of the time that compiling takes.
    """
    return _compiled(function, no_cpython_wrapper=True)


def inlined(function: Callable) -> Any:  # noqa: ANN401 - as above
    """Make a kernel that is copied into its callers.

    For what is called in inner loops with arrays: a call would count their references.
    """
    return _compiled(function, inline="always")


def _compiled(function: Callable, **options: object) -> Any:  # noqa: ANN401 - as above
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(CACHE_DIRECTORY or before)
    try:
        made = numba.njit(
            cache=CACHE_DIRECTORY is not None,
            nogil=True,
            error_model="numpy",
            fastmath=False,
            no_cfunc_wrapper=True,
            **options,
        )(function)
    finally:
        numba.config.CACHE_DIR = before
    if not numba.config.DISABLE_JIT:
        made.get_call_template = _without_literals(made.get_call_template)
    return made


def _without_literals(template_of: Callable) -> Callable:
    """Take a number that stands in a call for its type: else a kernel is compiled for each.

    So it has one signature, and processes that compile it at once write the same files.
    """

    def template_without_literals(args: tuple, kws: dict) -> Any:  # noqa: ANN401 - as above
        return template_of(
            tuple(unliteral(a) for a in args), {name: unliteral(a) for name, a in kws.items()}
        )

    return template_without_literals
