from itertools import chain, permutations

import aimed
import naive
import naive_delaunay
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lepp.geometry.predicates import exact_in_circle, exact_orientation, in_circle, orientation

anything = st.floats(allow_nan=False, allow_infinity=False)
near_one = st.integers(-4, 4).map(lambda k: 1.0 + k * 2.0**-52)
lattice = st.integers(-5, 5).map(float)
tenths = st.integers(-5, 5).map(lambda k: 0.1 * k)
tiny = st.integers(-3, 3).map(lambda k: k * 5e-324)
kinds = (anything, near_one, lattice, tenths, tiny, anything | near_one | lattice)


def points_of_any_kind(n):
    return st.one_of(*(st.lists(st.tuples(s, s), min_size=n, max_size=n) for s in kinds))


def sign(x):
    return (x > 0) - (x < 0)


def flat(points):
    return [float(x) for x in chain.from_iterable(points)]


def assert_orientation_is_exact(points):
    expected = sign(naive.turn(*naive.exact(points)))
    assert orientation(*flat(points)) == expected
    assert exact_orientation(*flat(points)) == expected


def assert_in_circle_is_exact(points):
    expected = sign(naive_delaunay.in_circle(*naive.exact(points)))
    assert in_circle(*flat(points)) == expected
    assert exact_in_circle(*flat(points)) == expected


@settings(max_examples=500, deadline=None)
@given(points_of_any_kind(3))
def test_orientation_is_exact_for_all_doubles(points):
    assert_orientation_is_exact(points)


@settings(max_examples=500, deadline=None)
@given(aimed.near_collinear())
def test_orientation_is_exact_near_a_line(points):
    assert_orientation_is_exact(points)


@pytest.mark.parametrize("triple", aimed.ALMOST_COLLINEAR + aimed.ALMOST_COLLINEAR_AND_TINY)
def test_orientation_is_exact_where_rounding_is_worst(triple):
    for points in permutations(aimed.read(triple)):
        assert_orientation_is_exact(points)


def test_orientation_of_nearly_equal_products_of_all_magnitudes():
    """n * n - (n - 1) * (n + 1) = 1, of products of 106 bits that round to the same double.

    Differences are exact; down to the scale at which the last bits of the products are below the
    least double, and up to that at which the products overflow.
    """
    n = 2.0**53 - 3
    for exponent in range(-1074, 970):
        a, b = np.ldexp([n, n - 1], exponent), np.ldexp([n + 1, n], exponent)
        assert orientation(*a, *b, 0.0, 0.0) == 1
        assert orientation(*b, *a, 0.0, 0.0) == -1
        assert orientation(*a, *-a, 0.0, 0.0) == 0


@settings(max_examples=500, deadline=None)
@given(points_of_any_kind(4))
def test_in_circle_is_exact_for_all_doubles(points):
    assert_in_circle_is_exact(points)


@settings(max_examples=500, deadline=None)
@given(aimed.near_cocircular())
def test_in_circle_is_exact_near_a_circle(points):
    assert_in_circle_is_exact(points)


@pytest.mark.parametrize(
    "four",
    aimed.ALMOST_COCIRCULAR
    + aimed.ALMOST_COCIRCULAR_AND_FLAT
    + aimed.ALMOST_COCIRCULAR_AND_TINY
    + aimed.TINY_BESIDE_LARGE,
)
def test_in_circle_is_exact_where_rounding_is_worst(four):
    for points in permutations(aimed.read(four)):
        assert_in_circle_is_exact(points)


@pytest.mark.parametrize("k", [1, 3, 100, 5000, 2**16, 2**17, 2**18 + 1, 2**20, 2**25])
def test_in_circle_of_integers_off_the_circle_by_one(k):
    """(2 k**2)**2 + (2 k)**2 = (2 k**2 + 1)**2 - 1: no point is nearer to so large a circle."""
    r, x, y, o = 2.0 * k * k + 1, 2.0 * k * k, 2.0 * k, 0.0
    assert in_circle(r, o, o, r, -r, o, x, y) == 1
    assert in_circle(r, o, o, r, x, y, -r, o) == -1  # two points have changed places
    assert in_circle(x, y, o, r, -r, o, r, o) == -1
    assert in_circle(r, o, o, r, -r, o, o, -r) == 0


def test_in_circle_sees_the_last_bit():
    """Four corners of a rectangle are on a circle, until one moves by a last bit."""
    for corner in (1.0, 0.1, 1e-200, 1e150, 3.0):
        on = (0.0, 0.0, corner, 0.0, corner, corner / 3, 0.0, corner / 3)
        assert in_circle(*on) == 0
        assert in_circle(*on[:7], np.nextafter(corner / 3, np.inf)) == -1
        assert in_circle(*on[:7], np.nextafter(corner / 3, -np.inf)) == 1
