import functools
import operator
import pickle
from dataclasses import astuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from study.design.sampling import BLOCK, DISTRIBUTIONS, marginal_cdf, sample_block, sample_points
from study.run import checks_of_blocks
from study.run.checks_of_blocks import extract, histogram, plan_checks
from study.run.point_checks import check_randomness

BELOW_HALF = np.nextafter(0.5, 0)


def divided(points, size):
    """Indices of the first points of blocks of a size, and the blocks."""
    firsts = range(0, len(points), size)
    return [(first, points[first : first + size]) for first in firsts]


def checks_in_two_passes(blocks, distribution, seed=0):
    """The checks with every message pickled and every arrival shuffled."""
    generator = np.random.default_rng(seed)
    n_points = sum(len(points) for _, points in blocks)

    def received(messages):
        arrived = [pickle.loads(pickle.dumps(message)) for message in messages]
        return [arrived[i] for i in generator.permutation(len(arrived))]

    histograms = received(histogram(points, distribution, n_points) for _, points in blocks)
    (plan,) = received([plan_checks(functools.reduce(operator.add, histograms))])
    extracts = received(extract(points, first, plan) for first, points in blocks)
    return checks_of_blocks.checks_of_blocks(plan, iter(extracts))


def assert_same_bits(checks, expected):
    assert np.array(astuple(checks)).tobytes() == np.array(astuple(expected)).tobytes(), (
        checks,
        expected,
    )


