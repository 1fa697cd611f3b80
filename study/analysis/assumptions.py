"""Tables 2 and 3: tests of the groups' equal variances and normality."""

from collections.abc import Iterator

import numpy as np
from scipy import stats

from study.analysis.measurements import (
    SIGNIFICANCE,
    Measurements,
    Missing,
    NotEnough,
    Row,
    for_each_population,
)
from study.analysis.table import DISTRIBUTION, METHOD, N_POINTS, Column, Table
from study.statistics.multiple_testing import holm
from study.statistics.tails import log10_f_tail

#: What scipy's Shapiro-Wilk test needs, and beyond what it approximates p without a warrant.
_SHAPIRO_LEAST, _SHAPIRO_MOST = 3, 5000

_LEVENE = (
    METHOD,
    DISTRIBUTION,
    Column("center", "Centred at"),
    Column("df_group", "Df, groups", "", "int"),
    Column("df_residual", "Df, residuals", "", "int"),
    Column("f", "F", "", "fixed2"),
    Column("p", "p", "", "p"),
    Column("log10_p", "log10 p", "", "log10p"),
    Column("equal_variances", "Equal variances"),
)

_SHAPIRO = (
    METHOD,
    DISTRIBUTION,
    N_POINTS,
    Column("w", "W", "", "fixed4"),
    Column("p", "p", "", "p"),
    Column("p_holm", "p, Holm", "", "p"),
    Column("normal", "Normal"),
)

_QQ = (
    METHOD,
    DISTRIBUTION,
    N_POINTS,
    Column("normal_quantile", "Normal quantile", "", "fixed3"),
    Column("standardised_mean", "Standardised mean LEPP", "standard deviations", "fixed3"),
)


def levene(data: Measurements) -> tuple[Table, list[Missing]]:
    """Levene's test of equal variances, centred at the means (1960) and the medians (1974)."""

    def rows(method: str, distribution: str) -> Iterator[Row]:
        groups = data.groups(method, distribution).repeated(3)
        if len(groups) < 2:
            raise NotEnough("two or more sizes with three or more differing repetitions are needed")
        df_group, df_residual = len(groups) - 1, int(groups.counts.sum()) - len(groups)
        for center in ("mean", "median"):
            f, p = stats.levene(*groups.values, center=center)
            yield {
                "center": center,
                "df_group": df_group,
                "df_residual": df_residual,
                "f": f,
                "p": p,
                "log10_p": log10_f_tail(f, df_group, df_residual),
                "equal_variances": "rejected" if p < SIGNIFICANCE else "not rejected",
            }

    found, missing = for_each_population(data, "Levene's test", rows)
    note = (
        "Levene's test with deviations from the groups' means, and from their medians "
        "(Brown and Forsythe), which holds its level better when groups are skewed. "
        f"Rejected means p < {SIGNIFICANCE}."
    )
    title = "Equal variances of the groups? (Table 2)"
    return Table.from_rows("levene", title, _LEVENE, found, note), missing


def shapiro(data: Measurements) -> tuple[Table, list[Missing]]:
    """Shapiro-Wilk test of each group, with Holm's correction over the sizes."""

    def rows(method: str, distribution: str) -> Iterator[Row | NotEnough]:
        tested: list[Row] = []
        p_values = []
        groups = data.groups(method, distribution)
        for size, values in zip(groups.n_points.tolist(), groups.values, strict=True):
            if not _SHAPIRO_LEAST <= len(values) <= _SHAPIRO_MOST or not np.ptp(values):
                yield NotEnough(
                    f"{size} points: {_SHAPIRO_LEAST} to {_SHAPIRO_MOST} differing triangulations "
                    f"are needed, there are {len(np.unique(values))}"
                )
                continue
            w, p = stats.shapiro(values)
            tested.append({"n_points": size, "w": w, "p": p})
            p_values.append(p)
        for row, p_holm in zip(tested, holm(np.array(p_values)), strict=True):
            verdict = "rejected" if p_holm < SIGNIFICANCE else "not rejected"
            yield row | {"p_holm": p_holm, "normal": verdict}

    found, missing = for_each_population(data, "Shapiro-Wilk test", rows)
    note = (
        "Each method and distribution is a family of tests: Holm's correction keeps the chance of "
        f"any false rejection in it at {SIGNIFICANCE:.0%}. Without it, one group in twenty falls "
        "below 0.05 even if all are normal."
    )
    title = "Normal groups? Shapiro-Wilk tests (Table 3)"
    return Table.from_rows("shapiro", title, _SHAPIRO, found, note), missing


def qq(data: Measurements) -> tuple[Table, list[Missing]]:
    """Pair normal quantiles with the means, standardised in their groups and pooled."""

    def rows(method: str, distribution: str) -> Iterator[Row]:
        groups = data.groups(method, distribution).repeated(3)
        groups.need(1)
        values = np.concatenate([stats.zscore(group, ddof=1) for group in groups.values])
        sizes = np.repeat(groups.n_points, groups.counts)
        order = np.argsort(values, kind="stable")
        # Blom's plotting positions
        quantiles = stats.norm.ppf((np.arange(1, len(values) + 1) - 0.375) / (len(values) + 0.25))
        for size, quantile, value in zip(sizes[order], quantiles, values[order], strict=True):
            yield {"n_points": size, "normal_quantile": quantile, "standardised_mean": value}

    found, missing = for_each_population(data, "QQ plot", rows)
    note = (
        "Each mean LEPP size less its group's mean, in its group's standard deviations; all groups "
        "of a method and distribution together. Points on the diagonal are normal."
    )
    return Table.from_rows("qq", "Normal QQ plot of the means", _QQ, found, note), missing
