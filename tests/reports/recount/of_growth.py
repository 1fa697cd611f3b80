"""Trends: which models survive, whether there is a limit, projections, the paper's regressions.

Weights come from statsmodels' gamma regression; models that are linear in their coefficients are
fitted by plain least squares, and predict with the covariance of their prediction errors; powers
are looked for on a dense grid.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
import statsmodels.api as sm
from expected import Sheet, either, listed, plural
from recounts import View, recount
from run_data import INTERIOR, INTERIOR_LAYER, WHOLE, Groups, Run, log10_f_tail, t95
from scipy import optimize, special, stats

#: Model, number of coefficients, whether it has a limit.
MODELS: dict[str, tuple[int, bool | None]] = {
    "constant": (1, True),
    "linear": (2, False),
    "quadratic": (3, None),
    "logistic": (2, None),
    "logarithmic": (2, False),
    "doubly logarithmic": (2, False),
    "growing power": (3, False),
    "edge": (2, True),
    "thickening edge": (3, True),
    "saturating": (3, True),
}
BASES: dict[str, Callable[[np.ndarray], list[np.ndarray]]] = {
    "constant": lambda x: [x**0],
    "linear": lambda x: [x**0, x],
    "quadratic": lambda x: [x**0, x, x**2],
    "logistic": lambda x: [x**0, x],
    "logarithmic": lambda x: [x**0, np.log(x)],
    "doubly logarithmic": lambda x: [x**0, np.log(np.log(1000 * x))],
    "edge": lambda x: [x**0, x**-0.5],
    "thickening edge": lambda x: [x**0, x**-0.5, np.log(x) * x**-0.5],
}
_POWERS = np.linspace(-10, 2, 12001)
_PUBLISHED_UP_TO = 200_000
#: Grids and iterations leave so much open.
NEAR = 2e-6


def _smooth(groups: Groups) -> np.ndarray:
    """Variances by a gamma regression of sample variances on ln n, bent where that is better."""
    n = np.array(list(groups), dtype=float)
    counts = np.array([len(g) for g in groups.values()])
    log_n = np.log(n) - np.log(n).mean()
    repeated = np.array([len(g) > 1 and np.ptp(g) > 0 for g in groups.values()])
    variances = np.array([g.var(ddof=1) if len(g) > 1 else np.nan for g in groups.values()])

    def fit(degree: int) -> tuple[float, np.ndarray]:
        basis = np.vander(log_n, degree + 1, increasing=True)
        if repeated.sum() == degree + 1:  # it goes through all of them
            through = np.linalg.solve(basis[repeated], np.log(variances[repeated]))
            return 0.0, np.exp(basis @ through)
        family = sm.families.Gamma(sm.families.links.Log())
        model = sm.GLM(
            variances[repeated],
            basis[repeated],
            family=family,
            var_weights=counts[repeated] - 1.0,
        )
        found = model.fit(maxiter=300, tol=1e-13)
        return found.deviance / 2, np.exp(basis @ found.params)

    straight = fit(min(1, repeated.sum() - 1))
    if repeated.sum() >= 5 and counts[repeated].min() >= 6:
        bent = fit(2)
        if straight[0] - bent[0] > stats.chi2.ppf(0.95, 1):
            return bent[1]
    return straight[1]


@dataclass(frozen=True)
class Means:
    """Means by size, in thousands of points, with variances; df of the pure error."""

    x: np.ndarray
    y: np.ndarray
    v: np.ndarray
    df: int

    def where(self, kept: np.ndarray) -> "Means":
        """Some of the sizes."""
        return Means(self.x[kept], self.y[kept], self.v[kept], self.df)


def free_of_edge(run: Run, method: str, distribution: str) -> Groups | None:
    """Interiors of the meshes that are nine tenths interior; None for fewer than five sizes."""
    frame = run.counts("layers", method, distribution)
    every = frame.groupby("n_points")["count"].sum()
    inside = frame[frame["layer"] == INTERIOR_LAYER].groupby("n_points")["count"].sum()
    groups = run.groups(method, distribution, INTERIOR)
    large = {n: g for n, g in groups.items() if inside[n] >= 0.9 * every[n]}
    return large if len(large) >= 5 else None


def judged_groups(run: Run, method: str, distribution: str, part: str) -> Groups:
    """Means of triangulations at the sizes that are judged."""
    large = free_of_edge(run, method, distribution) if part == INTERIOR else None
    return large or run.groups(method, distribution, part)


@cache
def refuted_below(run: Run) -> float:
    """0.01 shared among all trends: those with a size of which the variance can be told."""
    trends = sum(
        any(len(g) > 1 and np.ptp(g) > 0 for g in judged_groups(run, m, d, part).values())
        for m in run.methods
        for d in run.distributions
        for part in (WHOLE, INTERIOR)
    )
    return 0.01 / max(trends, 1)


@cache
def means(run: Run, method: str, distribution: str, part: str) -> Means:
    """Means of one view, at the sizes that are judged."""
    return means_of(judged_groups(run, method, distribution, part))


def means_of(groups: Groups) -> Means:
    """Means of some triangulations."""
    counts = np.array([len(g) for g in groups.values()])
    return Means(
        np.array(list(groups)) / 1000,
        np.array([g.mean() for g in groups.values()]),
        _smooth(groups) / counts,
        int((counts - 1).sum()),
    )


def _scale(model: str, seen: Means) -> tuple[np.ndarray, np.ndarray]:
    """The values that a linear model fits, and their variances."""
    if model != "logistic" or seen.y.max() >= 4:
        return seen.y, seen.v
    slope = 4 / (seen.y * (4 - seen.y))
    return np.log(seen.y / (4 - seen.y)), seen.v * slope**2


def _linear(model: str, seen: Means) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients and covariance, with x scaled for the sake of the digits."""
    z, v = _scale(model, seen)
    basis = np.column_stack(BASES[model](seen.x))
    size = np.abs(basis).max(axis=0)
    root = 1 / np.sqrt(v)[:, None]
    inverse = np.linalg.pinv(basis / size * root)
    return inverse @ (z * root[:, 0]) / size, inverse @ inverse.T / np.outer(size, size)


