"""How it was made: design, seed, versions, and what did not work out."""

import math
from itertools import pairwise

from lepp import METHODS, NEARLY_EQUAL
from reports.page.blocks import Facts, Quotation, Section, Subsection, TableBlock, common
from reports.page.evidence import Evidence
from reports.page.views import distribution_word
from reports.study_page.tables import FAILURES
from reports.text.citation import SOFTWARE_LICENSE, paper_entry, report_entry
from reports.text.words import TITLE
from study.analysis.building import MISSING
from study.analysis.group_summaries import OVERVIEW
from study.analysis.table import Rows
from study.design.design import Design
from study.paper.published import CITATION
from study.text.numbers import count, large, listed, ten_to


def section(evidence: Evidence) -> Section:
    """Design, completeness, environment, citation."""
    parts = [
        Subsection("design", "Design", (_design(evidence),)),
        Subsection("completeness", "Completeness", _completeness(evidence)),
        Subsection("environment", "Environment", _environments(evidence)),
        Subsection("cite", "How to cite", _citations(evidence)),
    ]
    return Section("made", "How it was made", "Can I make it again?", tuple(parts))


def _repetitions(design: Design) -> str:
    by_size = design.repetitions_by_size
    of_sizes = "point sets for each distribution"
    if len(set(by_size.values())) == 1:
        return f"{next(iter(by_size.values())):,} {of_sizes} and size"
    each = listed([f"{sets:,} of {size:,}" for size, sets in by_size.items()])
    return f"{of_sizes}: {each} points"


def _design(evidence: Evidence) -> Facts:
    design = evidence.design
    times = len(design.methods)
    each = f", each point set {times} times" if times > 1 and not design.largest else ""
    stops = [f"{METHODS[name].word} up to {size:,}" for name, size in design.largest.items()]
    facts = [
        ("Triangulation", listed([METHODS[name].word for name in design.methods])),
        ("Distributions", listed([distribution_word(d) for d in design.distributions])),
        ("Numbers of points", "; ".join([_sizes(design.sizes), *stops])),
        ("Repetitions", _repetitions(design)),
        ("Seed", str(design.seed)),
        (
            "Triangulations",
            f"{design.n_triangulations:,} of {design.n_points:,} points in all{each}",
        ),
    ]
    if "bivariate_normal" in design.distributions:
        facts.append(
            (
                "Correlation of x and y",
                f"{design.correlation:g} (bivariate normal; assumed, as the paper names none)",
            )
        )
    facts.append(
        (
            "Random numbers",
            "NumPy's PCG64DXSM; a point set's own seed follows from the study's seed, its "
            "distribution, size and repetition, so it depends on nothing else",
        )
    )
    return Facts(tuple(facts))


def _sizes(sizes: tuple[int, ...]) -> str:
    steps = {second - first for first, second in pairwise(sizes)}
    if len(sizes) > 3 and len(steps) == 1:
        return f"{sizes[0]:,} to {sizes[-1]:,} in steps of {steps.pop():,} ({len(sizes)} sizes)"
    return listed([f"{size:,}" for size in sizes])


def _completeness(evidence: Evidence) -> tuple:
    overview = evidence.rows(OVERVIEW)
    asked, done, failed = (int(overview[c].sum()) for c in ("asked", "triangulations", "failed"))
    repeated = int(overview["repeated_points"].sum())
    sentence = (
        f"All {count(asked, 'triangulation')} were made; none failed."
        if done == asked
        else f"Of {count(asked, 'triangulation')}, {done:,} were made, {failed:,} failed and "
        f"{asked - done - failed:,} have not been run."
    )
    left_out = (
        f" {count(repeated, 'point')} that repeated another of the same set "
        f"{'was' if repeated == 1 else 'were'} left out."
        if repeated
        else ""
    )
    blocks: list = [
        common(sentence + left_out, _ties(overview)),
        TableBlock(OVERVIEW, "The study at a glance", follows=()),
    ]
    if not evidence.rows(MISSING).empty:
        blocks.append(TableBlock(MISSING, "What could not be computed, and why", follows=()))
    if not evidence.rows(FAILURES).empty:
        blocks.append(TableBlock(FAILURES, "Tasks that failed", follows=()))
    return tuple(blocks)


def _ties(overview: Rows) -> str:
    """Say how many triangles have several longest edges, on which the choice of a path hangs."""
    equal, nearly, triangles = (
        int(overview[c].sum()) for c in ("equal_longest", "nearly_equal_longest", "triangles")
    )
    some = "No triangle has" if equal == 0 else f"{count(equal, 'triangle has', 'triangles have')}"
    return (
        f"{some} longest edges of exactly equal length, and {nearly:,} of {large(triangles)} have "
        f"two that agree to {ten_to(round(math.log10(NEARLY_EQUAL)))} of their length: lengths are "
        "compared exactly, and where they are equal a path takes the shortest way."
    )


def _environments(evidence: Evidence) -> tuple:
    blocks: list = []
    for environment in evidence.manifest.get("environments", ()):
        facts = [
            ("Python", f"{environment['python']} ({environment['implementation']})"),
            ("System", f"{environment['system']}, {environment['machine']}"),
            *((name, version) for name, version in environment["packages"].items()),
        ]
        blocks.append(Facts(tuple(facts)))
    if len(blocks) > 1:
        blocks.insert(
            0, common("The run was taken up again in another environment; all are listed.")
        )
    return tuple(blocks)


def _checksums(evidence: Evidence) -> list[tuple[str, str]]:
    """Name the files of results with the sums by which they can be told from others."""
    return [(f"SHA-256 of {name}", s) for name, s in evidence.manifest.get("sha256", {}).items()]


def _citations(evidence: Evidence) -> tuple:
    return (
        common(
            "The report is made by software, from a design and a seed; cite both, and the paper."
        ),
        Quotation("This report, BibTeX", report_entry(TITLE, evidence.design, evidence.manifest)),
        Quotation("The paper, BibTeX", paper_entry(CITATION)),
        Facts((("Licence of the software", SOFTWARE_LICENSE), *_checksums(evidence))),
    )
