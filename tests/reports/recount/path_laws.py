"""The chance that a path goes on, size by size, and the laws of it, from the counts of a run."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from run_data import INTERIOR, WHOLE, Run, best_repeated, log10_f_tail, matrix, t95
from scipy import optimize


@dataclass(frozen=True)
class Rates:
    """Shares of paths that go on after 2, 3, ... triangles, and the covariance of them."""

    sizes: np.ndarray
    reached: np.ndarray
    rates: np.ndarray
    covariance: np.ndarray
    df: int

    @property
    def half(self) -> np.ndarray:
        """Half widths of their intervals; NaN where few paths come so far."""
        error = np.sqrt(np.diag(self.covariance))
        known = (self.reached >= 1000) & (self.df > 0)
        return np.where(known, (t95(self.df) if self.df > 0 else np.nan) * error, np.nan)

    @property
    def n_sure(self) -> int:
        """How many sizes are known to within 0.05, from the first on."""
        number = 0
        for half in self.half:
            if not 0 < 2 * half < 0.05:
                break
            number += 1
        return number


def rates_of(groups: list[np.ndarray]) -> Rates:
    """Ratios of sums over the triangulations of the last group, with linearised errors."""
    last = groups[-1]
    total = last.sum(axis=0)
    longest = int(np.flatnonzero(total).max())
    sizes = np.arange(2, longest + 1)
    used = groups[-1:] if len(last) >= 16 else groups
    df, products = 0, np.zeros((len(sizes), len(sizes)))
    for counts in used:
        residuals = []
        sums = np.array([counts[:, k:].sum() for k in range(longest + 3)], dtype=float)
        for row in counts:
            tail = np.array([row[k:].sum() for k in range(longest + 3)], dtype=float)
            if tail[2] > 0:
                rate = np.array([sums[k + 1] / sums[k] if sums[k] else 0.0 for k in sizes])
                residuals.append((tail[sizes + 1] - rate * tail[sizes]) / np.sqrt(tail[2]))
        products += np.array(residuals).T @ np.array(residuals)
        df += len(residuals) - 1
    reached = np.array([total[k:].sum() for k in sizes], dtype=float)
    more = np.array([total[k + 1 :].sum() for k in sizes], dtype=float)
    covariance = products / max(df, 1) * reached[0] / np.outer(reached, reached)
    return Rates(sizes, reached, more / reached, covariance, df)


@cache
def continuation(run: Run, method: str, distribution: str, part: str) -> tuple[int, Rates] | None:
    """The size that the chances are of, and the chances; None where the part is not there."""
    frame = run.histogram(method, distribution, part)
    if frame.empty:
        return None
    groups = {int(n): matrix(g) for n, g in frame.groupby("n_points")}
    n = best_repeated({n: len(counts) for n, counts in groups.items()})
    return n, rates_of([counts for size, counts in groups.items() if size <= n])


def law_part(key: tuple) -> str:
    """The part that the law is told of."""
    return INTERIOR if continuation(*key, INTERIOR) else WHOLE


@dataclass(frozen=True)
class Law:
    """A fitted law: what is fitted, errors, Hotelling's F, its degrees of freedom, log10 p."""

    coefficients: np.ndarray
    errors: np.ndarray
    f: float
    df: int
    df_residual: int
    log10_p: float
    upto: int

    @property
    def rejected(self) -> bool:
        return self.log10_p < np.log10(0.05)


def _judged(
    rates: Rates, number: int, beta: np.ndarray, slopes: np.ndarray, off: np.ndarray
) -> Law:
    inverse = np.linalg.inv(rates.covariance[:number, :number])
    chi2, m, q = float(off @ inverse @ off), rates.df, number - len(beta)
    inflation = m * (m - 1) / ((m - q) * (m - q - 1))
    covariance = np.linalg.inv(slopes.T @ inverse @ slopes) * inflation
    f, rest = chi2 * (m - q + 1) / (m * q), m - q + 1
    error, upto = np.sqrt(np.diag(covariance)), int(rates.sizes[number - 1])
    return Law(beta, error, f, q, rest, log10_f_tail(f, q, rest), upto)


@cache
def constant_law(run: Run, method: str, distribution: str, part: str) -> Law | None:
    """One chance for all sizes that are known well, by generalised least squares."""
    found = continuation(run, method, distribution, part)
    if found is None:
        return None
    rates = found[1]
    number = min(rates.n_sure, rates.df // 3)
    if number < 2:
        return None
    inverse = np.linalg.inv(rates.covariance[:number, :number])
    ones = np.ones(number)
    rate = ones @ inverse @ rates.rates[:number] / (ones @ inverse @ ones)
    return _judged(rates, number, np.array([rate]), ones[:, None], rates.rates[:number] - rate)


@cache
def falling_law(run: Run, method: str, distribution: str, part: str) -> Law | None:
    """lambda / (k + b)^a, looked for in b by Brent, the rest by Gauss and Newton."""
    rates = continuation(run, method, distribution, part)[1]  # type: ignore[index]
    number = min(rates.n_sure, rates.df // 3)
    if number < 4:
        return None
    k, c = rates.sizes[:number].astype(float), rates.rates[:number]
    root = np.linalg.inv(np.linalg.cholesky(rates.covariance[:number, :number]))

    def held(log_base: float) -> optimize.OptimizeResult:
        base = np.log((k - 2 + np.exp(log_base)) / np.exp(log_base))
        return optimize.least_squares(
            lambda two: root @ (c - np.exp(two[0] - two[1] * base)), [np.log(c[0]), 0.5],
            x_scale="jac", xtol=1e-14, ftol=1e-14, gtol=1e-14,
        )  # fmt: skip

    grid = np.linspace(np.log(0.05), np.log(200), 60)
    costs = [held(b).cost for b in grid]
    at = int(np.argmin(costs))
    if at in (0, len(grid) - 1):
        return None
    log_base = optimize.minimize_scalar(
        lambda b: held(b).cost, bounds=(grid[at - 1], grid[at + 1]), method="bounded",
        options={"xatol": 1e-9},
    ).x  # fmt: skip
    log_first, a = held(log_base).x
    b = np.exp(log_base) - 2
    scale = np.exp(log_first + a * log_base)
    curve = scale / (k + b) ** a
    slopes = np.column_stack([curve / scale, -a * curve / (k + b), -curve * np.log(k + b)])
    return _judged(rates, number, np.array([scale, b, a]), slopes, c - curve)


def longest(chance: object, paths: float) -> int | None:
    """The first size of which fewer than one longer path is expected."""
    size = 2
    while True:
        c = float(chance(size))  # type: ignore[operator]
        if not c < 1:
            return None
        paths *= c
        if paths < 1:
            return size
        size += 1
