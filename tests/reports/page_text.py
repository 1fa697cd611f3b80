"""What the report says, as text: by heading or figure, and by view."""

from collections.abc import Callable
from dataclasses import dataclass

import pandas as pd
import pytest
from frames import frames

from reports.page.blocks import Drawing, FigureBlock, Prose, Section, Tiles
from reports.page.evidence import Evidence
from reports.study_page import gather, sections
from study.design.design import Design
from study.results.store import Results
from study.run.triangulations import TRIANGULATIONS

Change = Callable[[pd.DataFrame], pd.DataFrame]


@dataclass(frozen=True)
class PageText:
    """The sections of a report."""

    sections: list[Section]
    evidence: Evidence

    def prose(self, part: str, view: str = "incremental/uniform") -> str:
        """Paragraphs of a subsection."""
        blocks = [block for block in self.blocks(part) if isinstance(block, Prose)]
        paragraphs = [p for b in blocks for p in b.paragraphs.get(view, b.paragraphs.get("*", []))]
        return " ".join(map(str, paragraphs)).replace("\u00a0", " ")

    def finding(self, figure: str, view: str = "incremental/uniform") -> str:
        """What the caption of a figure says that it shows; empty where it is not drawn."""
        for section in self.sections:
            for part in section.parts:
                for block in part.blocks:
                    if isinstance(block, FigureBlock | Drawing) and block.id == figure:
                        texts = block.alternatives
                        return str(texts.get(view, texts.get("*", ""))).replace("\u00a0", " ")
        raise KeyError(figure)

    def tiles(self, view: str = "incremental/uniform") -> dict[str, tuple[str, str]]:
        """Value and context of the key figures by their labels."""
        (block,) = (b for b in self.blocks("key-figures") if isinstance(b, Tiles))
        texts = {tile.label: (tile.value, tile.context) for tile in block.tiles[view]}
        return {k: (v, c.replace("\u00a0", " ")) for k, (v, c) in texts.items()}

    def blocks(self, name: str) -> tuple:
        """Blocks of a subsection."""
        for section in self.sections:
            for part in section.parts:
                if part.id == name:
                    return part.blocks
        raise KeyError(name)


def page_text(results: Results) -> PageText:
    """What the report of some results says."""
    with pytest.MonkeyPatch.context() as patch:
        # No sentence needs a strip of a million triangles.
        patch.setattr("study.analysis.worst_case_strip._SIZES", (1, 2, 3))
        evidence = gather.evidence_of(results)
    return PageText(sections.all_sections(evidence), evidence)


def drawn(design: Design, **changes: Change) -> Results:
    """Results drawn from a generator, with some of their frames changed."""
    names = ("results", "histograms", "regions", "layers", "point_sets")
    made = dict(zip(names, frames(design), strict=True))
    for name, change in changes.items():
        made[name] = change(made[name])
    complete = len(made["results"]) == design.n_triangulations
    manifest = {"complete": complete, "environments": []}
    return Results(made, manifest, TRIANGULATIONS, design, complete)
