"""What is said of growth: which models survive, the limit, projections, the paper's regressions."""

from functools import cache

import numpy as np
import statsmodels.api as sm
from expected import Sheet, either, listed, plural
from growth import (
    BASES,
    MODELS,
    NEAR,
    PUBLISHED_UP_TO,
    Means,
    OneLimit,
    fitted_sizes,
    free_of_edge,
    level_mean,
    limit_of,
    linear,
    means,
    means_of,
    one_limit,
    per_decade,
    predicted,
    refuted_below,
    scores,
    survivors,
    value_interval,
)
from recounts import View, recount
from run_data import INTERIOR, WHOLE, Groups, Run, log10_f_tail
from scipy import special, stats


def _models(names: list[str]) -> str:
    return f"{listed(names)} {plural(len(names), 'model survives', 'models survive')}"


_MEAN_OF = {WHOLE: "the mean of the whole mesh", INTERIOR: "the mean of the interior"}


def _with_a_limit(found: OneLimit, key: tuple, it: str, s: Sheet) -> str:
    if found.reason == "the mean is level":
        value, low, high = found.limit or (np.nan,) * 3
        start = 1000 * means(*key, found.part).x[0]
        return (
            f"{it} has a limit: {_MEAN_OF[found.part]} is level, as far as the data reach, for a "
            "constant survives, and it changes by no more than 0.001 with each tenfold "
            f"number of points from {s(start)} on; the limit is "
            f"{s(value)} (95 % from {s(low)} to {s(high)})."
        )
    scored, left = scores(*key, found.part), survivors(*key, found.part)
    if found.reason.startswith("it falls"):
        return (
            f"{it} has a limit: {_MEAN_OF[found.part]} falls, and no mean falls below 1, the size "
            "of the shortest path."
        )
    names = [
        f"{name} (p = {s.p(np.log10(one.fit_p), 1e-4)} for the fit to all sizes, "
        f"{s.p(np.log10(one.prediction_p), 1e-4)} for sizes not seen)"
        for name, one in scored.items()
        if name in left and MODELS[name][1]
    ]
    whose = "the whole mesh" if found.part == WHOLE else "the interior"
    return (
        f"{it} has a limit, among the {s(len(scored))} models tried: all that have none are "
        f"out for {whose}, and the {_models(names)}."
    )


def verdict_sentence(key: tuple, it: str, s: Sheet) -> str:
    """The verdict on a limit, in words."""
    found = one_limit(*key)
    assert found is not None
    opening = it[0].upper() + it[1:]
    if found.word == "yes":
        return _with_a_limit(found, key, opening, s)
    if found.word == "no":
        return (
            f"{opening} has no limit in sight, among the models tried: "
            f"{'it' if found.part == WHOLE else _MEAN_OF[found.part]} grows like a logarithm of "
            "the number of points or faster."
        )
    stays = f"Whether {it} has a limit stays undecided:"
    if found.reason.startswith("no change"):
        _, low, high = per_decade(key, found.part)
        return (
            f"{stays} no change is seen, but with each tenfold number of points it may be from "
            f"{s(low)} to {s(high)}."
        )
    if found.reason != "models with and without a limit survive":
        return f"{stays} {found.reason}."
    left = set(survivors(*key, found.part))
    names = [[m for m in MODELS if m in left and MODELS[m][1] is has] for has in (True, False)]
    if not names[1]:
        return (
            f"{stays} the {_models(names[0])}, but it may follow a power that no one can tell from "
            "a logarithm."
        )
    if not names[0]:
        return f"{stays} the {_models(names[1])}, but a power with a limit is not excluded."
    return f"{stays} with one, the {_models(names[0])}; without, the {_models(names[1])}."


@recount("limit", "Whether the mean has a limit needs")
def more_sizes(v: View, s: Sheet, k: int) -> str:
    needs = one_limit(*v.key) is None
    return f"Whether the mean has a limit needs {'more' if needs else 'no more'} sizes."


@recount("key-figures", "(It|Whether it) has ")
def limit_in_short(v: View, s: Sheet, k: int) -> str:
    return verdict_sentence(v.key, "it", s)


@recount("limit", "(The mean|Whether the mean) has ")
def limit_in_full(v: View, s: Sheet, k: int) -> str:
    return verdict_sentence(v.key, "the mean", s)


