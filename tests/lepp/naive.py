"""Slow and obvious twins of the kernels, in rational arithmetic."""

from collections import Counter
from fractions import Fraction
from itertools import pairwise


def exact(points):
    """Points as tuples of rationals."""
    return [tuple(Fraction(float(x)) for x in point) for point in points]


def turn(a, b, c):
    """Twice the signed area of a, b, c."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def canonical(triangle):
    """The same triangle with its smallest vertex first."""
    k = triangle.index(min(triangle))
    return triangle[k:] + triangle[:k]


def incremental(points):
    """Insert points one by one, without flips.

    Returns the set of counter-clockwise triangles and a dictionary of the points left out.
    """
    points = exact(points)
    triangles, repeated, chain = [], {}, []
    for i, p in enumerate(points):
        twins = [j for j in range(i) if points[j] == p and j not in repeated]
        if twins:
            repeated[i] = twins[0]
        elif triangles:
            triangles = _insert(points, triangles, i)
        elif len(chain) < 2 or turn(points[chain[0]], points[chain[1]], p) == 0:
            chain.append(i)
        else:
            chain.sort(key=lambda j: points[j])
            for a, b in pairwise(chain):
                triangles.append((a, b, i) if turn(points[a], points[b], p) > 0 else (b, a, i))
    return {canonical(t) for t in triangles}, repeated


def _insert(points, triangles, i):
    p = points[i]
    after = []
    hit = False
    for t in triangles:
        sides = [turn(points[t[k - 2]], points[t[k - 1]], p) for k in range(3)]
        if min(sides) < 0:
            after.append(t)
            continue
        hit = True  # inside, or on the boundary: every side that does not hold p makes a triangle
        after += [(t[k - 2], t[k - 1], i) for k in range(3) if sides[k] > 0]
    if not hit:
        edges = Counter((t[k - 2], t[k - 1]) for t in triangles for k in range(3))
        for a, b in edges:
            if (b, a) not in edges and turn(points[a], points[b], p) < 0:
                after.append((b, a, i))
    return after


def longest_edge(points, triangle):
    """The last of a triangle's edges in the order (squared length, smaller, larger index)."""

    def key(edge):
        a, b = edge
        square = 0.0
        for x, y in zip(points[a], points[b], strict=True):
            square += (float(x) - float(y)) * (float(x) - float(y))
        return (square, *edge)

    return max((tuple(sorted((triangle[k - 2], triangle[k - 1]))) for k in range(3)), key=key)


def path(points, triangles, t):
    """Lepp(t): the indices of its triangles, in order."""
    steps = [t]
    while True:
        edge = set(longest_edge(points, triangles[steps[-1]]))
        beyond = [s for s, other in enumerate(triangles) if s != steps[-1] and edge <= set(other)]
        if not beyond or beyond[0] in steps:
            return steps
        steps.append(beyond[0])


def neighbor_type(points, triangles, t):
    """Definition 1: 0 at the boundary, else 1, 2, 3 for A, B, C."""
    edge = longest_edge(points, triangles[t])
    beyond = [s for s, other in enumerate(triangles) if s != t and set(edge) <= set(other)]
    if not beyond:
        return 0
    a, b, c = triangles[beyond[0]]
    shorter = [e for e in ((a, b), (b, c), (c, a)) if set(e) != set(edge)]
    first = beyond[0]
    if longest_edge(points, triangles[first]) == edge:
        return 3

    def square(e):
        return sum(
            (float(x) - float(y)) ** 2 for x, y in zip(points[e[0]], points[e[1]], strict=True)
        )

    key = (square(edge), *sorted(edge))
    below = sum((square(e), *sorted(e)) < key for e in shorter)
    return 1 + below
