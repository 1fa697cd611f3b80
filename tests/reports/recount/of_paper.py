"""The paper's numbers beside the run's, and beside its own Table 4: published.json as JSON."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from expected import Sheet, listed, plural
from of_consistency import REPETITIONS, possible, table_4
from of_statistics import levene
from recounts import View, recount
from run_data import Run, log10_chi2_tail
from scipy import special, stats

MEAN, SD = "the mean LEPP size", "its standard deviation"
TRIANGLES, LARGEST = "the number of triangles", "the largest LEPP"
_SHOWN = "uniform"


@dataclass(frozen=True)
class Compared:
    """A published number in standard errors from ours, and the chance of more than 2."""

    kind: str
    n: int
    z: float
    beyond: float
    distribution: str = _SHOWN


def _beyond(error: float, unit: float) -> float:
    """Chance that a normal error and an even rounding are together beyond 2 of their joint sd."""
    limit = 2 * np.hypot(error, unit / np.sqrt(12))
    at = np.linspace(-unit / 2, unit / 2, 4001)
    tails = stats.norm.sf((limit - at) / error) + stats.norm.sf((limit + at) / error)
    return float(np.trapezoid(tails, at) / unit) if unit > 0 else float(tails[0])


def _bootstrap(means: np.ndarray, sds: np.ndarray, seed: int) -> float:
    """Standard deviation of ln F of Levene's test between normal replications."""
    rng = np.random.default_rng(seed)
    drawn = []
    for _ in range(4000):
        noise = rng.standard_normal((len(means), REPETITIONS))
        drawn.append(np.log(levene(list(means[:, None] + sds[:, None] * noise))[0]))
    return float(np.std(drawn, ddof=1))


def has_published_design(run: Run, method: str) -> bool:
    counts = run.rows(method, _SHOWN)["n_points"].value_counts().to_dict()
    return counts == {1000 * row[0]: REPETITIONS for row in table_4(run)}


@cache
def independent(run: Run, method: str) -> list[Compared]:
    """All independent numbers: Table 4, Levene's F, and Table 6 but for its uniform column."""
    made = []
    groups = run.groups(method, _SHOWN)
    for thousands, triangles, largest, mean, sd in table_4(run):
        n = 1000 * thousands
        if n not in groups:
            continue
        rows, r = run.rows(method, _SHOWN, n), len(groups[n])
        ours = groups[n].std(ddof=1)
        # The paper has no spread of these two: ours stands for both.
        of_triangles, of_largest = (rows[c].std() for c in ("n_triangles", "max_lepp"))
        for kind, value, at, spread, theirs, unit in (
            (TRIANGLES, rows["n_triangles"].mean(), triangles, of_triangles, of_triangles, 0.01),
            (LARGEST, rows["max_lepp"].mean(), largest, of_largest, of_largest, 1.0),
            (MEAN, groups[n].mean(), mean, ours, sd, 1e-4),
        ):
            error = np.sqrt(spread**2 / r + theirs**2 / REPETITIONS)
            z = (value - at) / np.sqrt(error**2 + unit**2 / 12)
            made.append(Compared(kind, n, z, _beyond(error, unit)))
        error, unit = np.sqrt(0.5 / (r - 1) + 0.5 / (REPETITIONS - 1)), 1e-4 / sd
        z = np.log(ours / sd) / np.sqrt(error**2 + unit**2 / 12)
        made.append(Compared(SD, n, z, _beyond(error, unit)))
    if has_published_design(run, method):
        printed = run.published["table_2_uniform_levene"]["f"]
        table = np.array(table_4(run))
        ours = np.array([(g.mean(), g.std(ddof=1)) for g in groups.values()])
        error = np.hypot(_bootstrap(*ours.T, 1), _bootstrap(table[:, 3], table[:, 4], 2))
        unit = 0.01 / printed
        f = levene(list(groups.values()))[0]
        z = np.log(f / printed) / np.hypot(error, unit / np.sqrt(12))
        made.append(Compared("levene", 0, float(z), _beyond(error, unit)))
    table_6 = run.published["table_6_t_test_mean_below_4"]
    for thousands, *row in table_6["rows"]:
        for distribution, p in zip(table_6["columns"][1:], row, strict=True):
            if distribution == _SHOWN or distribution not in run.distributions:
                continue
            group = run.groups(method, distribution).get(1000 * thousands)
            if group is None:
                continue
            r = len(group)
            published = stats.t.isf(p, REPETITIONS - 1) / np.sqrt(REPETITIONS)
            ours = (4 - group.mean()) / group.std(ddof=1)
            error = np.sqrt(0.5 / (r - 1) + 0.5 / (REPETITIONS - 1))
            z = float(np.log(ours / published) / error)
            beyond = float(2 * stats.norm.sf(2))
            made.append(Compared("t", 1000 * thousands, z, beyond, distribution))
    return made