@recount("key-figures", "The limit is below ")
@recount("limit", "The limit is below ")
def limit_from_above(v: View, s: Sheet, k: int) -> str:
    found = one_limit(*v.key)
    assert found is not None
    left = survivors(*v.key, found.part)
    named = [
        f"{s(limit_of(name, v.key, found.part)[0], 2 * NEAR)} ({name} model)"
        for name in MODELS
        if name in left and MODELS[name][1]
    ]
    put = f"; models that have one and survive put it at {listed(named)}" if named else ""
    return f"The limit is below {s((found.limit or (np.nan,) * 3)[2])}{put}."


@recount("key-figures", "How far below is open")
@recount("limit", "How far below is open")
def models_that_fall(v: View, s: Sheet, k: int) -> str:
    found = one_limit(*v.key)
    assert found is not None
    left = survivors(*v.key, found.part)
    endless = [name for name in MODELS if name in left and MODELS[name][1] is False]
    follow = plural(
        len(endless),
        "model, which falls without end, follows",
        "models, which fall without end, follow",
    )
    return f"How far below is open: the {listed(endless)} {follow} the means as well."


@recount("key-figures", r"The limit is \d")
@recount("limit", r"The limit is \d")
def limit_itself(v: View, s: Sheet, k: int) -> str:
    found = one_limit(*v.key)
    value, low, high = (found and found.limit) or (np.nan,) * 3
    near = 2 * NEAR
    return f"The limit is {s(value, near)} (95 % from {s(low, near)} to {s(high, near)})."


@recount("limit", "No constant survives for the interior")
def not_level(v: View, s: Sheet, k: int) -> str:
    limit, *_ = edge_limit(v.key) or (np.nan,)
    model = scores(*v.key, WHOLE)["thickening edge"]
    if level_mean(v.key) is not None or model.refuted:
        return "There is nothing to say of the interior."
    return (
        "No constant survives for the interior, so that its mean is no limit to hold the "
        f"thickening edge's {s(limit)} against."
    )


