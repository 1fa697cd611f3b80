"""Whether the mean has a limit, which one, and whether the edge model's is that of the interior."""

from collections.abc import Iterator

from study.analysis.building import Study, builds
from study.analysis.parts import INTERIOR, PART, WHOLE
from study.analysis.table import DISTRIBUTION, METHOD, Column, Declaration, Row, Table, end
from study.analysis.trends import JUDGED_NOTE, STRUCK_OUT_NOTE, Trend, free_of_edge, trends
from study.statistics.edge_limit import edge_limit
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
    combined,
    limit_of,
)
from study.statistics.models import MODELS, THICKENING_EDGE
from study.statistics.power_family import ProfileInterval
from study.statistics.thresholds import (
    CLEAR_AIC,
    LEVEL_PER_DECADE,
    NEARLY_LOGARITHMIC,
    REFUTED_BELOW,
    SIGNIFICANCE,
)
from study.statistics.thresholds import LEVEL as OF_INTERVALS
from study.statistics.verdicts import UNDECIDED, YES, yes

#: Reason of a verdict for which the run has too few sizes.
FEW = "the run has too few sizes"
REASONS = {
    LEVEL: "the mean is level",
    LIMIT: "only models with a limit survive",
    BOUNDED: "it falls, and cannot fall below 1",
    GROWTH: "it grows like a logarithm or faster",
    ROUGH: "no change is seen, but one that counts is not excluded",
    SEVERAL: "models with and without a limit survive",
    NONE_FITS: "no model follows the means",
    CONTRADICTION: "the whole mesh and its interior contradict each other",
}
#: Why there is one verdict for both parts.
ONE_LIMIT = (
    "The whole mesh and its interior have one limit, as long as the edge's share of the triangles "
    "falls faster than its mean grows"
)

LIMIT_VERDICTS = Declaration(
    "limit_verdicts",
    "Whether the mean LEPP size has a limit",
    (
        METHOD,
        DISTRIBUTION,
        Column("has_limit", "Has a limit", "", "verdict"),
        Column("reason", "Why"),
        Column("decided_by", "Decided by"),
        Column("limit", "Limit", "triangles", "fixed4"),
        Column("limit_low", f"{OF_INTERVALS} from", "triangles", "fixed4"),
        Column("limit_high", f"{OF_INTERVALS} to", "triangles", "fixed4"),
        Column("limit_from", "Limit of"),
    ),
    note=f"{ONE_LIMIT}. Yes or no: the whole or the interior says so, and the other does not say "
    "the opposite; where both say yes, the intervals of their limits overlap. Undecided otherwise. "
    "The limit is the mean of the interior where that is level, else that of the whole mesh, and "
    "of the interior if only that has one; where only models with a limit decide, the ends are the "
    "furthest of both parts. All of it is among the models that are tried here.",
)

LIMIT_EVIDENCE = Declaration(
    "limit_evidence",
    "What the whole mesh and its interior say of a limit",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        Column("has_limit", "Has a limit", "", "verdict"),
        Column("reason", "Why"),
        Column("sizes", "Sizes", "", "int"),
        Column("smallest", "Smallest", "points", "int"),
        Column("survivors", "Models that survive"),
        Column("struck_out", "Struck out by the interior"),
        Column("per_decade", "Change with tenfold points", "triangles", "fixed4"),
        Column("per_decade_low", f"Change, {OF_INTERVALS} from", "triangles", "fixed4"),
        Column("per_decade_high", f"Change, {OF_INTERVALS} to", "triangles", "fixed4"),
        Column("power", "Power of growth", "", "fixed3"),
        Column("power_low", f"Power, {OF_INTERVALS} from", "", "fixed3"),
        Column("power_high", f"Power, {OF_INTERVALS} to", "", "fixed3"),
        Column("limit", "Limit", "triangles", "fixed4"),
        Column("limit_low", f"Limit, {OF_INTERVALS} from", "triangles", "fixed4"),
        Column("limit_high", f"Limit, {OF_INTERVALS} to", "triangles", "fixed4"),
    ),
    note=f"{JUDGED_NOTE} A model is out if lack of fit or sizes not seen refute it with p below "
    f"{REFUTED_BELOW} divided by the number of trends judged; if {STRUCK_OUT_NOTE}; or if its AIC "
    f"is {CLEAR_AIC:g} above that of one that is neither; none is refuted while one that it "
    "contains is not. Yes: a constant survives and the change "
    f"with each tenfold number of points is surely no more than {LEVEL_PER_DECADE:g}; or a model "
    "with a limit survives and every one without is out, where the power model c + a x^s counts "
    f"as one only if surely s < {NEARLY_LOGARITHMIC:g}, for an s nearer to 0 follows ln ln n or "
    "the root of ln n, which have no limit, too well; or the mean surely falls, for what falls "
    "without end comes below 1, the size of the shortest path: the limit is then below the mean of "
    "the largest size, by how much is open. No: growth without limit survives, edge models "
    f"are out, and s is surely above {NEARLY_LOGARITHMIC:g}: no limit is in sight, as far as the "
    "data reach. Undecided otherwise. Surely means with all of the profile likelihood interval; an "
    "empty end says that the data set none. The powers are those of s. The limit is that of the "
    "model with the lowest AIC, its interval from the lowest end to the highest of all models with "
    "a limit that survive.",
)

