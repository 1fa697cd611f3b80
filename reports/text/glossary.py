"""The words of the field that the page explains where it first uses them."""

import re
from dataclasses import dataclass

from markupsafe import Markup, escape

from lepp import INTERIOR_LAYER
from lepp.theory import LEAST_P_TEXT


@dataclass(frozen=True)
class Term:
    """A word, how texts write it, and what it means.

    Attributes
    ----------
    name : str
        The word as the glossary lists it.
    pattern : str
        Regular expression of what a text has for it, in text that is escaped for HTML.
    definition : str
        One or two sentences, without the word's own name at the beginning.
    """

    name: str
    pattern: str
    definition: str

    @property
    def address(self) -> str:
        """Id of the element that holds the definition."""
        return "term-" + re.sub(r"\W+", "-", self.name.lower())


TERMS = (
    Term(
        "LEPP",
        r"\bLEPPs?\b",
        "The longest-edge propagation path of a triangle: the triangles from it to its terminal "
        "edge, each reached across the longest edge of the one before. Its size is their number.",
    ),
    Term(
        "terminal edge",
        r"\b[Tt]erminal[ \-]edges?\b",
        "An edge at which paths end: the longest edge of both triangles beside it, or of the only "
        "one, on the boundary.",
    ),
    Term(
        "region",
        r"(?<!rejection )\b[Rr]egions?\b",
        "All triangles whose paths end at the same terminal edge.",
    ),
    Term(
        "layer",
        r"\b[Ll]ayers?\b",
        "How far a triangle is from the boundary of the mesh: the number of edges to cross from it "
        "to a triangle at the hull. The hull's triangles are layer 0.",
    ),
    Term(
        "type C",
        r"\b[Tt]ype C\b",
        "The neighbour across a triangle's longest edge is of type C if that edge is the longest "
        "of both, so that the path ends there. Types A and B are those from which it goes on.",
    ),
    Term(
        "p",
        # Not the p of a test: that is followed by its value.
        rf"(?:(?<=chance )|(?<=share )|(?<=shares ))p\b|\bp\u00a0≥\u00a0{LEAST_P_TEXT}"
        r"|\bp(?= is \d)",
        "The chance that a triangle's path ends at its first step: the share of type C among the "
        "neighbours across longest edges. The theorems take it to be the same at every step.",
    ),
    Term(
        "r",
        r"(?:(?<=share of )|(?<=with ))r\b",
        "The chance that a step ends a path, over all steps of all paths together: one over the "
        "mean "
        "size less one. Theorem 1 with it has the measured mean by construction.",
    ),
    Term(
        "interior",
        r"(?<=in the )interiors?\b|(?<=Of their )interiors\b",
        f"The triangles that are {INTERIOR_LAYER} or more steps across edges away from a triangle "
        "at "
        "the hull. Closer ones have paths that feel the edge: with many Delaunay points the means "
        "of "
        "the layers come to rest some way before that.",
    ),
    Term(
        "plain insertion",
        r"\b[Pp]lain insertion\b",
        "Triangulation point by point in the given order, without flips: a point inside a triangle "
        "splits it in three, a point outside is joined to every edge of the hull that it sees.",
    ),
    Term(
        "Delaunay",
        r"\bDelaunay\b",
        "The triangulation in which no point lies inside the circle through the corners of a "
        "triangle: of all triangulations of the points the one with the largest least angle.",
    ),
)

_ANY = re.compile("|".join(f"(?P<t{k}>{term.pattern})" for k, term in enumerate(TERMS)))


def marked(text: Markup, used: set[str]) -> Markup:
    """Mark up the first use of each term.

    Parameters
    ----------
    text : Markup
        Escaped text without elements.
    used : set of str
        Names of terms that are marked already; those that are marked here are added.

    Returns
    -------
    Markup
        The text, with a button at each term that opens its definition.
    """

    def button(match: re.Match[str]) -> str:
        term = TERMS[int(str(match.lastgroup)[1:])]
        if term.name in used:
            return match[0]
        used.add(term.name)
        return (
            f'<button type="button" class="term" popovertarget="{escape(term.address)}" '
            f'aria-describedby="{escape(term.address)}">{match[0]}</button>'
        )

    return Markup(_ANY.sub(button, str(text)))
