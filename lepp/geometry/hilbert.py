"""The order of points along a Hilbert curve: those that are near in it are near in the plane."""

import numpy as np

from lepp.jit import inner, kernel

_BITS = 16  # of each coordinate; a key, the place along the curve, has twice as many
_CELLS = 2.0**_BITS - 2.0**-20  # so that the last point is in the last cell, not beyond
_DIGIT_BITS = 11
_RUN_DIGIT_BITS = 8  # of a run: 32 bits in an even number of digits
# Longer runs of points in one cell are ordered again, in a box about them.
_LONGEST_RUN = 16
_HALF_WORD = np.uint64(32)


def _hilbert_steps() -> np.ndarray:
    """Return four levels of the curve at once, as (4 * 16 * 16,) uint16.

    Indexed by ``256 * state + 16 * x + y``, with 4 bits of x and y; holds 8 bits of the key and,
    times 256, the state after them. Bit 0 of a state says that x and y change places, bit 1 that
    both are mirrored; so the curve turns from one quarter of a square to the next.
    """
    steps = np.empty((4, 16, 16), np.uint16)
    for first_state, x, y in np.ndindex(4, 16, 16):
        state, key = first_state, 0
        for level in (3, 2, 1, 0):
            right, up = (x >> level) & 1, (y >> level) & 1
            if state & 1:
                right, up = up, right
            if state & 2:
                right, up = 1 - right, 1 - up
            key = 4 * key + ((3 * right) ^ up)
            if not up:
                state ^= 3 if right else 1
        steps[first_state, x, y] = 256 * state + key
    return steps.ravel()


_STEPS = _hilbert_steps()


@kernel
def hilbert_order(points, order, scratch):
    """Order points along a Hilbert curve.

    The curve runs through a square of 2**16 cells a side about the points. Where it leaves more
    than a few points in one cell (or in the same few, about a sixteenth as many as there are
    points), it goes through these once more, in a square about these. So clusters and outliers of
    any scale are resolved.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
        Finite.
    order : (n,) uint32 ndarray, output
        Indices of the points; of equal points the first comes first.
    scratch : (2 n,) uint64 ndarray
        Overwritten.
    """
    n = len(points)
    n_bits = key_bits(n)
    keys = _keys(points)
    shift = np.uint32(2 * _BITS - n_bits)
    # A key in the upper half, an index in the lower.
    entries = scratch[:n]
    for i in range(n):
        entries[i] = (np.uint64(keys[i] >> shift) << _HALF_WORD) | np.uint64(i)
    entries, free = _radix_sorted(entries, scratch[n:], n_bits, _DIGIT_BITS)
    _order_runs(points, entries, free)
    for i in range(n):
        order[i] = entries[i]


@kernel
def key_bits(n):
    """Return the number of bits of the first keys of n points: whole digits, or all 32.

    Two digits, or as many as give the curve 16 times as many places as there are points.
    """
    n_bits = 2 * _DIGIT_BITS
    while n_bits < 2 * _BITS and (1 << n_bits) < 16 * n:
        n_bits += _DIGIT_BITS
    return min(n_bits, 2 * _BITS)


@inner
def _keys(points):
    """Return the place of each point along the curve through a square about them."""
    x_low = x_high = points[0, 0]
    y_low = y_high = points[0, 1]
    for i in range(len(points)):  # branches that are hardly ever taken, and so cost nothing
        x, y = points[i, 0], points[i, 1]
        if x < x_low:
            x_low = x
        if x > x_high:
            x_high = x
        if y < y_low:
            y_low = y
        if y > y_high:
            y_high = y
    # The extent must not overflow, nor the number of cells in it.
    unit = 0.25 if max(-x_low, x_high, -y_low, y_high) > 1.0 else 2.0**500
    x_low, y_low = unit * x_low, unit * y_low
    extent = max(unit * x_high - x_low, unit * y_high - y_low)
    cells = _CELLS / extent if extent > 0.0 else 0.0
    keys = np.empty(len(points), np.uint32)
    for i in range(len(points)):
        x = np.int32((unit * points[i, 0] - x_low) * cells)
        y = np.int32((unit * points[i, 1] - y_low) * cells)
        keys[i] = hilbert_key(x, y)
    return keys


@kernel
def hilbert_key(x, y):
    """Return the place of a cell along the Hilbert curve through 2**16 by 2**16 cells.

    Parameters
    ----------
    x, y : int
        Column and row, below 2**16.

    Returns
    -------
    int
        From 0 to 2**32 - 1; cells that follow each other have a side in common.
    """
    step = np.int64(_STEPS[((x >> 12) << 4) | (y >> 12)])
    key = step & 0xFF
    step = np.int64(_STEPS[(step & 0x300) | (((x >> 8) & 15) << 4) | ((y >> 8) & 15)])
    key = (key << 8) | (step & 0xFF)
    step = np.int64(_STEPS[(step & 0x300) | (((x >> 4) & 15) << 4) | ((y >> 4) & 15)])
    key = (key << 8) | (step & 0xFF)
    step = np.int64(_STEPS[(step & 0x300) | ((x & 15) << 4) | (y & 15)])
    return (key << 8) | (step & 0xFF)


@inner
def _radix_sorted(entries, result, n_bits, digit_bits):
    """Return two arrays, the first with the entries in the order of `n_bits` of key, stably.

    The entries are where they were if the number of digits is even.
    """
    n_buckets = 1 << digit_bits
    mask = np.uint64(n_buckets - 1)
    for first_bit in range(0, n_bits, digit_bits):
        shift = np.uint64(first_bit) + _HALF_WORD
        end = np.zeros(n_buckets, np.uint32)
        for entry in entries:
            end[(entry >> shift) & mask] += np.uint32(1)
        total = np.uint32(0)
        for bucket in range(n_buckets):
            count = end[bucket]
            end[bucket] = total
            total += count
        for entry in entries:
            bucket = (entry >> shift) & mask
            place = end[bucket]
            result[place] = entry
            end[bucket] = place + np.uint32(1)
        entries, result = result, entries
    return entries, result


@inner
def _order_runs(points, entries, free):
    """Order long runs of one key by keys in the box of the run, until none is left."""
    todo = [(0, len(entries))]
    while len(todo) > 0:
        begin, end = todo.pop()
        first = begin
        while first < end:
            key = entries[first] >> _HALF_WORD
            last = first + 1
            while last < end and entries[last] >> _HALF_WORD == key:
                last += 1
            if last - first > _LONGEST_RUN:
                run = entries[first:last]
                _renew_keys(points, run)
                _radix_sorted(run, free[first:last], 2 * _BITS, _RUN_DIGIT_BITS)
                if run[0] >> _HALF_WORD != run[-1] >> _HALF_WORD:  # else all are one point
                    todo.append((first, last))
            first = last


@inner
def _renew_keys(points, entries):
    """Give the entries new keys, in the box of their points."""
    places = np.empty((len(entries), 2))
    for k in range(len(entries)):
        i = np.uint32(entries[k])
        places[k, 0], places[k, 1] = points[i, 0], points[i, 1]
    keys = _keys(places)
    for k in range(len(entries)):
        entries[k] = (np.uint64(keys[k]) << _HALF_WORD) | np.uint64(np.uint32(entries[k]))
