"""From a results directory to everything that the page speaks from."""

from pathlib import Path

from reports.page.evidence import Evidence
from reports.study_page.explorer import explorer
from reports.study_page.tables import REPORT_TABLES
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
    """Analyse results, with the report's own tables beside."""
    tables = analyse(
        loaded["results"],
        loaded["histograms"],
        loaded["regions"],
        loaded["layers"],
        loaded["point_sets"],
        loaded.design,
        more=(*REPORT_TABLES, explorer),
    )
    return Evidence(tables, loaded.design, loaded.manifest)
