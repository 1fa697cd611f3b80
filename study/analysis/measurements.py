"""The results of a study as the statistics need them, and what of them is not enough."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from study.run.measures import columns_of
from study.run.triangulations import Measures, Task

if TYPE_CHECKING:
    from study.design.design import Design

#: Level of every interval, and the level of significance that the paper tests at.
CONFIDENCE = 0.95
SIGNIFICANCE = 0.05

Row = dict[str, object]

_KEY = ["method", *Task._fields]


class NotEnough(Exception):  # noqa: N818 - it is no error: the run simply does not hold enough
    """The results do not suffice for a statistic; the message says what is lacking."""


@dataclass(frozen=True)
class Missing:
    """A statistic that could not be computed, and why."""

    method: str
    distribution: str
    what: str
    why: str


@dataclass(frozen=True)
class Groups:
    """Mean LEPP sizes of the triangulations of one method and distribution, by size.

    Attributes
    ----------
    n_points : (k,) int64 ndarray
        Sizes, ascending, of the groups with at least one triangulation.
    values : tuple of (r,) float64 ndarray
        One mean LEPP size a triangulation, for each group.
    """

    n_points: np.ndarray
    values: tuple[np.ndarray, ...]

    def __len__(self) -> int:
        return len(self.values)

    @cached_property
    def counts(self) -> np.ndarray:
        """Triangulations of each group, (k,) int64."""
        return np.array([len(group) for group in self.values], dtype=np.int64)

    @cached_property
    def means(self) -> np.ndarray:
        """Mean of each group, (k,) float64."""
        return np.array([group.mean() for group in self.values])

    @cached_property
    def variances(self) -> np.ndarray:
        """Sample variance of each group, (k,) float64; NaN for a single triangulation."""
        return np.array([variance(group) for group in self.values])

    def repeated(self, least: int = 2) -> "Groups":
        """Only the groups of at least `least` triangulations that are not all equal."""
        kept = [i for i, group in enumerate(self.values) if len(group) >= least and np.ptp(group)]
        return Groups(self.n_points[kept], tuple(self.values[i] for i in kept))

    def need(self, groups: int) -> None:
        """Raise NotEnough unless there are at least `groups` groups."""
        if len(self) < groups:
            raise NotEnough(
                f"{groups} or more sizes with two or more differing triangulations are needed, "
                f"there {'is' if len(self) == 1 else 'are'} {len(self)}"
            )


def variance(values: np.ndarray) -> float:
    """Sample variance; NaN for fewer than two values, exactly 0 for equal ones."""
    if len(values) < 2:
        return np.nan
    return float(values.var(ddof=1)) if np.ptp(values) else 0.0


@dataclass(frozen=True)
class Measurements:
    """All that a run has measured.

    Attributes
    ----------
    results : pandas.DataFrame
        A row for each triangulation that succeeded, without nulls in what was counted.
    failures : pandas.DataFrame
        A row for each task that failed.
    histograms, regions : pandas.DataFrame
        Counts of LEPP sizes and of terminal-edge region sizes.
    point_sets : pandas.DataFrame
        A row for each point set, with the p-values of its checks.
    design : Design
        Which triangulations were asked for.
    """

    results: pd.DataFrame
    failures: pd.DataFrame
    histograms: pd.DataFrame
    regions: pd.DataFrame
    point_sets: pd.DataFrame
    design: "Design"

    @classmethod
    def of(
        cls,
        results: pd.DataFrame,
        histograms: pd.DataFrame,
        regions: pd.DataFrame,
        point_sets: pd.DataFrame,
        design: "Design",
    ) -> "Measurements":
        """Part what succeeded from what failed, in the order of the design."""
        failed = results["error"].notna().to_numpy(dtype=bool)
        types = {column.name: column.dtype for column in columns_of(Measures)}
        return cls(
            results=_ordered(results[~failed], design).astype(types),
            failures=_ordered(results[failed], design),
            histograms=_ordered(histograms, design),
            regions=_ordered(regions, design),
            point_sets=_ordered(point_sets, design),
            design=design,
        )

    @property
    def populations(self) -> Iterator[tuple[str, str]]:
        """Every method with every distribution of the design."""
        for method in self.design.methods:
            for distribution in self.design.distributions:
                yield method, distribution

    def triangulations(self, method: str, distribution: str) -> pd.DataFrame:
        """Rows of `results` of one method and distribution."""
        found = self._by_population.get((method, distribution))
        return self.results.iloc[:0] if found is None else found

    @cached_property
    def _by_population(self) -> dict[tuple[str, str], pd.DataFrame]:
        return dict(list(self.results.groupby(["method", "distribution"], sort=False)))

    def groups(self, method: str, distribution: str) -> Groups:
        """Mean LEPP sizes of one method and distribution."""
        return groups_of(self.triangulations(method, distribution), "mean_lepp")


def select(frame: pd.DataFrame, method: str, distribution: str) -> pd.DataFrame:
    """Rows of one method and distribution."""
    return frame[(frame["method"] == method) & (frame["distribution"] == distribution)]


def groups_of(triangulations: pd.DataFrame, column: str) -> Groups:
    """Group the values of a column by number of points."""
    grouped = {
        size: group.to_numpy(dtype=np.float64)
        for size, group in triangulations.groupby("n_points", sort=True)[column]
    }
    return Groups(np.array(list(grouped), dtype=np.int64), tuple(grouped.values()))


def for_each_population(
    data: Measurements, what: str, statistic: Callable[[str, str], Iterable[Row | NotEnough]]
) -> tuple[list[Row], list[Missing]]:
    """Rows of a statistic for every method and distribution.

    Parameters
    ----------
    data : Measurements
    what : str
        Name of the statistic, for what is missing.
    statistic : callable
        Takes method and distribution and yields rows; yields a NotEnough for a row that cannot be
        had and raises one when none (or no more) can.

    Returns
    -------
    rows : list of dict
        Each with its method and distribution.
    missing : list of Missing
    """
    rows: list[Row] = []
    missing: list[Missing] = []
    for method, distribution in data.populations:
        try:
            for row in statistic(method, distribution):
                if isinstance(row, NotEnough):
                    missing.append(Missing(method, distribution, what, str(row)))
                else:
                    rows.append({"method": method, "distribution": distribution} | row)
        except NotEnough as lack:
            missing.append(Missing(method, distribution, what, str(lack)))
    return rows, missing


def _ordered(frame: pd.DataFrame, design: "Design") -> pd.DataFrame:
    def rank(names: Sequence[str]) -> dict[str, int]:
        return {name: place for place, name in enumerate(names)}

    ranks = {"method": rank(design.methods), "distribution": rank(design.distributions)}
    by = [name for name in (*_KEY, "lepp_size", "region_size") if name in frame.columns]
    return frame.sort_values(
        by,
        key=lambda column: column.map(ranks[column.name]) if column.name in ranks else column,
        kind="stable",
    ).reset_index(drop=True)
