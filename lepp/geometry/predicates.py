"""Exact signs of geometric determinants.

Each predicate first evaluates its determinant in floating point and trusts the sign when it
exceeds a bound on the rounding error (J. R. Shewchuk, "Adaptive precision floating-point arithmetic
and fast robust geometric predicates", 1997, section 4.2). Where it does not, the determinant of the
coordinates as given is summed exactly in fixed point, over the whole range of doubles: neither
overflow nor underflow can falsify a sign.
"""

import math

import numpy as np

from lepp.geometry.fixed_point import accumulator_sign, add_product, new_accumulator
from lepp.jit import inlined, inner, kernel

EPSILON = 2.0**-53
ORIENTATION_BOUND = (3.0 + 16.0 * EPSILON) * EPSILON
# Products that underflow lose up to 2**-1075 each, which the relative bounds do not see.
UNDERFLOW = 2.0**-960
# Inside these magnitudes (or at zero) the error-free product below neither over- nor underflows:
# the last bits of the factors are at least 2**-537, and so that of their product is at least
# 2**-1074; the product is below 2**1022.
_PRODUCT_MIN = 2.0**-485
_PRODUCT_MAX = 2.0**511
_SPLITTER = 2.0**27 + 1.0


@kernel
def exact_orientation(ax, ay, bx, by, cx, cy):
    """Return the sign of `orientation` by fixed-point summation of its six products.

    Parameters
    ----------
    ax, ay, bx, by, cx, cy : float
        Coordinates of a, b and c, finite.

    Returns
    -------
    int
        As `orientation`, which is faster.
    """
    accumulator = new_accumulator()
    add_product(accumulator, 1, (ax, by, 1.0, 1.0))
    add_product(accumulator, -1, (ax, cy, 1.0, 1.0))
    add_product(accumulator, -1, (ay, bx, 1.0, 1.0))
    add_product(accumulator, 1, (ay, cx, 1.0, 1.0))
    add_product(accumulator, 1, (bx, cy, 1.0, 1.0))
    add_product(accumulator, -1, (by, cx, 1.0, 1.0))
    return accumulator_sign(accumulator)


@kernel
def _product_error(a, b, product):
    """Return ``a * b - product`` exactly (Dekker's two-product)."""
    big = _SPLITTER * a
    a_high = big - (big - a)
    a_low = a - a_high
    big = _SPLITTER * b
    b_high = big - (big - b)
    b_low = b - b_high
    return a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low)


@kernel
def difference_is_exact(a, b, difference):
    """Tell whether `difference` is a - b without rounding, at a magnitude safe for products.

    Parameters
    ----------
    a, b : float
        Finite.
    difference : float
        Their rounded difference.

    Returns
    -------
    bool
        True where nothing was rounded off, and the difference is 0 or between 2**-485 and 2**511 in
        magnitude.

    Notes
    -----
    What the rounding loses is Knuth's two-sum: Shewchuk (1997), theorem 7.
    """
    b_virtual = a - difference
    a_virtual = difference + b_virtual
    rounding = (a - a_virtual) + (b_virtual - b)
    magnitude = abs(difference)
    return rounding == 0.0 and (difference == 0.0 or _PRODUCT_MIN < magnitude < _PRODUCT_MAX)


@inner
def uncertain_orientation(ax, ay, bx, by, cx, cy):
    """Return the sign of `orientation` where the floating filter has failed.

    On lattices the differences are exact and two exact products settle it; fixed point does the
    rest.

    Parameters
    ----------
    ax, ay, bx, by, cx, cy : float
        Coordinates of a, b and c, finite.

    Returns
    -------
    int
        As `orientation`.
    """
    acx, acy, bcx, bcy = ax - cx, ay - cy, bx - cx, by - cy
    if (
        difference_is_exact(ax, cx, acx)
        and difference_is_exact(ay, cy, acy)
        and difference_is_exact(bx, cx, bcx)
        and difference_is_exact(by, cy, bcy)
    ):
        left, right = acx * bcy, acy * bcx
        if left == right:  # equal after rounding: the rounding errors decide
            left = _product_error(acx, bcy, left)
            right = _product_error(acy, bcx, right)
        return int(left > right) - int(left < right)  # rounding keeps the order of products
    return exact_orientation(ax, ay, bx, by, cx, cy)


@kernel
def turn_is_certain(left, right):
    """Tell whether the rounded products of a turn differ in the order of the exact ones.

    Parameters
    ----------
    left, right : float
        The two products of rounded differences of which the turn is the difference.

    Returns
    -------
    bool
        Whether they are farther apart than `ORIENTATION_BOUND` allows (Shewchuk's ccwerrboundA),
        and than underflow can lose.
    """
    return abs(left - right) > ORIENTATION_BOUND * (abs(left) + abs(right)) + UNDERFLOW


