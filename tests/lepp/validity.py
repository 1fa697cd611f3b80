"""What must be true of every triangulation of a point set."""

import naive
import numpy as np

import lepp
from lepp.geometry.lengths import edge_ranks


def assert_valid(triangulation):
    """Hold a point set's triangulation against all that must be true of it."""
    points, triangles = naive.exact(triangulation.points), triangulation.triangles
    areas = [naive.turn(*(points[v] for v in t)) for t in triangles.tolist()]
    assert min(areas) > 0
    if triangulation._edge_ranks is not None:
        ranks = edge_ranks(triangulation.points, triangles)
        assert np.array_equal(triangulation._edge_ranks, ranks)
    rebuilt = lepp.Triangulation.from_arrays(triangulation.points, triangles)
    assert np.array_equal(rebuilt.neighbors, triangulation.neighbors)
    hull = {}
    for t, neighbors in enumerate(triangulation.neighbors.tolist()):
        for k in range(3):
            if neighbors[k] < 0:
                hull[int(triangles[t, k - 2])] = int(triangles[t, k - 1])
    n = len(points) - len(triangulation.repeated)
    assert len(triangles) == 2 * n - 2 - len(hull)
    assert set(np.unique(triangles)) == set(range(len(points))) - set(triangulation.repeated[:, 0])
    ring = [next(iter(hull))]
    while hull[ring[-1]] != ring[0]:
        ring.append(hull[ring[-1]])
    assert len(ring) == len(hull)
    ring_points = [points[v] for v in ring]
    twice_area = sum(
        a[0] * b[1] - a[1] * b[0]
        for a, b in zip(ring_points, ring_points[1:] + ring_points[:1], strict=True)
    )
    assert sum(areas) == twice_area
    corners = zip(
        ring_points,
        ring_points[1:] + ring_points[:1],
        ring_points[2:] + ring_points[:2],
        strict=True,
    )
    assert all(naive.turn(a, b, c) >= 0 for a, b, c in corners)
