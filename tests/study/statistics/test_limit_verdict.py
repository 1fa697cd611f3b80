"""The verdict on a limit, by data whose truth is known."""

from collections import Counter
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import stats

from study.statistics import models
from study.statistics.groups import Groups, NotEnough
from study.statistics.limit_verdict import (
    BOUNDED,
    CONTRADICTION,
    GROWTH,
    LEVEL,
    LIMIT,
    NONE_FITS,
    ROUGH,
    SEVERAL,
    LimitVerdict,
    _verdict,
    candidates,
    combined,
    judge,
    level_mean,
    limit_of,
    per_decade,
)
from study.statistics.model_scores import (
    coefficient_interval,
    lack_of_fit,
    prediction_score,
    sizes_to_fit,
)
from study.statistics.power_family import ProfileInterval
from study.statistics.size_means import SizeMeans
from study.statistics.verdicts import NO, UNDECIDED, YES

SIZES = np.array([1, 2, 5, 10, 20, 50, 100, 200, 500, 1000]) * 10**4
COUNTS = [40, 40, 40, 40, 40, 40, 40, 20, 10, 6]
PUBLISHED = 200_000
RUNS = 24


def made(curve, seed, spread=0.85, sizes=SIZES, counts=COUNTS):
    """Means as variable as those of plain insertion."""
    rng = np.random.default_rng(seed)
    values = (
        curve(n / 1000) + rng.normal(0, spread * n**-0.45, r)
        for n, r in zip(sizes, counts, strict=True)
    )
    return SizeMeans.of(Groups(np.array(sizes), tuple(values)))


def verdicts(curve, **settings):
    judged = [judge(made(curve, seed, **settings), PUBLISHED) for seed in range(RUNS)]
    return judged, Counter((one.verdict, one.reason) for one in judged)


WITH_LIMIT = {
    "saturating": (3.09, lambda x: 3.09 - 0.1 * x**-0.3),
    "edge": (3.4765, lambda x: 3.4765 + 0.3 * x**-0.5),
    "thickening edge": (3.4765, lambda x: 3.4765 + (0.2 + 0.05 * np.log(x)) * x**-0.5),
}


@pytest.mark.parametrize("name", WITH_LIMIT)
def test_a_limit_is_seen(name):
    truth, curve = WITH_LIMIT[name]
    judged, counted = verdicts(curve)
    assert counted[YES, LIMIT] >= 0.9 * RUNS
    assert all(verdict != NO for verdict, _ in counted)
    limits = [one.limit for one in judged if one.verdict == YES]
    covered = [limit.low <= truth <= limit.high for limit in limits]
    assert np.mean(covered) >= 0.85
    assert all(limit.low <= limit.estimate <= limit.high for limit in limits)
    named = Counter(one.model.name for each in judged for one in each.survivors)
    assert named[name] >= 0.9 * RUNS
    assert not named["logarithmic"]


WITHOUT = {
    "logarithm": lambda x: 3.04 + 0.0043 * np.log(x),
    "power": lambda x: 3 + 0.02 * x**0.2,
    "line": lambda x: 3 + 1e-6 * x,
    "root of the logarithm": lambda x: 3 + 0.03 * np.sqrt(np.log(1000 * x)),
    "logarithm of the logarithm": lambda x: 2.9 + 0.06 * np.log(np.log(1000 * x)),
}


@pytest.mark.parametrize("name", WITHOUT)
def test_growth_without_limit_is_never_taken_for_one(name):
    judged, counted = verdicts(WITHOUT[name])
    assert all(verdict != YES for verdict, _ in counted)
    # The two slowest are no nearer to a logarithm than the data can tell.
    assert counted[NO, GROWTH] >= {"l": 0.15, "r": 0.6}.get(name[0] * ("of" in name), 0.9) * RUNS
    assert all(one.limit is None for one in judged)


FALLING = {
    "logarithm": lambda x: 3.6 - 0.0043 * np.log(x),
    "root of the logarithm": lambda x: 3.6 - 0.03 * np.sqrt(np.log(1000 * x)),
    "power": lambda x: 3.6 - 0.02 * x**0.2,
}


