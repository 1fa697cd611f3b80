"""Tables 2 and 3: tests of the groups' equal variances and normality."""

from collections.abc import Iterator

import numpy as np
from scipy import stats

from study.analysis.building import Population, rows_by_population
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Declaration, Row
from study.statistics.groups import NotEnough
from study.statistics.multiple_testing import holm
from study.statistics.tails import log10_f_tail
from study.statistics.thresholds import SIGNIFICANCE
from study.statistics.verdicts import rejected

#: What scipy's Shapiro-Wilk test needs, and beyond what it approximates p without a warrant.
_SHAPIRO_LEAST, _SHAPIRO_MOST = 3, 5000

#: Where Levene's test measures deviations from: the first is Levene's own, as the paper has it.
CENTERS = ("mean", "median")

LEVENE = Declaration(
    "levene",
    "Equal variances of the groups? (Table 2)",
    (
        METHOD,
        DISTRIBUTION,
        Column("center", "Centred at"),
        Column("df_group", "Df, groups", "", "int"),
        Column("df_residual", "Df, residuals", "", "int"),
        Column("f", "F", "", "fixed2"),
        Column("p", "p", "", "p"),
        Column("log10_p", "log10 p", "", "log10p"),
        Column("equal_variances", "Equal variances"),
    ),
    note="Levene's test with deviations from the groups' means, and from their medians "
    "(Brown and Forsythe), which holds its level better when groups are skewed. "
    f"Rejected means p < {SIGNIFICANCE}.",
)

SHAPIRO = Declaration(
    "shapiro",
    "Normal groups? Shapiro-Wilk tests (Table 3)",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        Column("w", "W", "", "fixed4"),
        Column("p", "p", "", "p"),
        Column("p_holm", "p, Holm", "", "p"),
        Column("normal", "Normal"),
    ),
    note="Each method and distribution is a family of tests: Holm's correction keeps the chance of "
    f"any false rejection in it at {SIGNIFICANCE:.0%}. Without it, one group in "
    f"twenty falls below {SIGNIFICANCE} even if all are normal.",
)

QQ = Declaration(
    "qq",
    "Normal QQ plot of the means",
    (
        METHOD,
        DISTRIBUTION,
        N_POINTS,
        Column("normal_quantile", "Normal quantile", "", "fixed3"),
        Column("standardised_mean", "Standardised mean LEPP", "standard deviations", "fixed3"),
    ),
    note="Each mean LEPP size less its group's mean, in its group's standard deviations; all "
    "groups of a method and distribution together. Points on the diagonal are normal.",
)


@rows_by_population(LEVENE, "Levene's test")
def levene(one: Population) -> Iterator[Row]:
    """Levene's test of equal variances, centred at the means (1960) and the medians (1974)."""
    groups = one.groups.repeated(3)
    if len(groups) < 2:
        raise NotEnough("two or more sizes with three or more differing repetitions are needed")
    df_group, df_residual = len(groups) - 1, int(groups.counts.sum()) - len(groups)
    for center in CENTERS:
        f, p = stats.levene(*groups.values, center=center)
        yield {
            "center": center,
            "df_group": df_group,
            "df_residual": df_residual,
            "f": f,
            "p": p,
            "log10_p": log10_f_tail(f, df_group, df_residual),
            "equal_variances": rejected(p < SIGNIFICANCE),
        }


@rows_by_population(SHAPIRO, "Shapiro-Wilk test")
def shapiro(one: Population) -> Iterator[Row]:
    """Shapiro-Wilk test of each group, with Holm's correction over the sizes."""
    tested: list[Row] = []
    p_values = []
    single = one.data.design.single_sizes_of(one.method)
    for size, values in zip(one.groups.n_points.tolist(), one.groups.values, strict=True):
        if not _SHAPIRO_LEAST <= len(values) <= _SHAPIRO_MOST or not np.ptp(values):
            if size not in single:
                one.lacks(
                    f"{size} points: {_SHAPIRO_LEAST} to {_SHAPIRO_MOST} differing triangulations "
                    f"are needed, there are {len(np.unique(values))}"
                )
            continue
        w, p = stats.shapiro(values)
        tested.append({"n_points": size, "w": w, "p": p})
        p_values.append(p)
    for row, p_holm in zip(tested, holm(np.array(p_values)), strict=True):
        yield row | {"p_holm": p_holm, "normal": rejected(p_holm < SIGNIFICANCE)}


@rows_by_population(QQ, "QQ plot")
def qq(one: Population) -> Iterator[Row]:
    """Pair normal quantiles with the means, standardised in their groups and pooled."""
    groups = one.groups.repeated(3)
    groups.need(1)
    values = np.concatenate([stats.zscore(group, ddof=1) for group in groups.values])
    sizes = np.repeat(groups.n_points, groups.counts)
    order = np.argsort(values, kind="stable")
    # Blom's plotting positions
    quantiles = stats.norm.ppf((np.arange(1, len(values) + 1) - 0.375) / (len(values) + 0.25))
    for size, quantile, value in zip(sizes[order], quantiles, values[order], strict=True):
        yield {"n_points": size, "normal_quantile": quantile, "standardised_mean": value}
