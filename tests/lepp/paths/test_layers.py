"""Layers against steps counted one by one, and what is counted by layer."""

from collections import Counter

import naive
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from point_sets import nasty_points

import lepp
from lepp.paths.layers import layers_from_boundary


def writable_neighbors(mesh):
    return np.array(mesh.neighbors)


@settings(max_examples=80, deadline=None)
@given(nasty_points(max_size=30), st.sampled_from(list(lepp.METHODS)), st.integers(0, 6))
def test_layers_are_steps_from_the_boundary(points, method, last):
    try:
        mesh = lepp.triangulate(points, method)
    except lepp.InputError:
        return  # on one line
    layers = layers_from_boundary(writable_neighbors(mesh), last)
    assert layers.tolist() == naive.layers(mesh.triangles.tolist(), last)


def test_the_interior_is_the_last_layer_and_all_deeper():
    mesh = lepp.triangulate(np.random.default_rng(5).random((9000, 2)), "delaunay")
    layers = lepp.triangle_layers(mesh)
    assert layers.dtype == np.int8
    assert layers.tolist() == naive.layers(mesh.triangles.tolist(), lepp.INTERIOR_LAYER)
    deeper = layers_from_boundary(writable_neighbors(mesh), 120)
    assert deeper.max() > lepp.INTERIOR_LAYER == layers.max()


def test_a_closed_surface_is_all_interior():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.5]])
    triangles = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    mesh = lepp.Triangulation.from_arrays(points, triangles)
    assert lepp.triangle_layers(mesh).tolist() == [lepp.INTERIOR_LAYER] * 4


@pytest.mark.parametrize("seed", range(3))
def test_sizes_are_counted_by_layer(seed):
    rng = np.random.default_rng(seed)
    layers = rng.integers(0, 5, 200).astype(np.int8)
    sizes = rng.integers(1, 9, 200).astype(np.int32)
    counts = lepp.sizes_by_layer(layers, sizes)
    assert counts.shape == (layers.max() + 1, sizes.max() + 1)
    seen = Counter(zip(layers.tolist(), sizes.tolist(), strict=True))
    for place, count in np.ndenumerate(counts):
        assert count == seen[place]
