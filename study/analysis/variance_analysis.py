"""Table 5: classical, Welch's and rank-based analysis of variance of the groups' means."""

from collections.abc import Iterator

from scipy import stats

from study.analysis.building import Population, rows_by_population
from study.analysis.table import DISTRIBUTION, METHOD, Column, Declaration, Row
from study.statistics.effect_size import eta_squared, omega_squared, population_share
from study.statistics.groups import Groups
from study.statistics.tails import log10_chi2_tail, log10_f_tail
from study.statistics.thresholds import LEVEL

CLASSICAL, WELCH, KRUSKAL_WALLIS = "classical", "Welch", "Kruskal-Wallis"
ETA_SQUARED, OMEGA_SQUARED, EPSILON_SQUARED = "η²", "ω²", "ε²"

ANOVA = Declaration(
    "anova",
    "Equal means of the groups? (Table 5)",
    (
        METHOD,
        DISTRIBUTION,
        Column("test", "Test"),
        Column("df_group", "Df, groups", "", "int"),
        Column("df_residual", "Df, residuals", "", "df"),
        Column("statistic", "F or H", "", "fixed2"),
        Column("p", "p", "", "p"),
        Column("log10_p", "log10 p", "", "log10p"),
        Column("effect", "Effect size"),
        Column("effect_size", "Share of variance", "", "fixed3"),
        Column("effect_low", f"{LEVEL} from", "", "fixed3"),
        Column("effect_high", f"{LEVEL} to", "", "fixed3"),
    ),
    note="Tested is whether all groups have the same mean LEPP size. The classical test supposes "
    "equal variances, Welch's does not, Kruskal-Wallis compares ranks (p from its χ² limit). "
    "Effect sizes are shares of the variance between triangulations that the number of points "
    "accounts for: they belong to the design, since other sizes, or more of some, give others; "
    "η² is the sample's, ω² corrects its bias; their intervals come from "
    "the noncentral F distribution and are those of the population's share, for which the "
    "sample's η² is a little high. "
    "There is no such interval for ε².",
)


@rows_by_population(ANOVA, "analysis of variance")
def anova(one: Population) -> Iterator[Row]:
    """One-way analysis of variance of the mean LEPP sizes by number of points, three ways."""
    groups = one.groups.repeated()
    groups.need(2)
    yield from _classical(groups)
    yield _welch(groups)
    yield _kruskal(groups)


def _classical(groups: Groups) -> Iterator[Row]:
    f = float(stats.f_oneway(*groups.values).statistic)
    total = int(groups.counts.sum())
    df1, df2 = len(groups) - 1, total - len(groups)
    low, high = population_share(f, df1, df2, total)
    effects = {
        ETA_SQUARED: eta_squared(f, df1, df2),
        OMEGA_SQUARED: omega_squared(f, df1, total),
    }
    for effect, size in effects.items():
        yield {
            "test": CLASSICAL,
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

    test = anova_oneway(groups.values, use_var="unequal", welch_correction=True)
    f, df1, df2 = float(test.statistic), int(test.df_num), float(test.df_denom)
    total = int(groups.counts.sum())
    low, high = population_share(f, df1, df2, total)
    return {
        "test": WELCH,
        "df_group": df1,
        "df_residual": df2,
        "statistic": f,
        "p": test.pvalue,
        "log10_p": log10_f_tail(f, df1, df2),
        "effect": OMEGA_SQUARED,
        "effect_size": omega_squared(f, df1, total),
        "effect_low": low,
        "effect_high": high,
    }


def _kruskal(groups: Groups) -> Row:
    h, p = stats.kruskal(*groups.values)
    df = len(groups) - 1
    return {
        "test": KRUSKAL_WALLIS,
        "df_group": df,
        "statistic": h,
        "p": p,
        "log10_p": log10_chi2_tail(h, df),
        "effect": EPSILON_SQUARED,
        "effect_size": h / (groups.counts.sum() - 1),
    }
