"""How the means of the parts change, and the layers before the interior, counted by hand."""

from types import SimpleNamespace

import numpy as np
import pytest
from frames import design, frames
from scipy import stats
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.weightstats import CompareMeans, DescrStatsW

from lepp import INTERIOR_LAYER
from study.analysis import part_changes
from study.analysis.analyse import analyse
from study.analysis.building import Study

SIZES = (1000, 2000, 4000, 8000, 16000)
KEY = ["method", "distribution"]


@pytest.fixture(scope="module")
def run():
    asked = design(sizes=SIZES)
    results, histograms, regions, layers, sets = frames(asked)
    layers = layers[layers["count"] > 0]
    # The layers at the hull become one of the last before the interior, and the one before those.
    layer = layers["layer"].replace({0: 23})
    layers = layers.assign(layer=layer.where(layer != 1, 24 + layers["replicate"] % 6))
    # Few of the interior's paths of exponential points, so that its mean is another.
    inside = layers["layer"] == INTERIOR_LAYER
    moved = inside & (layers["distribution"] == "exponential") & (layers["lepp_size"] > 3)
    layers = layers.assign(count=layers["count"].where(~moved, layers["count"] // 3))
    return results, layers, analyse(results, histograms, regions, layers, sets, asked)


def means_of(layers, kept):
    """Mean of each triangulation, one path at a time."""
    found = {}
    for key, one in layers[kept].groupby([*KEY, "n_points", "replicate"]):
        found[key] = np.repeat(one["lepp_size"], one["count"]).mean()
    return found


def test_changes_are_welchs(run):
    results, layers, tables = run
    inside = means_of(layers, layers["layer"] == INTERIOR_LAYER)
    for row in tables["part_changes"].frame.itertuples():
        where = (row.method, row.distribution)
        of_interior = {key: mean for key, mean in inside.items() if key[:2] == where}
        sizes = sorted({key[2] for key in of_interior})
        assert (row.from_points, row.to_points) == (sizes[0], sizes[-1])
        if row.part == "interior":
            ends = [[m for k, m in of_interior.items() if k[2] == n] for n in sizes]
            first, last = ends[0], ends[-1]
        else:
            mine = results[(results["method"] == where[0]) & (results["distribution"] == where[1])]
            first, last = (
                mine.loc[mine["n_points"] == n, "mean_lepp"].tolist() for n in (sizes[0], sizes[-1])
            )
        assert row.change == pytest.approx(np.mean(last) - np.mean(first))
        compared = CompareMeans(DescrStatsW(last), DescrStatsW(first))
        assert (row.low, row.high) == pytest.approx(compared.tconfint_diff(usevar="unequal"))
        assert row.p == pytest.approx(compared.ttest_ind(usevar="unequal")[1])
    assert len(tables["part_changes"].frame) == 2 * len(
        tables["part_changes"].frame[KEY].drop_duplicates()
    )


def test_the_last_layers_are_held_against_the_interior(run):
    _, layers, tables = run
    largest = layers[layers["n_points"] == SIZES[-1]]
    last = means_of(largest, largest["layer"].isin([24, 25, 26, 27, 28, 29]))
    inside = means_of(largest, largest["layer"] == INTERIOR_LAYER)
    table = tables["last_layers"].frame
    assert len(table) == 2
    for row in table.itertuples():
        keys = [k for k in last if k[:2] == (row.method, row.distribution) and k in inside]
        off = np.array([last[k] - inside[k] for k in keys])
        assert row.triangulations == len(off)
        assert row.n_points == SIZES[-1]
        assert row.last_layers == pytest.approx(np.mean([last[k] for k in keys]))
        assert row.interior == pytest.approx(np.mean([inside[k] for k in keys]))
        assert row.difference == pytest.approx(off.mean())
        t, p = stats.ttest_1samp(off, 0)
        assert row.p == pytest.approx(p)
        assert row.log10_p == pytest.approx(np.log10(p))
        half = stats.t.ppf(0.975, len(off) - 1) * off.std(ddof=1) / len(off) ** 0.5
        assert (row.low, row.high) == pytest.approx((off.mean() - half, off.mean() + half))
        assert np.sign(t) == np.sign(row.difference)
    rejected, *_ = multipletests(table["p"], method="holm")
    assert (table["same_mean"] == "rejected").tolist() == rejected.tolist()
    assert rejected.any()


def test_without_an_interior_there_is_nothing_to_hold_them_against(run):
    results, layers, _ = run
    asked = design(sizes=SIZES)
    _, histograms, regions, _, sets = frames(asked)
    no_interior = layers[layers["layer"] < INTERIOR_LAYER]
    tables = analyse(results, histograms, regions, no_interior, sets, asked)
    assert tables["last_layers"].frame.empty
    assert tables["part_changes"].frame.empty
    few = layers[layers["replicate"] < 1]
    tables = analyse(results[results["replicate"] < 1], histograms, regions, few, sets, asked)
    assert tables["last_layers"].frame.empty
    assert tables["part_changes"].frame.empty


def test_several_that_are_held_against_it_are_corrected_for(monkeypatch):
    p = {"uniform": 0.03, "exponential": 0.04}

    def rows(study, method, distribution):
        yield {"method": method, "distribution": distribution, "p": p[distribution]}

    monkeypatch.setattr(part_changes, "_last_layers", rows)
    keys = [("incremental", name) for name in p]
    study = Study(SimpleNamespace(populations=keys), {})
    (table,) = part_changes.last_layers.make(study)
    assert table.frame["same_mean"].tolist() == ["not rejected", "not rejected"]
    p["uniform"] = 0.02
    (table,) = part_changes.last_layers.make(study)
    assert table.frame["same_mean"].tolist() == ["rejected", "rejected"]
