"""The mathematics: triangulations and their longest-edge propagation paths (LEPP)."""

from lepp import theory
from lepp.counts import LeppCounts
from lepp.errors import InputError, MeshError, MeshProblem
from lepp.paths import (
    TYPE_A,
    TYPE_B,
    TYPE_C,
    TYPE_NONE,
    LeppPaths,
    lepp_paths,
    lepp_sizes,
)
from lepp.triangulation import METHODS, Triangulation, triangulate
from lepp.warm import compile_kernels

__all__ = [
    "METHODS",
    "TYPE_A",
    "TYPE_B",
    "TYPE_C",
    "TYPE_NONE",
    "InputError",
    "LeppCounts",
    "LeppPaths",
    "MeshError",
    "MeshProblem",
    "Triangulation",
    "compile_kernels",
    "lepp_paths",
    "lepp_sizes",
    "theory",
    "triangulate",
]
