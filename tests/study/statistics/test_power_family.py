"""The power family in other parameters by scipy, and its intervals by simulation."""

import numpy as np
import pytest
from scipy import optimize, stats

from study.statistics.groups import NotEnough
from study.statistics.power_family import PowerFamily, ProfileInterval
from study.statistics.size_means import SizeMeans

SIZES = np.array([10, 20, 50, 100, 200, 500, 1000, 2000]) * 1000
ERRORS = 0.01 * (SIZES / 10_000) ** -0.5
DF = 60


def made(curve, seed=1, noise=1.0):
    rng = np.random.default_rng(seed)
    means = curve(SIZES / 1000) + noise * rng.normal(0, ERRORS)
    return SizeMeans(SIZES, means, ERRORS**2, DF)


def saturating(x, c=3.1, a=0.4, b=0.5):
    return c - a * x**-b


def logarithm(x):
    return 3 + 0.02 * np.log(x)


def squares_at_limit(seen, c):
    """Least squares of c - exp(u) x^(-exp(v)) for a given c, by another route than a line."""

    def residuals(p):
        return (seen.means - c + np.exp(p[0]) * seen.x ** -np.exp(p[1])) / ERRORS

    starts = [(np.log(0.4), np.log(b)) for b in (0.1, 0.5, 1.0)]
    return min(2 * optimize.least_squares(residuals, at, xtol=1e-14).cost for at in starts)


@pytest.mark.parametrize("seed", range(3))
def test_the_limit_by_another_route(seed):
    seen = made(saturating, seed)
    found = PowerFamily(seen).value(np.inf)
    least = optimize.minimize_scalar(
        lambda c: squares_at_limit(seen, c), bounds=(3.05, 3.3), method="bounded",
        options={"xatol": 1e-9},
    )  # fmt: skip
    assert found.estimate == pytest.approx(least.x, abs=1e-6)
    rise = stats.f.isf(0.05, 1, DF)
    ends = [
        optimize.brentq(lambda c: squares_at_limit(seen, c) - least.fun - rise, least.x, to)
        for to in (least.x - 0.03, least.x + 1.0)
    ]
    assert (found.low, found.high) == pytest.approx(ends, abs=1e-6)
    # not alike to both sides, which no interval from a slope at the best fit can be
    assert found.high - found.estimate > 1.05 * (found.estimate - found.low)


@pytest.mark.parametrize("seed", range(3))
def test_the_power_by_another_route(seed):
    seen = made(saturating, seed)
    family = PowerFamily(seen)

    def squares(b):
        basis = np.column_stack([np.ones(8), seen.x**-b]) / ERRORS[:, None]
        return np.linalg.lstsq(basis, seen.means / ERRORS, rcond=None)[1][0]

    least = optimize.minimize_scalar(squares, bounds=(0.01, 2), method="bounded")
    assert -family.power.estimate == pytest.approx(least.x, abs=1e-4)
    assert family.best()[1] == pytest.approx(least.fun)
    for end in (family.power.low, family.power.high):
        assert squares(-end) - least.fun == pytest.approx(stats.f.isf(0.05, 1, DF))
    assert family.power.low < family.power.estimate < family.power.high < 0


def test_at_a_power_of_0_it_is_the_logarithm():
    seen = made(logarithm)
    family = PowerFamily(seen)
    basis = np.column_stack([np.ones(8), np.log(seen.x)]) / ERRORS[:, None]
    found, squares, *_ = np.linalg.lstsq(basis, seen.means / ERRORS, rcond=None)
    assert family.squares(0.0) == pytest.approx(squares[0])
    assert family.squares(1e-7) == pytest.approx(squares[0], rel=1e-4)
    assert family.at(0.0, 1e6) == pytest.approx(found @ [1, np.log(1e6)])
    assert family.best(least=0.0, most=0.0)[0] == 0


@pytest.mark.parametrize("power", [-2.0, -0.5, -0.1, 0.0, 0.2, 1.0])
def test_powers_are_recovered(power):
    scale = 0.4 if power < 0 else 0.01
    curve = (lambda x: 3 + np.sign(power) * scale * x**power) if power else logarithm
    seen = made(curve, noise=1e-5)
    assert PowerFamily(seen).power.estimate == pytest.approx(power, abs=0.02)


def test_a_limit_may_have_no_upper_end():
    noisy = made(lambda x: saturating(x, 3.1, 0.2, 0.1))
    family = PowerFamily(noisy)
    assert family.power.high > 0 > family.power.estimate
    limit = family.value(np.inf)
    assert limit.high == np.inf
    assert np.isfinite(limit.low)
    assert not limit.bounded
    falling = SizeMeans(SIZES, 6 - noisy.means, noisy.variances, DF)
    mirrored = PowerFamily(falling).value(np.inf)
    assert mirrored.low == -np.inf
    assert mirrored.high == pytest.approx(6 - limit.low)
    assert PowerFamily(made(saturating)).value(np.inf).bounded


def test_a_level_mean_has_a_limit_without_ends():
    seen = SizeMeans(SIZES, 3 + ERRORS * [1, -1, 1, -1, 1, -1, 1, -1], ERRORS**2, DF)
    family = PowerFamily(seen)
    assert (family.power.low, family.power.high) == (-np.inf, np.inf)
    if family.power.estimate < 0:
        found = family.value(np.inf)
        assert (found.low, found.high) == (-np.inf, np.inf)


@pytest.mark.parametrize("curve", [lambda x: 3 + 1e-3 * x, lambda x: 3 + 0.05 * x**0.3])
def test_faster_growth_has_no_limit(curve):
    with pytest.raises(NotEnough, match="show no saturation"):
        PowerFamily(made(curve)).value(np.inf)


def test_values_by_another_route():
    seen = made(saturating)
    at = 1e4

    def squares(value):
        # c - a x^-b with c such that the curve passes through the value at x = 10^4
        def residuals(p):
            powers = seen.x ** -np.exp(p[1]) - at ** -np.exp(p[1])
            return (seen.means - value + np.exp(p[0]) * powers) / ERRORS

        return 2 * optimize.least_squares(residuals, (np.log(0.4), np.log(0.5)), xtol=1e-14).cost

    found = PowerFamily(seen).value(at)
    ceiling = squares(found.estimate) + stats.f.isf(0.05, 1, DF)
    assert squares(found.low) == pytest.approx(ceiling, rel=1e-5)
    assert squares(found.high) == pytest.approx(ceiling, rel=1e-5)


def test_intervals_cover():
    truth = {"limit": 3.1, "power": -0.3, "value": saturating(1e4, 3.1, 0.4, 0.3)}
    inside = dict.fromkeys(truth, 0)
    runs = 300
    for seed in range(runs):
        family = PowerFamily(made(lambda x: saturating(x, 3.1, 0.4, 0.3), seed))
        found = {"limit": family.value(np.inf), "power": family.power, "value": family.value(1e4)}
        for name, interval in found.items():
            inside[name] += interval.low <= truth[name] <= interval.high
    for number in inside.values():
        # errors count as known here, the t quantile of 60 degrees of freedom as little more
        assert 0.92 <= number / runs <= 0.985


def test_too_few_sizes():
    seen = made(saturating)
    with pytest.raises(NotEnough, match="needs 3 sizes, not 2"):
        PowerFamily(seen.where(np.arange(8) < 2))
    assert not ProfileInterval(1.0, -np.inf, 2.0).bounded
