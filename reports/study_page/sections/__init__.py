"""The sections of the page, in the order in which a reader asks."""

from types import ModuleType

from markupsafe import Markup

from lepp import METHODS
from reports.page.blocks import Section
from reports.page.evidence import Evidence
from reports.page.views import distribution_name
from reports.study_page.sections import (
    agreement,
    data,
    distributions,
    edge,
    methods,
    path,
    provenance,
    regions,
    regressions,
    statistics,
    summary,
    theory,
)
from reports.text.citation import paper_in_words, versions
from study.analysis.building import MISSING
from study.analysis.group_summaries import OVERVIEW, TRIANGULATIONS_MISSING
from study.analysis.path_lengths import LAW_MISSING
from study.analysis.regressions import SATURATION_MISSING
from study.paper.published import CITATION
from study.text.numbers import count, large, listed

LEDE = (
    "When a triangle of a mesh is bisected at its longest edge, the neighbour across that edge has "
    "to be bisected with it, and so on in turn. A published study has a theory and an experiment "
    "of how far that goes. This page repeats the experiment, and holds the theory against it."
)
COLOPHON = (
    "Made by lepp-study. Plots by Plotly.js (MIT licence), which is part of this file: the page "
    "needs no network."
)

_MOST_ALARMS = 6


def modules_of(evidence: Evidence) -> list[ModuleType]:
    """List the modules of the sections that the run gives reason for."""
    modules = [path, summary, agreement, theory, statistics, edge, regressions]
    if len(evidence.design.distributions) > 1:
        modules.append(distributions)
    if len(evidence.design.methods) > 1:
        modules.append(methods)
    return [*modules, regions, data, provenance]


def all_sections(evidence: Evidence) -> list[Section]:
    """Make every section that the run gives reason for."""
    return [module.section(evidence) for module in modules_of(evidence)]


def description(evidence: Evidence) -> str:
    """Say in a sentence what was studied."""
    overview = evidence.rows(OVERVIEW)
    done, asked = int(overview["triangulations"].sum()), evidence.design.n_triangulations
    drawn = (
        count(done, "random triangulation")
        if done == asked
        else f"{done:,} of {asked:,} random triangulations"
    )
    sizes = evidence.design.sizes
    of = f"{sizes[0]:,} to {sizes[-1]:,}" if len(sizes) > 1 else f"{sizes[0]:,}"
    return (
        f"{drawn} of {of} points, {large(overview['triangles'].sum())} triangles in all: the "
        "longest-edge propagation path (LEPP) of every one of them, measured, and held against the "
        "published theory and statistics."
    )


def source(evidence: Evidence) -> Markup:
    """Name the paper, with a link where its DOI is confirmed, and this run's version and seed."""
    paper: str | Markup = paper_in_words(CITATION)
    if CITATION.doi_confirmed:
        paper = Markup('<a href="https://doi.org/{}">{}</a>').format(CITATION.doi, paper)
    return Markup(
        "The study: {}. This run: lepp-study {}, seed {} (<a href='#cite'>how to cite</a>)."
    ).format(paper, listed(versions(evidence.manifest)), evidence.design.seed)


def alarms(evidence: Evidence) -> list[str]:
    """Say what is missing, the tasks first; a full run that only lacks a fit has no alarm."""
    rows = evidence.rows(MISSING)
    tasks = rows.select(what=TRIANGULATIONS_MISSING).frame
    sentences = [
        f"{_whose(evidence, row.distribution, row.method)}{row.why}." for row in tasks.itertuples()
    ]
    # That means show no saturation is a finding, and what was not asked for is not missed.
    no_alarm = {TRIANGULATIONS_MISSING, *SATURATION_MISSING, LAW_MISSING}
    others = rows.frame[~rows["what"].isin(no_alarm)]
    others = others[others["distribution"].isin(evidence.design.distributions)]
    lacking: dict[str, list[str]] = {}
    for row in others.drop_duplicates(["what", "distribution"]).itertuples():
        lacking.setdefault(row.why, []).append(row.what)
    for why, whats in lacking.items():
        sentences.append(f"Not computed: {listed(list(dict.fromkeys(whats)))}, because {why}.")
    if len(sentences) > _MOST_ALARMS:
        rest = len(sentences) - _MOST_ALARMS + 1
        sentences = [
            *sentences[: _MOST_ALARMS - 1],
            f"{rest} more, listed under “How it was made”.",
        ]
    return sentences


def _whose(evidence: Evidence, distribution: str, method: str) -> str:
    names = [distribution_name(distribution)]
    if len(evidence.design.methods) > 1:
        names.append(METHODS[method].word)
    return f"{', '.join(names)}: "