def _box(power: float, x: np.ndarray) -> np.ndarray:
    log = np.log(x / 100)
    return log if abs(power) < 1e-12 else np.expm1(power * log) / power


def _line(power: float, seen: Means) -> tuple[np.ndarray, np.ndarray, float]:
    basis = np.column_stack([np.ones(len(seen.x)), _box(power, seen.x)])
    root = 1 / np.sqrt(seen.v)[:, None]
    inverse = np.linalg.pinv(basis * root, rcond=1e-14)
    beta = inverse @ (seen.y * root[:, 0])
    return beta, inverse @ inverse.T, float((((seen.y - basis @ beta) * root[:, 0]) ** 2).sum())


_COARSE = np.linspace(-10, 2, 1201)


def _best_power(seen: Means, low: float, high: float) -> tuple[float, float]:
    powers = _COARSE[(low - 1e-9 <= _COARSE) & (high + 1e-9 >= _COARSE)]
    costs = [_line(p, seen)[2] for p in powers]
    k = int(np.argmin(costs))
    found = optimize.minimize_scalar(
        lambda p: _line(p, seen)[2],
        bounds=(powers[max(k - 1, 0)], powers[min(k + 1, len(powers) - 1)]),
        method="bounded",
        options={"xatol": 1e-9},
    )
    return (float(found.x), float(found.fun)) if found.fun < costs[k] else (powers[k], costs[k])


_RANGES = {"growing power": (0.0, 2.0), "saturating": (-10.0, 0.0)}


def squares(model: str, seen: Means) -> float:
    """Least weighted sum of squares."""
    if model in _RANGES:
        return _best_power(seen, *_RANGES[model])[1]
    z, v = _scale(model, seen)
    beta = _linear(model, seen)[0]
    return float(((z - np.column_stack(BASES[model](seen.x)) @ beta) ** 2 / v).sum())


