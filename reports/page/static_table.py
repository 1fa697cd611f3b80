"""A table in the page's markup, as it is until the script draws it, or where no script runs."""

from dataclasses import dataclass

from reports.page.blocks import SWITCHES, TableBlock
from reports.page.evidence import Evidence
from reports.page.views import View
from reports.text.words import sense
from study.analysis.table import Column
from study.text.numbers import show

#: Tables with more rows are left to the script.
MOST_ROWS = 20


@dataclass(frozen=True)
class Cell:
    """A cell's text and, of a verdict, whether it is ``good`` or ``bad`` news."""

    text: str
    is_verdict: bool = False
    sense: str = ""


@dataclass(frozen=True)
class StaticTable:
    """Columns, and the rows that a view picks.

    Attributes
    ----------
    columns : list of Column
    rows : list of list of Cell
        None of them where there are more than `MOST_ROWS`.
    """

    columns: list[Column]
    rows: list[list[Cell]]


def static_table(block: TableBlock, evidence: Evidence, view: View) -> StaticTable:
    """Pick columns and rows as the page's script does for this view."""
    followed = {name: view.where[name] for name in block.followed}
    rows = evidence.rows(block.table, **followed, **block.where)
    table = evidence.tables[block.table.name]
    by_name = {column.name: column for column in table.columns}
    constant = {*followed, *block.where, *_single_switches(evidence)}
    names = block.columns or tuple(by_name)
    columns = [by_name[name] for name in names if name not in constant]
    if len(rows) > MOST_ROWS:
        return StaticTable(columns, [])
    cells = [[_cell(value, column) for value in rows[column.name]] for column in columns]
    return StaticTable(columns, [list(row) for row in zip(*cells, strict=True)])


def _single_switches(evidence: Evidence) -> set[str]:
    """Switches with a single choice: a column of it would say the same in every row."""
    values = {name: {view.where[name] for view in evidence.views} for name in SWITCHES}
    return {name for name, different in values.items() if len(different) == 1}


def _cell(value: object, column: Column) -> Cell:
    text = show(value, column.format)
    if column.format != "verdict":
        return Cell(text)
    return Cell(text, is_verdict=True, sense=sense(text))
