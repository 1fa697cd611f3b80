"""Holm's correction against statsmodels, and by the chance of a false rejection."""

import numpy as np
import pytest
from statsmodels.stats.multitest import multipletests

from study.statistics.multiple_testing import holm


@pytest.mark.parametrize("m", [1, 2, 7, 80])
def test_adjusted_p_is_statsmodels(m):
    rng = np.random.default_rng(m)
    for p in (rng.random(m), rng.random(m) ** 5, np.round(rng.random(m), 1)):
        np.testing.assert_allclose(holm(p), multipletests(p, method="holm")[1], rtol=1e-14)


def test_by_hand():
    # 0.01 * 4, then 0.02 * 3, then 0.025 * 2 = 0.05 which is not less than 0.06; 0.9
    np.testing.assert_allclose(holm(np.array([0.9, 0.02, 0.01, 0.025])), [0.9, 0.06, 0.04, 0.06])
    np.testing.assert_allclose(holm(np.array([0.6, 0.7])), [1.0, 1.0])
    assert holm(np.array([])).tolist() == []


def test_any_false_rejection_has_the_chance_of_one_test():
    p = np.random.default_rng(2).random((4000, 10))
    false = [(holm(row) < 0.05).any() for row in p]
    assert np.mean(false) == pytest.approx(0.05, abs=0.012)
