"""The rules of judging, by hand and by honest replications: two that measure the same agree."""

import numpy as np
import pytest
from scipy import special, stats

from study.paper import judging
from study.paper.published import Number

UP = np.inf


def number(value, places=12, scientific=False):
    """A published number, by default printed to so many places that rounding is nothing."""
    return Number(4, "made up", float(f"{value:.{places}{'e' if scientific else 'f'}}"), places,
                  scientific=scientific)  # fmt: skip


def spread(judgements):
    """Root mean square of the differences in standard errors."""
    return np.sqrt(np.mean([judgement.difference**2 for judgement in judgements]))


def at_limits(judge, center, unit):
    """Verdicts just inside and outside 2 and 3 standard errors of `unit`, on both sides."""
    just = 1e-6
    for side in (-1, 1):
        for z, verdict in [
            (0.0, "agrees"),
            (2 - just, "agrees"),
            (2 + just, "close"),
            (3 - just, "close"),
            (3 + just, "differs"),
            (50.0, "differs"),
        ]:
            judgement = judge(center + side * z * unit)
            assert judgement.difference == pytest.approx(side * z, abs=1e-8)
            assert judgement.verdict == verdict


def test_limits_are_two_and_three_standard_errors():
    for size, verdict in [
        (0.0, "agrees"),
        (2.0, "agrees"),
        (np.nextafter(2.0, UP), "close"),
        (3.0, "close"),
        (np.nextafter(3.0, UP), "differs"),
        (np.inf, "differs"),
    ]:
        assert judging.within(size) == judging.within(-size) == verdict
    assert judging.within(np.nan) == "not comparable"


def test_the_rule_says_what_the_limits_are_worth():
    assert "within 2 standard errors (19 of 20" in judging.RULE
    assert 2 * stats.norm.sf(2) == pytest.approx(1 / 20, abs=0.005)
    assert "within 3 (all but one in 370)" in judging.RULE
    assert 1 / (2 * stats.norm.sf(3)) == pytest.approx(370, abs=0.5)


def test_verdicts_are_all_that_a_rule_can_give():
    assert judging.VERDICTS == (
        "agrees", "close", "differs", "plausible draw", "implausible draw", "misprint",
        "not comparable", "not run",
    )  # fmt: skip


@pytest.mark.parametrize("places", [1, 2, 4])
def test_means(places):
    published = number(3.06, places)
    by_hand = np.sqrt(0.02**2 / 40 + 0.03**2 / 10 + (10.0**-places) ** 2 / 12)
    at_limits(
        lambda ours: judging.of_mean(ours, 0.02, 40, published, 0.03, 10), published.value, by_hand
    )
    judgement = judging.of_mean(3.07, 0.02, 40, published, 0.03, 10)
    assert (judgement.ours, judgement.standard_error) == (3.07, pytest.approx(by_hand))
    assert np.isnan(judgement.log10_ratio)


def test_means_of_honest_replications():
    # printed to one decimal, of which a standard error is half: rounding must be counted
    rng = np.random.default_rng(1)
    ours, theirs = rng.normal(3.0, 0.3, (2000, 30)), rng.normal(3.0, 0.3, (2000, 60))
    assert spread(
        judging.of_mean(a.mean(), a.std(ddof=1), 30, number(b.mean(), 1), b.std(ddof=1), 60)
        for a, b in zip(ours, theirs, strict=True)
    ) == pytest.approx(1, abs=0.06)


@pytest.mark.parametrize("places", [3, 12])
def test_standard_deviations(places):
    published = number(0.013, places)
    by_hand = np.sqrt(1 / (2 * 29) + 1 / (2 * 39) + (10.0**-places / 0.013) ** 2 / 12)
    for side in (-1, 1):
        for z, verdict in [(1.999, "agrees"), (2.001, "close"), (2.999, "close"),
                           (3.001, "differs")]:  # fmt: skip
            ours = 0.013 * np.exp(side * z * by_hand)
            judgement = judging.of_sd(ours, 30, published, 40)
            assert judgement.difference == pytest.approx(side * z)
            assert judgement.verdict == verdict
            assert judgement.standard_error == pytest.approx(by_hand * 0.013)
            assert judgement.ours == ours