def _larger_half(groups: Groups) -> Groups:
    return dict(list(groups.items())[len(groups) // 2 :])


def edge_limit(key: tuple) -> tuple[float, float, float, float] | None:
    """Limit of the thickening edge, mean of larger interiors, t and p of their difference."""
    whole = key[0].all_groups(*key[1:])
    inside = free_of_edge(*key) or _larger_half(key[0].all_groups(*key[1:], INTERIOR))
    seen = means_of(inside)
    of_whole = means(*key, WHOLE)

    def weights(model: str, at: Means) -> np.ndarray:
        """What each mean adds to the first coefficient, by shifting one after another."""
        base = linear(model, at)[0][0]
        shifted = [Means(at.x, at.y + row, at.v, at.df) for row in np.eye(len(at.y))]
        return np.array([linear(model, one)[0][0] - base for one in shifted])

    a, b = weights("thickening edge", of_whole), weights("constant", seen)
    share = dict(zip(inside, b, strict=True))
    parts, dfs = [], []
    for (n, values), weight in zip(whole.items(), a, strict=True):
        combined = weight * values - (share[n] * inside[n] if n in inside else 0)
        parts.append(combined.var(ddof=1) / len(combined))
        dfs.append(len(combined) - 1)
    variance = np.array(parts)
    df = variance.sum() ** 2 / (variance**2 / np.array(dfs)).sum()
    limit, interior = float(a @ of_whole.y), float(b @ seen.y)
    t = (limit - interior) / np.sqrt(variance.sum())
    return limit, interior, float(t), float(2 * stats.t.sf(abs(t), df))


@recount("limit", "With an edge that thickens")
def edge_check(v: View, s: Sheet, k: int) -> str:
    limit, interior, _, _ = edge_limit(v.key) or (np.nan,) * 4
    return (
        "With an edge that thickens as the logarithm of the number of points, the whole mesh has "
        f"the limit {s(limit)}; the interior of the larger meshes has the mean {s(interior)}."
    )


@recount("limit", "(The two differ|No difference is seen)")
def edge_agrees(v: View, s: Sheet, k: int) -> str:
    _, _, t, p = edge_limit(v.key) or (np.nan,) * 4
    return (
        f"{'No difference is seen' if p >= 0.05 else 'The two differ'}: the two are "
        f"{s(abs(t), 1e-3)} standard errors apart (p = {s.p(np.log10(p), 1e-3)})."
    )


def trend(v: View, s: Sheet) -> str:
    """The sentence on the mean at both ends, with Welch's test."""
    groups = v.run.all_groups(v.method, v.distribution)
    welch = welch_test(v.run.groups(v.method, v.distribution))
    first, last = min(groups), max(groups)
    a, b = groups[first].mean(), groups[last].mean()
    of_test = f"(Welch's analysis of variance, {s.p_is(welch[3])})"
    if welch[3] >= np.log10(0.05):
        return (
            "The mean does not depend on the number of points, as far as this run can tell "
            f"{of_test}."
        )
    return (
        f"The mean {'grows' if b > a else 'falls'} with the number of points, from {s(a)} at "
        f"{s(first)} to {s(b)} at {s(last)} {of_test}."
    )


def welch_test(groups: Groups) -> tuple[float, float, float, float]:
    """Welch's F by its formula (1951), with its degrees of freedom and the logarithm of p."""
    r = np.array([len(g) for g in groups.values()], dtype=float)
    m = np.array([g.mean() for g in groups.values()])
    w = r / np.array([g.var(ddof=1) for g in groups.values()])
    k, share = len(r), w / w.sum()
    center = share @ m
    spread = ((1 - share) ** 2 / (r - 1)).sum()
    f = (w @ (m - center) ** 2 / (k - 1)) / (1 + 2 * (k - 2) / (k * k - 1) * spread)
    df2 = (k * k - 1) / (3 * spread)
    return float(f), k - 1, float(df2), log10_f_tail(float(f), k - 1, float(df2))


@recount("key-figures", "The mean (grows|falls|does not depend)")
def trend_in_short(v: View, s: Sheet, k: int) -> str:
    return trend(v, s)


@recount("fits", "(This run has too few sizes|Each model is fitted)")
def what_is_predicted(v: View, s: Sheet, k: int) -> str:
    seen = means(*v.key, WHOLE)
    kept = fitted_sizes(seen)
    up_to, rest = int(seen.x[kept].max() * 1000), int((~kept).sum())
    sizes = f"{s(rest)} {plural(rest, 'larger size')}"
    if up_to == PUBLISHED_UP_TO:
        return (
            f"Each model is fitted up to 200,000 points, the paper's range, and has to predict the "
            f"{sizes} of this run."
        )
    return (
        "This run has too few sizes on one side of 200,000 points, where the paper's range ends, "
        f"so that each model is fitted up to {s(up_to)} points and has to predict the {sizes} left "
        "out."
    )


@recount("fits", "For the ")
def which_survive(v: View, s: Sheet, k: int) -> str:
    part = (WHOLE, INTERIOR)[k]
    scored = scores(*v.key, part)
    left = set(survivors(*v.key, part))
    names = [m for m in scored if m in left]
    refuted = [m for m in scored if scored[m].refuted]
    which = f"the {_models(names)}" if names else "no model survives"
    rest = [m for m in scored if m not in left and not scored[m].out]
    if rest:
        which += f", the {listed(rest)} {plural(len(rest), 'one is', 'ones are')} far behind"
    gone = (
        f"the {listed(refuted)} {plural(len(refuted), 'one is', 'ones are')} refuted"
        if refuted
        else "none is refuted"
    )
    of = "the whole mesh" if part == WHOLE else "the interior"
    smallest = 1000 * means(*v.key, part).x[0]
    if smallest > min(v.run.groups(v.method, v.distribution, part)):
        of = f"{of} from {s(smallest)} points on"
    seen = [means(*v.key, each) for each in (WHOLE, part)]
    kept = [fitted_sizes(each) for each in seen]
    ends = [
        (1000 * each.x[at].max(), int((~at).sum())) for each, at in zip(seen, kept, strict=True)
    ]
    if ends[0] != ends[1]:
        up_to, left_out = ends[1]
        sizes = plural(left_out, "larger size", "larger sizes")
        of = f"{of}, fitted up to {s(up_to)} points to predict {s(left_out)} {sizes}"
    return f"For {of}, {which} and {gone}."


@recount("fits", "The .* than the interior")
def struck_out(v: View, s: Sheet, k: int) -> str:
    scored = scores(*v.key, WHOLE)
    names = [m for m in scored if scored[m].struck_out and not scored[m].refuted]
    return (
        f"The {listed(names)} {plural(len(names), 'model has', 'models have')} another limit than "
        "the interior, which is level: out as well."
    )


@recount("fits", "A p below")
def level_of_refutation(v: View, s: Sheet, k: int) -> str:
    return (
        f"A p below {s(refuted_below(v.run))} there, or for the fit to all sizes, refutes it: "
        "0.01, shared among all trends of this run."
    )


@recount("fits", "At ")
def logarithm(v: View, s: Sheet, k: int) -> str:
    seen = means(*v.key, (WHOLE, INTERIOR)[k])
    kept = fitted_sizes(seen)
    beta, covariance = linear("logarithmic", seen.where(kept))
    row = np.array([1.0, np.log(seen.x[-1])])
    off = (seen.y[-1] - row @ beta) / np.sqrt(seen.v[-1] + row @ covariance @ row)
    return (
        f"At {s(1000 * seen.x[-1])} points the logarithmic model, which the paper prefers, "
        f"predicts {s(row @ beta, NEAR)}; measured is {s(seen.y[-1])}, {s(abs(off), 1e-3)} "
        f"standard errors {'below' if off < 0 else 'above'}."
    )


def _curves(s: Sheet, values: dict[str, float], at: float, measured: float) -> str:
    low, high = min(values.values()), max(values.values())
    # A growing power of next to 0 is the logarithm: which of the two is higher is a rounding.
    lowest, highest = (
        either([m for m, value in values.items() if abs(value - end) < NEAR]) for end in (low, high)
    )
    return (
        f"At {s(at)} points the curves for the whole mesh are from {s(low, NEAR)} ({lowest}) to "
        f"{s(high, NEAR)} ({highest}), and the measured mean is {s(measured)}."
    )


@recount("figure-projections")
def curves_beyond(v: View, s: Sheet, k: int) -> str:
    last = means(*v.key, WHOLE)
    seen = last.where(fitted_sizes(last))
    left = survivors(*v.key, WHOLE)
    values = {
        m: predicted(m, seen, last.x[-1])
        for m in MODELS
        if (m in left or m == "logarithmic") and len(seen.x) > MODELS[m][0]
    }
    return _curves(s, values, 1000 * last.x[-1], last.y[-1])


@recount("figure-models")
def curves_of_all(v: View, s: Sheet, k: int) -> str:
    groups = v.run.all_groups(v.method, v.distribution)
    fits = _least_squares(*v.key)
    n = max(groups)
    values = {}
    for model, fit in fits.items():
        basis = np.column_stack(BASES[model](np.array([n / 1000])))
        value = float(fit.predict(basis)[0])
        values[model] = float(4 * special.expit(value)) if model == "logistic" else value
    return _curves(s, values, n, groups[n].mean())


@recount("projections", "At ")
def projections(v: View, s: Sheet, k: int) -> str:
    words = []
    for model in survivors(*v.key, WHOLE):
        if MODELS[model][1] is not None:
            ends = value_interval(model, v.key, WHOLE, 1e6)
            # So far out, the sixth digit of a variance counts.
            near = 5e-6 + 1e-5 * (ends[2] - ends[1])
            value, low, high = (s(end, near) for end in ends)
            words.append(f"{value} ({model}, 95 % from {low} to {high})")
    return f"At {s(1e9)} points they put the mean at {listed(words)}."


@cache
def _least_squares(run: Run, method: str, distribution: str) -> dict:
    """The paper's four models by statsmodels' least squares."""
    groups = run.all_groups(method, distribution)
    x = np.concatenate([np.full(len(g), n / 1000) for n, g in groups.items()])
    y = np.concatenate(list(groups.values()))
    made = {}
    for model in ("linear", "quadratic", "logistic", "logarithmic"):
        if model == "logistic" and (y >= 4).any():
            continue
        z = np.log(y / (4 - y)) if model == "logistic" else y
        made[model] = sm.OLS(z, np.column_stack(BASES[model](x))).fit()
    return made


def adjusted_r2(run: Run, method: str, distribution: str) -> dict[str, float]:
    """Of the paper's four models."""
    fits = _least_squares(run, method, distribution)
    return {model: float(fit.rsquared_adj) for model, fit in fits.items()}


@recount("table-7", "Of the paper's four models")
def of_paper(v: View, s: Sheet, k: int) -> str:
    r2 = adjusted_r2(*v.key)
    top = max(r2, key=r2.__getitem__)
    return (
        f"Of the paper's four models the {top} one fits the {v.word} points best by least squares, "
        f"with an adjusted R² of {s(r2[top])}."
    )
