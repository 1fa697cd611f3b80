"""Types of longest-edge neighbours (Definition 1): what the crossed edge is to the neighbour."""

import numpy as np

from lepp.geometry.lengths import NEARLY_EQUAL_BIT, SHORTEST_SHIFT
from lepp.jit import kernel

TYPE_NONE, TYPE_A, TYPE_B, TYPE_C = 0, 1, 2, 3
"""Type of a longest-edge neighbour (Definition 1): none; the crossed edge is its shortest (A),
middle (B) or longest (C). A path ends at a neighbour of type C."""

# The bits of a rank that say which edges are longest and which is shortest.
_ORDERS = NEARLY_EQUAL_BIT - 1


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
    # The type by rank and crossed edge. It is looked up, and the edge added up: branches would be
    # mispredicted. Edge 3 stands for a neighbour on two sides, which no sound mesh has.
    of_edge = np.full((_ORDERS + 1, 4), TYPE_NONE, np.int8)
    for rank in range(_ORDERS + 1):
        for edge in range(3):
            kind = TYPE_A if edge == rank >> SHORTEST_SHIFT else TYPE_B
            of_edge[rank, edge] = TYPE_C if (rank >> edge) & 1 else kind
    types = np.empty(len(successors), np.int8)
    for t in range(len(successors)):
        s = max(successors[t], 0)
        shared = (neighbors[s, 1] == t) + 2 * (neighbors[s, 2] == t)
        kind = of_edge[ranks[s] & _ORDERS, shared]
        types[t] = kind if successors[t] >= 0 else TYPE_NONE
    return types


def count_types(types: np.ndarray) -> np.ndarray:
    """Return how many neighbours are of each type, (4,) int64, `TYPE_NONE` the first.

    Parameters
    ----------
    types : (m,) int8 ndarray
    """
    kinds = (TYPE_NONE, TYPE_A, TYPE_B, TYPE_C)
    return np.array([np.count_nonzero(types == kind) for kind in kinds], np.int64)
