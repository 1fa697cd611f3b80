"""Whether the paper is consistent with itself: what it prints beside what its own Table 4 gives.

No measurement of ours enters.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from study.analysis.bound_tests import UPPER_BOUND
from study.analysis.building import Study, rows_of
from study.analysis.table import N_POINTS, Column, Declaration, Row
from study.paper import published
from study.paper.judging import CONSISTENT, MISPRINT
from study.paper.published import REPETITIONS, SHOWN, Number
from study.statistics.models import LINEAR_MODELS
from study.statistics.rounding import Range, RoundedGroups, RoundedRegression, Statistic
from study.statistics.tails import log10_f_tail, log10_t_tail
from study.statistics.verdicts import UNDECIDED

#: Which table of the paper a row is about.
PUBLISHED_TABLE = Column("published_table", "Published table", "", "int")

CONSISTENCY = Declaration(
    "consistency",
    "The paper's numbers recomputed from its Table 4",
    (
        PUBLISHED_TABLE,
        Column("quantity", "Quantity"),
        N_POINTS,
        Column("printed", "Printed"),
        Column("recomputed", "From Table 4", "", "g5"),
        Column("low", "At least", "", "g5"),
        Column("high", "At most", "", "g5"),
        Column("attained_low", "Attained from", "", "g5"),
        Column("attained_high", "Attained to", "", "g5"),
        Column("verdict", "Verdict", "", "verdict"),
    ),
    note="Table 5, the uniform column of Table 6 and all of Table 7 follow from the 20 means and "
    "standard deviations of Table 4, each of which is rounded. At least and at most are proven "
    "bounds of what all data give that round to Table 4; exact for the coefficients and the t "
    "tests, and to the second order in the rounding for F and what follows from it, R² and "
    "p. The logistic model is fitted to logits, whose spread Table 4 fixes only roughly: its "
    "bounds hold for any data, and are wider. "
    f"{CONSISTENT.capitalize()}: what rounds to the printed number meets the range that made-up "
    f"data reach which round to Table 4; {MISPRINT}: it lies outside the bounds, so that no data "
    f"give both; {UNDECIDED}: between.",
)


@dataclass(frozen=True)
class Recomputed:
    """A published number beside what Table 4 gives.

    Attributes
    ----------
    number : Number
    value : float
        From the printed means and standard deviations.
    bounds : tuple of float
        Beyond which no data lie that round to Table 4.
    attained : tuple of float
        Between which such data are known.
    """

    number: Number
    value: float
    bounds: Range
    attained: Range

    @property
    def verdict(self) -> str:
        """Whether the printed number can belong to Table 4."""
        low, high = self.number.rounded_from
        if low > self.bounds[1] or high < self.bounds[0]:
            return MISPRINT
        meets = low <= self.attained[1] and high >= self.attained[0]
        return CONSISTENT if meets else UNDECIDED


@dataclass(frozen=True)
class _Ranges:
    """A statistic of Table 4: its value, the bounds that hold for it, and what it attains."""

    value: float
    bounds: Range
    attained: Range

    @classmethod
    def of(cls, groups: RoundedGroups, statistic: Statistic, bounds: Range) -> "_Ranges":
        """Evaluate a statistic of means and standard deviations whose bounds are known."""
        value = statistic(groups.means, groups.sds)
        return cls(value, bounds, groups.attained(statistic))

    def growing(self, function: Callable[[float], float]) -> "_Ranges":
        """Give the ranges of a function that grows with the statistic."""
        return _Ranges(
            function(self.value),
            (function(self.bounds[0]), function(self.bounds[1])),
            (function(self.attained[0]), function(self.attained[1])),
        )

    def falling(self, function: Callable[[float], float]) -> "_Ranges":
        """Give the ranges of a function that falls as the statistic grows."""
        made = self.growing(function)
        return _Ranges(made.value, made.bounds[::-1], made.attained[::-1])

    def of_number(self, number: Number) -> Recomputed:
        """Put a published number beside them."""
        return Recomputed(number, self.value, self.bounds, self.attained)


def _p_of_f(regression: RoundedRegression, f: float) -> float:
    return float(10 ** log10_f_tail(f, *regression.df))


def _p_of_t(t: float) -> float:
    """Find p of a mean that lies below the bound, as -t does above it."""
    return float(10 ** log10_t_tail(-t, REPETITIONS - 1))


@rows_of(CONSISTENCY)
def consistency(_: Study) -> Iterator[Row]:
    """Recompute every number that follows from Table 4."""
    for one in recomputed():
        yield {
            "published_table": one.number.table,
            "quantity": one.number.quantity,
            "n_points": one.number.n_points,
            "printed": one.number.printed,
            "recomputed": one.value,
            "low": one.bounds[0],
            "high": one.bounds[1],
            "attained_low": one.attained[0],
            "attained_high": one.attained[1],
            "verdict": one.verdict,
        }


def table_4_groups() -> RoundedGroups:
    """Means and standard deviations as Table 4 prints them."""
    rows = published.table_4()
    return RoundedGroups(
        x=np.array(published.sizes()) / 1000,
        means=np.array([mean.value for _, _, mean, _ in rows]),
        sds=np.array([sd.value for *_, sd in rows]),
        mean_half=rows[0][2].unit / 2,
        sd_half=rows[0][3].unit / 2,
        count=REPETITIONS,
    )


@cache
def recomputed() -> tuple[Recomputed, ...]:
    """All numbers that follow from Table 4, in the order of the paper's tables."""
    groups = table_4_groups()
    return (*_table_5(groups), *_table_6(groups), *_table_7(groups))


def _table_5(groups: RoundedGroups) -> Iterator[Recomputed]:
    _, _, f, p = published.f_test(5)
    anova = RoundedRegression(groups)
    ranges = _Ranges.of(groups, anova.f, anova.f_range())
    yield ranges.of_number(f)
    yield ranges.falling(partial(_p_of_f, anova)).of_number(p)


def _table_6(groups: RoundedGroups) -> Iterator[Recomputed]:
    place = {size: i for i, size in enumerate(published.sizes())}
    for number in published.table_6():
        if number.distribution != SHOWN or number.n_points is None:
            continue
        group = place[number.n_points]
        t = groups.t_range(group, UPPER_BOUND)
        middle = groups.t_statistic(group, UPPER_BOUND)(groups.means, groups.sds)
        # Of t below the bound, p grows with t.
        yield _Ranges(middle, t, t).growing(_p_of_t).of_number(number)


def _table_7(groups: RoundedGroups) -> Iterator[Recomputed]:
    fitted = {model.name: RoundedRegression(groups, model) for model in LINEAR_MODELS}
    terms = {model.name: model.terms for model in LINEAR_MODELS}
    for model, term, number in published.coefficients():
        place = terms[model].index(term)
        regression = fitted[model]
        ranges = _Ranges.of(
            groups, regression.coefficient(place), regression.coefficient_range(place)
        )
        yield ranges.of_number(number)
        if (model, term) == ("linear", "b"):
            yield ranges.of_number(published.linear_slope_as_printed())
    for model, r2, p in published.fits():
        regression = fitted[model]
        ranges = _Ranges.of(groups, regression.f, regression.f_range())
        yield ranges.growing(regression.adjusted_r2).of_number(r2)
        yield ranges.falling(partial(_p_of_f, regression)).of_number(p)