def of_kind(run: Run, method: str, kind: str) -> np.ndarray:
    """Differences of one kind of number, by size."""
    return np.array([c.z for c in independent(run, method) if c.kind == kind])


CLOSER = "agrees closer than chance"


def _together(z: np.ndarray, shift: bool) -> tuple[str, float, float]:
    """Verdict, chi-squared and log10 p of differences together."""
    chi2 = float(z @ z)
    p = 10 ** log10_chi2_tail(chi2, len(z))
    common = 2 * stats.norm.sf(abs(z.sum()) / np.sqrt(len(z)))
    verdict = "agrees"
    if min(p, common if shift else 1.0) < 0.01:
        verdict = "differs"
    elif stats.chi2.cdf(chi2, len(z)) < 0.01:
        verdict = CLOSER
    return verdict, chi2, log10_chi2_tail(chi2, len(z))


def standings(run: Run) -> dict[str, int]:
    """How many published numbers there are of each standing, counted in published.json."""
    p = run.published
    table_4 = 4 * len(p["table_4_uniform"]["rows"])
    table_6 = p["table_6_t_test_mean_below_4"]
    n_table_6 = len(table_6["rows"])
    seven = p["table_7_uniform_regressions"]
    models = ("linear", "quadratic", "logistic", "logarithmic")
    of_7 = sum(len(set(seven[m]) - {"x_printed", "form"}) for m in models) + 1
    return {
        "independent": table_4 + 1 + n_table_6 * (len(table_6["columns"]) - 2),
        "implied": of_7 + 1 + n_table_6,
        "construction": 4 + 2,
        "same": len(p["table_3_uniform_shapiro_wilk"]["rows"]),
        "draws": 4 * len(p["table_1_uniform_runs_and_ks"]["rows"])
        + len(p["table_3_uniform_shapiro_wilk"]["rows"]),
    }


@recount("scoreboard", "The paper prints")
def printed(v: View, s: Sheet, k: int) -> str:
    return f"The paper prints {s(sum(standings(v.run).values()))} numbers in its seven tables."


@recount("scoreboard", ".* of them are not derived")
def counted(v: View, s: Sheet, k: int) -> str:
    z = np.abs([c.z for c in independent(v.run, v.method)])
    within = int((z <= 2).sum()), int(((z > 2) & (z <= 3)).sum()), int((z > 3).sum())
    return (
        f"{s(len(z))} of them are not derived from another printed number, and can be held against "
        f"ours by their standard errors: {s(within[0])} within 2 (agreement), {s(within[1])} "
        f"within 3 (close) and {s(within[2])} beyond (different)."
    )


@recount("scoreboard", "By chance")
def by_chance(v: View, s: Sheet, k: int) -> str:
    found = independent(v.run, v.method)
    beyond = sum(abs(c.z) > 2 for c in found)
    expected = sum(c.beyond for c in found)
    return (
        f"By chance {s(expected, 2e-3)} would be beyond 2; {s(beyond)} "
        f"{plural(max(beyond, 1), 'is', 'are')}."
    )


@recount("scoreboard", "All together")
def all_together(v: View, s: Sheet, k: int) -> str:
    z = np.array([c.z for c in independent(v.run, v.method)])
    verdict, chi2, p = _together(z, shift=False)
    words = {
        "agrees": "are as far from ours as chance puts them",
        "differs": "are further from ours than chance puts them",
        CLOSER: "are nearer to ours than chance puts them",
    }[verdict]
    # The bootstrap's own error is that of one number of all.
    levene_z = of_kind(v.run, v.method, "levene")
    slack = 0.05 * float(levene_z @ levene_z) + 1e-3
    less = stats.chi2.cdf(chi2, len(z))
    return (
        f"All together they {words} (χ² = {s(chi2, slack)} on {s(len(z))} degrees of freedom; "
        f"{s.p_is(p, 0.25 * slack)} for more, {s(less, 0.02 * slack)} for less)."
    )