def predicted(model: str, seen: Means, x: float) -> float:
    """Value of the fitted curve."""
    at = np.array([x])
    if model in _RANGES:
        power = _best_power(seen, *_RANGES[model])[0]
        beta = _line(power, seen)[0]
        return float(beta[0] + beta[1] * _box(power, at)[0])
    value = float(np.column_stack(BASES[model](at))[0] @ _linear(model, seen)[0])
    return float(4 * special.expit(value)) if model == "logistic" else value


def fitted_sizes(seen: Means) -> np.ndarray:
    """Which sizes are fitted before the others are predicted."""
    kept = seen.x * 1000 <= _PUBLISHED_UP_TO
    if kept.all() or kept.sum() < 4:
        # A quarter is left out, but four are fitted, and one at least is predicted.
        fitted = min(max(len(kept) - int(np.ceil(len(kept) / 4)), 4), len(kept) - 1)
        kept = np.arange(len(kept)) < fitted
    return kept


def _prediction_chi2(model: str, seen: Means, kept: np.ndarray) -> float:
    if model in _RANGES:
        return max(squares(model, seen) - squares(model, seen.where(kept)), 0.0)
    beta, covariance = _linear(model, seen.where(kept))
    rest = seen.where(~kept)
    z, v = _scale(model, rest)
    basis = np.column_stack(BASES[model](rest.x))
    errors = z - basis @ beta
    return float(errors @ np.linalg.solve(basis @ covariance @ basis.T + np.diag(v), errors))


@dataclass(frozen=True)
class Scored:
    """A model with its p-values and AIC."""

    fit_p: float
    prediction_p: float
    aic: float

    refuted_below: float
    struck_out: bool

    @property
    def refuted(self) -> bool:
        return min(self.fit_p, self.prediction_p) < self.refuted_below

    @property
    def out(self) -> bool:
        return self.refuted or self.struck_out


@cache
def scores(run: Run, method: str, distribution: str, part: str) -> dict[str, Scored]:
    """Score every model that the sizes suffice for."""
    key = (run, method, distribution)
    seen = means(*key, part)
    kept = fitted_sizes(seen)
    level = level_mean(key) if part == WHOLE else None
    made = {}
    for model, (terms, _) in MODELS.items():
        if kept.sum() < terms + 1 or kept.all() or (model == "logistic" and seen.y.max() >= 4):
            continue
        fit, n = squares(model, seen), len(seen.x) - terms
        prediction = _prediction_chi2(model, seen, kept)
        unseen = int((~kept).sum())
        made[model] = Scored(
            float(stats.f.sf(fit / n, n, seen.df)),
            float(stats.f.sf(prediction / unseen, unseen, seen.df)),
            fit + 2 * terms,
            refuted_below(run),
            level is not None and _has_another_limit(model, key, level),
        )
    return made


def _has_another_limit(model: str, key: tuple, level: "Interval") -> bool:
    """Whether the limit that a model has for the whole mesh is not near that mean."""
    if not MODELS[model][1] or (model == "saturating" and _profile(key, WHOLE)[0] >= 0):
        return False
    _, low, high = limit_of(model, key, WHOLE)
    return low > level[2] or level[1] > high


def limit_of(model: str, key: tuple, part: str) -> "Interval":
    """Limit of a model that has one."""
    if model == "saturating":
        return power_value(key, part, np.inf)
    return _along(model, means(*key, part), np.eye(MODELS[model][0])[0])


def level_mean(key: tuple) -> "Interval | None":
    """Mean of an interior for which a constant survives, as far as a limit may be from it."""
    if not any(len(g) > 1 and np.ptp(g) > 0 for g in judged_groups(*key, INTERIOR).values()):
        return None
    if len(means(*key, INTERIOR).x) < 5 or "constant" not in survivors(*key, INTERIOR):
        return None
    value, low, high = limit_of("constant", key, INTERIOR)
    _, less, more = per_decade(key, INTERIOR)
    unseen = max(-less, more)
    return value, low - unseen, high + unseen


