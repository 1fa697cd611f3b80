"""The page of a benchmark: one HTML file."""

import math

from reports.bench_page.tables import tables_of
from reports.page.assets import ICON, environment, static
from study.run.benchmark import Benchmark, compared
from study.text.numbers import count, show


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
            versions_headings=["", "Here"] if before is None else ["", "Here", "Before"],
        )
    )


def _lede(made: Benchmark) -> str:
    frame = made.measurements
    ratios = frame[frame["quantity"] == "times_scipy"]["value"]
    overhead = frame[frame["quantity"] == "overhead"].iloc[-1]
    cores = int(overhead["cores"])
    return (
        "Triangulating and measuring paths together is "
        f"{show(ratios.min(), 'fixed1')} to {show(ratios.max(), 'fixed1')} times as fast as "
        f"SciPy's Delaunay triangulation alone. A run of {overhead['n_points']:,} points on "
        f"{'one core' if cores == 1 else f'{cores} cores'} takes "
        f"{show(overhead['value'], 'percent1')} longer than its tasks."
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
