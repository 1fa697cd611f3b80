"""What is counted of one triangulation: all its measures follow from that."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

import lepp


@dataclass(frozen=True, eq=False)
class Counted:
    """What the measures of a triangulation follow from.

    Attributes
    ----------
    n_triangles, n_hull, n_repeated : int
    by_layer : (layers, sizes) int64 ndarray
        Triangles by layer and LEPP size, as from `lepp.sizes_by_layer`.
    types : (4,) int64 ndarray
        Triangles by the type of their successor, `lepp.TYPE_NONE` the first.
    n_equal, n_nearly_equal : int
        As of `lepp.LeppPaths`.
    regions : (k,) int64 ndarray
        ``regions[s]`` terminal-edge regions have s triangles.
    """

    n_triangles: int
    n_hull: int
    n_repeated: int
    by_layer: NDArray[np.int64]
    types: NDArray[np.int64]
    n_equal: int
    n_nearly_equal: int
    regions: NDArray[np.int64]

    @classmethod
    def of(cls, triangulation: lepp.Triangulation) -> "Counted":
        """Follow the paths of a triangulation, and count."""
        paths = lepp.lepp_paths(triangulation)
        return cls(
            len(triangulation),
            triangulation.n_hull,
            len(triangulation.repeated),
            lepp.sizes_by_layer(lepp.triangle_layers(triangulation), paths.sizes),
            lepp.count_types(paths.neighbor_types),
            paths.n_equal,
            paths.n_nearly_equal,
            paths.region_counts,
        )

    @cached_property
    def lepp(self) -> lepp.LeppCounts:
        """The histogram of LEPP sizes."""
        return lepp.LeppCounts(self.by_layer.sum(axis=0))
