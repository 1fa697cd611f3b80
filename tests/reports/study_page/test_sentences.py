"""Sentences follow the numbers: the same code says the opposite of opposite tables."""

from dataclasses import replace
from pathlib import Path

import pytest
from frames import adding
from tiny_runs import DESIGN

from reports.page.evidence import Evidence
from reports.page.views import View
from reports.study_page.gather import gather
from reports.study_page.sections import agreement, regions, statistics, summary, theory
from reports.study_page.sections.randomness import randomness
from study.analysis.bound_tests import BOUNDS
from study.analysis.group_summaries import GROUPS
from study.analysis.path_lengths import LAW, TERMINATION
from study.analysis.terminal_regions import REGION_SIZES
from study.text.numbers import show

VIEW = View("incremental", "uniform")


@pytest.fixture(scope="module")
def evidence(run_directory: Path) -> Evidence:
    return gather(run_directory)


def altered(evidence: Evidence, table: str, **values: object) -> Evidence:
    """Copy the evidence with columns of a table set to a value."""
    frame = evidence.tables[table].frame.assign(**values)
    changed = replace(evidence.tables[table], frame=frame)
    return replace(evidence, tables=adding(evidence.tables, changed))


def prose(section: object, part_of: int = 0) -> str:
    paragraphs = section.parts[part_of].blocks[0].paragraphs  # type: ignore[attr-defined]
    return " ".join(paragraphs.get(VIEW.key, paragraphs.get("*", [])))


def test_bounds_and_premise(evidence: Evidence) -> None:
    held = altered(evidence, "theorem_2", premise="yes")
    said = prose(summary.section(held))
    assert "hold in every triangulation. So does what they follow from, that every" in said
    broken = altered(evidence, "theorem_2", bounds="no")
    assert "Theorem 2's bounds fail" in prose(summary.section(broken))
    unfounded = altered(evidence, "theorem_2", premise="no", lowest_rate=0.2)
    assert "although not every step" in prose(summary.section(unfounded))
    assert "fails in every group" in prose(theory.section(unfounded))


def test_growth(evidence: Evidence) -> None:
    grown = altered(evidence, "anova", p=1e-9)
    assert "The mean grows with the number of points" in prose(summary.section(grown))
    level = altered(evidence, "anova", p=0.5)
    assert "does not depend on the number of points" in prose(summary.section(level))
    means = evidence.tables["table_4"].frame["mean_lepp"]
    falling = altered(grown, "table_4", mean_lepp=-means)
    assert "The mean falls with the number of points" in prose(summary.section(falling))


def test_verdicts_are_counted(evidence: Evidence) -> None:
    frame = evidence.tables["reproduction_summary"].frame
    counts = dict.fromkeys(frame.columns[2:], 0)
    counts |= {"numbers": 30, "independent": 10, "agrees": 20, "differs": 5}
    counts |= {"independent_agrees": 7, "independent_differs": 3}
    said = prose(agreement.section(altered(evidence, "reproduction_summary", **counts)))
    tables = (frame["method"] == "incremental").sum()
    assert f"{7 * tables} within 2 (agreement), 0 within 3 (close)" in said
    assert f"{3 * tables} beyond" in said
    assert f"{10 * tables} of them are not derived from another" in said


def test_chance_is_not_blamed_for_too_many_rejections(evidence: Evidence) -> None:
    part = randomness(altered(evidence, "randomness", verdict="not rejected"))
    assert "what chance alone leads one to expect" in part.blocks[0].paragraphs["*"][0]  # type: ignore[union-attr]
    part = randomness(altered(evidence, "randomness", verdict="rejected"))
    assert "which chance alone does not explain" in part.blocks[0].paragraphs["*"][0]  # type: ignore[union-attr]


def test_numbers_in_tiles_are_those_of_the_tables(evidence: Evidence) -> None:
    tiles = summary.section(evidence).parts[0].blocks[1].tiles[VIEW.key]  # type: ignore[union-attr]
    rows = evidence.rows(GROUPS, VIEW)
    assert tiles[0].value == f"{rows['mean_lepp'].iloc[-1]:.4f}"
    histograms = evidence.rows(LAW, VIEW)
    assert tiles[1].value == str(histograms["lepp_size"][histograms["count"] > 0].max())


def said_of(section: object, id: str) -> str:
    """The finding below a figure."""
    blocks = [block for part in section.parts for block in part.blocks]  # type: ignore[attr-defined]
    (figure,) = (block for block in blocks if getattr(block, "id", "") == id)
    return figure.alternatives[VIEW.key]


