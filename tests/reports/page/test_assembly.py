"""The page put together: numbers, references, terms."""

import re

import pytest
from markupsafe import Markup

from reports.page.assembly import assemble, reference
from reports.page.blocks import (
    ALWAYS,
    Block,
    Drawing,
    FigureBlock,
    Prose,
    Section,
    Subsection,
    TableBlock,
    common,
)
from study.analysis.table import Column, Declaration, UnknownNameError

CURVES = Declaration("curves_of_models", "Curves", (Column("x", "x"),))


def figure(name: str, *tables: TableBlock) -> FigureBlock:
    return FigureBlock(f"figure-{name}", name.capitalize(), {}, {ALWAYS: name}, "", tables)


def section(name: str, *blocks: Block) -> Section:
    return Section(name, name.capitalize(), "?", (Subsection(f"{name}-part", "Part", blocks),))


def blocks_of(sections: list[Section]) -> list[Block]:
    return [block for one in sections for part in one.parts for block in part.blocks]


def text_of(block: Block, view: str = ALWAYS) -> str:
    assert isinstance(block, Prose)
    return " ".join(map(str, block.paragraphs[view]))


def test_figures_are_numbered_in_order_and_name_their_data() -> None:
    first = section("a", figure("models", TableBlock(CURVES, "the curves")), common("text"))
    second = section("b", figure("points", TableBlock(CURVES, "x"), TableBlock(CURVES, "y")))
    models, _, points = blocks_of(assemble([first, second]))
    assert isinstance(models, FigureBlock)
    assert isinstance(points, FigureBlock)
    assert (models.number, points.number) == (1, 2)
    assert [table.caption for table in points.data] == [
        "Data of Figure 2: x",
        "Data of Figure 2: y",
    ]
    assert [table.address for table in (*models.data, *points.data)] == [
        "figure-models-data", "figure-points-data", "figure-points-data-2",
    ]  # fmt: skip
    (points, *_) = blocks_of(assemble([second, first]))
    assert isinstance(points, FigureBlock)
    assert points.number == 1


def test_references_are_links_and_follow_the_order() -> None:
    text = common(
        f"{reference('figure-models')} and {reference('table-curves-of-models')}, see "
        f"{reference('b')} & {reference('b-part')}."
    )
    sections = [section("a", text), section("b", figure("points"), figure("models"),
        TableBlock(CURVES, "The curves"))]  # fmt: skip
    assert text_of(blocks_of(assemble(sections))[0]) == (
        '<a href="#figure-models">Figure 2</a> and <a href="#table-curves-of-models">the table '
        '“The curves”</a>, see <a href="#b">“B”</a> &amp; <a href="#b-part">“Part”</a>.'
    )


def test_a_reference_to_nothing_is_an_error() -> None:
    with pytest.raises(UnknownNameError, match="'figure-model', which the page does not have"):
        assemble([section("a", common(reference("figure-model")), figure("models"))])


def test_an_id_given_twice_is_an_error() -> None:
    twice = [TableBlock(CURVES, "one"), TableBlock(CURVES, "two")]
    with pytest.raises(ValueError, match="the id table-curves-of-models: give one of them"):
        assemble([section("a", *twice)])
    named = [TableBlock(CURVES, "one"), TableBlock(CURVES, "two", id="table-two")]
    assert len(blocks_of(assemble([section("a", *named)]))) == 2


@pytest.mark.parametrize("title", ["Figure 4. The points", "Table 7. The models", "Data: x"])
def test_a_title_that_brings_a_number_is_an_error(title: str) -> None:
    with pytest.raises(ValueError, match="a title is plain words, not"):
        TableBlock(CURVES, title)
    with pytest.raises(ValueError, match="a title is plain words, not"):
        FigureBlock("figure-points", title, {}, {}, "", ())
    with pytest.raises(ValueError, match="a title is plain words, not"):
        Drawing("figure-points", "", {}, title, {}, "")
    TableBlock(CURVES, "Tables and figures of the data")


@pytest.mark.parametrize("address", ["figure-4", "points", "figure-Points", "figure_points"])
def test_an_id_of_a_figure_is_a_word(address: str) -> None:
    with pytest.raises(ValueError, match="a figure's id is a word like"):
        FigureBlock(address, "The points", {}, {}, "", ())


def test_terms_are_marked_at_their_first_use_in_a_section() -> None:
    words = common("A region < a layer.", "The region.")
    first, second = blocks_of(assemble([section("a", words), section("b", words)]))
    for block in (first, second):
        text = text_of(block)
        assert text.count("<button") == 2
        assert text.endswith("The region.")
        assert "&lt;" in text


def test_every_view_has_its_own_first_use() -> None:
    words = Prose({"x": ["A region."], "y": ["A region."]})
    views, after = blocks_of(assemble([section("a", words, Prose({"x": ["regions"]}))]))
    assert all("<button" in text_of(views, view) for view in "xy")
    assert "<button" not in text_of(after, "x")
    shared, views = blocks_of(assemble([section("a", common("A region."), words)]))
    assert "<button" in text_of(shared)
    assert not any("<button" in text_of(views, view) for view in "xy")


def test_text_that_is_html_keeps_its_elements() -> None:
    html = Markup('<em title="a region">region</em> of ') + reference("figure-regions")
    (text, _) = blocks_of(assemble([section("a", common(html), figure("regions"))]))
    assert text_of(text) == (
        '<em title="a region">region</em> of <a href="#figure-regions">Figure 1</a>'
    )


def test_a_reference_is_no_use_of_a_term() -> None:
    text, _ = blocks_of(
        assemble([section("a", common(reference("figure-layer")), figure("layer"))])
    )
    assert re.sub("<[^>]*>", "", text_of(text)) == "Figure 1"
    assert "<button" not in text_of(text)