@cache
def survivors(run: Run, method: str, distribution: str, part: str) -> list[str]:
    """Models that are neither refuted nor far behind, by AIC."""
    left = {k: s for k, s in scores(run, method, distribution, part).items() if not s.out}
    lowest = min((s.aic for s in left.values()), default=0.0)
    names = sorted(left, key=lambda name: left[name].aic)
    return [name for name in names if left[name].aic - lowest <= 10]


Interval = tuple[float, float, float]


def _along(model: str, seen: Means, direction: np.ndarray) -> Interval:
    beta, covariance = _linear(model, seen)
    half = t95(seen.df) * float(np.sqrt(direction @ covariance @ direction))
    value = float(direction @ beta)
    return value, value - half, value + half


@cache
def _profile(key: tuple, part: str) -> tuple[float, float, list, float, Means]:
    """Best power, ceiling of the squares, and the lines of all powers below it."""
    seen = means(*key, part)
    best, least = _best_power(seen, -10, 2)
    ceiling = least + t95(seen.df) ** 2
    coarse = [p for p in _COARSE if _line(p, seen)[2] <= ceiling] or [best]
    low, high = max(coarse[0] - 0.01, -10), min(coarse[-1] + 0.01, 2)
    powers = np.union1d(np.linspace(low, high, 6001), [best, 0.0])
    lines = [(p, *_line(p, seen)) for p in powers if low <= p <= high]
    return best, ceiling, [line for line in lines if line[3] <= ceiling], least, seen


def power_interval(key: tuple, part: str) -> tuple[float, float]:
    """Ends of the powers that the data leave open."""
    _, _, lines, _, _ = _profile(key, part)
    low, high = lines[0][0], lines[-1][0]
    return (-np.inf if low <= -10 else low), (np.inf if high >= 2 else high)


def power_value(key: tuple, part: str, x: float) -> Interval:
    """Value at x, or the limit, with its profile likelihood interval over all powers."""
    best, ceiling, lines, _, seen = _profile(key, part)

    def end(power: float, side: int) -> float:
        beta, covariance, cost = _line(power, seen)
        at = np.array([1.0, -1 / power if np.isinf(x) else _box(power, np.array([x]))[0]])
        left = max(ceiling - cost, 0.0)
        return float(at @ beta + side * np.sqrt(left * (at @ covariance @ at)))

    powers = [line[0] for line in lines if line[0] < 0 or not np.isinf(x)]
    ends = []
    for side in (-1, 1):
        values = [side * end(power, side) for power in powers]
        k = int(np.argmax(values))
        between = powers[max(k - 1, 0)], powers[min(k + 1, len(powers) - 1)]
        nearer = optimize.minimize_scalar(
            lambda power, side=side: -side * end(power, side), bounds=between, method="bounded"
        )
        ends.append(side * max(values[k], -float(nearer.fun)))
    low, high = ends
    beta, covariance, cost = _line(0.0, seen)
    if np.isinf(x) and cost <= ceiling:
        half = np.sqrt((ceiling - cost) * covariance[1, 1])
        low = -np.inf if beta[1] - half < 0 else low
        high = np.inf if beta[1] + half > 0 else high
    return end(best, 0), low, high


def value_interval(model: str, key: tuple, part: str, x: float) -> Interval:
    """Value of a model at x with its interval."""
    if model in _RANGES:
        return power_value(key, part, x)
    direction = np.column_stack(BASES[model](np.array([x])))[0]
    ends = _along(model, means(*key, part), direction)
    if model == "logistic":
        value, low, high = (float(4 * special.expit(end)) for end in ends)
        return value, low, high
    return ends


def per_decade(key: tuple, part: str) -> Interval:
    """Change with each tenfold number of points."""
    ends = _along("logarithmic", means(*key, part), np.array([0.0, np.log(10)]))
    return ends


