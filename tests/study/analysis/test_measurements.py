"""What is measured of a part of the meshes, against counting row by row."""

import numpy as np
from frames import design, frames

from lepp import INTERIOR_LAYER
from study.analysis.measurements import Measurements
from study.analysis.parts import INTERIOR, WHOLE

ASKED = design(repetitions=(2, 3, 1, 2))


def test_the_interior_is_the_last_layer_and_the_whole_is_all():
    made = frames(ASKED)
    data = Measurements.of(*made, ASKED)
    _, histograms, _, layers, _ = made
    for distribution in ASKED.distributions:
        whole = data.groups("incremental", distribution)
        inner = data.groups("incremental", distribution, INTERIOR)
        assert whole.n_points.tolist() == inner.n_points.tolist() == list(ASKED.sizes)
        assert whole.counts.tolist() == inner.counts.tolist() == [2, 3, 1, 2]
        for size, values in zip(inner.n_points, inner.values, strict=True):
            for replicate, value in enumerate(values):
                total = count = 0
                for row in layers.itertuples():
                    if (row.distribution, row.n_points, row.replicate) == (
                        distribution, size, replicate,
                    ) and row.layer == INTERIOR_LAYER:  # fmt: skip
                        total += row.lepp_size * row.count
                        count += row.count
                assert value == total / count
        picked = data.by_layer("incremental", distribution)
        counted = picked.groupby(["n_points", "replicate", "lepp_size"])["count"].sum()
        seen = data.histogram("incremental", distribution, WHOLE)
        assert counted.tolist() == seen["count"].tolist()
        assert len(seen) == (histograms["distribution"] == distribution).sum()


def test_populations_are_methods_with_distributions():
    asked = design(methods=("incremental", "delaunay"))
    assert list(Measurements.of(*frames(asked), asked).populations) == [
        (method, distribution) for method in asked.methods for distribution in asked.distributions
    ]


def test_a_mesh_without_an_interior_is_in_no_group_of_it():
    results, histograms, regions, layers, sets = frames(ASKED)
    small = layers["n_points"] == ASKED.sizes[0]
    layers = layers[~(small & (layers["layer"] == INTERIOR_LAYER))]
    data = Measurements.of(results, histograms, regions, layers, sets, ASKED)
    assert data.groups("incremental", "uniform", INTERIOR).n_points[0] == ASKED.sizes[1]
    assert data.groups("incremental", "uniform").n_points[0] == ASKED.sizes[0]


def test_nothing_measured_has_no_groups():
    data = Measurements.of(*(frame.iloc[:0] for frame in frames(ASKED)), ASKED)
    for part in (WHOLE, INTERIOR):
        assert len(data.groups("incremental", "uniform", part)) == 0
        assert np.array_equal(
            data.histogram("incremental", "uniform", part).columns,
            ["n_points", "replicate", "lepp_size", "count"],
        )
