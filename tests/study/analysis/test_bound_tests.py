"""t tests against 2 and 4 by scipy and by the published p-values."""

import numpy as np
import pytest
from frames import design, frames
from scipy import stats
from test_group_assumptions import values_of

from study.analysis.analyse import analyse


def test_t_tests_are_scipys(study):
    _, (results, *_), tables = study
    frame = tables["bounds"].frame
    assert len(frame) == 2 * 4 * 4
    for row in frame.itertuples():
        values = values_of(results, row.method, row.distribution)[row.n_points]
        expected = stats.ttest_1samp(values, row.bound, alternative=row.alternative)
        assert row.alternative == {4: "less", 2: "greater"}[row.bound]
        assert row.t == pytest.approx(expected.statistic)
        assert row.df == expected.df
        assert row.p == pytest.approx(expected.pvalue, rel=1e-6, abs=0)
        assert 10**row.log10_p == pytest.approx(expected.pvalue, rel=1e-9, abs=0)
        corrected = min(expected.pvalue * len(frame), 1)
        assert 10**row.log10_p_bonferroni == pytest.approx(corrected, rel=1e-6, abs=0)
        assert (row.verdict == "rejected") == (corrected < 0.05)


def test_groups_that_do_not_vary_have_no_test():
    asked = design(distributions=("uniform",))
    results, *others = frames(asked)
    least = results["n_points"].min()
    level = results["mean_lepp"].where(results["n_points"] != least, 3.0625)
    tables = analyse(results.assign(mean_lepp=level), *others, asked)
    sizes = sorted(set(results["n_points"]))
    assert sorted(set(tables["bounds"].frame["n_points"])) == sizes[1:]
    missing = tables["missing"].frame
    told = missing[missing["what"].str.startswith("t tests")]["why"].tolist()
    assert told == [f"{least} points: two or more differing triangulations are needed, there is 1"]


def test_published_p_values_follow_from_the_published_means(paper_study):
    frame = paper_study[2]["bounds"].frame.query("bound == 4").set_index("n_points")
    # p goes as sd^39 and sd is printed to 4 decimals: 0.5 % of it is 0.1 in log10 p.
    for n, p in ((10_000, 6.08e-77), (20_000, 2.27e-79), (200_000, 2.65e-100)):
        assert frame.loc[n, "log10_p"] == pytest.approx(np.log10(p), abs=0.5)
