"""Analysis of variance by regression, by formula and by ranks."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats
from statsmodels.formula.api import ols
from statsmodels.stats.anova import anova_lm
from test_group_assumptions import values_of


def rows(study, test):
    _, (results, *_), tables = study
    for row in tables["anova"].frame.query("test == @test").itertuples():
        yield row, list(values_of(results, row.method, row.distribution).values())


def test_classical_is_the_regression_on_groups(study):
    for row, groups in rows(study, "classical"):
        data = pd.DataFrame(
            {
                "y": np.concatenate(groups),
                "g": np.repeat(range(len(groups)), [len(g) for g in groups]),
            }
        )
        table = anova_lm(ols("y ~ C(g)", data).fit())
        between, within = table["sum_sq"]
        assert row.statistic == pytest.approx(table["F"].iloc[0])
        assert row.p == pytest.approx(table["PR(>F)"].iloc[0])
        assert 10**row.log10_p == pytest.approx(row.p)
        assert (row.df_group, row.df_residual) == tuple(table["df"])
        if row.effect == "η²":
            assert row.effect_size == pytest.approx(between / (between + within))
        else:
            mean_square = within / table["df"].iloc[1]
            omega = (between - 3 * mean_square) / (between + within + mean_square)
            assert row.effect_size == pytest.approx(max(omega, 0))


def test_welch_by_its_formula(study):
    for row, groups in rows(study, "Welch"):
        w = np.array([len(g) / g.var(ddof=1) for g in groups])
        means = np.array([g.mean() for g in groups])
        k = len(groups)
        center = (w * means).sum() / w.sum()
        lost = sum((1 - w / w.sum()) ** 2 / (np.array([len(g) for g in groups]) - 1))
        f = (w * (means - center) ** 2).sum() / (k - 1)
        f /= 1 + 2 * (k - 2) / (k**2 - 1) * lost
        df = (k**2 - 1) / (3 * lost)
        assert (row.statistic, row.df_residual) == pytest.approx((f, df))
        assert row.p == pytest.approx(stats.f.sf(f, k - 1, df))
        assert 10**row.log10_p == pytest.approx(row.p)


def test_kruskal_by_its_formula(study):
    for row, groups in rows(study, "Kruskal-Wallis"):
        ranks = np.split(
            stats.rankdata(np.concatenate(groups)), np.cumsum([len(g) for g in groups])[:-1]
        )
        n = sum(map(len, groups))
        h = 12 / (n * (n + 1)) * sum(len(r) * r.mean() ** 2 for r in ranks) - 3 * (n + 1)
        assert row.statistic == pytest.approx(h)
        assert row.p == pytest.approx(stats.chi2.sf(h, 3))
        assert 10**row.log10_p == pytest.approx(row.p)
        assert row.effect_size == pytest.approx(h * (n + 1) / (n**2 - 1))


def test_the_published_anova_follows_from_the_published_means(paper_study):
    row = paper_study[2]["anova"].frame.iloc[0]
    assert row["statistic"] == pytest.approx(33.34, abs=0.5)
