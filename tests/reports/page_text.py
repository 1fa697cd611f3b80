"""What the report says, as text: by heading or figure, and by view."""

from collections.abc import Callable, Iterator
from typing import Any

import pandas as pd
import pytest
from frames import frames

from reports.page.blocks import Drawing, Facts, FigureBlock, Prose, Section, Tiles
from reports.page.evidence import Evidence
from reports.study_page import gather, sections
from study.analysis.worst_case_strip import WORST_CASE
from study.design.design import Design
from study.results.store import Results
from study.run.triangulations import TRIANGULATIONS

Change = Callable[[pd.DataFrame], pd.DataFrame]


class PageText:
    """What the sections of a report say; each is made when it is first asked for."""

    def __init__(self, evidence: Evidence) -> None:
        self.evidence = evidence
        self._made: dict[str, Section] = {}

    @property
    def sections(self) -> list[Section]:
        """All sections, in their order."""
        return list(self._sections())

    def _sections(self, first: str = "") -> Iterator[Section]:
        # That which had the name on another page comes first here, to spare the others.
        modules = sections.modules_of(self.evidence)
        for module in sorted(modules, key=lambda module: module.__name__ != first):
            if module.__name__ not in self._made:
                self._made[module.__name__] = module.section(self.evidence)
            yield self._made[module.__name__]

    def _find(self, name: str, choose: Callable[[Section], Iterator]) -> Any:
        for section in self._sections(_WHERE.get(name, "")):
            for found in choose(section):
                _WHERE[name] = next(k for k, made in self._made.items() if made is section)
                return found
        raise KeyError(name)

    def prose(self, part: str, view: str = "incremental/uniform") -> str:
        """Paragraphs of a subsection."""
        blocks = [block for block in self.blocks(part) if isinstance(block, Prose)]
        paragraphs = [p for b in blocks for p in b.paragraphs.get(view, b.paragraphs.get("*", []))]
        return " ".join(map(str, paragraphs)).replace("\u00a0", " ")

    def finding(self, figure: str, view: str = "incremental/uniform") -> str:
        """What the caption of a figure says that it shows; empty where it is not drawn."""

        def choose(section: Section) -> Iterator:
            blocks = (block for part in section.parts for block in part.blocks)
            figures = (b for b in blocks if isinstance(b, FigureBlock | Drawing))
            return (block for block in figures if block.id == figure)

        texts = self._find(figure, choose).alternatives
        return str(texts.get(view, texts.get("*", ""))).replace("\u00a0", " ")

    def tiles(self, view: str = "incremental/uniform") -> dict[str, tuple[str, str]]:
        """Value and context of the key figures by their labels."""
        (block,) = (b for b in self.blocks("key-figures") if isinstance(b, Tiles))
        texts = {tile.label: (tile.value, tile.context) for tile in block.tiles[view]}
        return {k: (v, c.replace("\u00a0", " ")) for k, (v, c) in texts.items()}

    def facts(self, part: str) -> dict[str, str]:
        """Names and values of a subsection."""
        blocks = (block for block in self.blocks(part) if isinstance(block, Facts))
        return {name: str(value) for block in blocks for name, value in block.facts}

    def blocks(self, name: str) -> tuple:
        """Blocks of a subsection."""
        found = self._find(name, lambda section: (p for p in section.parts if p.id == name))
        return found.blocks


#: The module whose section has a subsection or figure, by its id, as far as it was met.
_WHERE: dict[str, str] = {}


def page_text(results: Results) -> PageText:
    """What the report of some results says."""
    with pytest.MonkeyPatch.context() as patch:
        # No sentence needs a strip of a million triangles.
        patch.setattr("study.analysis.worst_case_strip._SIZES", (1, 2, 3))
        evidence = gather.evidence_of(results)
        assert not evidence.rows(WORST_CASE).empty  # made here; the others when they are needed
        return PageText(evidence)


def drawn(design: Design, **changes: Change) -> Results:
    """Results drawn from a generator, with some of their frames changed."""
    names = ("results", "histograms", "regions", "layers", "point_sets")
    made = dict(zip(names, frames(design), strict=True))
    for name, change in changes.items():
        made[name] = change(made[name])
    complete = len(made["results"]) == design.n_triangulations
    manifest = {"complete": complete, "environments": []}
    return Results(made, manifest, TRIANGULATIONS, design, complete)
