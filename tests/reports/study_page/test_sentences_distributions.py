"""What the report says of the distributions against each other, and the opposite."""

from functools import cache

import pytest
from frames import design
from page_text import PageText, drawn, page_text

from reports.study_page.sections import distributions

ASKED = design(
    methods=("incremental", "delaunay"), distributions=("uniform", "normal", "bivariate_normal"),
    sizes=(1000, 4000), repetitions=10,
)  # fmt: skip
PART = "distributions-compared"


@cache
def shifted(shift: float, spread: float = 0.002) -> PageText:
    """A run in which the means of normal points are larger by a share."""

    def change(results):
        scores = (results["replicate"] - 4.5) / 3.03
        factor = 1 + shift * (results["distribution"] == "normal")
        return results.assign(mean_lepp=factor * (3 + spread * scores))

    return page_text(drawn(ASKED, results=change))


@pytest.mark.parametrize(
    ("shift", "spread", "words"),
    [
        (
            0.0,
            0.002,
            "6 pairs of means can be compared: 6 show no difference and leave room for less than "
            "1 % (95 % intervals; tests at all sizes together, by Welch and Holm).",
        ),
        (0.005, 0.002, "2 show no difference and leave room for less than 1 % and 4 show one, of"),
        (0.02, 0.002, "and 4 show one that may be 1 % or more (95 %"),
        (0.0, 0.2, "6 show none, but leave room for 1 % or more"),
    ],
)
def test_pairs_are_counted(shift, spread, words):
    assert words in shifted(shift, spread).prose(PART)


@pytest.mark.parametrize(
    ("shift", "spread", "words"),
    [
        (0.0, 0.002, "So the distributions agree within 1 %, and no difference is detected."),
        (0.005, 0.002, "So the distributions agree within 1 %."),
        (0.02, 0.002, "So the distributions do not agree within 1 %."),
        (0.0, 0.2, "Whether the distributions agree within 1 % stays open."),
    ],
)
def test_agreement_is_by_intervals(shift, spread, words):
    said = shifted(shift, spread).prose(PART)
    whole, _, interior = said.partition(" Of their interiors,")
    assert whole.startswith("Of whole meshes, triangulated by the plain insertion method, 6 pairs")
    assert whole.endswith(words)
    assert interior.startswith(" triangulated by the plain insertion method, ")


def test_the_largest_difference_is_named():
    page = shifted(0.02)
    frame = page.evidence.tables["distributions"].frame
    frame = frame.query("method == 'incremental' and part == 'whole'")
    row = frame.loc[frame["relative"].abs().idxmax()]
    low, high = (f"{100 * row[end]:.2f}".replace("-", "−") for end in ("low", "high"))
    relative = f"{100 * row['relative']:.2f}".replace("-", "−")
    names = [str(row[f"distribution_{k}"]).replace("_", " ") for k in (2, 1)]
    assert (
        f"The largest difference is {relative} % ({low} % to {high} %): {names[0]} against "
        f"{names[1]} points, {row['n_points']:,} of each."
    ) in page.prose(PART)


def test_the_means_are_shown_elsewhere():
    said = shifted(0.02).prose(PART)
    assert said.endswith("[[figure-parts]] shows the means of all distributions.")


def test_one_distribution_has_no_such_section():
    one = page_text(drawn(design(distributions=("uniform",))))
    assert "distributions" not in [section.id for section in one.sections]
    assert "distributions" in [section.id for section in shifted(0.02).sections]


def test_without_means_nothing_is_said():
    none = page_text(drawn(ASKED, results=lambda f: f.iloc[:0], layers=lambda f: f.iloc[:0]))
    assert none.prose(PART) == ""
    assert distributions.section(none.evidence).id == "distributions"
