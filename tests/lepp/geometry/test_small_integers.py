"""The in-circle predicate where coordinates are small integers but for the last bit of one."""

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
