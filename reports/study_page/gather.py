"""From a results directory to everything that the page speaks from."""

from pathlib import Path

from reports.page.evidence import Evidence
from reports.study_page import tables as own
from reports.study_page.explorer import explorer_tables
from study.analysis import analyse
from study.results import store


def gather(directory: Path) -> Evidence:
    """Load a results directory and analyse it.

    Raises
    ------
    InputError
        If the directory holds no results that can be read.
    """
    loaded = store.load(directory)
    design = loaded.design
    tables = dict(
        analyse(
            loaded["results"], loaded["histograms"], loaded["regions"], loaded["point_sets"], design
        )
    )
    evidence = Evidence(tables, design, loaded.manifest)
    for table in (
        own.table_4(tables["groups"], tables["reproduction"]),
        own.statements_compared(tables["statements"], design.methods),
        own.triangulations(loaded["results"]),
        own.point_sets(loaded["point_sets"]),
        own.failures(loaded["results"]),
        own.sampled_points(design),
        *explorer_tables(design, evidence.views),
    ):
        tables[table.name] = table
    return evidence
