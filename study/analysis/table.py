"""Tables of the analysis: what each is declared to hold, its rows, and how they are reached.

A table is declared once, as a module-level `Declaration` beside the code that fills it. The report
draws the tables and formats their cells; the numbers on disk are exact. Whoever asks for a table or
a column that does not exist is told so at once.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import pandas as pd

Row = dict[str, object]

_WORDS = ("text", "name", "verdict")
_FORMAT = re.compile(rf"{'|'.join(_WORDS)}|int|df|p|log10p|fixed\d+|g\d+|percent\d+")
#: Not of Arrow: its overhead is a third of the analysis of frames as small as these.
_WORDS_DTYPE = pd.StringDtype("python", na_value=np.nan)
_QUOTED = re.compile(r'[",\r\n]')


class UnknownNameError(KeyError):
    """A table or a column was asked for that does not exist: a mistake in the program."""

    def __str__(self) -> str:
        return str(self.args[0])


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
        How a cell is shown: ``text``, ``name`` (of a method or distribution), ``verdict`` (a word
        that is good or bad news), ``int``, ``df`` (degrees of freedom, whole or not), ``fixedN``
        (N decimals), ``gN`` (N significant digits), ``percentN`` (a share times 100, N decimals),
        ``p`` (a p-value) or ``log10p`` (its decimal logarithm).
    note : str
        What a reader of this column has to know beside the table's own note: what shows only some
        of the columns has only their notes.
    """

    name: str
    label: str
    unit: str = ""
    format: str = "text"
    note: str = ""

    def __post_init__(self) -> None:
        if not _FORMAT.fullmatch(self.format):
            raise ValueError(f"unknown format {self.format!r} of column {self.name!r}")

    @property
    def header(self) -> str:
        """The column's name with its unit, as CSV files have it: ``n_points [points]``."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    @property
    def is_number(self) -> bool:
        """Whether the cells are numbers, not words."""
        return self.format not in _WORDS


METHOD = Column("method", "Triangulation", "", "name")
DISTRIBUTION = Column("distribution", "Distribution", "", "name")
N_POINTS = Column("n_points", "Points", "points", "int")


def end(value: float) -> float | None:
    """Return the end of an interval as a cell: null where the interval has none."""
    return value if np.isfinite(value) else None


def select(frame: pd.DataFrame, where: Mapping[str, object], of: str = "the frame") -> pd.DataFrame:
    """Rows of a frame whose columns have the values asked for.

    Parameters
    ----------
    frame : pandas.DataFrame
    where : mapping of str to object
        Column and value.
    of : str
        What the frame is, for the error.

    Raises
    ------
    UnknownNameError
        If the frame has no such column.
    """
    check_columns(where, list(frame.columns), of)
    if not where:
        return frame
    picked = np.ones(len(frame), dtype=bool)
    for column, value in where.items():
        picked &= _equal(frame[column], value)
    return frame[picked]


def _equal(cells: pd.Series, value: object) -> np.ndarray:
    """Tell which cells have a value, (n,) bool."""
    if isinstance(cells.dtype, np.dtype):
        return cells.to_numpy() == value
    if cells.dtype == _WORDS_DTYPE:  # pandas takes a millisecond for a comparison of few
        return cells.to_numpy(dtype=object) == value
    return (cells == value).to_numpy(dtype=bool, na_value=False)


def check_columns(asked: Iterable[str], columns: Sequence[str], of: str) -> None:
    """Raise UnknownNameError unless all columns asked for are there."""
    for name in asked:
        if name not in columns:
            raise UnknownNameError(f"{of} has no column {name!r}, only {', '.join(columns)}")


@dataclass(frozen=True)
class ColumnReference:
    """The values of a column, and where they stand: figures refer to them instead of repeating.

    Attributes
    ----------
    table, column : str
    where : mapping of str to object
        What picks the rows.
    values : pandas.Series
    """

    table: str
    column: str
    where: Mapping[str, object]
    values: pd.Series = field(repr=False, compare=False)

    def __len__(self) -> int:
        return len(self.values)

    def __iter__(self) -> Iterator[object]:
        return iter(self.values)

    def min(self) -> float:
        """Least value."""
        return self.values.min()

    def max(self) -> float:
        """Largest value."""
        return self.values.max()


@dataclass(frozen=True)
class Rows:
    """Rows of a table that have given values in some columns.

    Attributes
    ----------
    table : str
        Name of the table.
    where : mapping of str to object
        The columns and values that have picked the rows.
    frame : pandas.DataFrame
    """

    table: str
    where: Mapping[str, object]
    frame: pd.DataFrame

    def __len__(self) -> int:
        return len(self.frame)

    def __getitem__(self, column: str) -> pd.Series:
        check_columns([column], list(self.frame.columns), f"table {self.table!r}")
        return self.frame[column]

    @property
    def empty(self) -> bool:
        """Whether there is no row."""
        return self.frame.empty

    @property
    def first(self) -> pd.Series:
        """The first row; IndexError if there is none."""
        return self.frame.iloc[0]

    @property
    def last(self) -> pd.Series:
        """The last row; IndexError if there is none."""
        return self.frame.iloc[-1]

    def column(self, name: str) -> ColumnReference:
        """Refer to a column of these rows."""
        return ColumnReference(self.table, name, self.where, self[name])

    def select(self, **where: object) -> "Rows":
        """Narrow the rows down."""
        frame = select(self.frame, where, f"table {self.table!r}")
        return Rows(self.table, {**self.where, **where}, frame)


def _series(cells: list[object], column: Column) -> pd.Series:
    if not column.is_number:
        return pd.Series(cells, dtype=_WORDS_DTYPE)
    if column.format == "int":
        return pd.Series(cells, dtype="Int64" if any(map(pd.isna, cells)) else "int64")
    return pd.Series(cells, dtype="float64")


def _quoted(cell: str) -> str:
    return '"' + cell.replace('"', '""') + '"' if _QUOTED.search(cell) else cell


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
        What is assumed, and how to read the table; of columns, only what all of them need.
    """

    name: str
    title: str
    frame: pd.DataFrame
    columns: tuple[Column, ...]
    note: str = ""

    def __post_init__(self) -> None:
        described = [column.name for column in self.columns]
        if list(self.frame.columns) != described:
            has = list(self.frame.columns)
            raise ValueError(f"table {self.name!r} has columns {has}, described: {described}")

    def rows(self, **where: object) -> Rows:
        """Rows that have the values asked for."""
        return Rows(self.name, {}, self.frame).select(**where)

    def has(self, column: str) -> bool:
        """Whether there is a column of that name."""
        return column in self.frame.columns

    def cells(self, column: str) -> list[str]:
        """Text of a column's cells as CSV files have them: every float at full precision."""
        values = self.frame[column]
        if values.dtype == np.float64:
            return ["" if value != value else repr(value) for value in values.tolist()]
        return ["" if null else str(v) for v, null in zip(values, values.isna(), strict=True)]

    def to_csv(self) -> str:
        """Text of the table as CSV, header with units."""
        columns = [[column.header, *self.cells(column.name)] for column in self.columns]
        lines = zip(*columns, strict=True)
        return "".join(",".join(map(_quoted, line)) + "\n" for line in lines)