@recount("scoreboard", "Over all groups")
def shifts(v: View, s: Sheet, k: int) -> str:
    each, off = [], []
    for kind in (MEAN, SD, TRIANGLES, LARGEST):
        z = of_kind(v.run, v.method, kind)
        shift = z.sum() / np.sqrt(len(z))
        log_p = log10_chi2_tail(shift * shift, 1)
        each.append(f"{kind} {s(shift)} ({s.p_is(log_p, 1e-6)})")
        if log_p < -2:
            off.append(kind)
    which = (
        f"{listed(off)} {plural(len(off), 'is', 'are')} shifted to one side"
        if off
        else "no kind of number is shifted to one side by more than chance"
    )
    return f"Over all groups {which}; ours less the paper's, in standard errors: {listed(each)}."


def not_run(run: Run, method: str) -> dict[str, int]:
    """Published numbers by standing that are of groups which the run does not have."""
    sizes, p = set(run.groups(method, _SHOWN)), run.published
    table_3 = p["table_3_uniform_shapiro_wilk"]["rows"]
    without = sum(1000 * int(group[1:]) not in sizes for group, *_ in table_3)
    missing = {"same": without, "draws": without, "implied": 0}
    missing["independent"] = 4 * sum(1000 * row[0] not in sizes for row in table_4(run))
    table_6 = p["table_6_t_test_mean_below_4"]
    for distribution in table_6["columns"][1:]:
        run_too = distribution in run.distributions
        there = set(run.groups(method, distribution)) if run_too else set()
        standing = "implied" if distribution == _SHOWN else "independent"
        missing[standing] += sum(1000 * row[0] not in there for row in table_6["rows"])
    if not len(_sets_of_table_1(run)):
        missing["draws"] += 4 * len(p["table_1_uniform_runs_and_ks"]["rows"])
    return missing


def not_comparable(run: Run, method: str) -> dict[str, int]:
    """Numbers by standing of Tables 2, 5 and 7 that only the published design has."""
    n = standings(run)
    of_table_6 = len(run.published["table_6_t_test_mean_below_4"]["rows"])
    if has_published_design(run, method):
        return {}
    return {
        "independent": 1,
        "construction": n["construction"],
        "implied": n["implied"] - of_table_6,
    }


@recount("scoreboard", "Not counted are")
def not_counted(v: View, s: Sheet, k: int) -> str:
    n = standings(v.run)
    others = sum(n.values()) - len(independent(v.run, v.method))
    unlike, absent = not_comparable(v.run, v.method), not_run(v.run, v.method)
    counted = {key: n[key] - unlike.get(key, 0) - absent.get(key, 0) for key in n}
    counted |= {"unlike": sum(unlike.values()), "absent": sum(absent.values())}
    each = [
        f"{s(counted[key])} {words}"
        for key, words in (
            ("implied", "that follow from the paper's own Table 4"),
            ("construction", "that every run of this design gives"),
            ("same", "that stand beside the p-value of the same test"),
            ("draws", "that are random draws, which no other run can repeat"),
            ("unlike", "that cannot be compared with this design"),
            ("absent", "that belong to groups which this run does not have"),
        )
        if counted[key]
    ]
    return f"Not counted are the other {s(others)}: {listed(each)}."


@cache
def implausible(run: Run, method: str) -> tuple[int, int]:
    """Draws that are not plausible beside ours, and those that can be compared."""
    odd = number = 0
    printed = run.published["table_1_uniform_runs_and_ks"]["rows"]
    of_size = [1000 * row[0] for row in table_4(run) if possible(run, 1000 * row[0])[0] == 8]
    sets = run.point_sets
    sets = sets[(sets["distribution"] == _SHOWN) & sets["n_points"].isin(of_size)]
    for kind, columns in (("runs", (1, 2)), ("ks", (3, 4))):
        theirs = [row[c] for row in printed for c in columns]
        ours = sets[[f"{kind}_p_x", f"{kind}_p_y"]].to_numpy().ravel()
        ours = ours[~np.isnan(ours)]
        if len(ours):
            number += len(theirs)
            p = stats.mannwhitneyu(theirs, ours, method="asymptotic").pvalue
            odd += len(theirs) if p < 0.01 else 0
    for group, _, p in run.published["table_3_uniform_shapiro_wilk"]["rows"]:
        ours = run.groups(method, _SHOWN).get(1000 * int(group[1:]))
        if ours is not None:
            z = (special.ndtri(stats.shapiro(ours).pvalue) - special.ndtri(p)) / np.sqrt(2)
            number, odd = number + 1, odd + (abs(z) > 3)
    return int(odd), number


