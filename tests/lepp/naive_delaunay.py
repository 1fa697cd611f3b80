"""Slow and obvious twin of the Delaunay kernel, in rational arithmetic."""

from naive import exact, turn


def in_circle(a, b, c, p):
    """Positive where p is inside the circle through a, b, c (counter-clockwise)."""
    rows = [(x - p[0], y - p[1], (x - p[0]) ** 2 + (y - p[1]) ** 2) for x, y in (a, b, c)]
    return sum(
        rows[k][2] * (rows[k - 2][0] * rows[k - 1][1] - rows[k - 2][1] * rows[k - 1][0])
        for k in range(3)
    )


def delaunay(points):
    """Insert points one by one (Bowyer and Watson); None is the vertex of the triangles outside.

    Returns the list of counter-clockwise triangles and a dictionary of the points left out.
    """
    points = exact(points)
    repeated = {i: points.index(p) for i, p in enumerate(points) if points.index(p) < i}
    todo = [i for i in range(len(points)) if i not in repeated]
    turns = (k for k in todo[2:] if turn(points[todo[0]], points[todo[1]], points[k]) != 0)
    third = next(turns, None)
    if third is None:
        return [], repeated
    a, b, c = todo[0], todo[1], third
    if turn(points[a], points[b], points[c]) < 0:
        a, b = b, a
    triangles = [(a, b, c), (None, b, a), (None, c, b), (None, a, c)]
    for i in todo:
        if i not in (a, b, c):
            cavity = [t for t in triangles if in_conflict(points, t, points[i])]
            edges = {(t[k - 2], t[k - 1]) for t in cavity for k in range(3)}
            sides = [(u, v) for u, v in edges if (v, u) not in edges]
            triangles = [t for t in triangles if t not in cavity] + [(u, v, i) for u, v in sides]
    return [t for t in triangles if None not in t], repeated


def in_conflict(points, triangle, p):
    if None not in triangle:
        return in_circle(*(points[v] for v in triangle), p) > 0
    k = triangle.index(None)
    a, b = points[triangle[k - 2]], points[triangle[k - 1]]
    side = turn(a, b, p)
    return side > 0 or (side == 0 and min(a, b) < p < max(a, b))


def center(a, b, c):
    """Centre of the circle through three points."""
    bx, by, cx, cy = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    b2, c2, d = bx * bx + by * by, cx * cx + cy * cy, 2 * (bx * cy - by * cx)
    return a[0] + (cy * b2 - by * c2) / d, a[1] + (bx * c2 - cx * b2) / d


def cells(points, triangles):
    """The polygons of which each has its corners on one empty circle.

    They are the same for every Delaunay triangulation of the points, whichever diagonals it draws.
    """
    points = exact(points)
    corners = {}
    for t in triangles:
        corners.setdefault(center(*(points[v] for v in t)), set()).update(t)
    return {frozenset(c) for c in corners.values()}


def is_delaunay(points, triangles):
    """Whether no point is inside the circle of any triangle."""
    points = exact(points)
    return all(in_circle(*(points[v] for v in t), p) <= 0 for t in triangles for p in points)
