"""Whether the mean has a limit, which one, and whether the edge model's is that of the interior."""

from collections.abc import Iterator

from study.analysis.building import Study, builds
from study.analysis.model_scores import PUBLISHED_UP_TO
from study.analysis.parts import INTERIOR, PART, PARTS, WHOLE
from study.analysis.table import DISTRIBUTION, METHOD, Column, Declaration, Row, Table, end
from study.statistics.edge_limit import edge_limit
from study.statistics.groups import Groups, NotEnough
from study.statistics.limit_verdict import (
    GROWTH,
    LEVEL,
    LIMIT,
    NONE_FITS,
    ROUGH,
    SEVERAL,
    judge,
    limit_of,
    per_decade,
)
from study.statistics.model_scores import lack_of_fit
from study.statistics.models import CONSTANT, MODELS, THICKENING_EDGE
from study.statistics.size_means import SizeMeans
from study.statistics.thresholds import (
    CLEAR_AIC,
    LEVEL_PER_DECADE,
    NEARLY_LOGARITHMIC,
    REFUTED_BELOW,
    SIGNIFICANCE,
)
from study.statistics.thresholds import LEVEL as OF_INTERVALS
from study.statistics.verdicts import UNDECIDED, yes

#: Sizes that it takes to call the interior level.
_LEAST_LEVEL = 3
#: Reason of a verdict for which the run has too few sizes.
FEW = "the run has too few sizes"
REASONS = {
    LEVEL: "the mean is level",
    LIMIT: "only models with a limit survive",
    GROWTH: "it grows like a logarithm or faster",
    ROUGH: "no change is seen, but one that counts is not excluded",
    SEVERAL: "models with and without a limit survive",
    NONE_FITS: "no model follows the means",
}

LIMIT_VERDICTS = Declaration(
    "limit_verdicts",
    "Whether the mean LEPP size has a limit",
    (
        METHOD,
        DISTRIBUTION,
        PART,
        Column("has_limit", "Has a limit", "", "verdict"),
        Column("reason", "Decided by"),
        Column("survivors", "Models that survive"),
        Column("per_decade", "Change with tenfold points", "triangles", "fixed4"),
        Column("per_decade_low", f"{OF_INTERVALS} from", "triangles", "fixed4"),
        Column("per_decade_high", f"{OF_INTERVALS} to", "triangles", "fixed4"),
        Column("power", "Power", "", "fixed3"),
        Column("power_low", f"{OF_INTERVALS} from", "", "fixed3"),
        Column("power_high", f"{OF_INTERVALS} to", "", "fixed3"),
        Column("limit", "Limit", "triangles", "fixed4"),
        Column("limit_low", f"{OF_INTERVALS} from", "triangles", "fixed4"),
        Column("limit_high", f"{OF_INTERVALS} to", "triangles", "fixed4"),
    ),
    note="A model is out if lack of fit or sizes not seen refute it with p below "
    f"{REFUTED_BELOW}, or if its AIC is {CLEAR_AIC:g} above that of one that is not refuted. Yes: "
    "a constant survives and the change with each tenfold number of points is surely no more than "
    f"{LEVEL_PER_DECADE:g}; or a model with a limit survives and every one without is out, where "
    f"c - a x^(-b) counts only if surely b > {-NEARLY_LOGARITHMIC:g}, for a lower power follows "
    "ln ln n or the root of ln n, which have no limit, too well. No: growth without limit "
    "survives, edge models are out, and the power of growth lambda = -b is surely above "
    f"{NEARLY_LOGARITHMIC:g}: no limit is in sight, as far as the data reach. Undecided "
    "otherwise. Surely means with all of the profile likelihood interval; an empty end "
    "says that the data set none. The limit is that of the model with the lowest AIC, its interval "
    "from the lowest end to the highest of all models with a limit that survive.",
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
        Column("difference", "Difference", "triangles", "fixed4"),
        Column("standard_error", "Standard error", "triangles", "g2"),
        Column("t", "Difference", "standard errors", "fixed2"),
        Column("p", "p", "", "p"),
        Column("agrees", "Agrees", "", "verdict"),
    ),
    note=f"The limit c of the model {THICKENING_EDGE.formula} of the whole mesh, against the "
    "weighted mean of the interior over the larger half of the sizes; only where that is level: a "
    "constant is not refuted, and the interval of its change with the number of points has 0 in "
    "it. Both are of the same triangulations, and the standard error counts what they share. "
    "Agrees: p of at "
    f"least {SIGNIFICANCE}.",
)


@builds(LIMIT_VERDICTS, LIMITS, EDGE_LIMITS)
def limits(study: Study) -> Iterator[Table]:
    """Judge every method, distribution and part."""
    yield LIMIT_VERDICTS.table(_verdicts(study))
    yield LIMITS.table(_limits(study))
    yield EDGE_LIMITS.table(_edge_limits(study))


def _means(study: Study) -> Iterator[tuple[Row, SizeMeans | None]]:
    for method, distribution in study.data.populations:
        for part in PARTS:
            key: Row = {"method": method, "distribution": distribution, "part": part}
            try:
                yield key, SizeMeans.of(study.data.groups(method, distribution, part))
            except NotEnough:
                yield key, None


def _verdicts(study: Study) -> Iterator[Row]:
    for key, means in _means(study):
        yield key | (_verdict(means) if means is not None else _too_few())


def _too_few() -> Row:
    return {"has_limit": UNDECIDED, "reason": FEW}


def _verdict(means: SizeMeans) -> Row:
    try:
        found = judge(means, PUBLISHED_UP_TO)
    except NotEnough:
        return _too_few()
    row: Row = {
        "has_limit": found.verdict,
        "reason": REASONS[found.reason],
        "survivors": ", ".join(one.model.name for one in found.survivors),
    }
    for name, interval in (
        ("per_decade", found.per_decade), ("power", found.power), ("limit", found.limit),
    ):  # fmt: skip
        if interval is not None:
            row |= {
                name: interval.estimate,
                f"{name}_low": end(interval.low),
                f"{name}_high": end(interval.high),
            }
    return row


def _limits(study: Study) -> Iterator[Row]:
    for key, means in _means(study):
        if means is None:
            continue
        for model in MODELS:
            if model.has_limit and len(means) > len(model.terms):
                try:
                    found = limit_of(model, means)
                except NotEnough:  # no saturation: the note says so
                    continue
                yield key | {
                    "model": model.name,
                    "value": found.estimate,
                    "low": end(found.low),
                    "high": end(found.high),
                }


def _edge_limits(study: Study) -> Iterator[Row]:
    for method, distribution in study.data.populations:
        whole = study.data.groups(method, distribution, WHOLE)
        interior = _larger_half(study.data.groups(method, distribution, INTERIOR))
        try:
            if not _is_level(SizeMeans.of(interior)):
                continue
            found = edge_limit(THICKENING_EDGE, whole, interior)
        except NotEnough:  # the note says when there is one
            continue
        yield {
            "method": method,
            "distribution": distribution,
            "limit": found.limit,
            "interior": found.interior,
            "difference": found.difference,
            "standard_error": found.standard_error,
            "t": found.t,
            "p": found.p,
            "agrees": yes(found.p >= SIGNIFICANCE),
        }


def _larger_half(groups: Groups) -> Groups:
    half = len(groups) // 2
    return Groups(groups.n_points[half:], groups.values[half:])


def _is_level(means: SizeMeans) -> bool:
    if len(means) < _LEAST_LEVEL:
        return False
    decade = per_decade(means)
    return lack_of_fit(CONSTANT, means).p >= REFUTED_BELOW and decade.low <= 0 <= decade.high
