"""The whole analysis: its bytes, and designs too small for its statistics."""

import csv
import io

import numpy as np
import pandas as pd
import pytest
from frames import design, failed, frames

from study.analysis.analyse import analyse


def bytes_of(tables):
    return {name: table.to_csv() for name, table in tables.items()}


def test_tables_are_named_and_described(study):
    tables = study[2]
    for name, table in tables.items():
        assert table.name == name
        assert table.title
        assert all(column.label for column in table.columns)


def test_same_results_same_bytes_in_any_order(study):
    asked, made, _ = study
    shuffled = [frame.sample(frac=1, random_state=3) for frame in made]
    assert bytes_of(analyse(*shuffled, asked)) == bytes_of(analyse(*made, asked))


def test_inputs_are_not_changed(study):
    asked, made, _ = study
    copies = [frame.copy() for frame in made]
    analyse(*made, asked)
    for frame, copy in zip(made, copies, strict=True):
        pd.testing.assert_frame_equal(frame, copy)


def test_every_number_survives_its_csv(study):
    for table in study[2].values():
        back = list(csv.reader(io.StringIO(table.to_csv())))
        assert back[0] == [column.header for column in table.columns]
        assert len(back) == len(table.frame) + 1
        for place, column in enumerate(table.columns):
            cells = [row[place] for row in back[1:]]
            values = table.frame[column.name]
            if values.dtype == np.float64:
                read = np.array([float(cell) if cell else np.nan for cell in cells])
                np.testing.assert_array_equal(read, values)
            elif column.format == "int":
                assert cells == ["" if pd.isna(value) else str(value) for value in values]


def test_no_number_is_infinite(study, paper_study):
    for _, _, tables in (study, paper_study):
        for table in tables.values():
            numbers = table.frame.select_dtypes("number").to_numpy(dtype=float, na_value=0.0)
            assert not np.isinf(numbers).any(), table.name


SMALL = {
    "one group": {"sizes": (1000,)},
    "two groups": {"sizes": (1000, 2000)},
    "one repetition": {"repetitions": 1},
    "two repetitions": {"repetitions": 2},
    "one of each": {"sizes": (1000,), "repetitions": 1, "distributions": ("normal",)},
    "another distribution": {"distributions": ("exponential",)},
    "delaunay only": {"methods": ("delaunay",)},
}


@pytest.mark.parametrize("changes", SMALL.values(), ids=SMALL)
def test_small_designs_lack_what_they_lack(changes):
    asked = design(**changes)
    tables = analyse(*frames(asked), asked)
    bytes_of(tables)
    assert len(tables["groups"].frame) == len(asked.sizes) * len(asked.distributions)
    missing = set(tables["missing"].frame["what"])
    if len(asked.sizes) == 1:
        assert tables["anova"].frame.empty
        assert tables["regressions"].frame.empty
        assert {"analysis of variance", "Games-Howell comparisons"} <= missing
    if asked.repetitions == 1:
        assert tables["bounds"].frame.empty
        assert tables["groups"].frame["sd_between"].isna().all()
        assert {"t tests against 2 and 4", "linear regression, weighted"} <= missing
        assert set(tables["theorem_2"].frame["premise"]) == {"undecided"}
        if len(asked.sizes) == 1:
            assert tables["termination"].frame["standard_error"].isna().all()
    if asked.repetitions < 3:
        assert tables["shapiro"].frame.empty
        assert {"Levene's test", "Shapiro-Wilk test"} <= missing
    if asked.repetitions >= 2 and len(asked.sizes) >= 2:
        assert len(tables["anova"].frame) == 4 * len(asked.distributions)


def test_one_repetition_can_still_be_fitted():
    asked = design(repetitions=1, sizes=(1000, 2000, 3000, 4000, 5000))
    frame = analyse(*frames(asked), asked)["regressions"].frame
    assert set(frame["fitting"]) == {"least squares"}
    assert {"linear", "quadratic", "logistic", "logarithmic"} <= set(frame["model"])
    assert frame["lack_of_fit_p"].isna().all()


