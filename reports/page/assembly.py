"""The page put together: figures get their numbers, references their targets, terms their meaning.

A text refers to a figure, a table or a part of the page by its id, `reference("figure-models")`;
what the reader sees of it, and that it exists, is settled here, when all of the page is there.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import count

from markupsafe import Markup, escape

from reports.page.blocks import (
    ALWAYS,
    Block,
    Drawing,
    FigureBlock,
    Prose,
    Section,
    Subsection,
    TableBlock,
)
from reports.text.glossary import marked
from study.analysis.table import UnknownNameError

_REFERENCE = re.compile(r"\[\[([\w-]+)\]\]")


def reference(address: str) -> str:
    """Refer to a part of the page by its id, in a text of a block."""
    return f"[[{address}]]"


def assemble(sections: Iterable[Section]) -> list[Section]:
    """Assemble a page: number the figures in its order, and finish its texts.

    Returns
    -------
    list of Section
        The same blocks, with texts as HTML: links for references, and the first use of each term of
        the glossary in each section marked.

    Raises
    ------
    UnknownNameError
        If a text refers to an id that the page does not have.
    ValueError
        If an id is given twice.
    """
    numbered = _numbered(sections)
    names = _names(numbered)
    return [_Texts(names).section(section) for section in numbered]


def _numbered(sections: Iterable[Section]) -> list[Section]:
    numbers = count(1)

    def block(given: Block) -> Block:
        if isinstance(given, TableBlock):
            return replace(given, id=given.address)
        if not isinstance(given, FigureBlock | Drawing):
            return given
        number = next(numbers)
        data = tuple(
            replace(
                table,
                id=f"{given.id}-data{'' if k == 0 else f'-{k + 1}'}",
                caption=f"Data of Figure {number}: {table.caption}",
            )
            for k, table in enumerate(given.data)
        )
        return replace(given, number=number, data=data)

    def part(given: Subsection) -> Subsection:
        return replace(given, blocks=tuple(block(one) for one in given.blocks))

    return [replace(one, parts=tuple(part(p) for p in one.parts)) for one in sections]


def _names(sections: list[Section]) -> dict[str, str]:
    """Name everything that has an id as texts call it."""
    named = list(_addresses(sections))
    twice = [address for address, n in Counter(address for address, _ in named).items() if n > 1]
    if twice:
        raise ValueError(
            f"more than one element of the page has the id {', '.join(twice)}: give one of them "
            "an id of its own"
        )
    return dict(named)


def _addresses(sections: list[Section]) -> Iterator[tuple[str, str]]:
    for section in sections:
        yield section.id, f"“{section.title}”"
        for part in section.parts:
            if part.title:
                yield part.id, f"“{part.title}”"
            for block in part.blocks:
                if isinstance(block, TableBlock):
                    yield block.address, f"the table “{block.caption}”"
                elif isinstance(block, FigureBlock | Drawing):
                    yield block.id, f"Figure {block.number}"
                    yield from ((table.address, table.caption) for table in block.data)


class _Texts:
    """Finishes the texts of one section."""

    def __init__(self, names: dict[str, str]) -> None:
        self.names = names
        #: Terms that are explained already, by view.
        self.used: dict[str, set[str]] = {ALWAYS: set()}

    def section(self, section: Section) -> Section:
        parts = tuple(
            replace(part, blocks=tuple(self.block(block) for block in part.blocks))
            for part in section.parts
        )
        return replace(section, parts=parts)

    def block(self, block: Block) -> Block:
        if isinstance(block, Prose):
            paragraphs: dict[str, list[str | Markup]] = {
                view: [self.text(paragraph, view) for paragraph in variant]
                for view, variant in block.paragraphs.items()
            }
            return replace(block, paragraphs=paragraphs)
        if isinstance(block, FigureBlock | Drawing):
            alternatives: dict[str, str] = {
                view: self.text(text, view) for view, text in block.alternatives.items()
            }
            reading = self.text(block.reading, ALWAYS)
            return replace(block, alternatives=alternatives, reading=reading)
        return block

    def text(self, text: str, view: str) -> Markup:
        """Put links for references, and buttons for terms; a text that is HTML keeps its words."""
        pieces = _REFERENCE.split(text)
        for k, piece in enumerate(pieces):
            if k % 2:
                pieces[k] = self.link(piece)
            elif not isinstance(text, Markup):
                pieces[k] = self.explained(piece, view)
        return Markup("".join(pieces))

    def link(self, address: str) -> str:
        if address not in self.names:
            raise UnknownNameError(
                f"a text refers to {address!r}, which the page does not have, only "
                f"{', '.join(self.names)}"
            )
        return f'<a href="#{escape(address)}">{escape(self.names[address])}</a>'

    def explained(self, text: str, view: str) -> Markup:
        used = self.used.setdefault(view, set()) | self.used[ALWAYS]
        before = set(used)
        result = marked(escape(text), used)
        self.used[view] |= used - before
        return result
