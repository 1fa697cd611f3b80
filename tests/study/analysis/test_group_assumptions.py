"""Levene and Shapiro-Wilk by independent routes."""

import numpy as np
import pytest
from frames import design, frames
from scipy import stats
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.oneway import anova_oneway

from study.analysis.analyse import analyse


def values_of(results, method, distribution):
    chosen = results[(results["method"] == method) & (results["distribution"] == distribution)]
    return {n: g["mean_lepp"].to_numpy() for n, g in chosen.groupby("n_points")}


@pytest.mark.parametrize(("center", "of"), [("mean", np.mean), ("median", np.median)])
def test_levene_is_the_anova_of_absolute_deviations(study, center, of):
    _, (results, *_), tables = study
    for row in tables["levene"].frame.query("center == @center").itertuples():
        groups = values_of(results, row.method, row.distribution).values()
        deviations = [np.abs(group - of(group)) for group in groups]
        expected = anova_oneway(deviations, use_var="equal")
        assert row.f == pytest.approx(expected.statistic)
        assert row.p == pytest.approx(expected.pvalue)
        assert 10**row.log10_p == pytest.approx(expected.pvalue)
        assert (row.df_group, row.df_residual) == (3, 20)
        assert row.equal_variances == ("rejected" if expected.pvalue < 0.05 else "not rejected")


def test_shapiro_of_three_values_has_a_closed_form():
    # n = 3: W = 3/4 (range)^2 / (sum of squares), p = 6/pi (asin sqrt W - asin sqrt 3/4)
    asked = design(distributions=("uniform",), repetitions=3)
    made = frames(asked)
    frame = analyse(*made, asked)["shapiro"].frame
    assert len(frame) == 4
    for row in frame.itertuples():
        x = values_of(made[0], "incremental", "uniform")[row.n_points]
        w = 0.5 * np.ptp(x) ** 2 / ((x - x.mean()) ** 2).sum()
        assert row.w == pytest.approx(w)
        p = 6 / np.pi * (np.arcsin(np.sqrt(w)) - np.arcsin(np.sqrt(0.75)))
        assert row.p == pytest.approx(p, abs=1e-12)


def test_holm_corrects_within_method_and_distribution(study):
    frame = study[2]["shapiro"].frame
    for _, family in frame.groupby(["method", "distribution"]):
        rejected, adjusted, *_ = multipletests(family["p"], method="holm")
        np.testing.assert_allclose(family["p_holm"], adjusted)
        words = ["rejected" if one else "not rejected" for one in rejected]
        assert family["normal"].tolist() == words


def test_a_group_that_is_not_normal_is_rejected():
    asked = design(distributions=("uniform",), repetitions=8)
    results, *others = frames(asked)
    far = (results["replicate"] == 0) & (results["n_points"] == results["n_points"].max())
    results = results.assign(mean_lepp=results["mean_lepp"].where(~far, 9.0))
    frame = analyse(results, *others, asked)["shapiro"].frame
    assert frame["normal"].tolist() == ["not rejected"] * 3 + ["rejected"]


def test_qq_pairs_sorted_scores_with_normal_quantiles(study):
    _, (results, *_), tables = study
    qq = tables["qq"].frame.query("method == 'incremental' and distribution == 'uniform'")
    groups = values_of(results, "incremental", "uniform")
    scores = np.sort(np.concatenate([(g - g.mean()) / g.std(ddof=1) for g in groups.values()]))
    np.testing.assert_allclose(qq["standardised_mean"], scores)
    middle = stats.norm.cdf(qq["normal_quantile"])
    np.testing.assert_allclose(np.diff(middle), 1 / (len(scores) + 0.25))
    assert middle[0] == pytest.approx(0.625 / (len(scores) + 0.25))
    for n, score in zip(qq["n_points"], qq["standardised_mean"], strict=True):
        g = groups[n]
        assert np.isclose((g - g.mean()) / g.std(ddof=1), score).any()
