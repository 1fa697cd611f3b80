"""Bounds and questions that the kernels ask by themselves, held to their definitions."""

from fractions import Fraction

import numpy as np
import pytest

from lepp.geometry.predicates import (
    EPSILON,
    UNDERFLOW,
    _product_error,
    difference_is_exact,
    orient,
    orientations,
    same,
    turn_error,
    turn_is_certain,
)

TWO = Fraction(2)


@pytest.mark.parametrize("width", [2.0**-30, 0.7, 1.0, 3.0, 2.0**40])
@pytest.mark.parametrize("height", [2.0**-50, 0.3, 1.0, 5.0, 2.0**60])
def test_error_of_turns_is_that_of_two_products(width, height):
    error = Fraction(turn_error(width, height))
    least = 6 * TWO**-53 * Fraction(width) * Fraction(height)
    assert least < error < least * (1 + TWO**-40) + Fraction(UNDERFLOW)


@pytest.mark.parametrize(("width", "height"), [(0.0, 0.0), (0.0, 3.0), (2.0**-600, 2.0**-600)])
def test_error_of_turns_covers_what_underflow_loses(width, height):
    assert turn_error(width, height) == UNDERFLOW


@pytest.mark.parametrize("scale", [2.0**-500, 2.0**-20, 1.0, 2.0**20, 2.0**500])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_turn_is_certain_beyond_three_roundings_of_the_sum(scale, sign):
    def is_certain(roundings):
        left, right = scale, scale * (1.0 - 2.0 * roundings * EPSILON)
        results = {turn_is_certain(sign * left, sign * right),
                   turn_is_certain(sign * right, sign * left)}  # fmt: skip
        assert len(results) == 1
        return results.pop()

    assert not is_certain(0.0)
    assert not is_certain(3.0)
    assert is_certain(4.0)
    assert turn_is_certain(sign * scale, -sign * scale)


def test_turn_is_uncertain_where_products_may_have_underflowed():
    assert not turn_is_certain(UNDERFLOW, 0.0)
    assert not turn_is_certain(0.0, -UNDERFLOW)
    assert turn_is_certain(2.0 * UNDERFLOW, 0.0)


@pytest.mark.parametrize(
    ("a", "b", "is_exact"),
    [
        (3.0, 1.0, True),
        (-3.0, 1.0, True),
        (1.0, 1.0, True),
        (0.0, 0.0, True),
        (1.0, 2.0**-53, True),  # 1 - 2**-53 is a double
        (1.0, 2.0**-54, False),
        (2.0**-54, 1.0, False),
        (-1.0, 2.0**-53, False),  # 1 + 2**-53 is none
        (2.0**53, -1.0, False),
        (0.1, 0.3, True),
        (0.1, -0.3, False),
        (2.0**-485, 0.0, False),  # too small for products
        (2.0**-484, 0.0, True),
        (-(2.0**-485), 0.0, False),
        (-(2.0**-484), 0.0, True),
        (2.0**511, 0.0, False),  # too large
        (2.0**511 - 2.0**458, 0.0, True),
        (-(2.0**511), 0.0, False),
        (5e-324, 5e-324, True),
    ],
)
def test_difference_is_exact(a, b, is_exact):
    assert bool(difference_is_exact(a, b, a - b)) == is_exact
    assert bool(difference_is_exact(b, a, b - a)) == is_exact
    if is_exact:
        assert Fraction(a) - Fraction(b) == Fraction(a - b)


@pytest.mark.parametrize("exponent", [-484, 0, 256, 510])
def test_error_of_a_product_is_exact(exponent):
    """Last bits of factors that are odd, and of which no half is short."""
    numbers = np.random.default_rng(1).integers(2**52, 2**53, (500, 2)) | 1
    for a, b in np.ldexp(numbers.astype(float), exponent - 53).tolist():
        for x, y in ((a, b), (-b, a)):
            assert Fraction(_product_error(x, y, x * y)) == Fraction(x) * Fraction(y) - Fraction(
                x * y
            )


def test_points_are_the_same_in_both_coordinates():
    points = np.array([[1.0, 2.0], [1.0, 3.0], [0.0, 2.0], [1.0, 2.0]])
    assert [bool(same(points, 0, k)) for k in range(4)] == [True, False, False, True]


def test_orientations_are_those_of_each_triangle():
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [2.0, 0.0]])
    triangles = np.array([[0, 1, 2], [0, 2, 1], [0, 1, 3], [2, 0, 1]], np.int32)
    signs = orientations(points, triangles)
    assert signs.dtype == np.int8
    assert signs.tolist() == [1, -1, 0, 1]
    assert [orient(points, *triangle) for triangle in triangles] == signs.tolist()
