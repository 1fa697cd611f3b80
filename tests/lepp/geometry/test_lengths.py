import math
from fractions import Fraction

import aimed
import naive
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lepp.geometry.lengths import NEARLY_EQUAL, NEARLY_EQUAL_BIT, SHORTEST_SHIFT, edge_ranks


def exact_rank(points, triangle, within):
    """The rank of a triangle by its definition, in rational arithmetic."""
    points = naive.exact(points)
    edges = [sorted((triangle[k - 2], triangle[k - 1])) for k in range(3)]
    squares = [
        sum((x - y) ** 2 for x, y in zip(points[a], points[b], strict=True)) for a, b in edges
    ]
    longest = max(squares)

    def as_long(margin):
        return [not longest > square * (1 + Fraction(margin)) ** 2 for square in squares]

    result = sum(1 << k for k in range(3) if as_long(within)[k])
    result |= min(range(3), key=lambda k: (squares[k], edges[k])) << SHORTEST_SHIFT
    return result | (NEARLY_EQUAL_BIT if sum(as_long(NEARLY_EQUAL)) > 1 else 0)


def assert_ranks_are_exact(points, within):
    """In all orders of the vertices: each edge is the first and the second in a comparison."""
    turned = [(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)]
    ranks = edge_ranks(np.array(points), np.array(turned, np.int32), equal_within=within)
    assert ranks.tolist() == [exact_rank(points, t, within) for t in turned]


@pytest.mark.parametrize("name", aimed.EDGES)
@pytest.mark.parametrize("scale", [1.0, 2.0**-40, 2.0**40])
def test_ranks_are_exact_where_rounding_is_worst(name, scale):
    within, points = aimed.EDGES[name]
    assert_ranks_are_exact(scale * aimed.read(points), float.fromhex(within))


@st.composite
def near_isosceles(draw, dim):
    """A triangle of which two edges are equal but for rounding and a few last bits."""
    a = [draw(aimed.coordinate) for _ in range(dim)]
    edge = [draw(aimed.coordinate) for _ in range(dim)]
    way = draw(st.sampled_from(["mirrored", "turned", "in tune"]))
    if way == "mirrored":
        other = [-x if draw(st.booleans()) else x for x in edge]
    elif way == "turned":
        other = [edge[1], edge[0], *edge[2:]]
    else:  # as long within 2**-20
        other = [x * (1 + 2.0**-20) for x in edge]
    b = [x + d for x, d in zip(a, edge, strict=True)]
    c = [x + d for x, d in zip(a, other, strict=True)]
    c = [x + draw(aimed.ulps) * math.ulp(x) for x in c]
    return np.ldexp([a, b, c], draw(aimed.exponents))


@settings(max_examples=300, deadline=None)
@given(
    st.sampled_from([2, 3]).flatmap(near_isosceles),
    st.sampled_from([0.0, 2.0**-52, 2.0**-20, 1e-6, 0.1]),
)
def test_ranks_are_exact_where_edges_are_nearly_equal(points, within):
    assert_ranks_are_exact(points, within)


@settings(max_examples=100, deadline=None)
@given(st.tuples(*[st.integers(-3, 3)] * 6))
def test_ranks_are_exact_on_a_lattice(numbers):
    assert_ranks_are_exact(np.array(numbers, float).reshape(3, 2), 0.0)
