"""The command ``lepp-study bench``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from study.run.benchmark import Benchmark, Measurement


@click.command()
@click.argument("directory", required=False, type=click.Path(path_type=Path))
@click.option(
    "--points",
    metavar="N",
    type=click.IntRange(min=3),
    default=200_000,
    show_default=True,
    help="Points of a set, without --full.",
)
@click.option(
    "--repeats",
    metavar="N",
    type=click.IntRange(min=1),
    default=5,
    show_default=True,
    help="Times that each is measured, without --full; the median counts.",
)
@click.option(
    "--full",
    is_flag=True,
    help="Measure rates from 1,000 to a million points, memory, and runs of the paper's study, for "
    "some minutes; write benchmark.parquet and benchmark.html into DIRECTORY, results/bench if not "
    "given.",
)
@click.option(
    "--against",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="With --full: the benchmark.parquet of another version, to compare with.",
)
def bench(
    directory: Path | None, points: int, repeats: int, full: bool, against: Path | None
) -> None:
    """Measure this machine: triangulation and LEPP against scipy.spatial.Delaunay."""
    from lepp import InputError

    if full:
        _measure_all(directory or Path("results") / "bench", against)
    elif directory is not None or against is not None:
        raise InputError("DIRECTORY and --against go with --full, which alone writes files.")
    else:
        from study.run import benchmark

        _print_rates(benchmark.rates(points, repeats), points)


def _measure_all(directory: Path, against: Path | None) -> None:
    from reports.bench_page.page import render
    from reports.cli.progress import progress
    from study.results.files import write_text
    from study.run.benchmark import Benchmark, measure

    before = None if against is None else Benchmark.read(against)
    directory.mkdir(parents=True, exist_ok=True)
    with progress() as listener:
        made = measure(listener)
    made.write(directory / "benchmark.parquet")
    write_text(directory / "benchmark.html", render(made, before))
    _print_all(made, before)
    click.echo(f"Page: {directory / 'benchmark.html'}")


def _print_rates(found: list[Measurement], points: int) -> None:
    """Print the rates of one core, a row a method."""
    import lepp
    from study.run.benchmark import QUANTITIES, YARDSTICK
    from study.text.numbers import show

    shown = ("triangulation", "sizes", "times_scipy")
    values = {(one.quantity, one.method): one.value for one in found}
    rows = [
        [method, *(show(values[name, method], QUANTITIES[name].format) for name in shown)]
        for method in lepp.METHODS
    ]
    headings = ["", "triangulation, ns a point", "LEPP sizes, ns a point", "times as fast as SciPy"]
    _print_table(f"{points:,} uniform points, one core; SciPy is {YARDSTICK}", headings, rows)


def _print_all(made: Benchmark, before: Benchmark | None) -> None:
    """Print a table for each quantity."""
    from reports.bench_page.tables import tables_of

    for table in tables_of(made, before):
        unit = f", {table.quantity.unit}" if table.quantity.unit else ""
        _print_table(table.quantity.title + unit, table.headings, table.rows)


def _print_table(title: str, headings: list[str], rows: list[list[str]]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table()
    for k, heading in enumerate(headings):
        table.add_column(heading, justify="right" if k else "left", no_wrap=not k)
    for row in rows:
        table.add_row(*row)
    console = Console()
    # Elsewhere than on a terminal, rich takes lines to have 80 characters.
    width = None if console.is_terminal else 110
    console.print(f"\n{title}", width=width, highlight=False)
    console.print(table, width=width)
