"""Every sentence that a page of a run tells its reader, with where it stands."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from reports.page.assembly import assemble
from reports.page.blocks import ALWAYS, Drawing, FigureBlock, Prose, Tiles
from reports.study_page import sections
from reports.study_page.gather import gather
from study.paper.statements import STATEMENTS

_TAG = re.compile(r"<[^>]+>")
_ENTITIES = {"&amp;": "&", "&lt;": "<", "&gt;": ">", "&#39;": "'", "&#34;": '"'}
#: A sentence ends at a full stop before a capital letter, or before the end.
_END = re.compile(r"(?<=[.!?])\s+(?=[A-Z“√λχ\d])")


@dataclass(frozen=True)
class Sentence:
    """A sentence of the page.

    Attributes
    ----------
    place : str
        The id of the block or part, or ``tile`` or ``statement`` with its name.
    method, distribution : str
        The view; ``*`` where all views show it.
    text : str
        Plain text, without tags and with ordinary spaces.
    """

    place: str
    method: str
    distribution: str
    text: str


def plain(text: object) -> str:
    """Return a text of a block as its reader sees it, with ordinary spaces."""
    bare = _TAG.sub("", str(text))
    for entity, sign in _ENTITIES.items():
        bare = bare.replace(entity, sign)
    return re.sub(r"\s+", " ", bare.replace("\u00a0", " ")).strip()


def sentences_of(text: str) -> list[str]:
    """Split plain text into sentences."""
    return [piece for piece in _END.split(text) if piece]


def page_sentences(directory: Path) -> list[Sentence]:
    """Render the page of a results directory, and take its sentences."""
    evidence = gather(directory)
    found: list[Sentence] = []

    def add(place: str, view: str, text: object) -> None:
        method, _, distribution = view.partition("/")
        pair = ("*", "*") if view == ALWAYS else (method, distribution)
        found.extend(Sentence(place, *pair, one) for one in sentences_of(plain(text)))

    add("description", ALWAYS, sections.description(evidence))
    add("source", ALWAYS, sections.source(evidence))
    for alarm in sections.alarms(evidence):
        add("alarm", ALWAYS, alarm)
    for place, view, text in _texts(assemble(sections.all_sections(evidence))):
        add(place, view, text)
    for row in evidence.rows(STATEMENTS).frame.itertuples():
        text = plain(f"{row.statement} | {row.holds} | {row.evidence}")
        found.append(Sentence(f"statement {row.source}", row.method, row.distribution, text))
    return found


def _texts(parts: list) -> Iterator[tuple[str, str, object]]:
    for section in parts:
        for part in section.parts:
            for block in part.blocks:
                if isinstance(block, Prose):
                    for view, paragraphs in block.paragraphs.items():
                        yield from ((part.id, view, text) for text in paragraphs)
                elif isinstance(block, Tiles):
                    for view, tiles in block.tiles.items():
                        for tile in tiles:
                            yield "tile", view, f"{tile.label} | {tile.value} | {tile.context}"
                elif isinstance(block, FigureBlock | Drawing):
                    for view, text in block.alternatives.items():
                        yield block.id, view, text
                    yield f"{block.id} reading", ALWAYS, block.reading