def test_standard_deviations_of_honest_replications():
    # to two places, where a unit is half of a standard error
    rng = np.random.default_rng(2)
    ours = rng.normal(0, 0.1, (2000, 40)).std(axis=1, ddof=1)
    theirs = rng.normal(0, 0.1, (2000, 25)).std(axis=1, ddof=1)
    assert spread(
        judging.of_sd(a, 40, number(b, 2), 25) for a, b in zip(ours, theirs, strict=True)
    ) == pytest.approx(1, abs=0.07)


def of_logarithms(judge, value, error):
    """Verdicts just inside and outside the limits, of a number judged by its logarithm."""
    for side in (-1, 1):
        for z, verdict in [(0.0, "agrees"), (1.999, "agrees"), (2.001, "close"), (2.999, "close"),
                           (3.001, "differs")]:  # fmt: skip
            judgement = judge(value * np.exp(side * z * error))
            assert judgement.difference == pytest.approx(side * z, abs=1e-6)
            assert judgement.verdict == verdict


@pytest.mark.parametrize("places", [0, 2, 12])
def test_f_statistics(places):
    published = number(33.0, places)
    error = np.hypot(0.1, 10.0**-places / 33 / np.sqrt(12))
    of_logarithms(lambda ours: judging.of_f(ours, published, 0.1), 33.0, error)
    assert judging.of_f(30.0, published, 0.1).standard_error == pytest.approx(error * 33)


@pytest.mark.parametrize(("error", "unit"), [(1.0, 0.0), (1.0, 0.5), (0.18, 1.0), (1e-6, 1.0)])
def test_chance_of_more_than_two_standard_errors(error, unit):
    rng = np.random.default_rng(10)
    off = rng.normal(0, error, 400_000) + rng.uniform(-unit / 2, unit / 2, 400_000)
    seen = np.mean(np.abs(off) > 2 * np.hypot(error, unit / np.sqrt(12)))
    assert judging.chance_beyond(error, unit) == pytest.approx(seen, abs=0.002)


def test_chance_without_rounding_is_the_normal_one_and_without_error_none():
    normal = 2 * stats.norm.sf(2)
    for unit in (0.0, 1.9e-3, 2.1e-3):  # on both sides of what does not count
        assert judging.chance_beyond(1.0, unit) == pytest.approx(normal, rel=1e-5)
    assert judging.chance_beyond(0.0, 1.0) == 0.0
    assert judging.of_mean(3.0, 0.1, 9, number(3.0), 0.1, 9).chance_beyond == pytest.approx(normal)
    assert judging.of_mean(12.2, 0.5, 40, number(12, 0), 0.5, 40).chance_beyond < 0.02


def test_p_printed_as_zero():
    published = Number(5, "p", 0.0, 4)
    assert judging.of_rounded_p(5e-5, published).verdict == "agrees"
    assert judging.of_rounded_p(0.0, published).verdict == "agrees"
    assert judging.of_rounded_p(np.nextafter(5e-5, 1), published).verdict == "differs"
    assert judging.of_rounded_p(1e-3, published).verdict == "differs"
    judgement = judging.of_rounded_p(1e-9, published)
    assert judgement.ours == 1e-9
    assert np.isnan(judgement.difference)
    assert "4 decimals" in judgement.rule
    # rounding, not reaching: 0.1234 is printed by what is half a unit to either side
    other = Number(5, "p", 0.1234, 4)
    assert judging.of_rounded_p(0.12344, other).verdict == "agrees"
    assert judging.of_rounded_p(0.12336, other).verdict == "agrees"
    assert judging.of_rounded_p(0.12347, other).verdict == "differs"
    assert judging.of_rounded_p(0.12333, other).verdict == "differs"


@pytest.mark.parametrize("p", [0.9, 0.05, 1e-8, 1e-250])
def test_f_of_a_tail(p):
    assert stats.f.sf(judging.f_of_p(p, 3, 50), 3, 50) == pytest.approx(p, rel=1e-7)
    # with two degrees of freedom the tail is a power, P(F > f) = (1 + 2 f / df2)^(-df2 / 2)
    assert judging.f_of_p(p, 2, 50) == pytest.approx((p ** (-2 / 50) - 1) * 50 / 2, rel=1e-9)


