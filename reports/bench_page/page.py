"""The page of a benchmark: one HTML file."""

import math

from lepp import METHODS
from reports.bench_page.tables import tables_of
from reports.page.assets import ICON, environment, static
from study.run.benchmark import Benchmark, compared
from study.text.numbers import count, listed, show


def render(made: Benchmark, before: Benchmark | None = None) -> str:
    """Make the page's HTML.

    Parameters
    ----------
    made : Benchmark
        What is shown.
    before : Benchmark, optional
        What it is held against.
    """
    return (
        environment()
        .get_template("bench.html.j2")
        .render(
            static=static,
            icon=ICON,
            lede=_lede(made),
            comparison="" if before is None else _comparison(made, before),
            tables=list(tables_of(made, before)),
            versions=_versions(made, before),
            versions_headings=["", "Version", "Version before"][: 2 if before is None else 3],
        )
    )


def _lede(made: Benchmark) -> str:
    """Say the ratio for the largest set that SciPy was given, and what the largest run cost."""
    frame = made.measurements
    ratios = frame[frame["quantity"] == "times_scipy"]
    ratios = ratios[ratios["n_points"] == ratios["n_points"].max()]
    each = [
        f"{show(row.value, 'fixed1')} times as long as {METHODS[row.method].word}"
        for row in ratios.itertuples()
    ]
    overhead = frame[frame["quantity"] == "overhead"].iloc[-1]
    where = "one core" if overhead["cores"] == 1 else f"{overhead['cores']} cores"
    return (
        f"SciPy's Delaunay triangulation of {ratios['n_points'].iloc[0]:,} points takes "
        f"{listed(each)} here, path sizes included. A run of {overhead['n_points']:,} points on "
        f"{where} takes {show(overhead['value'], 'percent1')} longer than its tasks."
    )


def _comparison(made: Benchmark, before: Benchmark) -> str:
    """Say how much higher or lower the rates are."""
    both = compared(made, before).dropna(subset="gain")
    both = both[~both["quantity"].isin(["overhead", "memory"])]
    if both.empty:
        return "The two benchmarks have no rate in common."
    mean = math.exp(both["gain"].map(math.log).mean())
    return (
        f"{count(len(both), 'rate')} were measured before, too: they are now "
        f"{show(mean, 'fixed2')} times as high in the geometric mean, from "
        f"{show(both['gain'].min(), 'fixed2')} to {show(both['gain'].max(), 'fixed2')} times."
    )


def _versions(made: Benchmark, before: Benchmark | None) -> list[list[str]]:
    """Return a row for each part of the environments: its name, and what it is here and before."""
    environments = [one.environment for one in (made, before) if one is not None]
    names = dict.fromkeys(name for known in environments for name in known)
    return [[name, *(known.get(name, "–") for known in environments)] for name in names]
