"""The mathematics: triangulations and their longest-edge propagation paths (LEPP)."""

from lepp import theory
from lepp.errors import InputError, MeshError, MeshProblem, Remedy
from lepp.geometry.lengths import NEARLY_EQUAL
from lepp.histogram import LeppCounts
from lepp.jit.ahead import compile_kernels
from lepp.mesh.triangulation import Triangulation
from lepp.mesh.worst_case import worst_case_strip
from lepp.paths.layers import INTERIOR_LAYER, sizes_by_layer, triangle_layers
from lepp.paths.neighbor_types import TYPE_A, TYPE_B, TYPE_C, TYPE_NONE, count_types
from lepp.paths.paths import LeppPaths, lepp_paths, lepp_sizes
from lepp.triangulate import METHODS, Method, triangulate

__all__ = [
    "INTERIOR_LAYER",
    "METHODS",
    "NEARLY_EQUAL",
    "TYPE_A",
    "TYPE_B",
    "TYPE_C",
    "TYPE_NONE",
    "InputError",
    "LeppCounts",
    "LeppPaths",
    "MeshError",
    "MeshProblem",
    "Method",
    "Remedy",
    "Triangulation",
    "compile_kernels",
    "count_types",
    "lepp_paths",
    "lepp_sizes",
    "sizes_by_layer",
    "theory",
    "triangle_layers",
    "triangulate",
    "worst_case_strip",
]
