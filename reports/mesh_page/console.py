"""A mesh's survey on the terminal."""

import numpy as np
from rich import box
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from reports.mesh_page import findings
from study.meshes.survey import Survey
from study.text.numbers import show


def print_survey(survey: Survey) -> None:
    """Print what the paths of a mesh say: with rules on a terminal, plain elsewhere."""
    console = Console(highlight=False)
    for warning in findings.warnings(survey).values():
        _print(console, f"Warning: {warning}")
    _print(console, findings.headline(survey), style="bold")
    _print(console, ". ".join(f"{name}: {value}" for name, value in findings.facts(survey)) + ".")
    for note in survey.mesh.notes:
        _print(console, f"Note: {note}")
    _print_part(console, "How far refinements spread", findings.spread(survey))
    _print(console, findings.ties(survey))
    console.print(_sizes(console, survey.counts.counts))
    _print_part(console, "The longest path", findings.worst(survey))
    console.print(_path(console, survey))
    _print_part(console, "Where the paths end", findings.regions(survey))
    _print_part(console, "Theory", findings.theory(survey))


def _print(console: Console, text: str, style: str = "") -> None:
    """Print a paragraph, in lines only where somebody reads it at once."""
    console.print(Text(_plain(text), style=style), soft_wrap=not console.is_terminal)


def _print_part(console: Console, title: str, paragraph: str) -> None:
    console.print()
    _print(console, title, style="bold")
    _print(console, paragraph)


def _table(console: Console, *columns: str) -> Table:
    table = Table(
        box=box.SIMPLE_HEAD if console.is_terminal else None, pad_edge=False, header_style="bold"
    )
    for column in columns:
        table.add_column(column, justify="right", no_wrap=True)
    return table


def _sizes(console: Console, counts: np.ndarray) -> Padding:
    table = _table(console, "LEPP size", "Triangles", "Share", "Up to this size")
    for name, number, share, below in findings.size_rows(counts):
        table.add_row(
            name, f"{number:,}", _plain(show(share, "percent2")), _plain(show(below, "percent2"))
        )
    return _indented(console, table)


def _path(console: Console, survey: Survey) -> Padding:
    """Make a table of the longest path's first triangles and its last."""
    table = _table(console, "Step", "Triangle", "Block", "Cell", "Points", "Centre")
    triangulation, path = survey.triangulation, survey.worst_path
    shown = range(len(path)) if len(path) <= 24 else [*range(22), None, len(path) - 1]
    for step in shown:
        if step is None:
            table.add_row(*["…"] * 6)
            continue
        t = path[step]
        vertices = triangulation.triangles[t]
        centre = triangulation.points[vertices].mean(axis=0)
        table.add_row(
            f"{step + 1:,}",
            f"{t:,}",
            f"{survey.mesh.blocks[t]}",
            f"{survey.mesh.cells[t]:,}",
            " ".join(map(str, vertices)),
            " ".join(f"{x:.6g}" for x in centre),
        )
    return _indented(console, table)


def _indented(console: Console, table: Table) -> Padding:
    above = 0 if console.is_terminal else 1  # there a table has an empty line of its own
    return Padding(table, (above, 0, 0, 2), expand=False)


def _plain(text: str) -> str:
    return text.replace("\u00a0", " ")
