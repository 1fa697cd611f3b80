"""A client of a Dask scheduler, which is closed if it does not come about."""

from contextlib import suppress
from typing import Any

import distributed

# Few functions of distributed are annotated.
_distributed: Any = distributed


def connected(
    to: Any,  # noqa: ANN401 - as `_distributed`
    timeout: float,
) -> Any:  # noqa: ANN401 - as `_distributed`
    """Return a client that is connected.

    What a failing constructor of `distributed.Client` leaves would be closed when it is collected,
    in whatever thread that happens: in one that another client is starting, and waits for, it would
    wait for ever.

    Parameters
    ----------
    to : str or distributed.LocalCluster
        The address of a scheduler, or a cluster.
    timeout : float
        Seconds to try it.

    Returns
    -------
    distributed.Client

    Raises
    ------
    Exception
        What `distributed.Client` raises; what listens at an address may be anything.
    """
    client = object.__new__(_distributed.Client)
    try:
        client.__init__(to, timeout=timeout)
    except BaseException:
        # It may have been made so far that there is nothing to close, or nothing that ends in time.
        with suppress(AttributeError, OSError, RuntimeError):
            client.close(timeout=timeout)
        raise
    return client
