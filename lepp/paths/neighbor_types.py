"""Types of longest-edge neighbours (Definition 1): what the crossed edge is to the neighbour."""

import numpy as np

from lepp.geometry.lengths import SHORTEST_SHIFT
from lepp.jit import kernel

TYPE_NONE, TYPE_A, TYPE_B, TYPE_C = 0, 1, 2, 3
"""Type of a longest-edge neighbour (Definition 1): none; the crossed edge is its shortest (A),
middle (B) or longest (C). A path ends at a neighbour of type C."""


@kernel
def neighbor_types(neighbors, successors, ranks):
    """Return the type of each triangle's successor, (m,) int8.

    Parameters
    ----------
    neighbors : (m, 3) int32 ndarray
    successors : (m,) int32 ndarray
        -1 for none.
    ranks : (m,) uint8 ndarray
        Of `lepp.geometry.lengths`.
    """
    types = np.empty(len(successors), np.int8)
    for t in range(len(successors)):
        s = max(successors[t], 0)
        shared = 0 if neighbors[s, 0] == t else (1 if neighbors[s, 1] == t else 2)
        kind = TYPE_A if shared == (ranks[s] >> SHORTEST_SHIFT) & 3 else TYPE_B
        kind = TYPE_C if (ranks[s] >> shared) & 1 else kind
        types[t] = kind if successors[t] >= 0 else TYPE_NONE
    return types
