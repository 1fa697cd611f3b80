"""Table 5: classical, Welch's and rank-based analysis of variance of the groups' means."""

from collections.abc import Iterator

from scipy import optimize, special, stats

from study.analysis.measurements import (
    CONFIDENCE,
    Groups,
    Measurements,
    Missing,
    Row,
    for_each_population,
)
from study.analysis.table import DISTRIBUTION, METHOD, Column, Table
from study.statistics.tails import log10_chi2_tail, log10_f_tail

_ANOVA = (
    METHOD,
    DISTRIBUTION,
    Column("test", "Test"),
    Column("df_group", "Df, groups", "", "int"),
    Column("df_residual", "Df, residuals", "", "g6"),
    Column("statistic", "F or H", "", "fixed2"),
    Column("p", "p", "", "p"),
    Column("log10_p", "log10 p", "", "log10p"),
    Column("effect", "Effect size"),
    Column("effect_size", "Share of variance", "", "fixed3"),
    Column("effect_low", "95 % from", "", "fixed3"),
    Column("effect_high", "95 % to", "", "fixed3"),
)


def anova(data: Measurements) -> tuple[Table, list[Missing]]:
    """One-way analysis of variance of the mean LEPP sizes by number of points, three ways."""

    def rows(method: str, distribution: str) -> Iterator[Row]:
        groups = data.groups(method, distribution).repeated()
        groups.need(2)
        yield from _classical(groups)
        yield _welch(groups)
        yield _kruskal(groups)

    found, missing = for_each_population(data, "analysis of variance", rows)
    note = (
        "H0: all groups have the same mean LEPP size. The classical test supposes equal variances, "
        "Welch's does not, Kruskal-Wallis compares ranks (p from its chi-squared limit). "
        "Effect sizes are shares of the variance that the number of points accounts for; "
        "eta squared is the sample's, omega squared corrects its bias; their intervals come from "
        "the noncentral F distribution and are those of the population's share, for which the "
        "sample's eta squared is a little high. "
        "There is no such interval for epsilon squared."
    )
    title = "Equal means of the groups? (Table 5)"
    return Table.from_rows("anova", title, _ANOVA, found, note), missing


def _classical(groups: Groups) -> Iterator[Row]:
    f = float(stats.f_oneway(*groups.values).statistic)
    total = int(groups.counts.sum())
    df1, df2 = len(groups) - 1, total - len(groups)
    low, high = population_share(f, df1, df2, total)
    effects = {
        "eta squared": f * df1 / (f * df1 + df2),
        "omega squared": max(0.0, df1 * (f - 1) / (df1 * (f - 1) + total)),
    }
    for effect, size in effects.items():
        yield {
            "test": "classical",
            "df_group": df1,
            "df_residual": df2,
            "statistic": f,
            "p": stats.f.sf(f, df1, df2),
            "log10_p": log10_f_tail(f, df1, df2),
            "effect": effect,
            "effect_size": size,
            "effect_low": low,
            "effect_high": high,
        }


def _welch(groups: Groups) -> Row:
    from statsmodels.stats.oneway import anova_oneway

    found = anova_oneway(groups.values, use_var="unequal", welch_correction=True)
    f, df1, df2 = float(found.statistic), int(found.df_num), float(found.df_denom)
    total = int(groups.counts.sum())
    low, high = population_share(f, df1, df2, total)
    return {
        "test": "Welch",
        "df_group": df1,
        "df_residual": df2,
        "statistic": f,
        "p": found.pvalue,
        "log10_p": log10_f_tail(f, df1, df2),
        "effect": "omega squared",
        "effect_size": max(0.0, df1 * (f - 1) / (df1 * (f - 1) + total)),
        "effect_low": low,
        "effect_high": high,
    }


def _kruskal(groups: Groups) -> Row:
    h, p = stats.kruskal(*groups.values)
    df = len(groups) - 1
    return {
        "test": "Kruskal-Wallis",
        "df_group": df,
        "statistic": h,
        "p": p,
        "log10_p": log10_chi2_tail(h, df),
        "effect": "epsilon squared",
        "effect_size": h / (groups.counts.sum() - 1),
    }


def population_share(f: float, df1: float, df2: float, total: int) -> tuple[float, float]:
    """Interval of the population's share of variance between groups, from an F statistic.

    Parameters
    ----------
    f : float
        F statistic with df1 and df2 degrees of freedom.
    total : int
        Number of observations.

    Notes
    -----
    With the interval of the noncentrality lambda, the share is lambda / (lambda + total);
    Steiger (2004), Psychological Methods 9, 164-182. statsmodels' interval stops at a lambda of
    10,000, which large meshes exceed.
    """
    tail = (1 - CONFIDENCE) / 2
    low, high = (_noncentrality(f, df1, df2, level) for level in (1 - tail, tail))
    return low / (low + total), high / (high + total)


def _noncentrality(f: float, df1: float, df2: float, level: float) -> float:
    # The lambda for which P(F <= f) is `level`; 0 where no lambda makes so small an f likely.
    def excess(lam: float) -> float:
        return float(special.ncfdtr(df1, df2, lam, f)) - level

    if excess(0) <= 0:
        return 0.0
    above = max(1.0, df1 * f)
    while excess(above) > 0:
        above *= 2
    return float(optimize.brentq(excess, 0, above, rtol=1e-10))
