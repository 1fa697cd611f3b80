import re

import pytest
from markupsafe import Markup

from reports.text.glossary import TERMS, marked


def terms_in(text: str) -> list[str]:
    return re.findall(
        r'aria-describedby="term-([\w-]+)"[^>]*>([^<]*)<', marked(Markup(text), set())
    )


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("The LEPP of t, two LEPPs", [("lepp", "LEPP")]),
        ("Terminal edges and terminal-edge regions", [("terminal-edge", "Terminal edges"),
            ("region", "regions")]),
        ("the first layer", [("layer", "layer")]),
        ("players and the regional", []),
        ("a type C neighbour, of type B", [("type-c", "type C")]),
        ("by the plain insertion method", [("plain-insertion", "plain insertion")]),
        ("an incremental change", []),
        ("Plain insertion, not Delaunay",
            [("plain-insertion", "Plain insertion"), ("delaunay", "Delaunay")]),
        ("the shares p of type C", [("p", "p"), ("type-c", "type C")]),
        ("what it supposes, p\u00a0≥\u00a01/3, holds", [("p", "p\u00a0≥\u00a01/3")]),
        ("p is 0.41", [("p", "p")]),
        ("a test (p\u00a0=\u00a00.02)", []),
        ("up to a step", []),
        ("a share of r\u00a0=\u00a00.48 ends", [("r", "r")]),
        ("with r\u00a0=\u00a00.48 of all steps", [("r", "r")]),
        ("Spearman's r or our r", []),
        ("paths in the interior", [("interior", "interior")]),
        ("whose longest edge is interior", []),
    ],
)  # fmt: skip
def test_words_of_the_field_are_told_from_others(text: str, found: list[tuple[str, str]]) -> None:
    assert terms_in(text) == found


def test_a_term_is_marked_once() -> None:
    used: set[str] = {"region"}
    assert "<button" not in marked(Markup("a region"), used)
    assert marked(Markup("a layer, a layer"), used).count("<button") == 1
    assert used == {"region", "layer"}


def test_addresses_are_unique_and_definitions_are_sentences() -> None:
    addresses = [term.address for term in TERMS]
    assert len(addresses) == len(set(addresses))
    for term in TERMS:
        assert re.fullmatch(r"term-[a-z-]+", term.address)
        assert re.fullmatch(r"[A-Z].*\.", term.definition)
