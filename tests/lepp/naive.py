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


def edges_of(triangle):
    """The edges of a triangle, each with its smaller vertex first."""
    a, b, c = triangle
    return [tuple(sorted(edge)) for edge in ((b, c), (c, a), (a, b))]


def layers(triangles, last):
    """Steps across edges from each triangle to one on the boundary, at most `last`."""
    beside = {}
    for t, triangle in enumerate(triangles):
        for edge in edges_of(triangle):
            beside.setdefault(edge, []).append(t)
    steps = dict.fromkeys((ts[0] for ts in beside.values() if len(ts) == 1), 0)
    for step in range(1, last):
        reached = [t for t, before in steps.items() if before == step - 1]
        for t in reached:
            for edge in edges_of(triangles[t]):
                for s in beside[edge]:
                    steps.setdefault(s, step)
    return [min(steps.get(t, last), last) for t in range(len(triangles))]


class Paths:
    """Longest-edge propagation paths by their definition, in rational arithmetic.

    An edge is a longest one unless another is longer by more than `within` of its length; a path
    goes on only to a triangle whose longest edge is longer (by more than that) than the one
    crossed; of several ways it takes the shortest, of equally short ones one across a terminal
    edge, and of these that by the largest vertices.
    """

    def __init__(self, points, triangles, within=0):
        self.points, self.triangles = exact(points), [tuple(t) for t in triangles]
        self.factor = (1 + Fraction(within)) ** 2
        self.beside = {}
        for t, triangle in enumerate(self.triangles):
            for edge in edges_of(triangle):
                self.beside.setdefault(edge, []).append(t)
        self.found = {}

    def square(self, edge):
        a, b = edge
        return sum((x - y) ** 2 for x, y in zip(self.points[a], self.points[b], strict=True))

    def longest(self, t):
        edges = edges_of(self.triangles[t])
        most = max(map(self.square, edges))
        return [edge for edge in edges if not most > self.square(edge) * self.factor]

    def across(self, t, edge):
        return next((s for s in self.beside[edge] if s != t), None)

    def way(self, t, edge):
        """The rest of the path of t across one of its longest edges, and the terminal edge."""
        s = self.across(t, edge)
        if s is None:
            return [], edge
        if edge in self.longest(s):
            return [s], edge
        return self.path(s)

    def path(self, t):
        """Lepp(t), the indices of its triangles in order; and its terminal edge."""
        if t not in self.found:
            ways = [(*self.way(t, edge), edge) for edge in self.longest(t)]
            shortest = min(len(steps) for steps, *_ in ways)
            steps, terminal, edge = max(
                (w for w in ways if len(w[0]) == shortest), key=lambda w: (w[1] == w[2], w[2])
            )
            self.found[t] = ([t, *steps], terminal, edge)
        return self.found[t][:2]

    def sizes(self):
        return [len(self.path(t)[0]) for t in range(len(self.triangles))]

    def successor(self, t):
        self.path(t)
        return self.across(t, self.found[t][2])

    def neighbor_type(self, t):
        """Definition 1: 0 at the boundary, else 1, 2, 3 for A, B, C."""
        s = self.successor(t)
        if s is None:
            return 0
        edge = self.found[t][2]
        if edge in self.longest(s):
            return 3
        others = [other for other in edges_of(self.triangles[s]) if other != edge]
        return 1 if all((self.square(e), e) > (self.square(edge), edge) for e in others) else 2

    def n_equal(self):
        return sum(len(self.longest(t)) > 1 for t in range(len(self.triangles)))
