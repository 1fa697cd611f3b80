"""What options of the command line take: times and sizes of memory."""

from __future__ import annotations

import re
from typing import Any

import click

_SECONDS = {"s": 1, "min": 60, "h": 3600, "d": 86400}


class Duration(click.ParamType):
    """A time such as 90s, 30min or 2h, as seconds."""

    name = "duration"

    def convert(
        self,
        value: Any,  # noqa: ANN401 - as click declares it
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> float:
        """Return the seconds."""
        if isinstance(value, float):  # click converts defaults once more
            return value
        found = re.fullmatch(r"(\d+(?:\.\d+)?) ?(s|min|h|d)", value)
        if found is None:
            self.fail(f"{value!r} is no time: write it as 90s, 30min, 2h or 1d.", param, ctx)
        return float(found[1]) * _SECONDS[found[2]]


class Bytes(click.ParamType):
    """A size of memory such as 400MB or 4GB, as bytes."""

    name = "bytes"

    def convert(
        self,
        value: Any,  # noqa: ANN401 - as click declares it
        param: click.Parameter | None,
        ctx: click.Context | None,
    ) -> int:
        """Return the bytes."""
        from dask.utils import parse_bytes

        try:
            n_bytes = int(parse_bytes(value))
        except ValueError:
            n_bytes = 0
        if n_bytes <= 0:
            self.fail(f"{value!r} is no size of memory: write it as 400MB or 4GB.", param, ctx)
        return n_bytes