@pytest.mark.parametrize("name", FALLING)
def test_a_mean_that_falls_without_end_has_a_limit_since_no_path_is_empty(name):
    curve = FALLING[name]
    judged, counted = verdicts(curve)
    assert counted[YES, BOUNDED] >= 0.9 * RUNS  # a model is refuted in one run of a hundred
    assert all(verdict != NO for verdict, _ in counted)
    for one in judged:
        if one.verdict != YES:
            continue
        means = [float(curve(n / 1000)) for n in SIZES]
        assert np.isnan(one.limit.estimate)
        assert one.limit.low == -np.inf
        assert means[-1] - 0.001 < one.limit.high < means[-3]
    seen = made(curve, 0)
    error = np.sqrt(seen.variances[-1])
    end = judge(seen, PUBLISHED).limit.high
    assert end == pytest.approx(seen.means[-1] + stats.t.ppf(0.975, seen.df) * error)


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        (-0.02, -0.01, (YES, BOUNDED)),
        (-0.02, 0.01, (UNDECIDED, SEVERAL)),
        (0.01, 0.02, (UNDECIDED, SEVERAL)),
    ],
)
def test_only_a_mean_that_surely_falls_is_bounded(low, high, expected):
    power = SimpleNamespace(power=ProfileInterval(0.0, -1.0, 1.0))
    left = tuple(SimpleNamespace(model=one) for one in (models.LOGARITHMIC, models.EDGE))
    assert _verdict(left, power, ProfileInterval((low + high) / 2, low, high)) == expected


def test_a_falling_mean_that_no_model_follows_is_undecided():
    _, counted = verdicts(lambda x: 3.6 - 0.03 * np.log(x) + 0.03 * np.sin(2 * np.log(x)))
    assert counted == {(UNDECIDED, NONE_FITS): RUNS}


def test_no_model_is_refuted_while_one_that_it_contains_is_not():
    spared = 0
    for seed in range(RUNS):
        means = made(lambda x: 3.4755 + 0 * x, seed)
        fitted = sizes_to_fit(means.n_points, PUBLISHED, 4)
        # A threshold just above the constant's own p, as the worst of the larger models can be.
        constant = candidates(means, fitted)[0]
        below = min(constant.fit.p, constant.prediction.p)
        scored = {one.model.name: one for one in candidates(means, fitted, below)}
        assert not scored["constant"].refuted
        for one in scored.values():
            assert not one.refuted
            spared += min(one.fit.p, one.prediction.p) < below
        above = below * (1 + 1e-9)
        again = {one.model.name: one for one in candidates(means, fitted, above)}
        assert again["constant"].refuted
        worse = [
            one
            for one in again.values()
            if min(one.fit.p, one.prediction.p) < above
            and all(again[name].refuted for name in one.model.contains if name in again)
        ]
        assert [one.model.name for one in again.values() if one.refuted] == [
            one.model.name for one in worse
        ]
    assert spared > RUNS / 2


def test_a_power_model_that_is_best_as_the_logarithm_is_none_of_its_own():
    for curve, absent in (
        (WITHOUT["power"], "saturating"),
        (WITH_LIMIT["saturating"][1], "growing power"),
    ):
        means = made(curve, 1)
        fitted = sizes_to_fit(means.n_points, PUBLISHED, 4)
        names = [one.model.name for one in candidates(means, fitted)]
        assert names == [one.name for one in models.MODELS if one.name != absent]


@pytest.mark.parametrize("model", models.MODELS, ids=lambda model: model.name)
def test_a_model_fits_no_worse_than_those_that_it_contains(model):
    named = {one.name: one for one in models.MODELS}
    for seed, curve in enumerate((*WITHOUT.values(), *(c for _, c in WITH_LIMIT.values()))):
        means = made(curve, seed)
        for name in model.contains:
            larger = lack_of_fit(model, means).chi_squared
            contained = lack_of_fit(named[name], means).chi_squared
            # The logistic model is fitted on a scale of its own.
            assert larger <= contained * (1 + 1e-3 * (model.name == "logistic") + 1e-9)


def test_a_level_mean_has_a_limit():
    judged, counted = verdicts(lambda x: 3.4755 + 0 * x)
    assert counted[YES, LEVEL] >= 0.85 * RUNS
    for one in judged:
        if one.reason == LEVEL:
            assert one.limit.estimate == pytest.approx(3.4755, abs=0.001)
            assert max(-one.per_decade.low, one.per_decade.high) <= 0.001


def test_a_mean_that_is_level_as_far_as_is_seen():
    _, counted = verdicts(lambda x: 3.05 + 0 * x, spread=5.0)
    assert counted[UNDECIDED, ROUGH] >= 0.75 * RUNS
    assert all(verdict == UNDECIDED for verdict, _ in counted)


def test_a_change_too_small_to_count():
    _, counted = verdicts(lambda x: 3.05 + 0.0002 * np.log10(x), spread=0.4)
    assert counted[YES, LEVEL] >= 0.6 * RUNS
    _, counted = verdicts(lambda x: 3.05 + 0.004 * np.log10(x), spread=0.4)
    assert counted[YES, LEVEL] == 0


def test_too_short_a_range_is_undecided():
    sizes = np.arange(1, 21) * 10**4
    for curve in (WITHOUT["logarithm"], lambda x: 3.11 - 0.095 * x**-0.14):
        _, counted = verdicts(curve, sizes=sizes, counts=[40] * 20)
        assert counted[UNDECIDED, SEVERAL] >= 0.8 * RUNS


