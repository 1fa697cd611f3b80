"""Compiling ahead: before many processes would do so at once."""

import numpy as np

from lepp.paths import lepp_paths
from lepp.theory import worst_case_strip
from lepp.triangulation import METHODS, triangulate


def compile_kernels() -> None:
    """Compile every kernel, or load it from the cache on disk.

    Takes about half a minute the first time, and again after a change of version; then well under
    a second. Workers that start afterwards load what this has compiled.
    """
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    for method in METHODS:
        lepp_paths(triangulate(corners, method))
    lepp_paths(worst_case_strip(2))