@cache
def verdict(run: Run, method: str, distribution: str, part: str) -> tuple[str, str] | None:
    """Whether there is a limit, and why; None for too few sizes."""
    key = (run, method, distribution)
    if not run.groups(*key[1:], part) or len(means(*key, part).x) < 5:
        return None
    left = survivors(*key, part)
    _, low, high = per_decade(key, part)
    if "constant" in left:
        if max(-low, high) <= 0.001:
            return "yes", "the mean is level"
        if low <= 0 <= high:
            return "undecided", "no change is seen, but one that counts is not excluded"
    grows = any(MODELS[name][1] is False for name in left)
    edge = "edge" in left or "thickening edge" in left
    least, most = power_interval(key, part)
    if not grows and (edge or ("saturating" in left and most < -0.1)):
        return "yes", "only models with a limit survive"
    if grows and not edge and least > -0.1:
        return "no", "it grows like a logarithm or faster"
    if any(MODELS[name][1] is not None for name in left):
        return "undecided", "models with and without a limit survive"
    return "undecided", "no model follows the means"


def _limit(key: tuple, part: str, reason: str) -> Interval:
    if reason == "the mean is level":
        return limit_of("constant", key, part)
    ends = [
        limit_of(name, key, part)
        for name in survivors(*key, part)
        if name in ("edge", "thickening edge", "saturating")
        and (name != "saturating" or _profile(key, part)[0] < 0)
    ]
    return ends[0][0], min(e[1] for e in ends), max(e[2] for e in ends)


def _models(names: list[str]) -> str:
    return f"{listed(names)} {plural(len(names), 'model survives', 'models survive')}"


@dataclass(frozen=True)
class OneLimit:
    """The verdict of whole and interior together; the part that it is of, and its limit."""

    word: str
    reason: str
    part: str
    limit: Interval | None = None


@cache
def one_limit(run: Run, method: str, distribution: str) -> OneLimit | None:
    """Whether the whole mesh and its interior have their one limit; None for too few sizes."""
    key = (run, method, distribution)
    each = {part: verdict(*key, part) for part in (WHOLE, INTERIOR)}
    judged = {part: found for part, found in each.items() if found is not None}
    if not judged:
        return None
    first = next(iter(judged))
    yes = {p: _limit(key, p, why) for p, (word, why) in judged.items() if word == "yes"}
    no = [part for part, (word, _) in judged.items() if word == "no"]
    lows, highs = [one[1] for one in yes.values()], [one[2] for one in yes.values()]
    if yes and (no or max(lows) > min(highs)):
        reason = "the whole mesh and its interior contradict each other"
        return OneLimit("undecided", reason, first)
    if yes:
        level = INTERIOR in yes and judged[INTERIOR][1] == "the mean is level"
        part = INTERIOR if level else next(iter(yes))
        return OneLimit("yes", judged[part][1], part, yes[part])
    if no:
        return OneLimit("no", judged[no[0]][1], no[0])
    return OneLimit("undecided", judged[first][1], first)


_MEAN_OF = {WHOLE: "the mean of the whole mesh", INTERIOR: "the mean of the interior"}


def _with_a_limit(found: OneLimit, key: tuple, it: str, s: Sheet) -> str:
    if found.reason == "the mean is level":
        value, low, high = found.limit or (np.nan,) * 3
        start = 1000 * means(*key, found.part).x[0]
        return (
            f"{it} has a limit: {_MEAN_OF[found.part]} is level, for it changes by no more than "
            f"0.001 with each tenfold number of points from {s(start)} on; the limit is "
            f"{s(value)} (95 % from {s(low)} to {s(high)})."
        )
    scored, left = scores(*key, found.part), survivors(*key, found.part)
    names = [
        f"{name} (p = {s.p(np.log10(one.fit_p), 1e-4)} for the fit to all sizes, "
        f"{s.p(np.log10(one.prediction_p), 1e-4)} for sizes not seen)"
        for name, one in scored.items()
        if name in left and MODELS[name][1]
    ]
    whose = "" if found.part == WHOLE else " for the interior"
    return (
        f"{it} has a limit, among the {s(len(scored))} models tried: all that have none are "
        f"out{whose}, and the {_models(names)}."
    )


