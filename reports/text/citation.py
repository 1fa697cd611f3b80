"""How the report and the paper are cited, in words and as BibTeX."""

import re
import unicodedata
from collections.abc import Mapping
from importlib.metadata import version

from study.design.design import Design
from study.paper.published import Citation
from study.text.numbers import count, listed

#: As CITATION.cff has them.
SOFTWARE_TITLE = (
    "lepp-study: a distributed study of the longest-edge propagation path of triangulations"
)
SOFTWARE_AUTHOR = "The lepp-study developers"
SOFTWARE_LICENSE = "BSD-3-Clause"

_PACKAGE = "lepp-study"


def versions(manifest: Mapping) -> list[str]:
    """Versions of the software that made the results, or of this one where none is recorded."""
    recorded = [
        environment["packages"][_PACKAGE]
        for environment in manifest.get("environments", ())
        if _PACKAGE in environment["packages"]
    ]
    return list(dict.fromkeys(recorded)) or [version(_PACKAGE)]


def report_entry(title: str, design: Design, manifest: Mapping) -> str:
    """BibTeX entry of a report: what made it, and from what."""
    sizes = design.sizes
    points = f"{sizes[0]} to {sizes[-1]}" if len(sizes) > 1 else f"{sizes[0]}"
    stops = "".join(f", {name} up to {size}" for name, size in design.largest.items())
    note = (
        f"Report ``{title}'' of lepp-study {', '.join(versions(manifest))}: seed {design.seed}; "
        f"methods {', '.join(design.methods)}; distributions {', '.join(design.distributions)}; "
        f"{count(len(sizes), 'number')} of points, {points}{stops}; "
        f"{_repetitions(design.repetitions)}"
    )
    return _entry(
        "misc",
        f"lepp-study-seed-{design.seed}",
        {
            "author": f"{{{SOFTWARE_AUTHOR}}}",
            "title": f"{{{SOFTWARE_TITLE}}}",
            "version": ", ".join(versions(manifest)),
            "note": note,
        },
    )


def _repetitions(number: int | tuple[int, ...]) -> str:
    if isinstance(number, int):
        return count(number, "repetition")
    return f"{listed([str(one) for one in number])} repetitions"


def paper_entry(paper: Citation) -> str:
    """BibTeX entry of the paper; its DOI only where that has been confirmed."""
    fields = {
        "author": " and ".join(
            f"{family}, {author.removesuffix(family).strip()}"
            for author, family in zip(paper.authors, paper.family_names, strict=True)
        ),
        "title": f"{{{paper.title}}}",
        "booktitle": paper.venue,
        "year": str(paper.year),
    }
    if paper.doi_confirmed:
        fields["doi"] = paper.doi
    return _entry("inproceedings", f"{_key(paper.family_names[0])}{paper.year}", fields)


def paper_in_words(paper: Citation) -> str:
    """Write authors, title, place and year as a sentence has them."""
    return f"{' and '.join(paper.authors)}, “{paper.title}” ({paper.venue.split(',')[0]})"


def _key(family_name: str) -> str:
    plain = unicodedata.normalize("NFKD", family_name.lower())
    return re.sub("[^a-z]", "", plain)


def _entry(kind: str, key: str, fields: dict[str, str]) -> str:
    escaped = {name: re.sub(r"([_&%#])", r"\\\1", value) for name, value in fields.items()}
    if "doi" in fields:
        escaped["doi"] = fields["doi"]
    lines = [f"  {name} = {{{value}}}," for name, value in escaped.items()]
    return "\n".join([f"@{kind}{{{key},", *lines, "}"])
