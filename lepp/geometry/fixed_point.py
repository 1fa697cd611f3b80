"""Sums of products of doubles in fixed point: exact over the whole range of doubles."""

import math

import numpy as np

from lepp.jit import inner

_LIMB_BITS = 32
_LIMB_MASK = 0xFFFFFFFF
# The exponent of the last bit of a double's 53-bit mantissa, as math.frexp gives it, is at least:
_LOWEST_EXPONENT = -1073 - 53


@inner
def add_product(accumulator, weight, factors):
    """Add ``weight * prod(factors)`` to a fixed-point number, exactly.

    Parameters
    ----------
    accumulator : (k,) int64 ndarray
        Limbs of 32 bits, lowest first, carries not propagated; from `new_accumulator`.
    weight : int
        Small: a few times as many products as it says can be added.
    factors : (float, float, float, float)
        Fewer are filled up with 1.
    """
    limbs = np.zeros(9, np.uint64)
    limbs[0] = 1
    n_limbs = 1
    exponent = 0
    for factor in factors:
        if factor == 0.0:
            return
        if factor == 1.0:
            exponent -= _LOWEST_EXPONENT
            continue
        mantissa, factor_exponent = math.frexp(factor)
        if mantissa < 0.0:
            mantissa = -mantissa
            weight = -weight
        bits = np.uint64(mantissa * 9007199254740992.0)  # 2**53
        exponent += factor_exponent - 53 - _LOWEST_EXPONENT
        low = bits & np.uint64(_LIMB_MASK)
        high = bits >> np.uint64(_LIMB_BITS)
        carry = np.uint64(0)
        previous = np.uint64(0)
        for i in range(n_limbs + 2):
            limb = limbs[i] if i < n_limbs else np.uint64(0)
            product = limb * low + carry  # below 2**64: (2**32 - 1)**2 + 2**33
            cross = previous * high  # below 2**53
            total = (product & np.uint64(_LIMB_MASK)) + (cross & np.uint64(_LIMB_MASK))
            carry = (
                (product >> np.uint64(_LIMB_BITS))
                + (cross >> np.uint64(_LIMB_BITS))
                + (total >> np.uint64(_LIMB_BITS))
            )
            limbs[i] = total & np.uint64(_LIMB_MASK)
            previous = limb
        n_limbs += 2
    first = exponent // _LIMB_BITS
    shift = np.uint64(exponent % _LIMB_BITS)
    for i in range(n_limbs):
        shifted = limbs[i] << shift
        accumulator[first + i] += weight * np.int64(shifted & np.uint64(_LIMB_MASK))
        accumulator[first + i + 1] += weight * np.int64(shifted >> np.uint64(_LIMB_BITS))


@inner
def new_accumulator():
    """Return a fixed-point zero wide enough for products of four doubles.

    Returns
    -------
    (k,) int64 ndarray
        Limbs of 32 bits, lowest first, of 2,200 bits a factor: the range of doubles, from the last
        bit of the least to the first bit of the largest, has 2,098.
    """
    return np.zeros(4 * (2200 // _LIMB_BITS + 1) + 4, np.int64)


@inner
def accumulator_sign(accumulator):
    """Return the sign of a fixed-point number.

    Parameters
    ----------
    accumulator : (k,) int64 ndarray
        From `new_accumulator`, after any number of `add_product`.

    Returns
    -------
    int
        -1, 0 or 1.
    """
    carry = np.int64(0)
    nonzero = False
    for i in range(len(accumulator)):
        limb = accumulator[i] + carry
        carry = limb >> _LIMB_BITS
        if limb & _LIMB_MASK:
            nonzero = True
    if carry < 0:
        return -1
    return 1 if nonzero or carry > 0 else 0