def test_premise_is_judged_at_all_sizes(evidence: Evidence) -> None:
    frame = evidence.tables["theorem_2"].frame
    smallest = frame["n_points"] == DESIGN.sizes[0]
    known = altered(evidence, "theorem_2", lowest_rate=0.25, lowest_size=2)
    failing = altered(known, "theorem_2", premise=smallest.map({True: "no", False: "yes"}))
    said = prose(summary.section(failing))
    assert f"at 1 of {len(DESIGN.sizes)} numbers of points, the least is 0.2500" in said
    assert f"fails in 1 of {len(DESIGN.sizes)} groups" in prose(theory.section(failing))
    unsure = altered(known, "theorem_2", premise=smallest.map({True: "undecided", False: "yes"}))
    assert "while it stays open whether every" in prose(summary.section(unsure))
    groups = len(DESIGN.sizes)
    assert f"is clear in {groups - 1} of {groups} groups" in prose(theory.section(unsure))
    unknown = altered(evidence, "theorem_2", lowest_rate=float("nan"))
    assert "No step is known to within 0.05, so that this stays open" in prose(
        theory.section(unknown)
    )


def test_a_trend_ends_where_rates_are_rough(evidence: Evidence) -> None:
    laws = altered(evidence, "path_laws", verdict="rejected")
    size = evidence.tables["continuation"].frame["lepp_size"]
    rising = altered(
        laws,
        "continuation",
        rate=(0.4 + 0.02 * size).where(size < 6, 0.1),
        low=0.4,
        high=(0.4 + 0.0 * size).where(size != 5, 0.46),  # rough at 5 alone
    )
    said = said_of(theory.section(rising), "figure-continuation")
    assert "rises with every step, from 44.0\u00a0% to 48.0\u00a0%, up to size 4, as far as" in said
    falling = altered(rising, "continuation", rate=0.9 - 0.02 * size)
    said = said_of(theory.section(falling), "figure-continuation")
    assert "falls with every step, from 86.0\u00a0% to 82.0\u00a0%, up to size 4" in said
    rate = 0.5 + 0.1 * (size % 2)
    sizes = altered(laws, "continuation", rate=rate, low=rate - 0.01, high=rate + 0.01)
    said = said_of(theory.section(sizes), "figure-continuation")
    assert "moves between 50.0\u00a0% and 60.0\u00a0%" in said
    rough = altered(falling, "continuation", high=0.6)
    said = said_of(theory.section(rough), "figure-continuation")
    assert "where it is not known to within 0.05." in said


def test_long_paths_are_held_against_the_laws_tail(evidence: Evidence) -> None:
    law = evidence.rows(LAW, VIEW)
    measured = law["share"][(law["lepp_size"] >= 8) & (law["geometric_share"] > 0)].sum()
    p = evidence.rows(TERMINATION, VIEW).first["p_type_c"]
    expected = sum((1 - p) ** (k - 2) * p for k in range(8, 500))
    said = said_of(theory.section(evidence), "figure-law")
    assert f"are {show(expected / measured, 'g2')} times rarer than in the law" in said


def test_largest_regions_are_those_of_the_size_and_of_all(evidence: Evidence) -> None:
    sizes = evidence.tables["regions"].frame["n_points"]
    changed = altered(evidence, "regions", max_region=100 * (1 + (sizes < max(DESIGN.sizes))))
    assert "the largest in these triangulations has 100." in prose(regions.section(changed))
    counts = evidence.rows(REGION_SIZES, VIEW)
    said = said_of(regions.section(evidence), "figure-regions")
    assert f"the largest, of all numbers of points, has {counts['region_size'].max()}." in said
    within = counts["share"].cumsum()
    ninety = counts["region_size"][within >= 0.9].min()
    assert f"nine in ten have at most {ninety};" in said


def test_t_tests_are_summed_up_by_the_largest_p(evidence: Evidence) -> None:
    said = prose(statistics.section(evidence), part_of=3)
    for bound, side in ((4, "below"), (2, "above")):
        largest = evidence.rows(BOUNDS, VIEW, bound=bound)["log10_p_bonferroni"].max()
        assert f"significantly {side} {bound}; the largest p is {show(largest, 'log10p')}" in said


def test_means_are_counted_by_standard_errors(evidence: Evidence) -> None:
    frame = evidence.tables["table_4"].frame
    differences = [0.0, 1.9, -2.1, 2.9, -3.1]
    z = frame["n_points"].map(dict(zip(DESIGN.sizes, differences, strict=True)))
    changed = altered(evidence, "table_4", difference=z, published_mean=3.0)
    assert said_of(agreement.section(changed), "figure-means") == (
        "2 of 5 group means lie within 2 standard errors of the published one and 4 within 3; the "
        "largest difference is 3.10."
    )
