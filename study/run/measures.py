"""Measures: the fields of a dataclass, from which schemas, types and headings follow.

A measure is named once: its name, its type, what it is of, its words, its unit and its format stand
in one line of a class such as `study.run.triangulations.Measures`.
"""

import typing
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import cache
from typing import Any, TypeVar

import pyarrow as pa

M = TypeVar("M")

_TYPES = {int: pa.int64(), float: pa.float64(), str: pa.string()}


def measure(
    label: str, *, unit: str = "", format: str, of: Callable[[Any], Any] | None = None
) -> Any:  # noqa: ANN401 - as `dataclasses.field`, it stands for a value of the field's type
    """Declare a field that is a measure.

    Parameters
    ----------
    label : str
        Heading for a reader.
    unit : str
        Unit of measurement, empty where there is none.
    format : str
        How a cell is shown, as in `study.analysis.table.Column`.
    of : callable, optional
        Computes the measure of what `measured` is given.
    """
    return field(metadata={"label": label, "unit": unit, "format": format, "of": of})


@dataclass(frozen=True)
class MeasureColumn:
    """A measure as a column.

    Attributes
    ----------
    name, label, unit, format : str
        As in `study.analysis.table.Column`.
    type : type
        int, float or str.
    """

    name: str
    label: str
    unit: str
    format: str
    type: type

    @property
    def field(self) -> pa.Field:
        """The column of a Parquet file."""
        return pa.field(self.name, _TYPES[self.type])

    @property
    def dtype(self) -> str:
        """The column of a frame without nulls."""
        return {int: "int64", float: "float64", str: "str"}[self.type]


@cache
def _types_of(measures: type) -> dict[str, type]:
    return typing.get_type_hints(measures)


@cache
def columns_of(measures: type) -> tuple[MeasureColumn, ...]:
    """Return the columns of a class of measures, or of a named tuple's fields without words.

    Returns
    -------
    tuple of MeasureColumn
        In the order of the fields.
    """
    types = _types_of(measures)
    return tuple(
        MeasureColumn(
            entry.name,
            entry.metadata["label"],
            entry.metadata["unit"],
            entry.metadata["format"],
            types[entry.name],
        )
        for entry in fields(measures)
    )


def fields_of(task: type) -> list[pa.Field]:
    """Return the Parquet columns of a task's fields."""
    return [pa.field(name, _TYPES[kind]) for name, kind in typing.get_type_hints(task).items()]


def measured(measures: type[M], subject: object) -> M:
    """Compute every measure of a class; each is of its field's type."""
    described: Any = measures  # a dataclass, which a type variable cannot say
    types = _types_of(described)
    values = {
        entry.name: types[entry.name](entry.metadata["of"](subject)) for entry in fields(described)
    }
    return measures(**values)


def values_of(measures: object) -> tuple[Any, ...]:
    """Return the values of a class's instance in the order of its fields.

    As `dataclasses.astuple`, which copies each and takes a tenth of a small task's time.
    """
    return tuple(vars(measures).values())
