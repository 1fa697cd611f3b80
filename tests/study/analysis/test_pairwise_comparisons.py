"""Every pair of groups is in the table."""

import pytest


def test_every_pair_is_in_the_table(study):
    frame = study[2]["pairs"].frame
    sizes = study[0].sizes
    assert len(frame) == 4 * len(sizes) * (len(sizes) - 1) // 2
    assert (frame["n_points_1"] < frame["n_points_2"]).all()
    excludes_zero = (frame["low"] > 0) | (frame["high"] < 0)
    assert (excludes_zero == (frame["different"] == "yes")).all()
    means = study[2]["groups"].frame.set_index(["method", "distribution", "n_points"])["mean_lepp"]
    for row in frame.itertuples():
        gap = means[row.method, row.distribution, row.n_points_2]
        gap -= means[row.method, row.distribution, row.n_points_1]
        assert row.difference == pytest.approx(gap)