@dataclass(frozen=True)
class Declaration:
    """What a table is, said once; its rows are made elsewhere.

    Attributes
    ----------
    name, title, columns
        As of `Table`.
    note : str
        As of `Table`; may have fields in braces for what only the rows decide.
    """

    name: str
    title: str
    columns: tuple[Column, ...]
    note: str = ""

    @property
    def column_names(self) -> list[str]:
        """Names of the columns, in order."""
        return [column.name for column in self.columns]

    def check_columns(self, asked: Iterable[str]) -> None:
        """Raise UnknownNameError unless all columns asked for are declared."""
        check_columns(asked, self.column_names, f"table {self.name!r}")

    def table(self, rows: Iterable[Mapping[str, object]], **values: object) -> Table:
        """Make the table of one mapping a row; what a mapping lacks is a null cell.

        Columns of format ``int`` become int64 (nullable Int64 where cells are null), words stay as
        they are, everything else becomes float64. `values` fill the note's fields.
        """
        rows = list(rows)
        names = set(self.column_names)
        for row in rows:
            self.check_columns(row.keys() - names)
        frame = pd.DataFrame(
            {
                column.name: _series([row.get(column.name) for row in rows], column)
                for column in self.columns
            }
        )
        return self.of_frame(frame, **values)

    def of_frame(self, frame: pd.DataFrame, **values: object) -> Table:
        """Make the table of a frame that has its columns already."""
        note = self.note.format(**values) if values else self.note
        return Table(self.name, self.title, frame, self.columns, note)


class Tables(Mapping[str, Table]):
    """Tables by name. A name that is not there is an error that lists those that are."""

    def __init__(self, tables: Iterable[Table] = ()) -> None:
        self._tables = {table.name: table for table in tables}

    def __getitem__(self, name: str) -> Table:
        try:
            return self._tables[name]
        except KeyError:
            known = ", ".join(self._tables)
            raise UnknownNameError(f"there is no table {name!r}, only {known}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._tables)

    def __len__(self) -> int:
        return len(self._tables)

    def rows(self, declared: Declaration, **where: object) -> Rows:
        """Rows of a declared table that have the values asked for."""
        return self[declared.name].rows(**where)

    def only(self, declared: Iterable[Declaration]) -> "Tables":
        """Only the tables that are declared."""
        return Tables(self[one.name] for one in declared)
