"""Values by rank against sorting them all."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from study.run.ranks import Bins

VALUES = arrays(
    np.float64,
    st.integers(1, 300),
    elements=st.floats(-4, 4).filter(lambda x: x == 0 or abs(x) > 1e-150)
    | st.sampled_from([0.0, -0.0, 0.5, np.nextafter(0.5, 0)])
    | st.floats(1e-150, 1e150)
    | st.floats(-1e150, -1e-150),
)


@settings(deadline=None)
@given(VALUES, st.randoms(use_true_random=False))
def test_values_taken_have_their_ranks(values, random):
    bins = Bins.of(values)
    ordered = np.sort(values)
    wanted = np.array([random.random() < 0.4 for _ in bins.ends])
    taken, ranks = bins.take(wanted)
    assert taken.tolist() == ordered[ranks].tolist()
    everything, all_ranks = bins.take(np.ones(len(bins.ends), bool))
    assert everything.tolist() == ordered.tolist()
    assert all_ranks.tolist() == list(range(len(values)))


@settings(deadline=None)
@given(VALUES)
def test_bins_lie_between_their_edges(values):
    bins = Bins.of(values)
    numbers = np.arange(len(bins.ends))
    edges = bins.edges(np.append(numbers, len(numbers)))
    below = bins.below(np.append(numbers, len(numbers)))
    for k, edge in enumerate(edges):
        assert (values < edge).sum() == below[k]
    assert np.diff(edges).min() > 0
    ranks = np.arange(len(values))
    ordered = np.sort(values)
    for rank, k in zip(ranks, bins.holding(ranks), strict=True):
        assert edges[k] <= ordered[rank] < edges[k + 1]


@pytest.mark.parametrize("offset", [0.0, 1e6, -1e9])
@pytest.mark.parametrize("n", [1000, 50_000])
def test_few_values_share_a_bin(n, offset):
    values = np.random.default_rng(1).random(n) + offset
    counts = np.diff(Bins.of(values).ends, prepend=0)
    assert counts.mean() < 10
    assert len(counts) <= n / 2
