"""Tails against exact finite sums in long decimals, and against scipy above underflow."""

from decimal import Decimal, localcontext
from fractions import Fraction

import pytest
from scipy import stats

from study.statistics.tails import log10_chi2_tail, log10_f_tail, log10_t_tail

DIGITS = 1100


@pytest.mark.parametrize("f", [0.5, 3.0, 1e3, 1e6])
@pytest.mark.parametrize("df2", [7, 780, 7980])
def test_f_tail_with_two_degrees_of_freedom_is_a_power(f, df2):
    # P(F > f) = (1 + 2 f / df2)^(-df2 / 2)
    with localcontext(prec=50):
        exact = -(1 + 2 * Decimal(f) / df2).log10() * df2 / 2
    assert log10_f_tail(f, 2, df2) == pytest.approx(float(exact), rel=1e-12)


@pytest.mark.parametrize("f", [30.0, 3000.0, 1e5])
def test_f_tail_with_even_degrees_of_freedom_is_a_finite_sum(f):
    # I_x(a, b) for whole a and b is a binomial tail, Abramowitz and Stegun 26.5.24.
    a, b = 390, 9
    x = Fraction(1) / (1 + Fraction(2 * b, 2 * a) * Fraction(f))
    n, term = a + b - 1, Fraction(1)
    total = Fraction(0)
    for j in range(n + 1):
        if j >= a:
            total += term * x**j * (1 - x) ** (n - j)
        term = term * (n - j) / (j + 1)
    with localcontext(prec=50):
        exact = (Decimal(total.numerator) / Decimal(total.denominator)).log10()
    assert log10_f_tail(f, 2 * b, 2 * a) == pytest.approx(float(exact), rel=1e-11)


@pytest.mark.parametrize(("t", "df"), [(1.5, 4), (200.0, 78), (5000.0, 78), (400.0, 780)])
def test_t_tail_with_even_degrees_of_freedom_is_a_finite_sum(t, df):
    # Abramowitz and Stegun 26.7.4, its cancellation outdone by digits
    with localcontext(prec=DIGITS):
        cos2 = Decimal(df) / (df + Decimal(t) ** 2)
        term = total = Decimal(1)
        for j in range(1, df // 2):
            term = term * cos2 * (2 * j - 1) / (2 * j)
            total += term
        exact = ((1 - (1 - cos2).sqrt() * total) / 2).log10()
    assert log10_t_tail(t, df) == pytest.approx(float(exact), rel=1e-11)


@pytest.mark.parametrize(("x", "df"), [(3.0, 4), (800.0, 18), (3000.0, 18), (90000.0, 398)])
def test_chi2_tail_with_even_degrees_of_freedom_is_a_finite_sum(x, df):
    with localcontext(prec=50):
        y = Decimal(x) / 2
        term = total = Decimal(1)
        for j in range(1, df // 2):
            term = term * y / j
            total += term
        exact = ((-y).exp() * total).log10()
    assert log10_chi2_tail(x, df) == pytest.approx(float(exact), rel=1e-11)


@pytest.mark.parametrize("df", [1, 9, 39, 780])
def test_ordinary_tails_are_scipys(df):
    for value in (0.1, 1.0, 4.0):
        for t in (-value, value):
            assert 10 ** log10_t_tail(t, df) == pytest.approx(stats.t.sf(t, df), rel=1e-10)
        assert 10 ** log10_f_tail(value, 19, df) == pytest.approx(stats.f.sf(value, 19, df))
        assert 10 ** log10_chi2_tail(value, df) == pytest.approx(stats.chi2.sf(value, df))