def test_p_of_regressions():
    df = (1, 58)
    published = number(2.5e-11, 2, scientific=True)

    def judge(f):
        p = stats.f.sf(f, *df)
        judgement = judging.of_regression_p(p, np.log10(p), f, published, df, 0.25)
        assert judgement.log10_ratio == pytest.approx(np.log10(p / 2.5e-11))
        assert judgement.ours == p
        return judgement

    of_logarithms(judge, stats.f.isf(2.5e-11, *df), 0.25)


@pytest.mark.parametrize("places", [2, 12])
def test_adjusted_r_squared(places):
    published = number(0.31, places)
    error = np.sqrt(0.02**2 + (10.0**-places) ** 2 / 12)
    at_limits(lambda ours: judging.of_adjusted_r2(ours, published, 0.02), 0.31, error)


def test_coefficients():
    published = number(7.535e-5, 3, scientific=True)
    error = np.sqrt(1e-6**2 + 1e-8**2 / 12)
    at_limits(lambda ours: judging.of_coefficient(ours, published, 1e-6), 7.535e-5, error)


def t_of(values, bound):
    """t of a mean below a bound, and the logarithm of its p-value, by the normal quadrature."""
    n = len(values)
    t = (bound - values.mean()) / values.std(ddof=1) * np.sqrt(n)
    return t, np.log10(stats.t.sf(t, n - 1))


def test_t_tests():
    rng = np.random.default_rng(7)
    ours, theirs = rng.normal(3.0, 0.012, 30), rng.normal(3.0, 0.012, 40)
    t, log10_p = t_of(ours, 4.0)
    published_t, log10_published = t_of(theirs, 4.0)
    published = number(10**log10_published, 10, scientific=True)
    error = np.sqrt(1 / 58 + 1 / 78)
    ratio = t / np.sqrt(30) / (published_t / np.sqrt(40))
    judgement = judging.of_t_test(1e-9, log10_p, -t, 30, published, 40)
    assert judgement.ours == 1e-9
    assert judgement.difference == pytest.approx(np.log(ratio) / error, rel=1e-6)
    assert np.isnan(judgement.log10_ratio)  # p of other numbers of meshes has no ratio
    for side in (-1, 1):
        for z, verdict in [(0, "agrees"), (1.999, "agrees"), (2.001, "close"), (2.999, "close"),
                           (3.001, "differs")]:  # fmt: skip
            shifted = published_t * np.sqrt(30 / 40) * np.exp(side * z * error)
            judgement = judging.of_t_test(0.0, -50.0, shifted, 30, published, 40)
            assert judgement.verdict == verdict
    same = judging.of_t_test(0.0, -50.0, t, 40, published, 40)
    assert same.log10_ratio == pytest.approx(-50.0 - log10_published)


def test_t_tests_of_honest_replications():
    rng = np.random.default_rng(8)
    judged = []
    for ours, theirs in rng.normal(3.0, 0.012, (1000, 2, 40)):
        (t, log10_p), (_, log10_published) = t_of(ours, 4.0), t_of(theirs, 4.0)
        published = number(10**log10_published, 2, scientific=True)
        judged.append(judging.of_t_test(10**log10_p, log10_p, t, 40, published, 40))
    assert spread(judged) == pytest.approx(1, abs=0.08)


def test_p_of_true_hypotheses():
    for side in (-1, 1):
        for z, verdict in [(0.0, "plausible draw"), (2.999, "plausible draw"),
                           (3.001, "implausible draw")]:  # fmt: skip
            ours = special.ndtr(0.4 + side * z * np.sqrt(2))
            judgement = judging.of_null_p(0.98, special.ndtr(0.4), ours)
            assert judgement.difference == pytest.approx(side * z, abs=1e-6)
            assert judgement.verdict == verdict
            assert judgement.ours == 0.98
            assert "3 sqrt 2" in judgement.rule
    p = np.random.default_rng(9).random((3000, 2))
    assert spread(judging.of_null_p(0.0, *pair) for pair in p) == pytest.approx(1, abs=0.05)


def test_p_of_random_point_sets():
    for family_p, verdict in [(0.9, "plausible draw"), (0.01, "plausible draw"),
                              (0.0099, "implausible draw")]:  # fmt: skip
        judgement = judging.of_drawn_p(0.7, family_p)
        assert judgement.verdict == verdict
        assert judgement.ours == 0.7
        assert np.isnan(judgement.difference)
        assert np.isnan(judgement.standard_error)
        assert "unless p is below 0.01" in judgement.rule