@kernel
def turn_error(width, height):
    """Bound the rounding error of all turns about a point.

    Parameters
    ----------
    width, height : float
        No point taken is farther from that point than this along x and y.

    Returns
    -------
    float
        Twice the bound of one product, `width` times `height`.
    """
    return 2.0 * ORIENTATION_BOUND * (width * height) + UNDERFLOW


@kernel
def orientation(ax, ay, bx, by, cx, cy):
    """Tell on which side of the line from a to b the point c lies.

    Parameters
    ----------
    ax, ay, bx, by, cx, cy : float
        Coordinates of a, b and c, finite.

    Returns
    -------
    int
        1 if a, b, c turn left (counter-clockwise), -1 if they turn right, 0 if they are collinear.
        Exact for all finite doubles.
    """
    left = (ax - cx) * (by - cy)
    right = (ay - cy) * (bx - cx)
    if turn_is_certain(left, right):
        return 1 if left > right else -1
    return uncertain_orientation(ax, ay, bx, by, cx, cy)


@inlined
def orient(points, a, b, c):
    """Return `orientation` of three points given by their indices.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
        Finite.
    a, b, c : int

    Returns
    -------
    int
        1, -1 or 0.
    """
    return orientation(
        points[a, 0], points[a, 1], points[b, 0], points[b, 1], points[c, 0], points[c, 1]
    )


@inlined
def same(points, a, b):
    """Tell whether two points, given by their indices, coincide.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
    a, b : int

    Returns
    -------
    bool
    """
    return points[a, 0] == points[b, 0] and points[a, 1] == points[b, 1]


@kernel
def orientations(points, triangles):
    """Return the `orientation` of each triangle.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
        Finite.
    triangles : (m, 3) int32 ndarray

    Returns
    -------
    (m,) int8 ndarray
        1, -1 or 0.
    """
    signs = np.empty(len(triangles), np.int8)
    for t in range(len(triangles)):
        signs[t] = orient(points, triangles[t, 0], triangles[t, 1], triangles[t, 2])
    return signs


# The first filter of the in-circle determinant takes its error relative to the square of s, the sum
# of the three squared distances. Let a, b, c be the points relative to p, and t one of the three
# terms, a square times a minor. To first order in EPSILON, the error is at most the sum of
# - 7 |t|: two each for a square and for what the rounded differences do to it, one each for the
#   minor's subtraction, the multiplication and the first addition (the last is relative to the
#   result);
# - the permanent, for the products in the minors: at most s**2 / 3;
# - |a| |b| |c| (|a - b| + |b - c| + |c - a|), for what the rounded differences do to the minors: at
#   most sqrt(s / 3)**3 * 3 sqrt(s) < 0.578 s**2.
# A sign can be wrong only where the terms cancel but for some EPSILON. Their absolute values then
# sum up to twice the largest, and |a|**2 |b| |c| is at most s**2 / 8: 7 * 2/8 + 1/3 + 0.578 < 2.67.
IN_CIRCLE_BOUND = 2.75 * EPSILON
_PERMANENT_BOUND = (10.0 + 96.0 * EPSILON) * EPSILON
# With integers up to this, the in-circle determinant (12 times the fourth power) fits 63 bits.
_SMALL_BITS = 14


@inner
def _add_minor(accumulator, sign, ax, ay, bx, by, cx, cy):
    """Add the determinant of rows (x, y, x * x + y * y) to a fixed-point number, exactly."""
    for x, y, x1, y1, x2, y2 in (
        (ax, ay, bx, by, cx, cy),
        (bx, by, cx, cy, ax, ay),
        (cx, cy, ax, ay, bx, by),
    ):
        add_product(accumulator, sign, (x, x, x1, y2))
        add_product(accumulator, sign, (y, y, x1, y2))
        add_product(accumulator, -sign, (x, x, x2, y1))
        add_product(accumulator, -sign, (y, y, x2, y1))


@kernel
def exact_in_circle(ax, ay, bx, by, cx, cy, px, py):
    """Return the sign of `in_circle` by fixed-point summation of its 48 products.

    Parameters
    ----------
    ax, ay, bx, by, cx, cy, px, py : float
        Coordinates of a, b, c and p, finite.

    Returns
    -------
    int
        As `in_circle`, which is faster.
    """
    accumulator = new_accumulator()
    _add_minor(accumulator, 1, ax, ay, bx, by, cx, cy)
    _add_minor(accumulator, -1, ax, ay, bx, by, px, py)
    _add_minor(accumulator, 1, ax, ay, cx, cy, px, py)
    _add_minor(accumulator, -1, bx, by, cx, cy, px, py)
    return accumulator_sign(accumulator)