def verdict_sentence(key: tuple, it: str, s: Sheet) -> str:
    """The verdict on a limit, in words."""
    found = one_limit(*key)
    assert found is not None
    opening = it[0].upper() + it[1:]
    if found.word == "yes":
        return _with_a_limit(found, key, opening, s)
    if found.word == "no":
        grows = "grows" if per_decade(key, found.part)[0] > 0 else "falls"
        return (
            f"{opening} has no limit in sight, among the models tried: "
            f"{'it' if found.part == WHOLE else _MEAN_OF[found.part]} {grows} like a logarithm of "
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


@recount("key-figures", "The limit is ")
@recount("limit", "The limit is ")
def limit_itself(v: View, s: Sheet, k: int) -> str:
    found = one_limit(*v.key)
    value, low, high = (found and found.limit) or (np.nan,) * 3
    near = 2 * NEAR
    return f"The limit is {s(value, near)} (95 % from {s(low, near)} to {s(high, near)})."


@recount("limit", "But the interior is not level")
def not_level(v: View, s: Sheet, k: int) -> str:
    is_not = "is not level, and its mean no limit" if level_mean(v.key) is None else "is level"
    return f"But the interior {is_not}: they need not agree."


def _larger_half(groups: Groups) -> Groups:
    return dict(list(groups.items())[len(groups) // 2 :])


def edge_limit(key: tuple) -> tuple[float, float, float, float] | None:
    """Limit of the thickening edge, mean of larger interiors, t and p of their difference."""
    whole = key[0].groups(*key[1:])
    inside = free_of_edge(*key) or _larger_half(key[0].groups(*key[1:], INTERIOR))
    seen = means_of(inside)
    of_whole = means(*key, WHOLE)

    def weights(model: str, at: Means) -> np.ndarray:
        """What each mean adds to the first coefficient, by shifting one after another."""
        base = _linear(model, at)[0][0]
        shifted = [Means(at.x, at.y + row, at.v, at.df) for row in np.eye(len(at.y))]
        return np.array([_linear(model, one)[0][0] - base for one in shifted])

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


@recount("limit", "The two ")
def edge_agrees(v: View, s: Sheet, k: int) -> str:
    _, _, t, p = edge_limit(v.key) or (np.nan,) * 4
    return (
        f"The two {'agree' if p >= 0.05 else 'do not agree'}: they differ by "
        f"{s(abs(t), 1e-3)} standard errors (p = {s.p(np.log10(p), 1e-3)})."
    )


def trend(v: View, s: Sheet) -> str:
    """The sentence on the mean at both ends, with Welch's test."""
    groups = v.run.groups(v.method, v.distribution)
    welch = welch_test(groups)
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
    if up_to == _PUBLISHED_UP_TO:
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
    gone = (
        f"the {listed(refuted)} {plural(len(refuted), 'one is', 'ones are')} refuted"
        if refuted
        else "none is refuted"
    )
    of = "the whole mesh" if part == WHOLE else "the interior"
    smallest = 1000 * means(*v.key, part).x[0]
    if smallest > min(v.run.groups(v.method, v.distribution, part)):
        of = f"{of} from {s(smallest)} points on"
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
    beta, covariance = _linear("logarithmic", seen.where(kept))
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
    groups = v.run.groups(v.method, v.distribution)
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
        if model != "growing power" and MODELS[model][1] is not None:
            ends = value_interval(model, v.key, WHOLE, 1e6)
            # So far out, the sixth digit of a variance counts.
            near = 5e-6 + 1e-5 * (ends[2] - ends[1])
            value, low, high = (s(end, near) for end in ends)
            words.append(f"{value} ({model}, 95 % from {low} to {high})")
    return f"At {s(1e9)} points they put the mean at {listed(words)}."


@cache
def _least_squares(run: Run, method: str, distribution: str) -> dict:
    """The paper's four models by statsmodels' least squares."""
    groups = run.groups(method, distribution)
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
