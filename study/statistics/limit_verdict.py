"""Whether a mean that depends on the number of points has a limit: yes, no or undecided.

Every model is refuted or not, by its lack of fit to all sizes and by the sizes it has not seen; of
those that are not, some have a limit and some have none. What then is said:

- *yes*, if the mean is level: a constant survives, and the interval of the change with each tenfold
  number of points holds none that counts;
- *yes*, if a model with a limit survives, and every model without one is out. The saturating model
  c - a x^(-b) counts as one only if all of the profile interval of the power lambda = -b is below
  `NEARLY_LOGARITHMIC`: for b -> 0 it is the logarithm, and with a small b it follows ln ln n or
  (ln n)^(1/2) as far as anyone can compute, neither of which has a limit;
- *yes*, if the mean surely falls, and any of these models survives: what falls without end comes
  below 1, and no mean of sizes of paths does. Where the limit is stays open downwards;
- *no*, if a growth without limit survives, both edge models are out, and all of the interval of
  lambda is above `NEARLY_LOGARITHMIC`. No limit is then in sight; that there is none at all, no
  finite data can say;
- *undecided* otherwise.

A model is out if it is refuted, if it has another limit than a level mean that must have the same,
or if its AIC is `CLEAR_AIC` above that of one that is neither. None is refuted while one that it
contains is not: they differ in degrees of freedom alone. A power model that is best as the
logarithm, at the end of its powers, is none of its own.

The whole mesh and its interior must have one limit: the edge's share of the triangles tends to 0.
`combined` is the verdict of both.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from study.statistics.groups import NotEnough
from study.statistics.intervals import t_quantile
from study.statistics.model_scores import (
    Score,
    coefficient_interval,
    lack_of_fit,
    prediction_score,
    sizes_to_fit,
)
from study.statistics.models import (
    CONSTANT,
    EDGE_MODELS,
    LOGARITHMIC,
    MODELS,
    SATURATING,
    LinearModel,
    Model,
)
from study.statistics.power_family import PowerFamily, ProfileInterval
from study.statistics.size_means import SizeMeans
from study.statistics.thresholds import (
    CLEAR_AIC,
    LEVEL_PER_DECADE,
    NEARLY_LOGARITHMIC,
    REFUTED_BELOW,
)
from study.statistics.verdicts import NO, UNDECIDED, YES

#: Sizes that a verdict needs; so many of them are fitted to, at the least.
LEAST_SIZES, LEAST_FITTED = 5, 4

#: What decides.
LEVEL, LIMIT, BOUNDED, GROWTH = "level", "limit", "bounded", "growth"
ROUGH, SEVERAL, NONE_FITS = "rough", "several", "none fits"
#: What else may decide of two parts that must have one limit.
CONTRADICTION = "contradiction"


@dataclass(frozen=True)
class Candidate:
    """A model, how it fits all sizes, and how it predicts those it has not seen.

    Attributes
    ----------
    model : LinearModel or SaturatingModel
    fit, prediction : Score
    aic : float
        With the variances known, up to what all models have in common.
    refuted_below : float
        The p of either score below which the model is refuted.
    struck_out : bool
        Whether its limit is not that of a level mean that must have the same.
    contains_one_that_stands : bool
        Whether a model that it contains is not refuted.
    """

    model: Model
    fit: Score
    prediction: Score
    aic: float
    refuted_below: float
    struck_out: bool
    contains_one_that_stands: bool

    @property
    def refuted(self) -> bool:
        """By either score, and with all models that it contains."""
        low = min(self.fit.p, self.prediction.p) < self.refuted_below
        return low and not self.contains_one_that_stands


@dataclass(frozen=True)
class LimitVerdict:
    """Whether there is a limit, and what decides it.

    Attributes
    ----------
    verdict : str
        YES, NO or UNDECIDED of `study.statistics.verdicts`.
    reason : str
        For yes LEVEL, LIMIT or BOUNDED, for no GROWTH; else ROUGH (no change is seen, but one
        that counts is not excluded), SEVERAL (models with and without a limit survive) or
        NONE_FITS.
    survivors : tuple of Candidate
        All that are not out, the lowest AIC first.
    power : ProfileInterval
        lambda.
    per_decade : ProfileInterval
        Change of the mean with each tenfold number of points, by the logarithm.
    limit : ProfileInterval or None
        If the verdict is yes. Of the surviving model of the lowest AIC that has one; its ends are
        the furthest that any surviving model with a limit has. For BOUNDED only its upper end is
        known: that of the mean of the largest size.
    """

    verdict: str
    reason: str
    survivors: tuple[Candidate, ...]
    power: ProfileInterval
    per_decade: ProfileInterval
    limit: ProfileInterval | None = None


@dataclass(frozen=True)
class OneLimit:
    """Whether two parts that must have one limit have it.

    Attributes
    ----------
    verdict, reason : str
        As of `LimitVerdict`; UNDECIDED also for CONTRADICTION: the parts say different things.
    decided_by : tuple of LimitVerdict
        Those that say yes or no where the verdict does.
    limit : ProfileInterval or None
        The one that is stated, if the verdict is yes.
    """

    verdict: str
    reason: str
    decided_by: tuple[LimitVerdict, ...] = ()
    limit: ProfileInterval | None = None


def candidates(
    means: SizeMeans,
    fitted: np.ndarray,
    refuted_below: float = REFUTED_BELOW,
    level: ProfileInterval | None = None,
) -> tuple[Candidate, ...]:
    """Score every model that the sizes suffice for.

    Parameters
    ----------
    means : SizeMeans
    fitted : (g,) bool ndarray
        Which sizes models are fitted to before they predict the others.
    refuted_below : float
        `REFUTED_BELOW`, divided by the number of trends that are judged (Bonferroni).
    level : ProfileInterval, optional
        `level_mean` of a part that must have the same limit.
    """
    scored: list[Candidate] = []
    for model in _models_of_their_own(means):
        try:
            fit = lack_of_fit(model, means)
            prediction = prediction_score(model, means, fitted)
        except NotEnough:
            continue
        aic = fit.chi_squared + 2 * len(model.terms)
        struck_out = level is not None and _has_another_limit(model, means, level)
        stands = any(one.model.name in model.contains and not one.refuted for one in scored)
        scored.append(Candidate(model, fit, prediction, aic, refuted_below, struck_out, stands))
    return tuple(scored)


def judge(
    means: SizeMeans,
    published_up_to: int,
    refuted_below: float = REFUTED_BELOW,
    level: ProfileInterval | None = None,
) -> LimitVerdict:
    """Say whether the mean has a limit.

    Parameters
    ----------
    means : SizeMeans
    published_up_to : int
        Models are fitted to sizes up to this, before they predict the others.
    refuted_below, level
        As of `candidates`.

    Raises
    ------
    NotEnough
        For fewer than `LEAST_SIZES` sizes.
    """
    fitted = sizes_to_fit(means.n_points, published_up_to, LEAST_FITTED)
    return conclude(means, candidates(means, fitted, refuted_below, level))


def conclude(means: SizeMeans, scored: Iterable[Candidate]) -> LimitVerdict:
    """Say from models that are scored already whether the mean has a limit; else as `judge`."""
    if len(means) < LEAST_SIZES:
        raise NotEnough(f"a verdict on the limit needs {LEAST_SIZES} sizes, not {len(means)}")
    survivors = survivors_of(scored)
    family = PowerFamily(means)
    decade = per_decade(means)
    verdict, reason = _verdict(survivors, family, decade)
    limit = _limit(means, survivors, reason) if verdict == YES else None
    return LimitVerdict(verdict, reason, survivors, family.power, decade, limit)


def combined(whole: LimitVerdict | None, interior: LimitVerdict | None) -> OneLimit:
    """Say whether the whole mesh and its interior have their one limit.

    Parameters
    ----------
    whole, interior : LimitVerdict or None
        None for too few sizes; not both.

    Returns
    -------
    OneLimit
        Yes or no if one part says so, and the other does not say the opposite; no two limits may
        exclude each other. The limit that is stated is the interior's where it is level, else that
        of the whole, if it is known on both sides. Where only models with a limit decide, its ends
        are the furthest of both parts.
    """
    parts = [part for part in (whole, interior) if part is not None]
    of_limits = sorted(
        (part for part in parts if part.verdict == YES),
        key=lambda part: (part.reason != LEVEL or part is not interior, part.reason == BOUNDED),
    )
    growing = tuple(part for part in parts if part.verdict == NO)
    limits = [part.limit for part in of_limits if part.limit is not None]
    if (of_limits and growing) or (len(limits) == 2 and _apart(*limits)):
        return OneLimit(UNDECIDED, CONTRADICTION)
    if of_limits:
        return OneLimit(YES, of_limits[0].reason, tuple(of_limits), _spanned(of_limits))
    if growing:
        return OneLimit(NO, GROWTH, growing)
    return OneLimit(UNDECIDED, parts[0].reason)


def level_mean(
    means: SizeMeans, published_up_to: int, refuted_below: float = REFUTED_BELOW
) -> ProfileInterval | None:
    """Give the mean that a limit has to be near, if a constant survives; None otherwise.

    Its interval is wider by the most that a tenfold number of points may change the mean, unseen.

    Parameters
    ----------
    means, published_up_to, refuted_below
        As of `judge`.

    Raises
    ------
    NotEnough
        As `judge`.
    """
    verdict = judge(means, published_up_to, refuted_below)
    if CONSTANT not in [one.model for one in verdict.survivors]:
        return None
    mean, change = limit_of(CONSTANT, means), verdict.per_decade
    unseen = max(-change.low, change.high)
    return ProfileInterval(mean.estimate, mean.low - unseen, mean.high + unseen)


def per_decade(means: SizeMeans) -> ProfileInterval:
    """Change of the mean with each tenfold number of points, if it is logarithmic."""
    return _scaled(coefficient_interval(LOGARITHMIC, means, 1), float(np.log2(10)))


def limit_of(model: Model, means: SizeMeans) -> ProfileInterval:
    """Limit of a model that has one, with its interval.

    Raises
    ------
    NotEnough
        If the saturating model has none that can be seen.
    """
    if isinstance(model, LinearModel):
        return coefficient_interval(model, means, 0)
    return PowerFamily(means).value(np.inf)


def _verdict(
    survivors: tuple[Candidate, ...], family: PowerFamily, decade: ProfileInterval
) -> tuple[str, str]:
    names = {one.model.name for one in survivors}
    if CONSTANT.name in names and max(-decade.low, decade.high) <= LEVEL_PER_DECADE:
        return YES, LEVEL
    if CONSTANT.name in names and decade.low <= 0 <= decade.high:
        return UNDECIDED, ROUGH
    grows = any(one.model.has_limit is False for one in survivors)
    edge = any(model.name in names for model in EDGE_MODELS)
    saturates = SATURATING.name in names and family.power.high < NEARLY_LOGARITHMIC
    if not grows and (edge or saturates):
        return YES, LIMIT
    some = any(one.model.has_limit is not None for one in survivors)
    if some and decade.high < 0:
        return YES, BOUNDED
    if grows and not edge and family.power.low > NEARLY_LOGARITHMIC:
        return NO, GROWTH
    return UNDECIDED, SEVERAL if some else NONE_FITS


def _limit(means: SizeMeans, survivors: tuple[Candidate, ...], reason: str) -> ProfileInterval:
    if reason == LEVEL:
        return limit_of(CONSTANT, means)
    if reason == BOUNDED:
        half = t_quantile(means.df) * float(np.sqrt(means.variances[-1]))
        return ProfileInterval(np.nan, -np.inf, float(means.means[-1]) + half)
    with_limit = [one.model for one in survivors if one.model in (*EDGE_MODELS, SATURATING)]
    limits = []
    for model in with_limit:
        try:
            limits.append(limit_of(model, means))
        except NotEnough:  # the saturating model beside an edge that survives
            continue
    return ProfileInterval(
        limits[0].estimate, min(one.low for one in limits), max(one.high for one in limits)
    )


def _spanned(parts: list[LimitVerdict]) -> ProfileInterval | None:
    limit = parts[0].limit
    if limit is None or parts[0].reason != LIMIT:
        return limit
    same = [part.limit for part in parts if part.reason == LIMIT and part.limit is not None]
    return ProfileInterval(
        limit.estimate, min(one.low for one in same), max(one.high for one in same)
    )


def _models_of_their_own(means: SizeMeans) -> Iterator[Model]:
    try:
        power, _ = PowerFamily(means).best()
    except NotEnough:  # nor for a model with a power
        power = 0.0
    for model in MODELS:
        if isinstance(model, LinearModel) or model.powers[0] < power < model.powers[1]:
            yield model


def _has_another_limit(model: Model, means: SizeMeans, level: ProfileInterval) -> bool:
    if not model.has_limit:
        return False
    try:
        return _apart(limit_of(model, means), level)
    except NotEnough:  # the saturating model has no limit that can be seen
        return False


def _apart(one: ProfileInterval, other: ProfileInterval) -> bool:
    return one.low > other.high or other.low > one.high


def _scaled(interval: ProfileInterval, by: float) -> ProfileInterval:
    return ProfileInterval(interval.estimate * by, interval.low * by, interval.high * by)


def survivors_of(scored: Iterable[Candidate]) -> tuple[Candidate, ...]:
    """Return the candidates that are not out, the lowest AIC first."""
    left = sorted(
        (one for one in scored if not one.refuted and not one.struck_out), key=lambda one: one.aic
    )
    return tuple(one for one in left if one.aic - left[0].aic <= CLEAR_AIC)
