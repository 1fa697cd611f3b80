"""Compiling ahead: before many processes would do so at once."""

import numpy as np

from lepp.mesh.worst_case import worst_case_strip
from lepp.paths.paths import lepp_paths, lepp_sizes
from lepp.triangulate import METHODS, triangulate


def compile_kernels() -> None:
    """Compile every kernel that triangulating and following paths take, or load it from the cache.

    Takes about a minute the first time, and again after a change of version; then well under a
    second. Workers that start afterwards load what this has compiled.
    """
    square = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    turned = np.array([[0.0, 0.0], [1.0, 0.1], [0.0, 1.3], [1.1, 1.0]])
    for method in METHODS:
        for points in (square, turned):  # with and without equal lengths
            mesh = triangulate(points, method)
            lepp_sizes(mesh)
            lepp_paths(mesh)
    strip = worst_case_strip(2)
    lepp_sizes(strip)
    in_space = np.column_stack((strip.points, np.zeros(len(strip.points))))
    lepp_sizes(type(strip).from_arrays(in_space, strip.triangles))
