"""The page's data block: every number once, compressed.

Tables travel as the CSV text that also stands on disk. A figure's arrays, where they are columns
of those tables, are replaced by references to them: ``{"$": [table, column, where]}``.
"""

import base64
import json
import math
import zlib
from collections.abc import Iterable

import numpy as np
import pandas as pd

from study.analysis.table import Table

_SHORT = 4  # an array this short costs less than a reference to it


class ColumnIndex:
    """Columns of tables by their content, to recognise them in figures.

    Parameters
    ----------
    tables : dict of str to Table
    selections : iterable of (str, dict)
        Selections of rows: a table's name, and the value that each named column must have.
    """

    def __init__(
        self, tables: dict[str, Table], selections: Iterable[tuple[str, dict[str, object]]]
    ) -> None:
        self._references: dict[str, dict] = {}
        for name, where in selections:
            frame = select(tables[name].frame, where)
            for column in frame.columns:
                key = json.dumps(plain(frame[column]))
                self._references.setdefault(key, {"$": [name, column, where]})

    def replace(self, node: object) -> object:
        """Copy a figure's specification with references for the arrays that are known."""
        if isinstance(node, dict):
            return {key: self.replace(value) for key, value in node.items()}
        if isinstance(node, np.ndarray | pd.Series | list | tuple):
            if any(isinstance(item, dict | list | tuple) for item in node):
                return [self.replace(item) for item in node]
            values = plain(node)
            if len(values) > _SHORT:
                return self._references.get(json.dumps(values), values)
            return values
        return plain_value(node)


def select(frame: pd.DataFrame, where: dict[str, object]) -> pd.DataFrame:
    """Rows of a frame whose columns have the values asked for."""
    for column, value in where.items():
        frame = frame[frame[column] == value]
    return frame


def plain(values: Iterable[object]) -> list:
    """Make a list of JSON values, null for what is missing or not finite."""
    return [plain_value(value) for value in values]


def plain_value(value: object) -> object:
    """Make a JSON value of a NumPy, pandas or Python scalar."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or value is pd.NA or value is pd.NaT:
        return None
    if isinstance(value, float):
        if not math.isfinite(value):
            return None
        return int(value) if value.is_integer() and abs(value) < 2**53 else value
    return value


def table_data(table: Table) -> dict:
    """Describe a table for the page: its columns, and its CSV text as it stands on disk."""
    return {
        "title": table.title,
        "note": table.note,
        "columns": [
            {"name": c.name, "label": c.label, "unit": c.unit, "format": c.format}
            for c in table.columns
        ],
        "csv": table.to_csv(),
    }


def compress(text: str) -> str:
    """Compress text for a browser's ``DecompressionStream("deflate")``, as base64."""
    return base64.b64encode(zlib.compress(text.encode(), 9)).decode("ascii")


def encode(data: dict) -> str:
    """Make the text of a data block."""
    return compress(json.dumps(data, ensure_ascii=False, separators=(",", ":"), allow_nan=False))


def decode(block: str) -> dict:
    """Read a data block back."""
    return json.loads(zlib.decompress(base64.b64decode(block)))
