"""From a results directory to everything that the page speaks from."""

from pathlib import Path

from reports.page.evidence import Evidence
from reports.study_page.explorer import explorer_tables
from reports.study_page.tables import report_tables
from study.analysis.analyse import analyse
from study.results import store


def gather(directory: Path) -> Evidence:
    """Load a results directory and analyse it.

    Raises
    ------
    InputError
        If the directory holds no results that can be read.
    """
    return evidence_of(store.load(directory))


def evidence_of(loaded: store.Results) -> Evidence:
    """Analyse results, and add the report's own tables."""
    design = loaded.design
    tables = analyse(
        loaded["results"],
        loaded["histograms"],
        loaded["regions"],
        loaded["layers"],
        loaded["point_sets"],
        design,
    )
    evidence = Evidence(tables, design, loaded.manifest)
    added = (
        *report_tables(tables, loaded["results"], loaded["point_sets"], design),
        *explorer_tables(design, evidence.views),
    )
    return Evidence(tables.adding(*added), design, loaded.manifest)