def test_no_model_follows_a_wave():
    judged, counted = verdicts(lambda x: 3 + 0.03 * np.sin(2 * np.log(x)))
    assert counted == {(UNDECIDED, NONE_FITS): RUNS}
    assert not any(one.survivors for one in judged)


def test_models_are_refuted_by_what_they_have_not_seen_and_by_aic():
    means = made(WITH_LIMIT["thickening edge"][1], 1)
    fitted = sizes_to_fit(means.n_points, PUBLISHED, 4)
    scored = {one.model.name: one for one in candidates(means, fitted)}
    assert len(scored) == len(models.MODELS) - 1  # of two powers one is the logarithm
    assert scored["logarithmic"].refuted
    assert scored["constant"].prediction.p < 1e-6
    assert not scored["thickening edge"].refuted
    one = scored["thickening edge"]
    assert one.aic == pytest.approx(one.fit.chi_squared + 6)
    survivors = judge(means, PUBLISHED).survivors
    assert [one.aic for one in survivors] == sorted(one.aic for one in survivors)
    best = min(one.aic for one in scored.values() if not one.refuted)
    expected = {name for name, one in scored.items() if not one.refuted and one.aic <= best + 10}
    assert {one.model.name for one in survivors} == expected


def test_limits_and_slopes():
    means = made(WITHOUT["logarithm"], 1)
    slope = coefficient_interval(models.LOGARITHMIC, means, 1)
    decade = per_decade(means)
    assert decade.estimate == pytest.approx(slope.estimate * np.log2(10))
    assert decade.low < 0.0043 * np.log(10) < decade.high
    weights = 1 / means.variances
    mean = np.average(means.means, weights=weights)
    constant = limit_of(models.CONSTANT, means)
    assert constant.estimate == pytest.approx(mean)
    assert constant.high - mean == pytest.approx(1.968 / np.sqrt(weights.sum()), rel=2e-3)


def test_too_few_sizes():
    means = made(WITHOUT["logarithm"], 1)
    with pytest.raises(NotEnough, match="needs 5 sizes, not 4"):
        judge(means.where(np.arange(10) < 4), PUBLISHED)
    assert judge(means.where(np.arange(10) < 5), PUBLISHED).verdict == UNDECIDED


# Two parts that have one limit


def test_a_model_of_another_limit_than_a_level_interior_is_struck_out():
    for seed in range(RUNS):
        means = made(WITH_LIMIT["thickening edge"][1], seed)
        level = level_mean(made(lambda x: 3.4765 + 0 * x, seed + 100), PUBLISHED)
        if level is None:  # one in a hundred
            continue
        assert level.low < 3.4765 < level.high
        fitted = sizes_to_fit(means.n_points, PUBLISHED, 4)
        scored = {one.model.name: one for one in candidates(means, fitted, level=level)}
        for name, one in scored.items():
            if one.model.has_limit and name != "saturating":
                limit = limit_of(one.model, means)
                assert one.struck_out == (limit.low > level.high or limit.high < level.low)
            elif name != "saturating":
                assert not one.struck_out
        assert not scored["thickening edge"].struck_out
        assert scored["constant"].struck_out
        assert not any(one.struck_out for one in candidates(means, fitted))


def test_the_survivor_without_the_interior_is_out_with_it():
    means = made(WITH_LIMIT["saturating"][1], 1)
    assert "saturating" in {one.model.name for one in judge(means, PUBLISHED).survivors}
    off = ProfileInterval(3.4765, 3.476, 3.477)
    assert "saturating" not in {
        one.model.name for one in judge(means, PUBLISHED, level=off).survivors
    }
    near = ProfileInterval(3.09, 3.089, 3.091)
    verdict = judge(means, PUBLISHED, level=near)
    assert "saturating" in {one.model.name for one in verdict.survivors}


def test_a_level_mean_allows_for_what_may_be_hidden():
    means = made(lambda x: 3.4755 + 0 * x, 2)
    level, mean = level_mean(means, PUBLISHED), limit_of(models.CONSTANT, means)
    change = per_decade(means)
    unseen = max(abs(change.low), abs(change.high))
    assert (level.low, level.high) == pytest.approx((mean.low - unseen, mean.high + unseen))
    assert level_mean(made(WITHOUT["logarithm"], 2), PUBLISHED) is None


def test_the_level_is_that_of_all_trends_together():
    means = made(WITH_LIMIT["thickening edge"][1], 1)
    fitted = sizes_to_fit(means.n_points, PUBLISHED, 4)
    for below in (0.01, 1e-4, 0.9):
        for one in candidates(means, fitted, below):
            low = min(one.fit.p, one.prediction.p) < below
            assert one.refuted == (low and not one.contains_one_that_stands)


