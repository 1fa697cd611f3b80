"""Theorem 1's formulas against moments summed from its law, and the moments of counts."""

from fractions import Fraction
from math import sqrt

import numpy as np
import pytest

import lepp
from lepp import theory

#: From just above 0, where sums are long, to almost sure.
PROBABILITIES = [0.05, 1 / 3, 0.4156, 0.5, 0.9, 0.999]


def law(p, terms=2000):
    """Sizes and their probabilities, (1 - p)^(size - 2) p, by repeated multiplication."""
    sizes, chances, left = [], [], 1.0
    for size in range(2, 2 + terms):
        sizes.append(size)
        chances.append(left * p)
        left *= 1 - p
    return np.array(sizes), np.array(chances)


def moments(sizes, chances):
    """Mean, standard deviation, skewness and excess kurtosis, each from its definition."""
    mean = (sizes * chances).sum()
    second, third, fourth = (((sizes - mean) ** k * chances).sum() for k in (2, 3, 4))
    return mean, sqrt(second), third / second**1.5, fourth / second**2 - 3


@pytest.mark.parametrize("p", PROBABILITIES)
def test_formulas_are_moments_of_the_law(p):
    mean, sd, skewness, kurtosis = moments(*law(p))
    assert theory.mean(p) == pytest.approx(mean, rel=1e-10)
    assert theory.sd(p) == pytest.approx(sd, rel=1e-10)
    assert theory.skewness(p) == pytest.approx(skewness, rel=1e-8)
    assert theory.kurtosis(p) == pytest.approx(kurtosis, rel=1e-8)


@pytest.mark.parametrize("p", PROBABILITIES)
def test_probability_is_the_law(p):
    sizes, chances = law(p, 50)
    np.testing.assert_allclose(theory.probability(sizes, p), chances, rtol=1e-12)
    assert theory.probability(2, p) == p
    assert theory.probability(3, p) == pytest.approx(p * (1 - p))


def test_no_path_of_less_than_two_triangles():
    below = theory.probability(np.array([-3, 0, 1]), 0.4)
    assert below.tolist() == [0.0, 0.0, 0.0]
    assert theory.probability(np.arange(2, 400), 0.4).sum() == pytest.approx(1)
    assert theory.probability(np.array([2, 3]), 1.0).tolist() == [1.0, 0.0]


def test_bounds_of_theorem_2_are_the_moments_at_the_least_p():
    assert theory.LEAST_P == 1 / 3
    (low, high), (least, most) = theory.bounds()
    assert (low, least) == (2, 0)
    assert high == pytest.approx(4, rel=1e-12)
    assert most**2 == pytest.approx(6, rel=1e-12)
    p = np.linspace(0.25, 1, 400)
    (low, high), (least, most) = theory.bounds(0.25)
    means = [theory.mean(q) for q in p]
    spreads = [theory.sd(q) for q in p]
    assert (min(means), max(means)) == (low, pytest.approx(high))
    assert (min(spreads), max(spreads)) == (least, pytest.approx(most))


def test_moments_of_counts_by_definition():
    counts = [0, 3, 10, 0, 5, 1]
    sizes = np.repeat(np.arange(6), counts)
    made = lepp.LeppCounts(np.array([*counts, 0, 0]))
    assert made.count == 19
    assert made.max == 5
    assert len(made.counts) == 6
    mean, sd, skewness, kurtosis = moments(sizes, np.full(19, 1 / 19))
    assert (made.mean, made.sd) == (pytest.approx(mean), pytest.approx(sd))
    assert made.skewness == pytest.approx(skewness)
    assert made.kurtosis == pytest.approx(kurtosis)


def test_moments_of_counts_are_exact():
    # far from zero and many: sums of floats would lose the spread
    counts = np.zeros(10**6 + 2, np.int64)
    counts[-2:] = 10**12, 3 * 10**12
    made = lepp.LeppCounts(counts)
    quarter = Fraction(3, 4)
    assert made.mean == 10**6 + 0.75
    assert made.sd == pytest.approx(sqrt(quarter * (1 - quarter)), rel=1e-12)
    third = quarter * (1 - quarter) * (1 - 2 * quarter)
    assert made.skewness == pytest.approx(float(third) / sqrt(3 / 16) ** 3, rel=1e-12)
    fourth = quarter * (1 - quarter) * (1 - 3 * quarter * (1 - quarter))
    assert made.kurtosis == pytest.approx(float(fourth / Fraction(3, 16) ** 2) - 3, rel=1e-12)


def test_nothing_and_one_size():
    none = lepp.LeppCounts(np.zeros(4, np.int64))
    assert (none.count, none.max, len(none.counts)) == (0, 0, 0)
    assert np.isnan([none.mean, none.sd, none.skewness, none.kurtosis]).all()
    assert len(none.termination_rates) == 0
    one = lepp.LeppCounts(np.array([0, 0, 0, 7]))
    assert (one.count, one.max, one.mean, one.sd) == (7, 3, 3.0, 0.0)
    assert np.isnan([one.skewness, one.kurtosis]).all()
    assert one.termination_rates.tolist() == [0.0, 0.0, 0.0, 1.0]


def test_counts_are_values():
    counts = np.array([0, 2, 1])
    made = lepp.LeppCounts(counts)
    counts[1] = 9
    assert made.counts.tolist() == [0, 2, 1]
    with pytest.raises(ValueError, match="read-only"):
        made.counts[1] = 9
    same = lepp.LeppCounts(np.array([0, 2, 1, 0], np.uint8))
    assert same == made
    assert hash(same) == hash(made)
    assert made != lepp.LeppCounts(np.array([0, 2, 2]))
    assert made != [0, 2, 1]
    longer = lepp.LeppCounts(np.array([0, 0, 0, 4]))
    assert (made + longer).counts.tolist() == (longer + made).counts.tolist() == [0, 2, 1, 4]
    with pytest.raises(TypeError):
        made + counts


@pytest.mark.parametrize("counts", [3, [[1, 2]], [1.0, 2.0], [3, -1], [True]])
def test_what_is_no_counts_is_refused(counts):
    with pytest.raises(ValueError, match="one-dimensional array of integers of at least 0"):
        lepp.LeppCounts(np.array(counts))
