"""The report: one HTML file that holds everything it needs, and the tables beside it as CSV."""

import json
import re
from pathlib import Path

from lepp import METHODS, InputError
from reports.page import plotly
from reports.page.assembly import assemble
from reports.page.assets import ICON, environment, static
from reports.page.blocks import FigureBlock, Section, TableBlock
from reports.page.data import encode, figure_data, table_data
from reports.page.evidence import Evidence
from reports.page.static_table import StaticTable, static_table
from reports.page.views import distribution_name
from reports.study_page import sections
from reports.study_page.gather import gather
from reports.text.glossary import TERMS
from reports.text.words import TITLE
from study.analysis.table import DISTRIBUTION, METHOD, Column, Tables
from study.results.files import write_text

#: In the folder of tables: which files in it reports have written.
_WRITTEN = ".lepp-study.json"


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
    write_text(report, render(evidence))
    return report


def render(evidence: Evidence) -> str:
    """Make the page's HTML."""
    parts = assemble(sections.all_sections(evidence))
    first = evidence.views[0]

    def still(block: TableBlock) -> StaticTable:
        return static_table(block, evidence, first)

    return (
        environment()
        .get_template("page.html.j2")
        .render(
            title=TITLE,
            description=sections.description(evidence),
            lede=sections.LEDE,
            source=sections.source(evidence),
            icon=ICON,
            alarms=sections.alarms(evidence),
            colophon=sections.COLOPHON,
            sections=parts,
            views=evidence.views,
            first=first.key,
            shown_first=f"{first.distribution_word} points and the {first.method_word} method",
            switches=_switches(evidence),
            static=static,
            still=still,
            terms=TERMS,
            data=encode(page_data(evidence, parts)),
            plotly=plotly.script(),
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
    """Write each table as CSV, and remove those that an earlier report left.

    A file lists what reports have written here: no other file is removed, whatever its name.
    """
    # Tables are made here, if not before: what fails then leaves the folder as it is.
    texts = {f"{name}.csv": table.to_csv() for name, table in tables.items()}
    try:
        folder.mkdir(exist_ok=True)
    except FileExistsError:
        raise InputError(
            f"Cannot write into {folder}: a file has that name; give it another one."
        ) from None
    except OSError as error:
        raise InputError(f"Cannot write into {folder}: {error.strerror}.") from None
    before = _listed(folder / _WRITTEN)
    # First, so that the list holds what is written even if this ends halfway.
    _list(folder / _WRITTEN, before | texts.keys())
    for name, text in texts.items():
        write_text(folder / name, text)
    for old in before - texts.keys():
        (folder / old).unlink(missing_ok=True)
    _list(folder / _WRITTEN, set(texts))


def _listed(path: Path) -> set[str]:
    try:
        names = json.loads(path.read_text(encoding="utf-8"))["tables"]
        return {name for name in names if re.fullmatch(r"\w+\.csv", name)}
    except (OSError, ValueError, KeyError, TypeError):  # none, or edited: then nothing is removed
        return set()


def _list(path: Path, names: set[str]) -> None:
    write_text(path, json.dumps({"tables": sorted(names)}, indent=1) + "\n")


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
