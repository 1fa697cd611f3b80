"""The order of points along a Hilbert curve: those that are near in it are near in the plane."""

import numpy as np

from lepp.jit import inlined, kernel

_BITS = 16  # of each coordinate; a key, the place along the curve, has twice as many
_CELLS = 2.0**_BITS - 2.0**-20  # so that the last point is in the last cell, not beyond
_DIGIT_BITS = 11
# Longer runs of points in one cell are ordered again, in the box of their own.
_LONGEST_RUN = 16
_ALL = np.uint32(0xFFFF)
_HALF_WORD = np.uint64(32)


@kernel
def hilbert_order(points):
    """Order points along a Hilbert curve.

    The curve runs through a square of 2**16 cells a side about the points. Where it leaves more
    than a few points in one cell (or in the same few, about a sixteenth as many as there are
    points), it goes through these once more, in a square of their own. So clusters and outliers of
    any scale are resolved.

    Parameters
    ----------
    points : (n, 2) float64 ndarray
        Finite.

    Returns
    -------
    (n,) uint32 ndarray
        Indices of the points; of equal points the first comes first.
    """
    n = len(points)
    n_bits = 2 * _DIGIT_BITS
    while n_bits < 2 * _BITS and (1 << n_bits) < 16 * n:
        n_bits += _DIGIT_BITS
    n_bits = min(n_bits, 2 * _BITS)
    keys = _keys(points)
    shift = np.uint32(2 * _BITS - n_bits)
    # A key in the upper half, an index in the lower.
    entries = np.empty(n, np.uint64)
    for i in range(n):
        entries[i] = (np.uint64(keys[i] >> shift) << _HALF_WORD) | np.uint64(i)
    entries = _radix_sorted(entries, n_bits)
    _order_runs(points, entries)
    order = np.empty(n, np.uint32)
    for i in range(n):
        order[i] = entries[i]
    return order


@kernel
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
        x = np.uint32(np.int32((unit * points[i, 0] - x_low) * cells))
        y = np.uint32(np.int32((unit * points[i, 1] - y_low) * cells))
        keys[i] = hilbert_key(x, y)
    return keys


@inlined
def hilbert_key(x, y):
    """Return the place of a cell along the Hilbert curve through 2**16 by 2**16 cells.

    All bits at once: what the curve does to the square at one level is a linear map over two bits,
    and the maps of all levels are composed by a parallel prefix scan (the method of "2D Hilbert
    curves in O(1)", rawrunprotected.wordpress.com, which is in the public domain).

    Parameters
    ----------
    x, y : uint32
        Column and row, below 2**16.

    Returns
    -------
    uint32
    """
    one = np.uint32(1)
    a = x ^ y
    b = _ALL ^ a
    c = _ALL ^ (x | y)
    d = x & (y ^ _ALL)
    map_a = a | (b >> one)
    map_b = (a >> one) ^ a
    map_c = ((c >> one) ^ (b & (d >> one))) ^ c
    map_d = ((a & (c >> one)) ^ (d >> one)) ^ d
    map_a, map_b, map_c, map_d = _compose(map_a, map_b, map_c, map_d, np.uint32(2))
    map_a, map_b, map_c, map_d = _compose(map_a, map_b, map_c, map_d, np.uint32(4))
    map_a, map_b, map_c, map_d = _compose(map_a, map_b, map_c, map_d, np.uint32(8))
    low = x ^ y
    high = (map_d ^ (map_d >> one)) | (_ALL ^ (low | (map_c ^ (map_c >> one))))
    return (_spread(high) << one) | _spread(low)


@inlined
def _compose(a, b, c, d, levels):
    """Compose the map at each bit with that of as many levels above."""
    return (
        (a & (a >> levels)) ^ (b & (b >> levels)),
        (a & (b >> levels)) ^ (b & ((a ^ b) >> levels)),
        c ^ ((a & (c >> levels)) ^ (b & (d >> levels))),
        d ^ ((b & (c >> levels)) ^ ((a ^ b) & (d >> levels))),
    )


@inlined
def _spread(bits):
    """Move bit k of 16 to bit 2 k."""
    bits = (bits | (bits << np.uint32(8))) & np.uint32(0x00FF00FF)
    bits = (bits | (bits << np.uint32(4))) & np.uint32(0x0F0F0F0F)
    bits = (bits | (bits << np.uint32(2))) & np.uint32(0x33333333)
    return (bits | (bits << np.uint32(1))) & np.uint32(0x55555555)


@kernel
def _radix_sorted(entries, n_bits):
    """Return the entries sorted, stably, by the lowest `n_bits` of their keys."""
    n_buckets = 1 << _DIGIT_BITS
    mask = np.uint64(n_buckets - 1)
    result = np.empty_like(entries)
    for first_bit in range(0, n_bits, _DIGIT_BITS):
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
    return entries


@kernel
def _order_runs(points, entries):
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
                run.sort()
                if run[0] >> _HALF_WORD != run[-1] >> _HALF_WORD:  # else all are one point
                    todo.append((first, last))
            first = last


@kernel
def _renew_keys(points, entries):
    """Give the entries new keys, in the box of their own points."""
    own = np.empty((len(entries), 2))
    for k in range(len(entries)):
        i = np.uint32(entries[k])
        own[k, 0], own[k, 1] = points[i, 0], points[i, 1]
    keys = _keys(own)
    for k in range(len(entries)):
        entries[k] = (np.uint64(keys[k]) << _HALF_WORD) | np.uint64(np.uint32(entries[k]))