@inner
def _exact_in_circle_of_differences(ax, ay, bx, by, cx, cy):
    """Return the sign of `in_circle` from exact coordinates relative to p.

    On lattices these are small multiples of a power of two, and the determinant fits an integer;
    elsewhere 12 products are summed in fixed point.
    """
    largest = max(abs(ax), abs(ay), abs(bx), abs(by), abs(cx), abs(cy))
    scale = math.ldexp(1.0, _SMALL_BITS - math.frexp(largest)[1])
    ax_i, ay_i, bx_i = np.int64(ax * scale), np.int64(ay * scale), np.int64(bx * scale)
    by_i, cx_i, cy_i = np.int64(by * scale), np.int64(cx * scale), np.int64(cy * scale)
    if (
        ax_i == ax * scale
        and ay_i == ay * scale
        and bx_i == bx * scale
        and by_i == by * scale
        and cx_i == cx * scale
        and cy_i == cy * scale
    ):
        determinant = (
            (ax_i * ax_i + ay_i * ay_i) * (bx_i * cy_i - cx_i * by_i)
            + (bx_i * bx_i + by_i * by_i) * (cx_i * ay_i - ax_i * cy_i)
            + (cx_i * cx_i + cy_i * cy_i) * (ax_i * by_i - bx_i * ay_i)
        )
        return int(determinant > 0) - int(determinant < 0)
    accumulator = new_accumulator()
    _add_minor(accumulator, 1, ax, ay, bx, by, cx, cy)
    return accumulator_sign(accumulator)


@inner
def uncertain_in_circle(ax, ay, bx, by, cx, cy, px, py):
    """Return the sign of `in_circle` where its first floating filter has failed.

    The second filter is sharper for points that lie near a line.

    Parameters
    ----------
    ax, ay, bx, by, cx, cy, px, py : float
        Coordinates of a, b, c and p, finite.

    Returns
    -------
    int
        As `in_circle`.

    Notes
    -----
    The bound is Shewchuk's iccerrboundA: (10 + 96 EPSILON) EPSILON of the permanent.
    """
    adx, ady, bdx, bdy, cdx, cdy = ax - px, ay - py, bx - px, by - py, cx - px, cy - py
    a_square, b_square, c_square = (
        adx * adx + ady * ady,
        bdx * bdx + bdy * bdy,
        cdx * cdx + cdy * cdy,
    )
    bc, cb, ca, ac, ab, ba = bdx * cdy, cdx * bdy, cdx * ady, adx * cdy, adx * bdy, bdx * ady
    determinant = a_square * (bc - cb) + b_square * (ca - ac) + c_square * (ab - ba)
    permanent = (
        a_square * (abs(bc) + abs(cb))
        + b_square * (abs(ca) + abs(ac))
        + c_square * (abs(ab) + abs(ba))
    )
    # What a product loses to underflow may then be multiplied by a square, or by a product.
    lost = UNDERFLOW * (1.0 + a_square + b_square + c_square)
    if abs(determinant) > _PERMANENT_BOUND * permanent + lost:
        return 1 if determinant > 0.0 else -1
    if (
        difference_is_exact(ax, px, adx)
        and difference_is_exact(ay, py, ady)
        and difference_is_exact(bx, px, bdx)
        and difference_is_exact(by, py, bdy)
        and difference_is_exact(cx, px, cdx)
        and difference_is_exact(cy, py, cdy)
    ):
        return _exact_in_circle_of_differences(adx, ady, bdx, bdy, cdx, cdy)
    return exact_in_circle(ax, ay, bx, by, cx, cy, px, py)


@kernel
def in_circle(ax, ay, bx, by, cx, cy, px, py):
    """Tell whether the point p lies inside the circle through a, b, c (counter-clockwise).

    Parameters
    ----------
    ax, ay, bx, by, cx, cy, px, py : float
        Coordinates of a, b, c and p, finite.

    Returns
    -------
    int
        1 inside, -1 outside, 0 on the circle; the opposite if a, b, c turn clockwise. Exact for all
        finite doubles.
    """
    adx, ady, bdx, bdy, cdx, cdy = ax - px, ay - py, bx - px, by - py, cx - px, cy - py
    a_square, b_square, c_square = (
        adx * adx + ady * ady,
        bdx * bdx + bdy * bdy,
        cdx * cdx + cdy * cdy,
    )
    determinant = (
        a_square * (bdx * cdy - cdx * bdy)
        + b_square * (cdx * ady - adx * cdy)
        + c_square * (adx * bdy - bdx * ady)
    )
    size = a_square + b_square + c_square
    if abs(determinant) > IN_CIRCLE_BOUND * (size * size) + UNDERFLOW:
        return 1 if determinant > 0.0 else -1
    return uncertain_in_circle(ax, ay, bx, by, cx, cy, px, py)
