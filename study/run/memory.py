"""Memory is planned: what a process takes by itself, and what each task takes on top."""

from typing import Any

import psutil
from distributed.system import MEMORY_LIMIT

from lepp import InputError
from study.run.kinds import Kind

#: What Dask's nanny leaves a worker of its limit: it kills it at 95 %.
USABLE = 0.9


def free_memory() -> int:
    """Return the bytes that are free on this computer.

    In a container, at most its limit; what other programs hold is not there either.
    """
    return int(min(MEMORY_LIMIT, psutil.virtual_memory().available))


def check_memory(kind: Kind, design: Any, available: float, whose: str) -> None:  # noqa: ANN401 - of the kind's own type
    """Raise `InputError` if the largest task of a design does not fit into memory alone.

    Parameters
    ----------
    kind : Kind
        The kind of the tasks.
    design : kind.design
        The design.
    available : float
        Bytes for tasks, without what the process takes by itself.
    whose : str
        Whose memory that is: the subject and verb of a sentence that ends in the bytes.
    """
    tasks = kind.tasks_of(design)
    least = (kind.least_memory_of(task, design) for task in tasks)
    what, needed = max(least, key=lambda m: m.n_bytes)
    if needed > available:
        base = kind.base_memory
        raise InputError(
            f"{what} takes about {in_words(needed + base)} of memory, but {whose} "
            f"{in_words(max(available, 0) + base)}: use smaller sizes."
        )


def in_words(n_bytes: float) -> str:
    """Return bytes as a reader sees them."""
    return f"{n_bytes / 1e9:,.1f} GB" if n_bytes >= 1e9 else f"{n_bytes / 1e6:,.0f} MB"
