"""The results of a study as the statistics need them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from study.statistics.groups import Groups

if TYPE_CHECKING:
    from study.design.design import Design

_KEY = ["method", "distribution", "n_points", "replicate"]
_WHOLE = [
    "n_points", "replicate", "n_triangles", "n_hull", "n_repeated", "max_lepp",
    "n_interior_longest", "n_type_a", "n_type_b", "n_type_c", "n_regions", "max_region",
]  # fmt: skip
_REAL = [
    "mean_lepp", "sd_lepp", "skewness_lepp", "kurtosis_lepp",
    "runs_p_x", "runs_p_y", "ks_p_x", "ks_p_y",
]  # fmt: skip


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
    design : Design
        Which triangulations were asked for.
    """

    results: pd.DataFrame
    failures: pd.DataFrame
    histograms: pd.DataFrame
    regions: pd.DataFrame
    design: "Design"

    @classmethod
    def of(
        cls,
        results: pd.DataFrame,
        histograms: pd.DataFrame,
        regions: pd.DataFrame,
        design: "Design",
    ) -> "Measurements":
        """Part what succeeded from what failed, in the order of the design."""
        failed = results["error"].notna().to_numpy(dtype=bool)
        types = dict.fromkeys(_WHOLE, "int64") | dict.fromkeys(_REAL, "float64")
        return cls(
            results=_ordered(results[~failed], design).astype(types),
            failures=_ordered(results[failed], design),
            histograms=_ordered(histograms, design),
            regions=_ordered(regions, design),
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


def groups_of(triangulations: pd.DataFrame, column: str) -> Groups:
    """Group the values of a column by number of points."""
    grouped = {
        size: group.to_numpy(dtype=np.float64)
        for size, group in triangulations.groupby("n_points", sort=True)[column]
    }
    return Groups(np.array(list(grouped), dtype=np.int64), tuple(grouped.values()))


def _ordered(frame: pd.DataFrame, design: "Design") -> pd.DataFrame:
    def rank(names: Sequence[str]) -> dict[str, int]:
        return {name: place for place, name in enumerate(names)}

    ranks = {"method": rank(design.methods), "distribution": rank(design.distributions)}
    by = _KEY + [name for name in ("lepp_size", "region_size") if name in frame.columns]
    return frame.sort_values(
        by,
        key=lambda column: column.map(ranks[column.name]) if column.name in ranks else column,
        kind="stable",
    ).reset_index(drop=True)
