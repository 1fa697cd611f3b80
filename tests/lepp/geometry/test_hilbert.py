from fractions import Fraction
from itertools import groupby
from operator import itemgetter

import numpy as np
import pytest
from point_sets import reference_points

from lepp.geometry.hilbert import hilbert_key, hilbert_order, key_bits


def order_of(points):
    order = np.empty(len(points), np.uint32)
    hilbert_order(points, order, np.empty(2 * len(points), np.uint64))
    return order


def test_curve_goes_from_cell_to_neighbouring_cell():
    for shift in (0, 10):  # a corner of the square, cell by cell; and all of it, in blocks
        x, y = (np.arange(64 * 64) // 64) << shift, (np.arange(64 * 64) % 64) << shift
        keys = np.array([hilbert_key(*cell) for cell in zip(x.tolist(), y.tolist(), strict=True)])
        keys >>= 2 * shift
        assert sorted(keys) == list(range(64 * 64))
        order = np.argsort(keys)
        steps = np.abs(np.diff(x[order])) + np.abs(np.diff(y[order]))
        assert (steps == 1 << shift).all()


@pytest.mark.parametrize("scale", [2.0**-1000, 1.0, 2.0**1000])
@pytest.mark.parametrize(
    ("kind", "longest"),
    [
        ("uniform", 1.1 * 5000**0.5),
        ("thin", 2.0),  # there and back would be longer
        ("clusters", 110.0),  # 100 clusters at a distance of 1
    ],
)
def test_way_along_the_curve_is_short(kind, longest, scale):
    points = reference_points(kind, 5000, 1)
    order = order_of(points * scale)
    assert sorted(order) == list(range(len(points)))
    steps = np.hypot(*np.diff(points[order], axis=0).T)
    assert steps.sum() < longest
    if kind == "clusters":
        assert np.median(steps) < 1e-7 / 50**0.5  # points of a cluster, as many as these, apart


def test_equal_points_keep_their_order():
    points = np.tile(np.random.default_rng(1).random((3, 2)), (50, 1))
    order = order_of(points)
    for k in range(3):
        assert np.array_equal(order[order % 3 == k], np.arange(k, 150, 3))


def test_geometric_sequences_are_ordered():
    size = np.ldexp(1.0, np.arange(-1070, 1020))
    points = np.column_stack((size, size))
    order = order_of(np.random.default_rng(1).permutation(points))
    assert len(set(order)) == len(points)
    line = np.random.default_rng(1).permutation(points)[order][:, 0]
    assert (np.diff(line) > 0).mean() > 0.9


def place_along_curve(x, y):
    """The place of a cell by the curve's definition: quarter by quarter, each turned."""
    key = 0
    for level in range(15, -1, -1):
        right, up = (x >> level) & 1, (y >> level) & 1
        key = 4 * key + (3 * right ^ up)
        if not up:
            if right:  # mirrored in both
                x, y = ~x, ~y
            x, y = y, x
    return key


def test_place_of_any_cell_is_that_of_the_definition():
    cells = np.random.default_rng(1).integers(0, 2**16, (500, 2)).tolist()
    assert [hilbert_key(x, y) for x, y in cells] == [place_along_curve(x, y) for x, y in cells]


def naive_order(points, indices, n_bits):
    """The order by its definition, in rational arithmetic; (k,) indices."""
    exact = [tuple(map(Fraction, point)) for point in points[indices].tolist()]
    low = [min(axis) for axis in zip(*exact, strict=True)]
    extent = max(
        max(axis) - start for axis, start in zip(zip(*exact, strict=True), low, strict=True)
    )
    # As many cells, but for so little that the last point is in the last cell.
    cells = (2**16 - Fraction(1, 2**20)) / extent if extent else 0
    keys = [
        place_along_curve(*(int((x - start) * cells) for x, start in zip(point, low, strict=True)))
        >> (32 - n_bits)
        for point in exact
    ]
    order = []
    for _, run in groupby(sorted(zip(keys, indices, strict=True)), key=itemgetter(0)):
        run = [index for _, index in run]
        whole = len(run) == len(indices) and n_bits == 32
        order += naive_order(points, run, 32) if len(run) > 16 and not whole else run
    return order


def outlier(axis, place):
    """Points about (0.5, 0.5), and one far away."""
    points = np.random.default_rng(2).random((40, 2))
    points[7, axis] = place
    return points


ORDERED = {
    "uniform": reference_points("uniform", 200, 1),
    "offset": reference_points("offset", 200, 1),
    "thin": reference_points("thin", 200, 1),
    "clusters": np.repeat(np.arange(6.0), 40)[:, None] + 1e-7 * reference_points("uniform", 240, 2),
    "copies": reference_points("uniform", 20, 3)[np.arange(100) % 20 // np.arange(1, 101)],
    "runs of 16, 17 and 16": np.repeat([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0]], (16, 17, 16), axis=0)
    + 1e-6 * reference_points("uniform", 49, 4),
    "lattice": np.column_stack([axis.ravel() for axis in np.mgrid[0:14, 0:11]]).astype(float),
    "one": np.array([[0.1, 0.2]]),
    "largest": np.random.default_rng(3).permutation(
        np.finfo(float).max * reference_points("uniform", 60, 5) * [1, -1]
    ),
    "smallest": 5e-324 * np.floor(1000 * reference_points("uniform", 60, 6)),
    "nested": np.ldexp(reference_points("uniform", 200, 7), -5 * np.arange(200)[:, None]),
    **{
        f"far along {axis} at {place}": outlier(axis, place)
        for axis in (0, 1)
        for place in (-(2.0**1020), 2.0**1020, -3.0, 3.0)
    },
    "both ends": np.array([[-1.7e308, 0.0], [1.7e308, 0.0], [0.0, 1.7e308], [0.0, -1.7e308]]),
}


@pytest.mark.parametrize("name", ORDERED)
def test_order_is_that_of_the_definition(name):
    points = np.ascontiguousarray(ORDERED[name])
    assert order_of(points).tolist() == naive_order(points, list(range(len(points))), 22)


@pytest.mark.parametrize(
    ("n", "n_bits"),
    [(1, 22), (2**18, 22), (2**18 + 1, 32), (2**27, 32), (2**30, 32)],
)
def test_cells_are_about_sixteen_times_as_many_as_points(n, n_bits):
    assert key_bits(n) == n_bits