@pytest.mark.parametrize("n_points", [1, 2, 3, 4, 5, 6, 64, 65, 127, 999, 1000, 1001])
@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_checks_of_small_sets_are_those_of_the_whole_array(distribution, n_points):
    for seed in range(3):
        points = sample_points(distribution, n_points, 0, seed=seed)
        expected = check_randomness(points, distribution)
        smallest = -(-n_points // 30)
        for size in {smallest, smallest + 1, max(n_points - 1, 1), n_points, n_points + 1}:
            checks = checks_in_two_passes(divided(points, size), distribution, seed)
            assert_same_bits(checks, expected)


@pytest.mark.parametrize("n_points", [100_000, 100_001])
@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_checks_of_larger_sets_are_those_of_the_whole_array(distribution, n_points):
    for seed in range(5):
        points = sample_points(distribution, n_points, 0, seed=seed)
        checks = checks_in_two_passes(divided(points, 12_345), distribution, seed)
        assert_same_bits(checks, check_randomness(points, distribution))


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_blocks_as_they_are_drawn_have_the_checks_of_the_whole_set(distribution):
    n_points = BLOCK + 1
    blocks = [
        (block * BLOCK, sample_block(distribution, n_points, 0, block, seed=3))
        for block in range(2)
    ]
    expected = check_randomness(sample_points(distribution, n_points, 0, seed=3), distribution)
    assert_same_bits(checks_in_two_passes(blocks, distribution), expected)


def made(name, n, generator):
    uniform = generator.random((n, 2))
    return {
        "sorted": np.sort(uniform, axis=0),
        "alternating": np.tile([[0.1, 0.9], [0.9, 0.1]], (n, 1))[:n],
        "all equal": np.full((n, 2), 0.3),
        "ties at the median": np.where(uniform < 0.4, uniform, np.maximum(uniform, 0.6) - 0.2),
        "few different values": np.floor(uniform * 5) / 4,
        "median of neighbouring floats": np.where(uniform < 0.5, BELOW_HALF, 0.5),
        "two far values": np.where(uniform < 0.5, -3.0, 0.7),
        "one bin": 0.5 + 1e-9 * uniform,
        "one bin and ties": 0.5 + 1e-9 * np.floor(uniform * 9),
        "outside of the support": 6 * uniform - 3,
        "at the ends of the support": np.floor(3 * uniform) / 2,
        "far below": uniform - 1e6,
        "far above": 40 + uniform,
        "huge": np.where(uniform < 0.3, -1e300, 1e300) * uniform,
        "tiny": np.where(uniform < 0.5, -1e-300, 1e-300) * uniform,
        "signed zeros": np.where(uniform < 0.4, -0.0, np.where(uniform < 0.8, 0.0, uniform)),
        "heavy tails": np.tan(3.1 * (uniform - 0.5)),
        "long runs": np.repeat(uniform, 40, axis=0)[:n],
    }[name]


MADE = [
    "sorted", "alternating", "all equal", "ties at the median", "few different values",
    "median of neighbouring floats", "two far values", "one bin", "one bin and ties",
    "outside of the support", "at the ends of the support", "far below", "far above", "huge",
    "tiny", "signed zeros", "heavy tails", "long runs",
]  # fmt: skip


@pytest.mark.parametrize("name", MADE)
@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_checks_of_made_points_are_those_of_the_whole_array(distribution, name):
    generator = np.random.default_rng(4)
    for n_points, size in ((2, 1), (9, 2), (50, 1), (201, 13), (5000, 700), (5001, 700)):
        points = made(name, n_points, generator)
        checks = checks_in_two_passes(divided(points, size), distribution)
        assert_same_bits(checks, check_randomness(points, distribution))


COORDINATES = (
    st.sampled_from([0.0, -0.0, 0.25, BELOW_HALF, 0.5, 1.0, -1.0, 2.0, 40.0])
    | st.floats(0, 1)
    | st.floats(-1e300, 1e300)
)


@settings(deadline=None, max_examples=150)
@given(
    st.lists(
        st.lists(st.tuples(COORDINATES, COORDINATES), max_size=9), min_size=1, max_size=7
    ).filter(any),
    st.sampled_from(DISTRIBUTIONS),
)
def test_any_division_has_the_checks_of_the_whole_array(parts, distribution):
    parts = [np.array(part, float).reshape(-1, 2) for part in parts]
    firsts = np.cumsum([0] + [len(part) for part in parts[:-1]]).tolist()
    checks = checks_in_two_passes(list(zip(firsts, parts, strict=True)), distribution)
    assert_same_bits(checks, check_randomness(np.concatenate(parts), distribution))


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_histograms_add_up_in_any_order(distribution):
    points = sample_points(distribution, 30_000, 0, seed=5)
    points[:20_000] = 0.5  # so that the type of the counts must widen, twice
    points[20_000:20_200] = 0.9
    a, b, c = (histogram(points[i::3], distribution, 30_000) for i in range(3))
    whole = histogram(points, distribution, 30_000)
    for total in (a + b + c, c + b + a, b + (c + a), (a + c) + b):
        np.testing.assert_array_equal(total.counts, whole.counts, strict=True)
    few = histogram(points[20_000:20_200], distribution, 30_000)
    assert few.counts.dtype == np.uint8
    assert (few + few).counts.dtype == np.uint16
    assert (few + few).counts.max() == 400


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_second_pass_takes_few_values(distribution):
    n_points = 1 << 20
    for seed in range(3):
        points = sample_points(distribution, n_points, 0, seed=seed)
        plan = plan_checks(histogram(points, distribution, n_points))
        taken = extract(points, 0, plan)
        for axis in (taken.x, taken.y):
            assert len(axis.in_distance_bins) < 0.02 * n_points
            assert len(axis.kept) < 0.001 * n_points
        assert len(pickle.dumps(plan)) < 100_000


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
def test_bins_are_of_like_probability(distribution):
    n_bins = 1 << 12
    at_lower, at_upper = checks_of_blocks._cdf_at_edges(distribution, n_bins)
    assert (at_upper - at_lower).max() * n_bins < 2


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
@pytest.mark.parametrize("n_bins", [32, 1 << 15, 1 << 20])
def test_bins_keep_the_order_and_bound_the_distribution_function(distribution, n_bins):
    edges = np.arange(1, n_bins, max(n_bins // 500, 1)) / n_bins
    near = checks_of_blocks._unscaled(edges, distribution)
    spread = np.random.default_rng(6).standard_cauchy(20_000)
    far = [-np.inf, -1e300, -1.0, -1e-300, -0.0, 0.0, 1e-300, 1.0, 1e300, np.inf]
    values = [spread, near, far]
    for towards in (-np.inf, np.inf):
        step = near
        for _ in range(5):
            step = np.nextafter(step, towards)
            values.append(step)
    values = np.sort(np.concatenate(values))
    bins = checks_of_blocks._bins(values, distribution, n_bins)
    assert bins[0] == 0
    assert bins[-1] == n_bins
    assert (np.diff(bins) >= 0).all()
    at_lower, at_upper = checks_of_blocks._cdf_at_edges(distribution, n_bins)
    at_values = marginal_cdf(distribution)(values)
    assert (at_lower[bins] <= at_values).all()
    assert (at_values <= at_upper[bins]).all()


def test_passes_that_do_not_fit_each_other_are_refused():
    points = sample_points("normal", 100, 0, seed=7)
    blocks = divided(points, 40)
    first, *others = (histogram(block, "normal", 100) for _, block in blocks)
    total = sum(others, first)
    with pytest.raises(ValueError, match="60 points of 100"):
        plan_checks(first + others[1])
    with pytest.raises(ValueError, match="140 points of 100"):
        plan_checks(total + first)
    for other in (histogram(points, "uniform", 100), histogram(points, "normal", 101)):
        with pytest.raises(ValueError, match="different point sets"):
            total + other
    plan = plan_checks(total)
    taken = [extract(block, start, plan) for start, block in blocks]
    for wrong, message in (
        (taken[:2], "80 points of 100"),
        (taken[1:], "begins at point 40, those before it end at point 0"),
        ([taken[0], taken[2]], "begins at point 80, those before it end at point 40"),
        (taken + taken[:1], "begins at point 0, those before it end at point 40"),
        ([extract(block + 1, start, plan) for start, block in blocks], "not those of the first"),
    ):
        with pytest.raises(ValueError, match=message):
            checks_of_blocks.checks_of_blocks(plan, wrong)
