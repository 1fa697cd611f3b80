"""Notes below tables: they name no column that the table leaves out."""

import re
from collections.abc import Iterator

import pytest
from made_runs import page

from reports.page.blocks import TableBlock
from reports.study_page.tables import FAILURES

#: The ends of an interval go by its name.
END = re.compile(r"(, \d+ %)? (from|to)$")


def blocks() -> Iterator[TableBlock]:
    for section in page("drawn").sections:
        for part in section.parts:
            for block in part.blocks:
                yield from [block] if isinstance(block, TableBlock) else getattr(block, "data", ())


def shown(block: TableBlock) -> list[str]:
    """Names of the columns that a reader sees."""
    fixed = {*block.followed, *block.where}
    return [n for n in block.columns or block.table.column_names if n not in fixed]


def named(label: str) -> str:
    """What a note would call a column; nothing for a single word, which it may use as any other."""
    name = END.sub("", label)
    return name if " " in name or name.isupper() else ""


def hidden_names(block: TableBlock) -> list[str]:
    """Names of columns that are left out, and are not part of the name of one that is not."""
    kept = " ".join(c.label for c in block.table.columns if c.name in shown(block))
    names = [named(c.label) for c in block.table.columns if c.name not in shown(block)]
    return [name for name in names if name and name not in kept]


def note(block: TableBlock) -> str:
    columns = [c for c in block.table.columns if c.name in shown(block)]
    return " ".join([block.table.note, *(column.note for column in columns)])


ALL = [block for block in blocks() if block.table.name != FAILURES.name]


@pytest.mark.parametrize("block", ALL, ids=[block.address for block in ALL])
def test_notes_name_only_columns_that_are_shown(block):
    of_hidden = [rf"(?<!\w){re.escape(name)}(?!\w)" for name in hidden_names(block)]
    assert [name for name in of_hidden if re.search(name, note(block), re.IGNORECASE)] == []


def test_there_are_columns_to_be_named():
    left_out = {name for block in ALL for name in hidden_names(block)}
    assert {"SD of the means", "AIC", "Distance from uniform", "Power of growth"} <= left_out
    noted = [c for block in ALL for c in block.table.columns if c.note]
    assert any(c.note in note(block) for block in ALL for c in noted)
