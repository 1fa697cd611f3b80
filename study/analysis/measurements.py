"""The results of a study as the statistics need them."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from lepp import INTERIOR_LAYER
from study.analysis.parts import WHOLE
from study.run.measures import columns_of
from study.run.triangulations import Measures, Task
from study.statistics.groups import Groups

if TYPE_CHECKING:
    from study.design.design import Design

_KEY = ["method", *Task._fields]
_POPULATION = ["method", "distribution"]
_SET = ["n_points", "replicate"]


@dataclass(frozen=True, eq=False)
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
    layers : pandas.DataFrame
        Counts of LEPP sizes by the layer of the triangle.
    point_sets : pandas.DataFrame
        A row for each point set, with the p-values of its checks.
    design : Design
        Which triangulations were asked for.
    """

    results: pd.DataFrame
    failures: pd.DataFrame
    histograms: pd.DataFrame
    regions: pd.DataFrame
    layers: pd.DataFrame
    point_sets: pd.DataFrame
    design: "Design"

    @classmethod
    def of(
        cls,
        results: pd.DataFrame,
        histograms: pd.DataFrame,
        regions: pd.DataFrame,
        layers: pd.DataFrame,
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
            layers=_ordered(layers, design),
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

    def groups(self, method: str, distribution: str, part: str = WHOLE) -> Groups:
        """Mean LEPP sizes of one method and distribution, in a part of each mesh that is there."""
        if part == WHOLE:
            return groups_of(self.triangulations(method, distribution), "mean_lepp")
        counts = self.histogram(method, distribution, part)
        sums = (
            counts.assign(total=counts["lepp_size"] * counts["count"])
            .groupby(_SET, sort=True)[["total", "count"]]
            .sum()
            .reset_index()
        )
        return groups_of(sums.assign(mean_lepp=sums["total"] / sums["count"]), "mean_lepp")

    def histogram(self, method: str, distribution: str, part: str = WHOLE) -> pd.DataFrame:
        """Return counts of LEPP sizes of one method and distribution, in a part of each mesh.

        Returns
        -------
        pandas.DataFrame
            n_points, replicate, lepp_size, count; none for a mesh that has no such part.
        """
        if part == WHOLE:
            return _of_population(self._histograms, method, distribution, self.histograms)
        layers = self.by_layer(method, distribution)
        return layers[layers["layer"] == INTERIOR_LAYER].drop(columns="layer")

    def by_layer(self, method: str, distribution: str) -> pd.DataFrame:
        """Rows of `layers` of one method and distribution, without these two columns."""
        return _of_population(self._layers, method, distribution, self.layers)

    @cached_property
    def _histograms(self) -> dict[tuple[str, str], pd.DataFrame]:
        return _by_population(self.histograms)

    @cached_property
    def _layers(self) -> dict[tuple[str, str], pd.DataFrame]:
        return _by_population(self.layers)


def triangulations_by_size(rows: pd.DataFrame) -> dict[int, int]:
    """Count the triangulations that rows of histograms or layers are of, by number of points."""
    counts = rows.groupby("n_points")["replicate"].nunique()
    return {int(size): int(number) for size, number in counts.items()}


def _by_population(frame: pd.DataFrame) -> dict[tuple[str, str], pd.DataFrame]:
    return {
        (method, distribution): rows.drop(columns=_POPULATION).reset_index(drop=True)
        for (method, distribution), rows in frame.groupby(_POPULATION, sort=False)
    }


def _of_population(
    frames: dict[tuple[str, str], pd.DataFrame],
    method: str,
    distribution: str,
    whole: pd.DataFrame,
) -> pd.DataFrame:
    nothing = whole.iloc[:0].drop(columns=_POPULATION)
    return frames.get((method, distribution), nothing)


def groups_of(triangulations: pd.DataFrame, column: str) -> Groups:
    """Group the values of a column by number of points."""
    grouped = {
        size: group.to_numpy(dtype=np.float64)
        for size, group in triangulations.groupby("n_points", sort=True)[column]
    }
    return Groups(np.array(list(grouped), dtype=np.int64), tuple(grouped.values()))


def _ordered(frame: pd.DataFrame, design: "Design") -> pd.DataFrame:
    ranked = {"method": design.methods, "distribution": design.distributions}
    keys = [
        pd.Categorical(frame[name], categories=list(ranked[name])).codes
        if name in ranked
        else frame[name].to_numpy()
        for name in (*_KEY, "layer", "lepp_size", "region_size")
        if name in frame.columns
    ]
    return frame.take(np.lexsort(keys[::-1])).reset_index(drop=True)
