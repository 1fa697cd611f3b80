"""Builders are run in the order of their needs, and see nothing else."""

import pytest
from frames import design, frames

from study.analysis.building import Builder, build, builds, rows_by_population, rows_of
from study.analysis.measurements import Measurements
from study.analysis.table import DISTRIBUTION, METHOD, Column, Declaration, UnknownNameError
from study.statistics.groups import NotEnough

A, B, C = (Declaration(name, name.upper(), (Column("n", "N", "", "int"),)) for name in "abc")


@pytest.fixture(scope="module")
def data():
    return Measurements.of(*frames(design(sizes=(1000,))), design(sizes=(1000,)))


def counting(made, *needs):
    @rows_of(made, needs=needs)
    def rows(study):
        study.lacks("", "", made.name, "told")
        yield {"n": 1 + sum(int(study.tables[need.name].frame["n"].sum()) for need in needs)}

    return rows


def test_needs_decide_the_order_of_building_and_not_that_of_what_is_missing(data):
    tables, missing = build([counting(C, A, B), counting(B, A), counting(A)], data)
    assert {name: table.frame["n"].item() for name, table in tables.items()} == {
        "a": 1,
        "b": 2,
        "c": 4,
    }
    assert list(tables) == ["c", "b", "a"]
    assert [lack.what for lack in missing] == ["c", "b", "a"]


def test_a_table_that_is_not_declared_as_needed_cannot_be_read(data):
    @rows_of(B)
    def secretly(study):
        yield {"n": len(study.tables["a"].frame)}

    with pytest.raises(UnknownNameError, match="no table 'a'"):
        build([counting(A), secretly], data)


def test_a_need_that_nobody_makes_is_an_error(data):
    with pytest.raises(UnknownNameError, match="no builder makes the table 'a'"):
        build([counting(B, A)], data)


def test_a_builder_makes_what_it_declares(data):
    @builds(A, B)
    def one_too_few(study):
        yield A.table([])

    with pytest.raises(ValueError, match="made others"):
        build([one_too_few], data)


def test_populations_that_lack_something_are_told_and_the_others_are_built(data):
    declared = Declaration(
        "t", "T", (METHOD, DISTRIBUTION, Column("n", "N", "", "int")), "{n} in all"
    )

    @rows_by_population(declared, "a statistic", note=lambda data: {"n": len(data.results)})
    def rows(one):
        yield {"n": len(one.triangulations)}
        if one.distribution == "uniform":
            one.lacks("one row")
            yield {"n": 0}
        else:
            raise NotEnough("no more rows")

    assert isinstance(rows, Builder)
    tables, missing = build([rows], data)
    assert tables["t"].frame.to_dict("list") == {
        "method": ["incremental"] * 3,
        "distribution": ["uniform", "uniform", "exponential"],
        "n": [6, 0, 6],
    }
    assert tables["t"].note == "12 in all"
    assert [(lack.distribution, lack.what, lack.why) for lack in missing] == [
        ("uniform", "a statistic", "one row"),
        ("exponential", "a statistic", "no more rows"),
    ]


def test_two_builders_of_one_table_are_an_error(data):
    with pytest.raises(ValueError, match="two builders make the table 'a'"):
        build([counting(A), counting(B), counting(A)], data)
