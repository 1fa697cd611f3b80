"""Models of growth fitted anew: which survive, and whether the mean has a limit.

Weights come from statsmodels' gamma regression; models that are linear in their coefficients are
fitted by plain least squares, and predict with the covariance of their prediction errors; powers
are looked for on a dense grid.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
import statsmodels.api as sm
from run_data import INTERIOR, INTERIOR_LAYER, WHOLE, Groups, Run, t95
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
#: Models that are a model with some of its coefficients fixed.
CONTAINED = {
    "quadratic": ("linear",),
    "growing power": ("linear", "logarithmic"),
    "thickening edge": ("edge",),
    "saturating": ("edge", "logarithmic"),
}
_POWERS = np.linspace(-10, 2, 12001)
PUBLISHED_UP_TO = 200_000
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
    groups = run.all_groups(method, distribution, INTERIOR)
    large = {n: g for n, g in groups.items() if inside[n] >= 0.9 * every[n]}
    return large if len(large) >= 5 else None


def judged_groups(run: Run, method: str, distribution: str, part: str) -> Groups:
    """Means of triangulations at the sizes that are judged."""
    large = free_of_edge(run, method, distribution) if part == INTERIOR else None
    return large or run.all_groups(method, distribution, part)


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


def linear(model: str, seen: Means) -> tuple[np.ndarray, np.ndarray]:
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


#: A power, the coefficients of its line, their covariance, and the squares that are left.
Line = tuple[float, np.ndarray, np.ndarray, float]


def _line(power: float, seen: Means) -> Line:
    basis, w = _box(power, seen.x), 1 / seen.v
    middle, y = w @ basis / w.sum(), w @ seen.y / w.sum()
    across = basis - middle
    spread = w * across @ across
    slope = w * across @ (seen.y - y) / spread
    beta = np.array([y - slope * middle, slope])
    covariance = np.array([[1 / w.sum() + middle**2 / spread, -middle / spread],
                           [-middle / spread, 1 / spread]])  # fmt: skip
    return power, beta, covariance, float(w @ (seen.y - y - slope * across) ** 2)


_COARSE = np.linspace(-10, 2, 1201)


def _best_power(seen: Means, low: float, high: float) -> tuple[float, float]:
    powers = _COARSE[(low - 1e-9 <= _COARSE) & (high + 1e-9 >= _COARSE)]
    costs = [_line(p, seen)[-1] for p in powers]
    k = int(np.argmin(costs))
    found = optimize.minimize_scalar(
        lambda p: _line(p, seen)[-1],
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
    beta = linear(model, seen)[0]
    return float(((z - np.column_stack(BASES[model](seen.x)) @ beta) ** 2 / v).sum())


def predicted(model: str, seen: Means, x: float) -> float:
    """Value of the fitted curve."""
    at = np.array([x])
    if model in _RANGES:
        power = _best_power(seen, *_RANGES[model])[0]
        beta = _line(power, seen)[1]
        return float(beta[0] + beta[1] * _box(power, at)[0])
    value = float(np.column_stack(BASES[model](at))[0] @ linear(model, seen)[0])
    return float(4 * special.expit(value)) if model == "logistic" else value


def fitted_sizes(seen: Means) -> np.ndarray:
    """Which sizes are fitted before the others are predicted."""
    kept = seen.x * 1000 <= PUBLISHED_UP_TO
    if kept.all() or kept.sum() < 4:
        # A quarter is left out, but four are fitted, and one at least is predicted.
        fitted = min(max(len(kept) - int(np.ceil(len(kept) / 4)), 4), len(kept) - 1)
        kept = np.arange(len(kept)) < fitted
    return kept


def _prediction_chi2(model: str, seen: Means, kept: np.ndarray) -> float:
    if model in _RANGES:
        return max(squares(model, seen) - squares(model, seen.where(kept)), 0.0)
    beta, covariance = linear(model, seen.where(kept))
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

    refuted: bool
    struck_out: bool

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
    made: dict[str, Scored] = {}
    best = _best_power(seen, -10, 2)[0] if len(seen.x) >= 3 else 0.0
    for model, (terms, _) in MODELS.items():
        if (model == "growing power" and best <= 0) or (model == "saturating" and best >= 0):
            continue  # it is best as the logarithm
        if kept.sum() < terms + 1 or kept.all() or (model == "logistic" and seen.y.max() >= 4):
            continue
        fit, n = squares(model, seen), len(seen.x) - terms
        prediction = _prediction_chi2(model, seen, kept)
        unseen = int((~kept).sum())
        p = (
            float(stats.f.sf(fit / n, n, seen.df)),
            float(stats.f.sf(prediction / unseen, unseen, seen.df)),
        )
        smaller = () if model == "constant" else ("constant", *CONTAINED.get(model, ()))
        upheld = any(name in made and not made[name].refuted for name in smaller)
        made[model] = Scored(
            *p,
            fit + 2 * terms,
            min(p) < refuted_below(run) and not upheld,
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
    beta, covariance = linear(model, seen)
    half = t95(seen.df) * float(np.sqrt(direction @ covariance @ direction))
    value = float(direction @ beta)
    return value, value - half, value + half


@cache
def _profile(key: tuple, part: str) -> tuple[float, float, list[Line], float, Means]:
    """Best power, ceiling of the squares, and the lines of all powers below it."""
    seen = means(*key, part)
    best, least = _best_power(seen, -10, 2)
    ceiling = least + t95(seen.df) ** 2
    coarse = [p for p in _COARSE if _line(p, seen)[-1] <= ceiling] or [best]
    low, high = max(coarse[0] - 0.01, -10), min(coarse[-1] + 0.01, 2)
    powers = np.union1d(np.linspace(low, high, 6001), [best, 0.0])
    lines = [_line(p, seen) for p in powers if low <= p <= high]
    return best, ceiling, [line for line in lines if line[-1] <= ceiling], least, seen


def power_interval(key: tuple, part: str) -> tuple[float, float]:
    """Ends of the powers that the data leave open."""
    _, _, lines, _, _ = _profile(key, part)
    low, high = lines[0][0], lines[-1][0]
    return (-np.inf if low <= -10 else low), (np.inf if high >= 2 else high)


def power_value(key: tuple, part: str, x: float) -> Interval:
    """Value at x, or the limit, with its profile likelihood interval over all powers."""
    best, ceiling, lines, _, seen = _profile(key, part)

    def end(line: Line, side: int) -> float:
        power, beta, covariance, cost = line
        at = np.array([1.0, -1 / power if np.isinf(x) else _box(power, np.array([x]))[0]])
        left = max(ceiling - cost, 0.0)
        return float(at @ beta + side * np.sqrt(left * (at @ covariance @ at)))

    lines = [line for line in lines if line[0] < 0 or not np.isinf(x)]
    ends = []
    for side in (-1, 1):
        values = [side * end(line, side) for line in lines]
        k = int(np.argmax(values))
        between = lines[max(k - 1, 0)][0], lines[min(k + 1, len(lines) - 1)][0]
        nearer = optimize.minimize_scalar(
            lambda power, side=side: -side * end(_line(power, seen), side),
            bounds=between,
            method="bounded",
        )
        ends.append(side * max(values[k], -float(nearer.fun)))
    low, high = ends
    _, beta, covariance, cost = _line(0.0, seen)
    if np.isinf(x) and cost <= ceiling:
        half = np.sqrt((ceiling - cost) * covariance[1, 1])
        low = -np.inf if beta[1] - half < 0 else low
        high = np.inf if beta[1] + half > 0 else high
    return end(_line(best, seen), 0), low, high


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
    if not run.all_groups(*key[1:], part) or len(means(*key, part).x) < 5:
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
    telling = [name for name in left if MODELS[name][1] is not None]
    if telling and high < 0:
        return "yes", "it falls, and cannot fall below 1"
    if grows and not edge and least > -0.1:
        return "no", "it grows like a logarithm or faster"
    if telling:
        return "undecided", "models with and without a limit survive"
    return "undecided", "no model follows the means"


def _limit(key: tuple, part: str, reason: str) -> Interval:
    if reason == "the mean is level":
        return limit_of("constant", key, part)
    if reason == "it falls, and cannot fall below 1":
        seen = means(*key, part)
        return np.nan, -np.inf, float(seen.y[-1] + t95(seen.df) * np.sqrt(seen.v[-1]))
    ends = [
        limit_of(name, key, part)
        for name in survivors(*key, part)
        if name in ("edge", "thickening edge", "saturating")
        and (name != "saturating" or _profile(key, part)[0] < 0)
    ]
    return ends[0][0], min(e[1] for e in ends), max(e[2] for e in ends)


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
        known = [one for one in yes if not np.isnan(yes[one][0])] or list(yes)
        part = INTERIOR if level else known[0]
        only = "only models with a limit survive"
        same = [one for p, one in yes.items() if judged[p][1] == only]
        if judged[part][1] == only:
            yes[part] = yes[part][0], min(e[1] for e in same), max(e[2] for e in same)
        return OneLimit("yes", judged[part][1], part, yes[part])
    if no:
        return OneLimit("no", judged[no[0]][1], no[0])
    return OneLimit("undecided", judged[first][1], first)
