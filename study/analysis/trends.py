"""The trends that models of growth are held against: means by size, of each part of the mesh."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from study.analysis.measurements import Measurements
from study.analysis.parts import INTERIOR, PARTS, WHOLE, interior_shares
from study.analysis.table import Row
from study.paper import published
from study.statistics.groups import Groups, NotEnough
from study.statistics.limit_verdict import (
    LEAST_FITTED,
    LEAST_SIZES,
    Candidate,
    LimitVerdict,
    candidates,
    conclude,
    level_mean,
)
from study.statistics.model_scores import sizes_to_fit
from study.statistics.power_family import ProfileInterval
from study.statistics.size_means import SizeMeans
from study.statistics.thresholds import FREE_OF_EDGE, REFUTED_BELOW

#: The largest published number of points: models are fitted up to here before they predict.
PUBLISHED_UP_TO = max(published.sizes())
#: When the interior strikes a model of the whole mesh out, for the note of a table.
STRUCK_OUT_NOTE = (
    "a constant survives for the interior, and the interval of the model's limit has nothing in "
    "common with that of the interior's mean, widened by the most that a tenfold number of points "
    "may change this mean"
)
#: Which sizes of an interior are judged, for the note of a table.
JUDGED_NOTE = (
    "In a small mesh the interior is not free of the edge: it is judged at the sizes where it has "
    f"{100 * FREE_OF_EDGE:g} % of the triangles or more, if they are {LEAST_SIZES} or more, and at "
    "all sizes otherwise."
)


#: What `trends` has returned; forgotten with the data.
_OF_DATA: "WeakKeyDictionary[Measurements, tuple[Trend, ...]]" = WeakKeyDictionary()


@dataclass(frozen=True)
class Trend:
    """The means of one method, distribution and part.

    Attributes
    ----------
    key : dict
        Method, distribution and part.
    means : SizeMeans
    refuted_below : float
        The p below which a model is refuted.
    level : ProfileInterval or None
        `level_mean` of the interior, for a whole mesh.
    """

    key: Row
    means: SizeMeans
    refuted_below: float = REFUTED_BELOW
    level: ProfileInterval | None = None

    @cached_property
    def fitted(self) -> np.ndarray:
        """Which sizes models are fitted to before they predict the others, (g,) bool."""
        return sizes_to_fit(self.means.n_points, PUBLISHED_UP_TO, LEAST_FITTED)

    @cached_property
    def candidates(self) -> tuple[Candidate, ...]:
        """The models held against the means."""
        return candidates(self.means, self.fitted, self.refuted_below, self.level)

    @cached_property
    def verdict(self) -> LimitVerdict | None:
        """Whether the mean has a limit; None for too few sizes."""
        try:
            return conclude(self.means, self.candidates)
        except NotEnough:
            return None


def trends(data: Measurements) -> tuple[Trend, ...]:
    """Return the trend of every method, distribution and part that has one.

    They are the same objects for every table that is made of the same data, so that no model is
    held against the same means twice.
    """
    if data not in _OF_DATA:
        _OF_DATA[data] = tuple(_trends(data))
    return _OF_DATA[data]


def _trends(data: Measurements) -> Iterator[Trend]:
    means = {
        (method, distribution, part): found
        for method, distribution in data.populations
        for part in PARTS
        if (found := _means(data, method, distribution, part)) is not None
    }
    below = REFUTED_BELOW / max(len(means), 1)
    for (method, distribution, part), found in means.items():
        key: Row = {"method": method, "distribution": distribution, "part": part}
        inside = means.get((method, distribution, INTERIOR)) if part == WHOLE else None
        yield Trend(key, found, below, _level(inside, below))


def free_of_edge(data: Measurements, method: str, distribution: str) -> Groups | None:
    """Give the interiors of meshes large enough for them to be free of the edge; None if few are.

    Which is measured by their share of the triangles.
    """
    groups = data.groups(method, distribution, INTERIOR)
    shares = interior_shares(data.by_layer(method, distribution))
    kept = [k for k, n in enumerate(groups.n_points) if shares.loc[n] >= FREE_OF_EDGE]
    if len(kept) < LEAST_SIZES:
        return None
    return Groups(groups.n_points[kept], tuple(groups.values[k] for k in kept))


def _means(data: Measurements, method: str, distribution: str, part: str) -> SizeMeans | None:
    large = free_of_edge(data, method, distribution) if part == INTERIOR else None
    try:
        return SizeMeans.of(large or data.groups(method, distribution, part))
    except NotEnough:  # told of the regressions
        return None


def _level(interior: SizeMeans | None, refuted_below: float) -> ProfileInterval | None:
    if interior is None:
        return None
    try:
        return level_mean(interior, PUBLISHED_UP_TO, refuted_below)
    except NotEnough:
        return None
