"""The paper against its own Table 4: what is printed, and what would not fit."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from study.paper import consistency, published
from study.paper.consistency import Recomputed
from study.paper.published import Number


def of(quantity, n_points=None):
    (one,) = [
        one
        for one in consistency.recomputed()
        if one.number.quantity == quantity and one.number.n_points == n_points
    ]
    return one


def test_all_that_follows_from_table_4_is_recomputed(paper_study):
    frame = paper_study[2]["consistency"].frame
    assert frame["published_table"].value_counts().to_dict() == {5: 2, 6: 4, 7: 18}
    implied = paper_study[2]["reproduction"].frame.query("standing == 'implied by Table 4'")
    recomputed = zip(frame["quantity"], frame["n_points"].fillna(0), strict=True)
    assert set(zip(implied["quantity"], implied["n_points"].fillna(0), strict=True)) == set(
        recomputed
    ) - {("p, ANOVA", 0)}


def test_the_paper_is_consistent_but_for_one_misprint(paper_study):
    frame = paper_study[2]["consistency"].frame
    verdicts = frame.set_index("quantity")["verdict"]
    assert verdicts[verdicts != "consistent"].to_dict() == {"linear, b, as printed": "misprint"}
    assert (frame["low"] <= frame["attained_low"]).all()
    assert (frame["attained_low"] <= frame["recomputed"]).all()
    assert (frame["recomputed"] <= frame["attained_high"]).all()
    assert (frame["attained_high"] <= frame["high"]).all()


def test_numbers_are_those_of_data_with_table_4_s_means_and_spreads(paper_study):
    # ours of the made-up run come from 800 values, by other code
    ours = paper_study[2]["reproduction"].frame.query("standing == 'implied by Table 4'")
    for row in ours.itertuples():
        one = of(row.quantity, None if pd.isna(row.n_points) else row.n_points)
        logistic = row.quantity.startswith("logistic")
        assert one.value == pytest.approx(row.ours, rel=0.05 if logistic else 1e-6)
        assert one.bounds[0] <= row.ours <= one.bounds[1]


def test_f_by_hand():
    _, _, means, sds = (np.array([row[i].value for row in published.table_4()]) for i in range(4))
    f = of("F, ANOVA")
    assert f.value == pytest.approx(40 * means.var(ddof=1) / (sds**2).mean())
    p = of("p, mean below 4", 10_000)
    t = np.array([(3.0485 + i - 4) / (0.0115 + j) for i in (-5e-5, 5e-5) for j in (-5e-5, 5e-5)])
    low, *_, high = np.sort(stats.t.cdf(t * np.sqrt(40), 39))
    assert 0 < high < 1e-60
    assert p.bounds == pytest.approx((low, high), rel=1e-6, abs=0)


@pytest.mark.parametrize(
    ("value", "verdict"),
    [
        (0.9, "misprint"),
        (0.949, "misprint"),
        (0.951, "undecided"),
        (1.149, "undecided"),
        (1.151, "consistent"),
        (1.5, "consistent"),
        (1.849, "consistent"),
        (1.851, "undecided"),
        (2.049, "undecided"),
        (2.051, "misprint"),
    ],
)
def test_verdicts_by_bounds_attained_values_and_rounding(value, verdict):
    number = replace(Number(7, "made up", 0.0, 1), value=value)
    assert Recomputed(number, 1.5, (1.0, 2.0), (1.2, 1.8)).verdict == verdict


@pytest.mark.parametrize("value", [0.5, 2.5])
def test_a_number_that_rounds_from_the_very_bound_is_no_misprint(value):
    number = replace(Number(7, "made up", 0.0, 0), value=value)
    assert Recomputed(number, 1.5, (1.0, 2.0), (1.2, 1.8)).verdict == "undecided"


def test_another_table_4_would_not_fit(monkeypatch):
    # one standard deviation misprinted: F, and all that follows, no longer fit
    printed = consistency.table_4_groups()
    sds = printed.sds.copy()
    sds[0] = 0.0215
    f, p = consistency._table_5(replace(printed, sds=sds))
    assert f.verdict == "misprint"
    assert p.verdict == "consistent"  # still printed as zero
    first, *rest = consistency._table_6(replace(printed, sds=sds))
    assert first.verdict == "misprint"
    assert {one.verdict for one in rest} == {"consistent"}
    judged = {one.number.quantity: one.verdict for one in
              consistency._table_7(replace(printed, sds=sds))}  # fmt: skip
    assert judged["logarithmic, p"] == "misprint"
    assert judged["logarithmic, d"] == "consistent"
