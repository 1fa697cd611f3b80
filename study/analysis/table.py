"""A table of the analysis: tidy rows, and what its columns are called and measured in.

The report draws these tables and formats their cells; the numbers on disk are exact.
"""

import re
from dataclasses import dataclass

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
            raise ValueError(
                f"table {self.name!r} has columns {list(self.frame.columns)}, described: {described}"
            )

    def to_csv(self) -> str:
        """Text of the table as CSV, header with units, every float at full precision."""
        return self.frame.to_csv(
            index=False, header=[column.header for column in self.columns], lineterminator="\n"
        )
