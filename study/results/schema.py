"""From the outcomes of tasks to tables and back."""

from collections.abc import Mapping, Sequence
from itertools import chain
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import NDArray

from study.run.kinds import ERROR, WORKER, Cells, Kind, Outcome


def tables_of(kind: Kind, design: Any, outcomes: Sequence[Outcome]) -> dict[str, pa.Table]:  # noqa: ANN401 - of the kind's own type
    """Arrange outcomes as the tables of a results directory.

    Parameters
    ----------
    kind : Kind
        The kind of the tasks.
    design : kind.design
        Their design; orders the rows.
    outcomes : sequence of Outcome
        In the order of the tasks.

    Returns
    -------
    tables : dict of str to pyarrow.Table
        By the names of `kind.tables`.
    """
    order = kind.order_of(design)
    return {
        name: _ordered(_table(name, table.schema, outcomes), order)
        for name, table in kind.tables.items()
    }


def outcomes_of(kind: Kind, tables: Mapping[str, pa.Table]) -> dict[Any, Outcome]:
    """Return the outcomes that tables were made of, by their tasks.

    Rows of a task are in the order of their tables; a task is failed if one of its rows is, and
    its own time, which no table needs, is not known any more.
    """
    rows: dict[Any, dict[str, list[Cells]]] = {}
    errors: dict[Any, list[str]] = {}
    workers: dict[Any, str] = {}
    for name, table in tables.items():
        columns = table.to_pydict()
        nothing = [None] * len(table)
        own = [columns[column] for column in table.schema.names if _is_cell(column, kind.task)]
        keys = zip(*(columns[field] for field in kind.task._fields), strict=True)
        for key, cells, error, worker in zip(
            keys,
            zip(*own, strict=True) if own else [()] * len(table),
            columns.get(ERROR, nothing),
            columns.get(WORKER, nothing),
            strict=True,
        ):
            task = kind.task(*key)
            rows.setdefault(task, {}).setdefault(name, []).append(cells)
            if error is not None:
                errors.setdefault(task, []).append(error)
            if worker is not None:
                workers[task] = worker
    return {
        task: Outcome(
            task,
            by_table,
            worker=workers.get(task, ""),
            error="; ".join(dict.fromkeys(errors.get(task, []))) or None,
        )
        for task, by_table in rows.items()
    }


def frame_of(table: pa.Table) -> pd.DataFrame:
    """Return a table as a frame: integers with gaps stay integers, texts are texts."""
    frame = table.to_pandas()
    for field in table.schema:
        if pa.types.is_integer(field.type) and table[field.name].null_count:
            frame[field.name] = pd.array(table[field.name].to_pylist(), dtype="Int64")
        elif pa.types.is_string(field.type):
            frame[field.name] = frame[field.name].astype("str")
    return frame


def _is_cell(column: str, task: Any) -> bool:  # noqa: ANN401 - a type of named tuples
    """Tell whether the rows of outcomes have a cell of a column."""
    return column not in task._fields and column != WORKER


def _table(name: str, schema: pa.Schema, outcomes: Sequence[Outcome]) -> pa.Table:
    rows = [outcome.rows.get(name, []) for outcome in outcomes]
    of_outcomes = {WORKER: [outcome.worker for outcome in outcomes]}
    for position, field in enumerate(outcomes[0].task._fields if outcomes else ()):
        of_outcomes[field] = [outcome.task[position] for outcome in outcomes]
    places = pa.array(np.repeat(np.arange(len(rows)), [len(part) for part in rows]))
    own = iter(zip(*chain.from_iterable(rows), strict=True))
    arrays = [
        pa.array(of_outcomes[field.name], type=field.type).take(places)
        if field.name in of_outcomes
        else pa.array(next(own, ()), type=field.type)
        for field in schema
    ]
    return pa.table(arrays, schema=schema)


def ranks_of(table: pa.Table, order: Mapping[str, Sequence[object]]) -> NDArray[np.int64]:
    """Return the place of each row by the columns that come before the tasks.

    Returns
    -------
    ndarray of int64
        Equal for rows that only their tasks order.
    """
    ranks = np.zeros(len(table), np.int64)
    for name, values in order.items():
        if name in table.schema.names:
            place = {value: rank for rank, value in enumerate(values)}
            ranks = ranks * len(place) + np.array([place[c] for c in table[name].to_pylist()], int)
    return ranks


def _ordered(table: pa.Table, order: Mapping[str, Sequence[object]]) -> pa.Table:
    """Order rows by the columns that come before the tasks, and else leave them as they are."""
    ranks = ranks_of(table, order)
    return table.take(pa.array(np.argsort(ranks, kind="stable"))).combine_chunks()