@recount("scoreboard", "(All|Of) .* draws? that")
def draws(v: View, s: Sheet, k: int) -> str:
    odd, number = implausible(v.run, v.method)
    those = f"{s(number)} {plural(number, 'draw')} that can be held against ours"
    if not odd:
        return f"All {those} are plausible."
    return f"Of {those}, {s(odd)} {plural(odd, 'is', 'are')} not plausible."


def _sets_of_table_1(run: Run) -> np.ndarray:
    of_size = [1000 * row[0] for row in table_4(run) if possible(run, 1000 * row[0])[0] == 8]
    sets = run.point_sets
    return sets[(sets["distribution"] == _SHOWN) & sets["n_points"].isin(of_size)].to_numpy()


@recount("table-4", "Over all groups together")
def group_by_group(v: View, s: Sheet, k: int) -> str:
    words = []
    for kind in (MEAN, SD, TRIANGLES, LARGEST):
        z = of_kind(v.run, v.method, kind)
        verdict, chi2, p = _together(z, shift=True)
        chance = s.p_is(p, 1e-6)
        if verdict == CLOSER:
            chance = f"{s.p_is(np.log10(stats.chi2.cdf(chi2, len(z))), 1e-6)} for less"
        words.append(
            f"{kind} {verdict} (χ² = {s(chi2)} on {s(len(z))} degrees of freedom, "
            f"{chance}; largest difference {s(np.abs(z).max())} standard errors)"
        )
    return f"Over all groups together, {listed(words)}."


@recount("figure-means", ".* group means? lie")
def group_means(v: View, s: Sheet, k: int) -> str:
    z = np.abs(of_kind(v.run, v.method, MEAN))
    return (
        f"{s((z <= 2).sum())} of {s(len(z))} {plural(len(z), 'group mean')} lie within 2 standard "
        f"errors of the published one and {s((z <= 3).sum())} within 3; the largest difference is "
        f"{s(z.max())}."
    )


@recount("figure-means", "The mean goes")
def mean_goes(v: View, s: Sheet, k: int) -> str:
    groups = v.run.all_groups(v.method, v.distribution)
    a, b = min(groups), max(groups)
    return (
        f"The mean goes from {s(groups[a].mean())} at {s(a)} points to {s(groups[b].mean())} at "
        f"{s(b)}."
    )


_PLAIN = "plain insertion, which never flips an edge"


@recount(
    "key-figures", "The (paper's triangulations|mean LEPP sizes that the|numbers of the paper)"
)
def which_triangulation(v: View, s: Sheet, k: int) -> str:
    tests = {m: _together(of_kind(v.run, m, MEAN), shift=True) for m in v.run.methods}

    def numbers(method: str) -> str:
        n, (_, chi2, p) = len(of_kind(v.run, method, MEAN)), tests[method]
        return f"(χ² = {s(chi2)} on {s(n)} degrees of freedom, {s.p_is(p, 1e-6)})"

    prints = "The mean LEPP sizes that the paper prints"
    if "incremental" not in tests:
        verb = "do not agree" if tests["delaunay"][0] == "differs" else "agree"
        return (
            f"{prints} {verb} with Delaunay triangulations {numbers('delaunay')}; {_PLAIN}, was "
            "not part of this run."
        )
    if tests["incremental"][0] == "differs":
        return (
            f"{prints} do not agree with this run's {_PLAIN} {numbers('incremental')}: this run "
            "does not tell which triangulation the paper used."
        )
    if "delaunay" not in tests:
        return f"{prints} agree with this run's {_PLAIN} {numbers('incremental')}."
    if tests["delaunay"][0] != "differs":
        return (
            f"{prints} agree with {_PLAIN}, and with Delaunay triangulations as well: this run is "
            "too small to tell which the paper used."
        )
    return (
        "The paper's triangulations are not Delaunay triangulations: the mean LEPP sizes that it "
        f"prints agree with {_PLAIN} {numbers('incremental')}."
    )


@recount("key-figures", "A user of CGAL")
def no_delaunay(v: View, s: Sheet, k: int) -> str:
    has = "has" if "delaunay" in v.run.methods else "does not have"
    return f"A user of CGAL would expect Delaunay triangulations, which this run {has} to compare."


@recount("key-figures", "Delaunay triangulations of this run's")
def beside_delaunay(v: View, s: Sheet, k: int) -> str:
    groups = v.run.groups("delaunay", _SHOWN)
    printed = {1000 * row[0]: row[3] for row in table_4(v.run)}
    n = max(set(groups) & set(printed))
    return (
        f"Delaunay triangulations of this run's {s(n)} uniform points have a mean of "
        f"{s(groups[n].mean())}, where the paper prints {s(printed[n])}."
    )
