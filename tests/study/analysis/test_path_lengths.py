"""The chance to go on and its laws, on meshes whose law is known."""

import numpy as np
import pandas as pd
import pytest
from frames import design, frames
from scipy import stats

from lepp import INTERIOR_LAYER
from study.analysis.analyse import analyse

SIZES, REPLICATES = (1000, 4000), 12
THEOREM_1 = ["Theorem 1, first step", "Theorem 1, all steps"]


def falling(k):
    return 0.9 / (k + 0.35) ** 0.5


def constant(k):
    return 0.55 + 0 * k


def made(inside, edge, paths=200):
    """Tables of a study with these chances to go on in the interior and beside the hull."""
    asked = design(distributions=("uniform",), sizes=SIZES, repetitions=REPLICATES)
    results, _, regions, *_, point_sets = frames(asked)
    rng = np.random.default_rng(5)
    rows = []
    for n in SIZES:
        for replicate in range(REPLICATES):
            for layer, curve, share in ((0, edge, 1), (INTERIOR_LAYER, inside, 9)):
                rates = curve(np.arange(2.0, 30))
                p = np.append(1, np.cumprod(rates)) * np.append(1 - rates, 1)
                counts = rng.multinomial(n * paths * share // 10, p)
                rows += [
                    {"method": "incremental", "distribution": "uniform", "n_points": n,
                     "replicate": replicate, "layer": layer, "lepp_size": 2 + k,
                     "count": int(count)}
                    for k, count in enumerate(counts)
                    if count
                ]  # fmt: skip
    layers = pd.DataFrame(rows)
    keys = ["method", "distribution", "n_points", "replicate", "lepp_size"]
    histograms = layers.groupby(keys, as_index=False)["count"].sum()
    return histograms, layers, analyse(results, histograms, regions, layers, point_sets, asked)


def laws_of(tables, part):
    return tables["path_laws"].rows(part=part).frame.set_index("law")


@pytest.fixture(scope="module")
def both():
    """The falling law inside, a constant chance beside the hull."""
    return made(falling, constant)


def test_rates_are_those_of_the_part_at_the_largest_size(both):
    histograms, layers, tables = both
    for part, frame in (("whole", histograms), ("interior", layers.query("layer > 0"))):
        largest = frame[frame["n_points"] == SIZES[-1]]
        counts = np.bincount(largest["lepp_size"], largest["count"])
        reached = counts[::-1].cumsum()[::-1]
        rows = tables["continuation"].rows(part=part).frame
        assert set(rows["n_points"]) == {SIZES[-1]}
        assert rows["lepp_size"].tolist() == list(range(2, len(counts)))
        assert rows["reached"].tolist() == reached[2:].tolist()
        assert rows["went_on"].tolist() == [*reached[3:].tolist(), 0]
        np.testing.assert_allclose(rows["rate"], np.append(reached[3:], 0) / reached[2:])
        np.testing.assert_allclose(rows["constant"], reached[3] / reached[2])
        known = rows["low"].notna()
        assert known.sum() > 5
        df = len(SIZES) * (REPLICATES - 1)
        half = stats.t.ppf(0.975, df) * rows["standard_error"][known]
        inside = known & (rows["low"] > 0) & (rows["high"] < 1)
        np.testing.assert_allclose(rows["high"][inside] - rows["rate"][inside], half[inside])
        np.testing.assert_allclose(rows["rate"][inside] - rows["low"][inside], half[inside])


def test_the_falling_law_comes_back_and_the_constant_is_rejected(both):
    laws = laws_of(both[2], "interior")
    assert laws.index.tolist() == ["constant", "λ / (k + b)ᵃ", *THEOREM_1]
    assert laws["verdict"].iloc[:2].tolist() == ["rejected", "not rejected"]
    law = laws.loc["λ / (k + b)ᵃ"]
    for name, truth in (("scale", 0.9), ("shift", 0.35), ("exponent", 0.5)):
        assert abs(law[name] - truth) < 3 * law[f"{name}_error"]
        assert law[f"{name}_error"] < 0.3
    rows = both[2]["continuation"].rows(part="interior").frame
    fitted = law["scale"] / (rows["lepp_size"] + law["shift"]) ** law["exponent"]
    np.testing.assert_allclose(rows["fitted"], fitted)
    assert law["df"] == law["upto_size"] - 1 - 3
    assert laws.loc["constant", "df"] == law["upto_size"] - 1 - 1
    widths = (rows["high"] - rows["low"])[rows["lepp_size"] <= law["upto_size"]]
    assert (widths < 0.05).all()


def test_a_truly_constant_chance_is_not_rejected():
    laws = laws_of(made(constant, constant)[2], "interior")
    assert laws.index.tolist() == ["constant", *THEOREM_1]
    assert laws.loc["constant", "verdict"] == "not rejected"
    assert 10 ** laws.loc["constant", "log10_p"] > 0.05
    assert abs(laws.loc["constant", "scale"] - 0.55) < 3 * laws.loc["constant", "scale_error"]


def test_longest_paths_by_summing_the_laws(both):
    laws = laws_of(both[2], "interior")
    rows = both[2]["continuation"].rows(part="interior").frame
    paths = rows["reached"].iloc[0]
    assert set(laws["paths"]) == {paths}
    assert set(laws["longest_seen"]) == {rows["lepp_size"].max()}
    mean = 1 + rows["reached"].sum() / paths
    k = np.arange(2, 100)
    law = laws.loc["λ / (k + b)ᵃ"]
    curve = law["scale"] / (k + law["shift"]) ** law["exponent"]
    for name, rates in (
        ("λ / (k + b)ᵃ", curve),
        (THEOREM_1[0], rows["rate"].iloc[0] + 0 * k),
        (THEOREM_1[1], 1 - 1 / (mean - 1) + 0 * k),
    ):
        assert laws.loc[name, "longest_expected"] == k[paths * np.cumprod(rates) < 1][0]
    assert abs(law["longest_expected"] - law["longest_seen"]) <= 3
    assert (laws.loc[THEOREM_1, "longest_expected"] > law["longest_seen"] + 5).all()
    assert laws.loc["constant", ["scale", "scale_error", "longest_expected"]].isna().all()
    level = laws_of(made(constant, constant)[2], "interior").loc["constant"]
    expected = k[level["paths"] * level["scale"] ** (k - 1) < 1][0]
    assert level["longest_expected"] == expected


def test_what_cannot_be_had_is_said():
    asked = design(distributions=("uniform",), sizes=(1000,), repetitions=1)
    results, histograms, regions, layers, point_sets = frames(asked)
    layers = layers[layers["layer"] < INTERIOR_LAYER]
    tables = analyse(results, histograms, regions, layers, point_sets, asked)
    missing = tables["missing"].rows(what="law of path lengths")
    why = missing["why"].tolist()
    assert why[0].startswith("whole: 2 or more sizes are needed whose rates are known to within")
    assert why[1] == "interior: no triangulation has it"
    assert laws_of(tables, "whole").index.tolist() == THEOREM_1
    assert tables["continuation"].rows(part="interior").empty
    assert tables["continuation"].frame["low"].isna().all()


def test_the_law_begins_with_the_shortest_path(both):
    histograms, _, tables = both
    rows = tables["law"].frame
    assert rows["lepp_size"].tolist() == list(range(1, histograms["lepp_size"].max() + 1))
    counts = np.bincount(histograms["lepp_size"], histograms["count"])
    assert rows["count"].tolist() == counts[1:].tolist()