def test_a_run_of_many_trends_seldom_refutes_a_true_model():
    def least_p(seed):
        means = made(lambda x: 3.4755 + 0 * x, seed + 5000)
        fitted = sizes_to_fit(means.n_points, PUBLISHED, 4)
        fit = lack_of_fit(models.CONSTANT, means)
        return min(fit.p, prediction_score(models.CONSTANT, means, fitted).p)

    runs = np.array([least_p(seed) for seed in range(800)]).reshape(50, 16).min(axis=1)
    assert (runs < 0.01 / 16).mean() <= 0.06
    assert (runs < 0.01).mean() >= 0.1


def part(verdict, reason, *limit):
    interval = ProfileInterval(*limit) if limit else None
    return LimitVerdict(verdict, reason, (), None, None, interval)


LEVEL_PART = part(YES, LEVEL, 3.0, 2.9, 3.1)
LIMIT_PART = part(YES, LIMIT, 3.05, 2.95, 3.15)
OTHER_LIMIT = part(YES, LIMIT, 3.5, 3.4, 3.6)
NO_PART = part(NO, GROWTH)
OPEN_PART = part(UNDECIDED, SEVERAL)
FALLING_PART = part(YES, BOUNDED, np.nan, -np.inf, 3.2)


@pytest.mark.parametrize(
    ("whole", "interior", "verdict", "reason", "limit"),
    [
        (OPEN_PART, LEVEL_PART, YES, LEVEL, 3.0),
        (LIMIT_PART, LEVEL_PART, YES, LEVEL, 3.0),
        (LEVEL_PART, LIMIT_PART, YES, LEVEL, 3.0),
        (LIMIT_PART, OPEN_PART, YES, LIMIT, 3.05),
        (OPEN_PART, LIMIT_PART, YES, LIMIT, 3.05),
        (LIMIT_PART, None, YES, LIMIT, 3.05),
        (None, LEVEL_PART, YES, LEVEL, 3.0),
        (OTHER_LIMIT, LEVEL_PART, UNDECIDED, CONTRADICTION, None),
        (NO_PART, LEVEL_PART, UNDECIDED, CONTRADICTION, None),
        (LIMIT_PART, NO_PART, UNDECIDED, CONTRADICTION, None),
        (NO_PART, OPEN_PART, NO, GROWTH, None),
        (OPEN_PART, NO_PART, NO, GROWTH, None),
        (NO_PART, None, NO, GROWTH, None),
        (FALLING_PART, LEVEL_PART, YES, LEVEL, 3.0),
        (FALLING_PART, LIMIT_PART, YES, LIMIT, 3.05),
        (LIMIT_PART, FALLING_PART, YES, LIMIT, 3.05),
        (FALLING_PART, OTHER_LIMIT, UNDECIDED, CONTRADICTION, None),
        (FALLING_PART, NO_PART, UNDECIDED, CONTRADICTION, None),
        (OPEN_PART, part(UNDECIDED, ROUGH), UNDECIDED, SEVERAL, None),
        (None, part(UNDECIDED, NONE_FITS), UNDECIDED, NONE_FITS, None),
    ],
)
def test_two_parts_have_one_verdict(whole, interior, verdict, reason, limit):
    found = combined(whole, interior)
    assert (found.verdict, found.reason) == (verdict, reason)
    assert (found.limit.estimate if found.limit else None) == limit
    said = {one.verdict for one in found.decided_by}
    assert said == ({verdict} if verdict != UNDECIDED else set())


def test_the_interval_of_a_limit_is_of_both_parts_that_only_models_decide():
    other = part(YES, LIMIT, 3.1, 3.0, 3.2)
    both = combined(LIMIT_PART, other).limit
    assert (both.estimate, both.low, both.high) == (3.05, 2.95, 3.2)
    both = combined(other, LIMIT_PART).limit
    assert (both.estimate, both.low, both.high) == (3.1, 2.95, 3.2)
    for whole, interior in ((LIMIT_PART, FALLING_PART), (LIMIT_PART, OPEN_PART)):
        assert combined(whole, interior).limit == LIMIT_PART.limit
    assert combined(LIMIT_PART, LEVEL_PART).limit == LEVEL_PART.limit
    assert combined(FALLING_PART, FALLING_PART).limit.high == 3.2


def test_of_two_limits_the_whole_is_stated_unless_the_interior_is_level():
    assert combined(LIMIT_PART, part(YES, LIMIT, 3.0, 2.9, 3.1)).limit.estimate == 3.05
    assert combined(part(YES, LEVEL, 3.05, 2.9, 3.1), LEVEL_PART).limit.estimate == 3.0
