"""The studentized range against Student's t and scipy's slow integration."""

import numpy as np
import pytest
from scipy import stats

from study.statistics.studentized_range import studentized_range_critical, studentized_range_tail

DF = np.array([1.0, 2.0, 5.5, 39.0, 77.3, 5000.0])


@pytest.mark.parametrize("q", [0.0, 0.5, 2.0, 4.0, 9.0])
def test_range_of_two_is_the_t_distribution(q):
    tail = studentized_range_tail(np.full(len(DF), q), 2, DF)
    np.testing.assert_allclose(tail, 2 * stats.t.sf(q / np.sqrt(2), DF), atol=1e-8)


@pytest.mark.parametrize(("k", "q", "df"), [(3, 3.5, 12.0), (20, 4.0, 60.0)])
def test_range_of_more_is_scipys(k, q, df):
    tail = studentized_range_tail(np.array([q]), k, np.array([df]))
    assert tail[0] == pytest.approx(stats.studentized_range.sf(q, k, df), abs=1e-7)


def test_tabulated_critical_value():
    # Tables of the studentized range: k = 10, 20 degrees of freedom, 5 %.
    assert studentized_range_critical(0.05, 10, np.array([20.0]))[0] == pytest.approx(
        5.008, abs=5e-4
    )


def test_critical_value_has_its_level():
    critical = studentized_range_critical(0.05, 20, DF)
    np.testing.assert_allclose(studentized_range_tail(critical, 20, DF), 0.05, rtol=1e-9)
