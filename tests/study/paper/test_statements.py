"""The paper's statements, on results that are made to bear them out or not."""

from dataclasses import replace

import pytest
from frames import adding

from study.analysis.building import Study
from study.analysis.measurements import Measurements
from study.paper import statements


def judged(study, table, **values):
    """Whether each statement holds once columns of a table of ours are set."""
    asked, made, tables = study
    frame = tables[table].frame.assign(**values)
    changed = adding(tables, replace(tables[table], frame=frame))
    (told,) = statements.statements.make(Study(Measurements.of(*made, asked), changed))
    rows = told.rows(method="incremental", distribution="uniform")
    return dict(zip(rows["statement"], rows["holds"], strict=True))


@pytest.mark.parametrize("holds", ["yes", "no", "undecided"])
def test_premise_of_theorem_2_is_the_tables(study, holds):
    of = "The probability p of a type C neighbour is at least 1/3, at every step"
    assert judged(study, "theorem_2", premise=holds)[of] == holds
    first = study[2]["theorem_2"].frame["n_points"] == 1000
    one = first.map({True: holds, False: "yes"})
    assert judged(study, "theorem_2", premise=one)[of] == holds


@pytest.mark.parametrize(
    ("verdict", "holds"), [("rejected", "no"), ("not rejected", "not rejected")]
)
def test_theorem_1_is_one_statement_on_its_premise(study, verdict, holds):
    told = judged(study, "path_laws", verdict=verdict)
    (statement,) = [s for s in told if s.startswith("Every step of a path ends")]
    assert told[statement] == holds


def test_geometric_meshes_do_not_refute_theorem_1(study):
    frame = study[2]["statements"].frame
    rows = frame[frame["source"] == "Premise of Theorem 1"]
    assert len(rows) == 4
    assert (rows["holds"] == "not rejected").sum() >= 3  # one in twenty is by chance


@pytest.mark.parametrize(
    ("verdict", "holds"), [("yes", "no"), ("no", "undecided"), ("undecided", "undecided")]
)
def test_a_limit_is_what_both_parts_are_judged_to_have(study, verdict, holds):
    asked, made, tables = study
    old = tables["limit_verdicts"]
    frame = old.frame.assign(
        has_limit=verdict, reason="as made", limit=3.1, limit_low=3.0, limit_high=3.2
    )
    changed = adding(tables, replace(old, frame=frame))
    (told,) = statements.statements.make(Study(Measurements.of(*made, asked), changed))
    rows = told.rows(method="incremental", distribution="uniform").frame.set_index("statement")
    assert rows.loc[LIMIT, "holds"] == holds
    assert rows.loc[BOUND, "holds"] == "not rejected"


BOUND = "The cost of a LEPP is constant"
LIMIT = "The logistic regression has an asymptotic limit equal to 4"


def test_means_differ_if_the_analysis_of_variance_says_so(study):
    differ = "The means of the groups differ"
    assert judged(study, "anova", p=0.049)[differ] == "yes"
    assert judged(study, "anova", p=0.051)[differ] == "not shown"


def test_bounds_and_t_tests_need_every_group(study):
    below = "The mean is significantly below 4 and above 2 in every group"
    assert judged(study, "bounds", verdict="rejected")[below] == "yes"
    first = study[2]["bounds"].frame.index == 0
    one = study[2]["bounds"].frame["verdict"].mask(first, "not rejected")
    assert judged(study, "bounds", verdict=one)[below] == "not shown"
