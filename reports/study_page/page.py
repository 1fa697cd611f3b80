"""The report: one HTML file that holds everything it needs, and the tables beside it as CSV."""

import importlib.util
from functools import cache
from pathlib import Path

from lepp import METHODS
from reports.page.assets import environment, static
from reports.page.blocks import FigureBlock, Section
from reports.page.data import compress, encode, figure_data, table_data
from reports.page.evidence import Evidence
from reports.page.files import write_whole
from reports.page.views import distribution_name
from reports.study_page import sections
from reports.study_page.gather import gather
from study.analysis.table import DISTRIBUTION, METHOD, Column, Tables


def write_report(directory: Path) -> Path:
    """Write ``tables/*.csv`` and ``report.html`` of a results directory.

    Parameters
    ----------
    directory : Path
        A directory that `study.run.runner.run` made, finished or not.

    Returns
    -------
    Path
        The report. The same results give the same bytes.

    Raises
    ------
    InputError
        If the directory holds no results that can be read, or cannot be written.
    """
    evidence = gather(directory)
    write_tables(directory / "tables", evidence.tables)
    report = directory / "report.html"
    write_whole(report, render(evidence))
    return report


def render(evidence: Evidence) -> str:
    """Make the page's HTML."""
    parts = sections.all_sections(evidence)
    return (
        environment()
        .get_template("page.html.j2")
        .render(
            title=sections.TITLE,
            description=sections.description(evidence),
            alarms=sections.alarms(evidence),
            colophon=sections.COLOPHON,
            sections=parts,
            views=evidence.views,
            first=evidence.views[0].key,
            switches=_switches(evidence),
            static=static,
            data=encode(page_data(evidence, parts)),
            plotly=_plotly(),
        )
    )


def page_data(evidence: Evidence, parts: list[Section]) -> dict:
    """Everything that the page's script draws: tables, and figures that refer to them."""
    figures = {
        block.id: {key: figure_data(spec) for key, spec in block.specs.items()}
        for section in parts
        for part in section.parts
        for block in part.blocks
        if isinstance(block, FigureBlock)
    }
    tables = {name: table_data(table) for name, table in evidence.tables.items()}
    return {"tables": tables, "figures": figures}


def write_tables(folder: Path, tables: Tables) -> None:
    """Write each table as CSV, and remove those that an earlier report left."""
    folder.mkdir(exist_ok=True)
    for name, table in tables.items():
        write_whole(folder / f"{name}.csv", table.to_csv())
    for old in sorted(folder.glob("*.csv")):
        if old.stem not in tables:
            old.unlink()


def _switches(evidence: Evidence) -> list[dict]:
    return [
        _switch(
            DISTRIBUTION, {name: distribution_name(name) for name in evidence.design.distributions}
        ),
        _switch(METHOD, {name: METHODS[name].title for name in evidence.design.methods}),
    ]


def _switch(column: Column, titles: dict[str, str]) -> dict:
    options = []
    for value, title in titles.items():
        short, _, rest = title.partition(" ")
        options.append({"value": value, "short": short, "rest": rest})
    return {"name": column.name, "title": column.label, "options": options}


@cache
def _plotly() -> str:
    # By its path: importing plotly costs more than all of the page.
    package = importlib.util.find_spec("plotly")
    assert package is not None, "plotly is a dependency"
    assert package.origin is not None, "plotly is a regular package"
    source = Path(package.origin).parent / "package_data" / "plotly.min.js"
    return compress(source.read_text(encoding="utf-8"))
