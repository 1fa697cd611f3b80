"""Terminal edges, and their regions: the triangles whose paths end there."""

import numpy as np

from lepp.jit import kernel


@kernel
def regions_of_triangles(triangles, edges, ends):
    """Return the terminal edges and regions, where a triangle has one longest edge.

    Parameters
    ----------
    triangles : (m, 3) int32 ndarray
    edges : (m,) uint8 ndarray
        The longest edge of each triangle.
    ends : (m,) int32 ndarray
        The first triangle at the terminal edge of each path.

    Returns
    -------
    terminal_edges : (k, 2) int32 ndarray
        Their vertices; in the order of their first triangles.
    regions : (m,) int32 ndarray
        Which of them each path ends at.
    """
    m = len(ends)
    terminal_edges = np.empty((m, 2), np.int32)
    number = np.empty(m, np.int32)
    n_edges = 0
    for t in range(m):
        longest = edges[t]
        number[t] = n_edges
        terminal_edges[n_edges, 0] = triangles[t, longest + 1 if longest < 2 else 0]
        terminal_edges[n_edges, 1] = triangles[t, longest - 1 if longest > 0 else 2]
        n_edges += ends[t] == t  # else it is overwritten
    regions = np.empty(m, np.int32)
    for t in range(m):
        regions[t] = number[ends[t]]
    return terminal_edges[:n_edges].copy(), regions


@kernel
def count_regions(ends, n_ends):
    """Count the terminal-edge regions by their size.

    Parameters
    ----------
    ends : (m,) int32 ndarray
        Something that tells the ends of the paths from each other.
    n_ends : int
        More than any of them.

    Returns
    -------
    (k,) int64 ndarray
        How many regions have that many triangles.
    """
    sizes = np.zeros(n_ends, np.int32)
    for t in range(len(ends)):
        sizes[ends[t]] += 1
    most = 0
    for end in range(n_ends):
        most = max(most, sizes[end])
    counts = np.zeros(most + 1, np.int64)
    for end in range(n_ends):
        counts[sizes[end]] += 1
    counts[0] = 0  # what is no end
    return counts


def regions_of_edges(triangles: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the same where a triangle may have several terminal edges.

    Parameters
    ----------
    triangles : (m, 3) int32 ndarray
    ends : (m,) int32 ndarray
        The terminal edge of each path: 3 t + k for edge k of triangle t, the first at that edge.
    """
    edges, regions = np.unique(ends, return_inverse=True)
    t, k = np.divmod(edges, 3)
    vertices = np.column_stack((triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]))
    return vertices.astype(np.int32), regions.astype(np.int32)
