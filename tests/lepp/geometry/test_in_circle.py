"""In-circle where coordinates are small integers but for a last bit, and where one term is most."""

from fractions import Fraction

import numpy as np
import pytest

from lepp.geometry.predicates import in_circle, orientation

#: On one circle with (0, 0), which is the fourth point: differences are the coordinates.
CIRCLES = [
    (-2.0, 4.0, -5.0, 5.0, -8.0, 4.0),
    (2.0, 4.0, -6.0, 8.0, -8.0, 4.0),
    (6.0, -2.0, 8.0, 4.0, 2.0, 6.0),
]


def sign_of_circle(numbers):
    ax, ay, bx, by, cx, cy = map(Fraction, numbers)
    rows = [(x, y, x * x + y * y) for x, y in ((ax, ay), (bx, by), (cx, cy))]
    (a, b, c), (d, e, f), (g, h, i) = rows
    determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return (determinant > 0) - (determinant < 0)


@pytest.mark.parametrize("numbers", CIRCLES)
@pytest.mark.parametrize("scale", [1.0, -1.0, 3.0, 2.0**-40, -(2.0**60)])
def test_a_last_bit_is_not_lost(numbers, scale):
    numbers = [scale * x for x in numbers]
    assert sign_of_circle(numbers) == 0
    assert in_circle(*numbers, 0.0, 0.0) == 0
    for k in range(6):
        for end in (-np.inf, np.inf):
            moved = [*numbers]
            moved[k] = float(np.nextafter(moved[k], end))
            expected = sign_of_circle(moved)
            assert expected != 0
            assert in_circle(*moved, 0.0, 0.0) == expected
            assert in_circle(*moved[2:], *moved[:2], 0.0, 0.0) == expected  # b, c, a
            assert in_circle(*moved[2:4], *moved[:2], *moved[4:], 0.0, 0.0) == -expected


#: b and c almost in a line with (0, 0), the fourth point: rounding turns the sign, by 0.05 EPSILON
#: of a's term of the permanent, which is 0.997 of all of it.
IN_LINE = [
    float.fromhex(x)
    for x in (
        "0x1.29cbcc71bc7a0p-4", "0x1.e3ee95a706c10p-1", "0x1.861109701a800p-11",
        "0x1.3059e67933c00p-10", "0x1.6c71c9d7b0200p-10", "0x1.1cbc459e15e00p-9",
    )
]  # fmt: skip


@pytest.mark.parametrize("scale", [1.0, 2.0**-60, 2.0**60])
def test_each_term_of_the_permanent_counts(scale):
    a, b, c = (np.array(IN_LINE).reshape(3, 2) * scale).tolist()
    inside = sign_of_circle([*a, *b, *c])
    for first, second, third in ((a, b, c), (b, c, a), (c, a, b)):
        assert in_circle(*first, *second, *third, 0.0, 0.0) == inside
        assert in_circle(*second, *first, *third, 0.0, 0.0) == -inside


@pytest.mark.parametrize("exponent", range(-20, 21))
@pytest.mark.parametrize("long", [8192.0, 4097.0])
def test_small_integers_decide_at_any_scale(exponent, long):
    """Steps along a diagonal beside (0, 0): the determinant is 4, of terms of some 2**54."""
    line = np.array([(long, long - 1), (long + 1, long), (long - 1, long - 2)])
    inside = sign_of_circle(line.ravel())
    assert inside != 0
    for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        numbers = np.ldexp(line[[*order]], exponent)
        assert in_circle(*numbers.ravel(), 0.0, 0.0) == inside
        assert in_circle(*numbers[::-1].ravel(), 0.0, 0.0) == -inside


@pytest.mark.parametrize("scale", [1.0, -1.0, 2.0**-200, 2.0**300, 2.0**-600, 2.0**600])
def test_lines_through_small_integers(scale):
    line = np.array([(-3.0, -1.0), (3.0, 1.0), (9.0, 3.0)]) * scale
    assert orientation(*line.ravel()) == 0
    for k in range(3):
        for axis, side in ((0, -1), (1, 1)):
            for way in (-1, 1):
                moved = line.copy()
                moved[k, axis] = np.nextafter(moved[k, axis], way * np.inf)
                turned = way * side * (-1 if k == 1 else 1) * (1 if scale > 0 else -1)
                assert orientation(*moved.ravel()) == turned