LIMITS = Declaration(
    "limits",
    "Limits of the models that have one",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        Column("model", "Model"),
        Column("value", "Limit", "triangles", "fixed4"),
        Column("low", f"{OF_INTERVALS} from", "triangles", "fixed4"),
        Column("high", f"{OF_INTERVALS} to", "triangles", "fixed4"),
    ),
    note="Weighted fits to all sizes, whether the model survives or not. Intervals by profile "
    "likelihood, with the F quantile of the pure error: all limits with which the fit is not "
    "significantly worse than the best. An empty end says that there is none: the model is "
    "then no worse as a logarithm. A saturating model that grows like a logarithm or faster has "
    "no limit, and no row.",
)

EDGE_LIMITS = Declaration(
    "edge_limits",
    "The limit of the edge model and the mean of the interior",
    (
        METHOD,
        DISTRIBUTION,
        Column("limit", "Limit of the whole", "triangles", "fixed4"),
        Column("interior", "Mean of the interior", "triangles", "fixed4"),
        Column("level", "Interior is level", "", "verdict"),
        Column("difference", "Difference", "triangles", "fixed4"),
        Column("standard_error", "Standard error", "triangles", "g2"),
        Column("t", "Difference", "standard errors", "fixed2"),
        Column("p", "p", "", "p"),
        Column("agrees", "Agrees", "", "verdict"),
    ),
    note=f"The limit c of the model {THICKENING_EDGE.formula} of the whole mesh, against the "
    "weighted mean of the interior over the sizes where it is free of the edge, or over the larger "
    "half of the sizes if those are too few. Level: a constant survives. Only a level mean is a "
    "limit; of any other, the difference says little. Both are of the same triangulations, and "
    f"the standard error counts what they share. Agrees: p of at least {SIGNIFICANCE}.",
)


@builds(LIMIT_VERDICTS, LIMIT_EVIDENCE, LIMITS, EDGE_LIMITS)
def limits(study: Study) -> Iterator[Table]:
    """Judge every method and distribution, and its parts."""
    judged = {_place(trend.key): (trend, trend.verdict) for trend in trends(study.data)}
    verdicts = {place: verdict for place, (_, verdict) in judged.items()}
    yield LIMIT_VERDICTS.table(
        {"method": method, "distribution": distribution}
        | _verdict(
            verdicts.get((method, distribution, WHOLE)),
            verdicts.get((method, distribution, INTERIOR)),
        )
        for method, distribution in study.data.populations
    )
    yield LIMIT_EVIDENCE.table(
        trend.key | _evidence(trend, found) for trend, found in judged.values()
    )
    yield LIMITS.table(row for trend, _ in judged.values() for row in _limits(trend))
    levels = {place for place, (trend, _) in judged.items() if trend.level is not None}
    yield EDGE_LIMITS.table(_edge_limits(study, levels))


def _place(key: Row) -> tuple[object, ...]:
    return key["method"], key["distribution"], key["part"]


def _interval(name: str, interval: ProfileInterval | None) -> Row:
    if interval is None:
        return {}
    return {
        name: end(interval.estimate),
        f"{name}_low": end(interval.low),
        f"{name}_high": end(interval.high),
    }


def _verdict(whole: LimitVerdict | None, interior: LimitVerdict | None) -> Row:
    if whole is None and interior is None:
        return {"has_limit": UNDECIDED, "reason": FEW}
    found = combined(whole, interior)
    parts = {WHOLE: whole, INTERIOR: interior}
    row: Row = {
        "has_limit": found.verdict,
        "reason": REASONS[found.reason],
        "decided_by": " and ".join(
            name for name, part in parts.items() if any(part is one for one in found.decided_by)
        ),
    }
    if found.verdict == YES:
        row["limit_from"] = next(n for n, part in parts.items() if part is found.decided_by[0])
    return row | _interval("limit", found.limit)


def _evidence(trend: Trend, found: LimitVerdict | None) -> Row:
    sizes: Row = {"sizes": len(trend.means), "smallest": int(trend.means.n_points[0])}
    if found is None:
        return {"has_limit": UNDECIDED, "reason": FEW} | sizes
    row: Row = {
        "has_limit": found.verdict,
        "reason": REASONS[found.reason],
        "survivors": ", ".join(one.model.name for one in found.survivors),
        "struck_out": ", ".join(
            one.model.name for one in trend.candidates if one.struck_out and not one.refuted
        ),
    }
    return (
        row
        | sizes
        | _interval("per_decade", found.per_decade)
        | _interval("power", found.power)
        | _interval("limit", found.limit)
    )


def _limits(trend: Trend) -> Iterator[Row]:
    for model in MODELS:
        if model.has_limit and len(trend.means) > len(model.terms):
            try:
                found = limit_of(model, trend.means)
            except NotEnough:  # no saturation: the note says so
                continue
            yield trend.key | {
                "model": model.name,
                "value": found.estimate,
                "low": end(found.low),
                "high": end(found.high),
            }


def _edge_limits(study: Study, levels: set[tuple[object, ...]]) -> Iterator[Row]:
    for method, distribution in study.data.populations:
        whole = study.data.groups(method, distribution, WHOLE)
        interior = free_of_edge(study.data, method, distribution) or _larger_half(
            study.data.groups(method, distribution, INTERIOR)
        )
        try:
            found = edge_limit(THICKENING_EDGE, whole, interior)
        except NotEnough:  # too small a run
            continue
        yield {
            "method": method,
            "distribution": distribution,
            "limit": found.limit,
            "interior": found.interior,
            "level": yes((method, distribution, WHOLE) in levels),
            "difference": found.difference,
            "standard_error": found.standard_error,
            "t": found.t,
            "p": found.p,
            "agrees": yes(found.p >= SIGNIFICANCE),
        }


def _larger_half(groups: Groups) -> Groups:
    half = len(groups) // 2
    return Groups(groups.n_points[half:], groups.values[half:])
