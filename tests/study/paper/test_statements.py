"""The paper's statements, on results that are made to bear them out or not."""

from dataclasses import replace

import pytest
from frames import design, frames

from study.analysis import analyse
from study.analysis.building import Study
from study.analysis.measurements import Measurements
from study.paper import statements


@pytest.mark.parametrize(
    ("low", "width", "holds"),
    [(0.25, 0.001, "no"), (0.40, 0.001, "yes"), (0.30, 0.3, "undecided")],
    ids=["one size surely below", "all surely above", "one size unsure"],
)
def test_one_group_surely_below_a_third_refutes_the_premise(low, width, holds):
    asked = design(distributions=("uniform",))
    results, *others = frames(asked)
    inside = results["n_interior_longest"]
    share = 0.45 + 0.001 * results["replicate"]
    first = results["n_points"] == 1000
    share[first] = low + width * (results["replicate"][first] % 2)
    unsure = results["n_points"] == 2000
    if holds == "no":  # a size that leaves it open does not outweigh the one that refutes
        share[unsure] = 0.2 + 0.3 * (results["replicate"][unsure] % 2)
    results["n_type_c"] = (share * inside).astype(int)
    tables = analyse(results, *others, asked)
    premise = tables["theorem_2"].frame["premise"]
    assert premise[0] == holds
    assert ("undecided" in set(premise)) == (holds != "yes")
    stated = tables["statements"].frame.set_index("statement")["holds"]
    assert stated["The probability p of a type C neighbour is at least 1/3"] == holds


def judged(study, table, **values):
    """Whether each statement holds once columns of a table of ours are set."""
    asked, made, tables = study
    frame = tables[table].frame.assign(**values)
    changed = tables.adding(replace(tables[table], frame=frame))
    (told,) = statements.statements.make(Study(Measurements.of(*made, asked), changed))
    rows = told.rows(method="incremental", distribution="uniform")
    return dict(zip(rows["statement"], rows["holds"], strict=True))


@pytest.mark.parametrize(("off", "holds"), [(0.0099, "yes"), (-0.0101, "no"), (0.4, "no")])
def test_moments_must_be_within_one_per_cent(study, off, holds):
    told = judged(study, "theorem_1", relative_difference=off)
    assert [told[s] for s in told if s.endswith("within 1 %")] == [holds] * 4


@pytest.mark.parametrize("verdict", ["yes", "no", "undecided"])
def test_a_limit_is_what_the_whole_mesh_is_judged_to_have(study, verdict):
    asked, made, tables = study
    old = tables["limit_verdicts"]
    other = {"yes": "no", "no": "yes", "undecided": "no"}[verdict]
    whole = old.frame["part"] == "whole"
    verdicts = whole.map({True: verdict, False: other})
    frame = old.frame.assign(has_limit=verdicts, reason="as made")
    changed = tables.adding(replace(old, frame=frame))
    (told,) = statements.statements.make(Study(Measurements.of(*made, asked), changed))
    rows = told.rows(method="incremental", distribution="uniform").frame.set_index("statement")
    assert rows.loc[LIMIT, "holds"] == verdict
    assert rows.loc[BOUND, "holds"] == "yes"


BOUND = "The cost of a LEPP is constant: its mean size is at most 4"
LIMIT = "The mean LEPP size has a limit as the number of points grows"


def test_means_differ_if_the_analysis_of_variance_says_so(study):
    differ = "The means of the groups differ"
    assert judged(study, "anova", p=0.049)[differ] == "yes"
    assert judged(study, "anova", p=0.051)[differ] == "no"


def test_bounds_and_t_tests_need_every_group(study):
    below = "The mean is significantly below 4 and above 2 in every group"
    assert judged(study, "bounds", verdict="rejected")[below] == "yes"
    one = study[2]["bounds"].frame["verdict"].where(study[2]["bounds"].frame.index > 0, "no")
    assert judged(study, "bounds", verdict=one)[below] == "no"
