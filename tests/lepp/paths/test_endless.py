"""Neighbours that lead in a circle, in meshes with equal edges."""

import numpy as np
import pytest

import lepp

#: Its two longest edges are equal.
ISOSCELES = [[0.0, -10.0], [2.0, -10.0], [1.0, -5.0]]


def circle(n):
    """A strip whose last triangle goes back to the first, and beside it one with equal edges."""
    mesh = lepp.worst_case_strip(n)
    longest = int((mesh.edge_ranks()[-1] & 7) >> 1)
    first = int((mesh.edge_ranks()[0] & 7) >> 1)
    neighbors = np.vstack((mesh.neighbors, [[-1, -1, -1]])).astype(np.int32)
    neighbors[n - 1, longest] = 0
    neighbors[0, (first + 1) % 3] = n - 1  # across an edge that is not its longest
    apart = len(mesh.points) + np.arange(3)
    points = np.vstack((mesh.points, ISOSCELES))
    triangles = np.vstack((mesh.triangles, [apart])).astype(np.int32)
    return lepp.Triangulation(points, triangles, neighbors)


@pytest.mark.parametrize("n", [3, 60])
def test_a_circle_is_told_also_where_edges_are_equal(n):
    mesh = circle(n)
    for of in (lepp.lepp_sizes, lepp.lepp_paths):
        with pytest.raises(lepp.InputError, match="does not end"):
            of(mesh)


def test_without_the_circle_the_same_mesh_has_paths():
    n = 60
    mesh = circle(n)
    neighbors = mesh.neighbors.copy()
    neighbors[n - 1][neighbors[n - 1] == 0] = -1
    paths = lepp.lepp_paths(lepp.Triangulation(mesh.points, mesh.triangles, neighbors))
    assert paths.sizes.tolist() == [*range(n, 0, -1), 1]
    assert paths.n_equal == 1
