"""A table of the analysis: tidy rows, and what its columns are called and measured in.

The report draws these tables and formats their cells; the numbers on disk are exact.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Self

import pandas as pd

_FORMAT = re.compile(r"text|int|p|log10p|fixed\d+|g\d+|percent\d+")


@dataclass(frozen=True)
class Column:
    """What one column of a table is.

    Attributes
    ----------
    name : str
        Name of the frame's column.
    label : str
        Heading for a reader.
    unit : str
        Unit of measurement, empty where there is none.
    format : str
        How a cell is shown: ``text``, ``int``, ``fixedN`` (N decimals), ``gN`` (N significant
        digits), ``percentN`` (a share times 100, N decimals), ``p`` (a p-value) or ``log10p``
        (its decimal logarithm).
    """

    name: str
    label: str
    unit: str = ""
    format: str = "text"

    def __post_init__(self) -> None:
        if not _FORMAT.fullmatch(self.format):
            raise ValueError(f"unknown format {self.format!r} of column {self.name!r}")

    @property
    def header(self) -> str:
        """The column's name with its unit, as CSV files have it: ``n_points [points]``."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


METHOD = Column("method", "Triangulation")
DISTRIBUTION = Column("distribution", "Distribution")
N_POINTS = Column("n_points", "Points", "points", "int")


def _series(cells: list[object], shown_as: str) -> pd.Series:
    if shown_as == "text":
        return pd.Series(cells, dtype="str")
    if shown_as == "int":
        return pd.Series(cells, dtype="Int64" if any(map(pd.isna, cells)) else "int64")
    return pd.Series(cells, dtype="float64")


@dataclass(frozen=True)
class Table:
    """Tidy rows and the description of their columns.

    Attributes
    ----------
    name : str
        Identifier, also the name of its CSV file.
    title : str
        One line for a reader.
    frame : pandas.DataFrame
        One row an observation; its columns are those of `columns`, in order. A null cell means
        that the value could not be computed.
    columns : tuple of Column
    note : str
        What is assumed, and how to read the table.
    """

    name: str
    title: str
    frame: pd.DataFrame
    columns: tuple[Column, ...]
    note: str = ""

    def __post_init__(self) -> None:
        described = [column.name for column in self.columns]
        if list(self.frame.columns) != described:
            found = list(self.frame.columns)
            raise ValueError(f"table {self.name!r} has columns {found}, described: {described}")

    @classmethod
    def from_rows(
        cls,
        name: str,
        title: str,
        columns: tuple[Column, ...],
        rows: Iterable[Mapping[str, object]],
        note: str = "",
    ) -> Self:
        """Make a table of one mapping a row; what a mapping lacks is a null cell.

        Columns of format ``int`` become int64 (nullable Int64 where cells are null), ``text``
        stays as it is, everything else becomes float64.
        """
        rows = list(rows)
        frame = pd.DataFrame(
            {
                column.name: _series([row.get(column.name) for row in rows], column.format)
                for column in columns
            }
        )
        return cls(name, title, frame, columns, note)

    def to_csv(self) -> str:
        """Text of the table as CSV, header with units, every float at full precision."""
        return self.frame.to_csv(
            index=False, header=[column.header for column in self.columns], lineterminator="\n"
        )