def test_equal_means_are_no_evidence():
    asked = design()
    results, *others = frames(asked)
    results["mean_lepp"] = 3.0
    tables = analyse(results, *others, asked)
    for name in (
        "levene",
        "shapiro",
        "qq",
        "anova",
        "pairs",
        "bounds",
        "regressions",
        "projections",
        "model_scores",
    ):
        frame = tables[name].frame
        # the layers, and so the interior, are as they were
        whole = frame[frame["part"] == "whole"] if "part" in frame else frame
        assert whole.empty, name
    assert tables["groups"].frame["mean_low"].isna().all()
    assert "all mean LEPP sizes are equal" in set(tables["missing"].frame["why"])


def test_one_group_of_equal_means_is_left_out():
    asked = design(distributions=("uniform",))
    results, *others = frames(asked)
    results.loc[results["n_points"] == 2000, "mean_lepp"] = 3.0
    tables = analyse(results, *others, asked)
    assert tables["anova"].frame["df_group"].tolist() == [2] * 4
    assert set(tables["bounds"].frame["n_points"]) == {1000, 4000, 8000}
    why = tables["missing"].frame["why"]
    assert why.str.startswith("2000 points").sum() == 2


def test_everything_failed():
    asked = design()
    results, histograms, regions, layers, sets = frames(asked)
    results = failed(results, range(len(results)))
    tables = analyse(results, histograms.iloc[:0], regions.iloc[:0], layers.iloc[:0], sets, asked)
    bytes_of(tables)
    assert tables["overview"].frame["failed"].tolist() == [24, 24]
    assert (tables["statements"].frame["holds"] == "not tested").all()
    assert tables["missing"].frame["why"].str.contains("24 of 24 tasks failed").sum() == 2
    assert not tables["reproduction"].frame["verdict"].isin(["agrees", "differs"]).any()


def test_nothing_was_run():
    asked = design()
    empty = [frame.iloc[:0] for frame in frames(asked)]
    tables = analyse(*empty, asked)
    bytes_of(tables)
    assert tables["overview"].frame["not_run"].tolist() == [24, 24]
    assert (
        tables["missing"].frame["why"].str.contains("24 of 24 tasks have not been run").sum() == 2
    )


def test_means_of_four_and_more_have_no_logistic_model():
    asked = design(methods=("delaunay",), distributions=("uniform",))
    tables = analyse(*frames(asked), asked)
    assert "logistic" not in set(tables["regressions"].frame["model"])
    missing = tables["missing"].frame.set_index("what")
    assert "4 or more" in missing.loc["logistic regression, least squares", "why"]


def test_triangulations_of_one_triangle():
    asked = design(distributions=("uniform",), sizes=(3,), repetitions=4)
    results, *_, sets = frames(design(distributions=("uniform",), sizes=(1000,), repetitions=4))
    counted = {"n_triangles": 1, "n_hull": 3, "mean_lepp": 1.0, "sd_lepp": 0.0, "max_lepp": 1}
    counted |= dict.fromkeys(("n_interior_longest", "n_type_a", "n_type_b", "n_type_c"), 0)
    counted |= {"n_regions": 1, "max_region": 1, "n_points": 3}
    counted |= {"skewness_lepp": np.nan, "kurtosis_lepp": np.nan}
    results = results.assign(**counted)
    key = results[["method", "distribution", "n_points", "replicate"]]
    tables = analyse(
        results,
        key.assign(lepp_size=1, count=1),
        key.assign(region_size=1, count=1),
        key.assign(layer=0, lepp_size=1, count=1),
        sets,
        asked,
    )
    bytes_of(tables)
    assert tables["groups"].frame["mean_lepp"].tolist() == [1.0]
    assert tables["theorem_1"].frame.empty
    assert tables["theorem_2"].frame["premise"].tolist() == ["undecided"]
    assert tables["law"].frame["share"].tolist() == [1.0]
