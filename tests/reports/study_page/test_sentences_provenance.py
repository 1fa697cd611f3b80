"""What the report says of how it was made."""

import pytest
from frames import design

from reports.page.blocks import Facts, Prose
from reports.page.evidence import Evidence
from reports.study_page.sections import provenance
from reports.study_page.tables import FAILURES
from study.analysis.building import MISSING
from study.analysis.group_summaries import OVERVIEW
from study.analysis.table import Tables
from study.design.design import Design

SUMS = {"results.parquet": "0f" * 32, "layers.parquet": "a1" * 32}


def made(overview: dict | None = None, manifest: dict | None = None, **asked: object) -> dict:
    """Subsections, by their ids: the text of their prose, and their facts."""
    zeros = dict.fromkeys(column.name for column in OVERVIEW.columns[2:])
    counts = {
        "asked": 48, "triangulations": 48, "failed": 0, "triangles": 2_400_000,
        "repeated_points": 0, "equal_longest": 0, "nearly_equal_longest": 0,
    }  # fmt: skip
    row = zeros | {"method": "incremental", "distribution": "uniform"} | counts | (overview or {})
    tables = Tables([OVERVIEW.table([row]), MISSING.table([]), FAILURES.table([])])
    evidence = Evidence(tables, asked.pop("design", None) or design(**asked), manifest or {})
    found = {}
    for part in provenance.section(evidence).parts:
        prose = (b.paragraphs["*"] for b in part.blocks if isinstance(b, Prose))
        words = " ".join(str(p) for paragraphs in prose for p in paragraphs)
        facts = [fact for b in part.blocks if isinstance(b, Facts) for fact in b.facts]
        found[part.id] = words.replace("\u00a0", " "), dict(facts)
    return found


def test_checksums_are_told():
    _, facts = made(manifest={"sha256": SUMS})["cite"]
    sums = {name: value for name, value in facts.items() if name.startswith("SHA-256")}
    assert sums == {f"SHA-256 of {name}": value for name, value in SUMS.items()}
    assert not [name for name in made()["cite"][1] if "SHA" in name]
    assert "Licence of the software" in facts


@pytest.mark.parametrize(
    ("counts", "words"),
    [
        ({}, "All 48 triangulations were made; none failed. No"),
        (
            {"triangulations": 40, "failed": 3},
            "Of 48 triangulations, 40 were made, 3 failed and 5 have not been run. No",
        ),
        (
            {"repeated_points": 1},
            "none failed. 1 point that repeated another of the same set was left out. No",
        ),
        ({"repeated_points": 2}, "2 points that repeated another of the same set were left out."),
        ({}, "No triangle has longest edges of exactly equal length, and 0 of 2.4 million have"),
        ({"equal_longest": 1}, "1 triangle has longest edges of exactly equal length"),
        (
            {"equal_longest": 2, "nearly_equal_longest": 1234},
            "2 triangles have longest edges of exactly equal length, and 1,234 of 2.4 million "
            "have two that agree to 10⁻⁶ of their length",
        ),
    ],
)
def test_completeness(counts, words):
    assert words in made(counts)["completeness"][0]


@pytest.mark.parametrize(
    ("sizes", "words"),
    [
        ((1000, 2000, 3000, 4000), "1,000 to 4,000 in steps of 1,000 (4 sizes)"),
        ((1000, 2000, 3000), "1,000, 2,000 and 3,000"),
        ((1000, 2000, 4000, 8000), "1,000, 2,000, 4,000 and 8,000"),
        ((1000,), "1,000"),
    ],
)
def test_sizes(sizes, words):
    assert made(sizes=sizes)["design"][1]["Numbers of points"] == words


def test_design():
    asked = design(methods=("incremental", "delaunay"), repetitions=40, seed=7)
    facts = made(design=asked)["design"][1]
    triangulations = 2 * 2 * 4 * 40
    assert facts["Triangulation"] == "plain insertion and Delaunay"
    assert facts["Distributions"] == "uniform and exponential"
    assert facts["Repetitions"] == "40 point sets for each distribution and size"
    assert facts["Seed"] == "7"
    assert facts["Triangulations"] == (
        f"{triangulations} of {2 * 2 * 15_000 * 40:,} points in all, each point set 2 times"
    )
    assert "Correlation of x and y" not in facts


def test_design_of_fewer_repetitions_of_some_sizes():
    asked = Design(distributions=("bivariate_normal",), sizes=(1000, 2000), repetitions=(1040, 8))
    facts = made(design=asked)["design"][1]
    assert facts["Repetitions"] == (
        "point sets for each distribution: 1,040 of 1,000 and 8 of 2,000 points"
    )
    assert facts["Triangulations"] == f"1,048 of {1040 * 1000 + 8 * 2000:,} points in all"
    assert facts["Correlation of x and y"].startswith("0.5 (bivariate normal; assumed")
