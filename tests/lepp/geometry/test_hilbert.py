import numpy as np
import pytest
from point_sets import reference_points

from lepp.geometry.hilbert import hilbert_key, hilbert_order


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
