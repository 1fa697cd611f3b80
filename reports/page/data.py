"""The page's data block: every number once, as a file has it and as a reader sees it, compressed.

A table's cells travel as the texts of its CSV file and, where those differ, as the texts that
`study.text.numbers` makes of them. A figure's arrays that are columns of a table are references
to them: ``{"$": [table, column, where]}``.
"""

import base64
import json
import math
import zlib
from collections.abc import Iterable

import numpy as np
import pandas as pd

from reports.text.words import sense
from study.analysis.table import Column, ColumnReference, Table
from study.text.notation import typeset
from study.text.numbers import show

_SHORT = 4  # an array this short costs less than a reference to it


def figure_data(node: object) -> object:
    """Make JSON values of a figure's specification, with references for columns of tables."""
    if isinstance(node, ColumnReference):
        if len(node) > _SHORT:
            where = {name: plain_value(value) for name, value in node.where.items()}
            return {"$": [node.table, node.column, where]}
        return plain(node)
    if isinstance(node, dict):
        return {key: figure_data(value) for key, value in node.items()}
    if isinstance(node, np.ndarray | pd.Series | list | tuple):
        return [figure_data(item) for item in node]
    return plain_value(node)


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
    """Describe a table for the page: its columns with their cells, raw and as they are shown."""
    return {
        "title": table.title,
        "note": typeset(table.note),
        "columns": [_column_data(table, column) for column in table.columns],
    }


def _column_data(table: Table, column: Column) -> dict:
    raw = table.cells(column.name)
    shown = [show(value, column.format) for value in table.frame[column.name]]
    label = typeset(column.label)
    if column.format == "log10p":  # shown as p
        label = label.removeprefix("log₁₀ ")
    data: dict[str, object] = {"name": column.name, "label": label, "header": column.header}
    if column.unit and column.unit != label.lower():
        data["unit"] = column.unit
    if column.is_number:
        data["number"] = True
    if column.format == "verdict":
        senses = {text: sense(text) for text in dict.fromkeys(shown)}
        data["senses"] = {text: value for text, value in senses.items() if value}
        data["verdict"] = True
    if column.note:
        data["note"] = typeset(column.note)
    data["raw"] = raw
    if shown != raw:
        data["shown"] = shown
    return data


def compress(text: str) -> str:
    """Compress text for a browser's ``DecompressionStream("deflate")``, as base64."""
    return base64.b64encode(zlib.compress(text.encode(), 9)).decode("ascii")


def encode(data: dict) -> str:
    """Make the text of a data block."""
    return compress(json.dumps(data, ensure_ascii=False, separators=(",", ":"), allow_nan=False))


def decode(block: str) -> dict:
    """Read a data block back."""
    return json.loads(zlib.decompress(base64.b64decode(block)))
