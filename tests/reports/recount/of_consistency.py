"""The paper beside its own Table 4, and the sets of its Table 1: published.json as JSON."""

from collections import Counter
from functools import cache

import numpy as np
import statsmodels.api as sm
from expected import Sheet, listed
from growth import BASES
from recounts import View, recount
from run_data import Run, log10_f_tail, log10_t_tail
from scipy import stats

#: Triangulations of each published group.
REPETITIONS = 40


def table_4(run: Run) -> list[list[float]]:
    return run.published["table_4_uniform"]["rows"]


def _fit(model: str, x: np.ndarray, m: np.ndarray, sd: np.ndarray) -> dict[str, float]:
    """Regression of groups of which means and sds are known, as weighted least squares of means."""
    z, spread = m, sd
    if model == "logistic":
        # To the second order of the spread inside a group, which is small.
        slope, bend = 4 / (m * (4 - m)), -1 / m**2 + 1 / (4 - m) ** 2
        z, spread = np.log(m / (4 - m)) + bend * sd**2 / 2, slope * sd
    basis = np.column_stack(BASES[model](x))
    if model == "logarithmic":
        basis[:, 1] /= np.log(2)
    found = sm.OLS(z, basis).fit()
    n, d1 = REPETITIONS * len(x), basis.shape[1] - 1
    left = REPETITIONS * found.ssr + (REPETITIONS - 1) * float((spread**2).sum())
    explained = REPETITIONS * found.ess
    f = explained / d1 / (left / (n - d1 - 1))
    r2 = 1 - left / (n - d1 - 1) / ((left + explained) / (n - 1))
    made = {str(k): float(b) for k, b in enumerate(found.params)}
    return made | {"adj_r2": r2, "log10_p": log10_f_tail(f, d1, n - d1 - 1)}


def _printed_numbers(run: Run) -> list[tuple[float, float, object]]:
    """Printed number, half a unit, and the function of means and sds that gives it."""
    p, table = run.published, np.array(table_4(run), dtype=float)
    x, root = table[:, 0], np.sqrt(REPETITIONS)
    made: list[tuple[float, float, object]] = []

    def f(m: np.ndarray, sd: np.ndarray) -> float:
        return REPETITIONS * m.var(ddof=1) / float((sd**2).mean())

    made.append((p["table_5_uniform_anova"]["f"], 0.005, f))
    for row in p["table_6_t_test_mean_below_4"]["rows"]:
        at = int(np.flatnonzero(x == row[0])[0])
        half = 0.005 * 10.0 ** np.floor(np.log10(row[1]))

        def p_below(m: np.ndarray, sd: np.ndarray, i: int = at) -> float:
            return 10 ** log10_t_tail((4 - m[i]) / sd[i] * root, REPETITIONS - 1)

        made.append((row[1], half, p_below))
    terms = {
        "linear": (("intercept", 3, 0), ("x", 8, 1)),
        "quadratic": (("intercept", 3, 0), ("x", 6, 1), ("x2", None, 2)),
        "logistic": (("a", 3, 0), ("b", 6, 1)),
        "logarithmic": (("c", 3, 0), ("d", 4, 1)),
    }
    for model, names in terms.items():
        seven = p["table_7_uniform_regressions"][model]
        for name, places, place in names:
            value = seven[name]
            half = (
                0.5 * 10.0**-places
                if places is not None
                else 0.005 * 10.0 ** np.floor(np.log10(abs(value)))
            )
            made.append((value, half, lambda m, sd, w=model, i=place: _fit(w, x, m, sd)[str(i)]))
        made.append((seven["adj_r2"], 0.005, lambda m, sd, w=model: _fit(w, x, m, sd)["adj_r2"]))
        half = 0.005 * 10.0 ** np.floor(np.log10(seven["p"]))
        made.append((seven["p"], half, lambda m, sd, w=model: 10 ** _fit(w, x, m, sd)["log10_p"]))
    return made


@cache
def consistent_numbers(run: Run) -> tuple[int, int]:
    """Numbers that follow from Table 4, and those that its rounding allows, by its corners."""
    table = np.array(table_4(run), dtype=float)
    m, sd, half = table[:, 3], table[:, 4], 5e-5
    fits = 0
    numbers = _printed_numbers(run)
    for value, unit, function in numbers:
        slopes = []
        for which in (0, 1):
            for i in range(len(m)):
                step = np.zeros(len(m))
                step[i] = half / 4
                up, down = (
                    (m + sign * step, sd) if which == 0 else (m, sd + sign * step)
                    for sign in (1, -1)
                )
                slopes.append(np.sign(function(*up) - function(*down)))  # type: ignore[operator]
        way = np.array(slopes).reshape(2, -1) * half
        ends = [function(m + sign * way[0], sd + sign * way[1]) for sign in (-1, 1)]  # type: ignore[operator]
        fits += ends[0] <= value + unit and ends[1] >= value - unit
    # Its p that is printed as zero is zero to four decimals.
    fits += log10_f_tail(REPETITIONS * m.var(ddof=1) / float((sd**2).mean()), 19, 780) < -5
    return len(numbers) + 2, int(fits)


@recount("consistency", ".* published numbers? of Tables")
def follows(v: View, s: Sheet, k: int) -> str:
    number, fits = consistent_numbers(v.run)
    return (
        f"{s(number)} published numbers of Tables 5, 6 and 7 follow from the means and standard "
        f"deviations of the paper's own Table 4; {'all' if fits == number else s(fits)} of them "
        "lie in the range that the rounding of Table 4 leaves open."
    )


@recount("consistency", "1 number is a misprint")
def misprint(v: View, s: Sheet, k: int) -> str:
    table = np.array(table_4(v.run), dtype=float)
    x, m = table[:, 0], table[:, 3]
    weights = (x - x.mean()) / ((x - x.mean()) ** 2).sum()
    slope, off = weights @ m, 5e-5 * np.abs(weights).sum()
    printed = float(v.run.published["table_7_uniform_regressions"]["linear"]["x_printed"])
    return (
        f"1 number is a misprint, whatever the data were: {s(printed)} (linear, b, as printed), "
        f"where Table 4 gives {s(slope - off)} to {s(slope + off)}."
    )


@cache
def possible(run: Run, n: int) -> tuple[int, float]:
    """Printed runs p-values that a set of n points can have, and how many would be by chance."""
    sd = np.sqrt(n * (n - 2) / (4 * (n - 1)))
    lattice = Counter(f"{p:.4f}" for p in stats.norm.sf(np.arange(5 * int(sd)) / sd) * 2)
    rows = run.published["table_1_uniform_runs_and_ks"]["rows"]
    printed = [f"{row[c]:.4f}" for row in rows for c in (1, 2)]
    return sum(p in lattice for p in printed), len(printed) * len(lattice) / 10_001


@recount("table-1-sets", "The 8 that")
def table_1_sets(v: View, s: Sheet, k: int) -> str:
    found = {1000 * row[0]: possible(v.run, 1000 * row[0]) for row in table_4(v.run)}
    fitting = {n: chance for n, (hits, chance) in found.items() if hits == 8}
    most = max(hits for hits, _ in found.values() if hits < 8)
    return (
        f"The {s(8)} that Table 1 prints are all possible for sets of "
        f"{listed([s(n) for n in fitting])} points ({listed([s(c) for c in fitting.values()])} "
        f"would be by chance), and at most {s(most)} of them for any other size: Table 1 tests "
        "sets of that group, and is compared with ours of that size."
    )
