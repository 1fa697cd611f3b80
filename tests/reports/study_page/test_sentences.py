"""Sentences follow the numbers: the same code says the opposite of opposite tables."""

from dataclasses import replace
from pathlib import Path

import pytest

from reports.page.evidence import Evidence
from reports.page.views import View
from reports.study_page.gather import gather
from reports.study_page.sections import agreement, found, theory
from reports.study_page.sections.randomness import randomness
from study.analysis.group_summaries import GROUPS
from study.analysis.path_lengths import LAW

VIEW = View("incremental", "uniform")


@pytest.fixture(scope="module")
def evidence(run_directory: Path) -> Evidence:
    return gather(run_directory)


def altered(evidence: Evidence, table: str, **values: object) -> Evidence:
    """Copy the evidence with columns of a table set to a value."""
    frame = evidence.tables[table].frame.assign(**values)
    changed = replace(evidence.tables[table], frame=frame)
    return replace(evidence, tables=evidence.tables.adding(changed))


def prose(section: object, block_of: int = 0, part_of: int = 0) -> str:
    paragraphs = section.parts[part_of].blocks[block_of].paragraphs  # type: ignore[attr-defined]
    return " ".join(paragraphs.get(VIEW.key, paragraphs.get("*", [])))


def test_bounds_and_premise(evidence: Evidence) -> None:
    said = prose(found.section(evidence), block_of=1)
    assert "Theorem 2's bounds hold in every triangulation, and so does what it supposes" in said
    broken = altered(evidence, "theorem_2", bounds="no")
    assert "Theorem 2's bounds fail" in prose(found.section(broken), block_of=1)
    unfounded = altered(evidence, "theorem_2", premise="no")
    assert "although what it supposes" in prose(found.section(unfounded), block_of=1)
    assert "fails in every group" in prose(theory.section(unfounded))


def test_growth(evidence: Evidence) -> None:
    grown = altered(evidence, "anova", p=1e-9)
    assert "The mean grows with the number of points" in prose(found.section(grown), block_of=1)
    level = altered(evidence, "anova", p=0.5)
    assert "does not depend on the number of points" in prose(found.section(level), block_of=1)
    means = evidence.tables["table_4"].frame["mean_lepp"]
    falling = altered(grown, "table_4", mean_lepp=-means)
    assert "The mean falls with the number of points" in prose(found.section(falling), block_of=1)


def test_theorem_1_is_praised_only_where_it_is_right(evidence: Evidence) -> None:
    right = altered(evidence, "theorem_1", relative_difference=0.001)
    assert "describes the measurement closely" in prose(theory.section(right), part_of=1)
    high = altered(evidence, "theorem_1", relative_difference=-0.2)
    assert "puts all four too high" in prose(theory.section(high), part_of=1)
    low = altered(evidence, "theorem_1", relative_difference=0.2)
    assert "puts all four too low" in prose(theory.section(low), part_of=1)


def test_verdicts_are_counted(evidence: Evidence) -> None:
    frame = evidence.tables["reproduction_summary"].frame
    counts = dict.fromkeys(frame.columns[2:], 0) | {"numbers": 10, "agrees": 7, "differs": 3}
    said = prose(agreement.section(altered(evidence, "reproduction_summary", **counts)))
    tables = (frame["method"] == "incremental").sum()
    assert f"{7 * tables} within 2 (agreement), 0 within 3 (close)" in said
    assert f"{3 * tables} beyond" in said


def test_chance_is_not_blamed_for_too_many_rejections(evidence: Evidence) -> None:
    part = randomness(altered(evidence, "randomness", verdict="not rejected"))
    assert "what chance alone leads one to expect" in part.blocks[0].paragraphs["*"][0]  # type: ignore[union-attr]
    part = randomness(altered(evidence, "randomness", verdict="rejected"))
    assert "which chance alone does not explain" in part.blocks[0].paragraphs["*"][0]  # type: ignore[union-attr]


def test_numbers_in_tiles_are_those_of_the_tables(evidence: Evidence) -> None:
    tiles = found.section(evidence).parts[0].blocks[0].tiles[VIEW.key]  # type: ignore[union-attr]
    rows = evidence.rows(GROUPS, VIEW)
    assert tiles[0].value == f"{rows['mean_lepp'].iloc[-1]:.4f}"
    histograms = evidence.rows(LAW, VIEW)
    assert tiles[1].value == str(histograms["lepp_size"][histograms["count"] > 0].max())
