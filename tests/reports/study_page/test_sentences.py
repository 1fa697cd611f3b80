"""Sentences follow the numbers: the same code says the opposite of opposite tables."""

from dataclasses import replace
from pathlib import Path

import pytest
from tiny_runs import DESIGN

from reports.page.evidence import Evidence
from reports.page.views import View
from reports.study_page.gather import gather
from reports.study_page.sections import agreement, regions, regressions, statistics, summary, theory
from reports.study_page.sections.randomness import randomness
from reports.text.numbers import show
from study.analysis.bound_tests import BOUNDS
from study.analysis.group_summaries import GROUPS
from study.analysis.path_lengths import LAW, TERMINATION
from study.analysis.regressions import REGRESSIONS
from study.analysis.terminal_regions import REGION_SIZES

VIEW = View("incremental", "uniform")


@pytest.fixture(scope="module")
def evidence(run_directory: Path) -> Evidence:
    return gather(run_directory)


def altered(evidence: Evidence, table: str, **values: object) -> Evidence:
    """Copy the evidence with columns of a table set to a value."""
    frame = evidence.tables[table].frame.assign(**values)
    changed = replace(evidence.tables[table], frame=frame)
    return replace(evidence, tables=evidence.tables.adding(changed))


def prose(section: object, part_of: int = 0) -> str:
    paragraphs = section.parts[part_of].blocks[0].paragraphs  # type: ignore[attr-defined]
    return " ".join(paragraphs.get(VIEW.key, paragraphs.get("*", [])))


def test_bounds_and_premise(evidence: Evidence) -> None:
    said = prose(summary.section(evidence))
    assert "Theorem 2's bounds hold in every triangulation, and so does what it supposes" in said
    broken = altered(evidence, "theorem_2", bounds="no")
    assert "Theorem 2's bounds fail" in prose(summary.section(broken))
    unfounded = altered(evidence, "theorem_2", premise="no")
    assert "although what it supposes" in prose(summary.section(unfounded))
    assert "fails in every group" in prose(theory.section(unfounded))


def test_growth(evidence: Evidence) -> None:
    grown = altered(evidence, "anova", p=1e-9)
    assert "The mean grows with the number of points" in prose(summary.section(grown))
    level = altered(evidence, "anova", p=0.5)
    assert "does not depend on the number of points" in prose(summary.section(level))
    means = evidence.tables["table_4"].frame["mean_lepp"]
    falling = altered(grown, "table_4", mean_lepp=-means)
    assert "The mean falls with the number of points" in prose(summary.section(falling))


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
    failing = altered(evidence, "theorem_2", premise=smallest.map({True: "no", False: "yes"}))
    said = prose(summary.section(failing))
    assert f"does not at 1 of {len(DESIGN.sizes)} numbers of points" in said
    assert f"fails in 1 of {len(DESIGN.sizes)} groups" in prose(theory.section(failing))
    unsure = altered(evidence, "theorem_2", premise=smallest.map({True: "undecided", False: "yes"}))
    assert "while it stays open" in prose(summary.section(unsure))
    groups = len(DESIGN.sizes)
    assert f"is clear in {groups - 1} of {groups} groups" in prose(theory.section(unsure))


def test_theorem_1_is_within_a_per_cent_only_if_it_is(evidence: Evidence) -> None:
    praise = "gives the mean and the standard deviation within one per cent"
    for off, praised in ((0.0099, True), (0.0101, False), (-9.0, False)):
        changed = altered(evidence, "theorem_1", relative_difference=off)
        assert (praise in prose(summary.section(changed))) == praised


def test_a_trend_ends_where_rates_are_rough(evidence: Evidence) -> None:
    size = evidence.tables["termination"].frame["lepp_size"]
    rising = altered(
        evidence,
        "termination",
        rate=(0.4 + 0.02 * size).where(size < 6, 0.1),
        low=0.4,
        high=(0.4 + 0.0 * size).where(size != 5, 0.46),  # rough at 5 alone
    )
    said = said_of(theory.section(rising), "figure-termination")
    assert "rises with every step up to size 4, while Theorem 1" in said
    falling = altered(rising, "termination", rate=0.9 - 0.02 * size)
    said = said_of(theory.section(falling), "figure-termination")
    assert "falls with every step up to size 4" in said
    level = altered(rising, "termination", rate=0.5 + 0.001 * (size % 2))
    said = said_of(theory.section(level), "figure-termination")
    assert "is constant to a hundredth, as Theorem 1" in said
    sizes = altered(rising, "termination", rate=0.5 + 0.1 * (size % 2))
    assert "moves between 50.0\u00a0% and 60.0\u00a0%" in said_of(
        theory.section(sizes), "figure-termination"
    )


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


def test_the_best_model_has_the_lowest_aic(evidence: Evidence) -> None:
    rows = evidence.rows(REGRESSIONS, VIEW, fitting="least squares").frame.dropna(subset="aic")
    lowest = rows.loc[rows["aic"].idxmin(), "model"]
    assert f"the {lowest} model describes it best by AIC" in prose(
        summary.section(altered(evidence, "anova", p=1e-9))
    )
    assert f"The {lowest} model, which has the lowest AIC" in prose(
        regressions.section(evidence), part_of=1
    )


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
