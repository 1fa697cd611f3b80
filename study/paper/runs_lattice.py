"""Which point sets Table 1 is about: its p-values of the runs test lie on a lattice.

The runs test about the median counts runs, which are whole numbers. Of n points, half above and
half below, their number R has mean n / 2 + 1 and variance n (n - 2) / (4 (n - 1)) (Wald and
Wolfowitz 1940), so that z is a multiple of the reciprocal of the standard deviation: of 1/50 for
10,000 points. A p-value printed to four decimals shows on which lattice it lies.
"""

from collections.abc import Iterator
from functools import cache

import numpy as np
from scipy import special

from study.analysis.building import Study, rows_of
from study.analysis.table import N_POINTS, Column, Declaration, Row
from study.paper import published
from study.paper.published import Number
from study.statistics.verdicts import yes

RUNS_LATTICE = Declaration(
    "runs_lattice",
    "Which point sets Table 1 tests",
    (
        N_POINTS,
        Column("printed", "Printed p-values", "", "int"),
        Column("possible", "Of which possible", "", "int"),
        Column("expected", "Expected by chance", "", "fixed2"),
        Column("steps", "Runs off the mean"),
        Column("fits", "All possible", "", "verdict"),
    ),
    note="For each published size: how many of the p-values that Table 1 prints of the runs test "
    "are, to the printed decimals, p-values that a set of so many points can have. Expected by "
    "chance: were the printed p-values any number from 0 to 1. Runs off the mean: how many runs "
    "more or less than expected give each printed p.",
)


@rows_of(RUNS_LATTICE)
def runs_lattice(_: Study) -> Iterator[Row]:
    """Hold the printed p-values of the runs test against the lattice of every published size."""
    numbers = runs_p_values()
    for size in published.sizes():
        possible = possible_p(size, numbers[0].places)
        steps = [possible.get(number.printed) for number in numbers]
        hits = sum(step is not None for step in steps)
        yield {
            "n_points": size,
            "printed": len(numbers),
            "possible": hits,
            "expected": len(numbers) * len(possible) / (10 ** numbers[0].places + 1),
            "steps": ", ".join("none" if step is None else str(step) for step in steps),
            "fits": yes(hits == len(numbers)),
        }


def runs_p_values() -> list[Number]:
    """p-values of the runs test in Table 1."""
    return [number for number in published.table_1() if "runs" in number.quantity]


def possible_p(n_points: int, places: int) -> dict[str, int]:
    """p-values of the runs test that an even number of points can have, as they are printed.

    Parameters
    ----------
    n_points : int
        Even: half of the points are above the median.
    places : int
        Decimals that are printed.

    Returns
    -------
    dict of str to int
        By how many runs, at least, their number is off its mean.
    """
    sd = np.sqrt(n_points * (n_points - 2) / (4 * (n_points - 1)))
    p = 2 * special.ndtr(-np.arange(n_points // 2) / sd)
    found: dict[str, int] = {}
    for step, value in enumerate(p.tolist()):
        text = f"{value:.{places}f}"
        found.setdefault(text, step)
        if float(text) == 0:
            break
    return found


@cache
def sizes_of_table_1() -> tuple[int, ...]:
    """Find the published sizes of which all p-values of the runs test in Table 1 are possible."""
    numbers = runs_p_values()
    return tuple(
        size
        for size in published.sizes()
        if {number.printed for number in numbers} <= possible_p(size, numbers[0].places).keys()
    )
