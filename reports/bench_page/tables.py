"""A benchmark as tables, a table a quantity; beside an earlier one where there is one."""

from collections.abc import Iterator
from dataclasses import dataclass

import pandas as pd

from lepp import METHODS
from study.run.benchmark import QUANTITIES, Benchmark, Quantity, compared
from study.text.numbers import show

#: How the columns that tell measurements apart are headed, and shown.
_KEYS = {"method": "Triangulation", "n_points": "Points", "cores": "Cores"}


@dataclass(frozen=True)
class QuantityTable:
    """The measurements of one quantity.

    Attributes
    ----------
    id : str
        Its name in `QUANTITIES`.
    quantity : Quantity
    headings : list of str
    rows : list of list of str
        Keys of which all rows have the same value are left out.
    n_words : int
        How many of the first columns are words.
    """

    id: str
    quantity: Quantity
    headings: list[str]
    rows: list[list[str]]
    n_words: int


def tables_of(made: Benchmark, before: Benchmark | None) -> Iterator[QuantityTable]:
    """Yield the tables of a benchmark in the order of `QUANTITIES`."""
    frame = made.measurements if before is None else compared(made, before)
    for name, quantity in QUANTITIES.items():
        rows = frame[frame["quantity"] == name].sort_values("method", key=_place, kind="stable")
        if len(rows):
            yield _table(name, quantity, rows)


def _table(name: str, quantity: Quantity, rows: pd.DataFrame) -> QuantityTable:
    keys = [key for key in _KEYS if rows[key].nunique() > 1]
    columns = {_KEYS[key]: [_key(value) for value in rows[key]] for key in keys}
    columns["Here"] = [show(value, quantity.format) for value in rows["value"]]
    if "before" in rows:
        columns["Before"] = [show(value, quantity.format) for value in rows["before"]]
        columns["Times as good"] = [show(value, "fixed2") for value in rows["gain"]]
    cells = [list(row) for row in zip(*columns.values(), strict=True)]
    return QuantityTable(name, quantity, list(columns), cells, int("method" in keys))


def _place(methods: pd.Series) -> pd.Series:
    return methods.map({method: place for place, method in enumerate(("", *METHODS))})


def _key(value: object) -> str:
    return METHODS[value].title if isinstance(value, str) else show(value, "int")
