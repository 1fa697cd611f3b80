"""The lattice of the runs test, by our own test on sequences of known runs."""

import numpy as np
import pytest

from study.paper import published, runs_lattice
from study.run.point_checks import count_sides, runs_p_value


def sequence(n, runs):
    """n values, half of them above the median, in so many runs."""
    above = np.full(n, -1.0)
    # the runs alternate; all of them single values but for the first two, which take the rest
    signs = np.where(np.arange(runs) % 2 == 0, 1.0, -1.0)
    high, low = (signs > 0).sum(), (signs < 0).sum()
    above = np.concatenate([
        np.ones(n // 2 - high + 1), -np.ones(n // 2 - low + 1), signs[2:],
    ])  # fmt: skip
    assert len(above) == n
    return above


@pytest.mark.parametrize("n", [100, 10_000])
def test_possible_p_values_are_those_of_our_test(n):
    possible = runs_lattice.possible_p(n, 4)
    for step in (0, 1, 2, 5, 11):
        for runs in (n // 2 + 1 + step, n // 2 + 1 - step):
            p = f"{runs_p_value(count_sides(sequence(n, runs), 0.0)):.4f}"
            assert possible[p] == step


def test_table_1_tests_sets_of_the_first_group(paper_study):
    frame = paper_study[2]["runs_lattice"].frame.set_index("n_points")
    assert frame["possible"].to_dict() == {
        size: {10_000: 8, 30_000: 3, 40_000: 6, 90_000: 6, 120_000: 3, 160_000: 6}.get(size, 2)
        for size in published.sizes()
    }
    assert frame.index[frame["fits"] == "yes"].tolist() == [10_000]
    assert frame.loc[10_000, "steps"] == "26, 0, 2, 21, 26, 3, 0, 56"
    assert frame.loc[20_000, "steps"] == "none, 0, none, none, none, none, 0, none"
    assert runs_lattice.sizes_of_table_1() == (10_000,)


def test_chance_of_lying_on_the_lattice(paper_study):
    # of numbers that were printed at random
    drawn = np.random.default_rng(0).integers(0, 10_001, 40_000)
    expected = paper_study[2]["runs_lattice"].frame.set_index("n_points")["expected"]
    for size in (10_000, 200_000):
        possible = runs_lattice.possible_p(size, 4)
        share = np.mean([f"{p / 10_000:.4f}" in possible for p in drawn])
        assert expected[size] == pytest.approx(8 * share, rel=0.1)


def test_other_printed_numbers_would_name_other_sets(monkeypatch):
    sd = np.sqrt(20_000 * 19_998 / (4 * 19_999))
    p = runs_lattice.special.ndtr(-np.array([1, 8, 33]) / sd) * 2
    made = [published.Number(1, "p of runs test, x", round(value, 4), 4) for value in p]
    monkeypatch.setattr(runs_lattice, "runs_p_values", lambda: made)
    assert 20_000 in runs_lattice.sizes_of_table_1.__wrapped__()
    assert 10_000 not in runs_lattice.sizes_of_table_1.__wrapped__()
