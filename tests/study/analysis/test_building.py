"""Tables are made when they are asked for, after their needs, and from nothing else."""

import pickle
from graphlib import CycleError

import pytest
from frames import design, frames

from study.analysis.building import Builder, BuiltTables, builds, rows_by_population, rows_of
from study.analysis.measurements import Measurements
from study.analysis.table import DISTRIBUTION, METHOD, Column, Declaration, Tables, UnknownNameError
from study.statistics.groups import NotEnough

A, B, C = (Declaration(name, name.upper(), (Column("n", "N", "", "int"),)) for name in "abc")


@pytest.fixture(scope="module")
def data():
    return Measurements.of(*frames(design(sizes=(1000,))), design(sizes=(1000,)))


def counting(made, *needs, told=None):
    @rows_of(made, needs=needs)
    def rows(study):
        study.lacks("", "", made.name, "told")
        if told is not None:
            told.append(made.name)
        yield {"n": 1 + sum(int(study.tables[need.name].frame["n"].sum()) for need in needs)}

    return rows


def test_needs_decide_the_order_of_building_and_not_that_of_what_is_missing(data):
    tables = BuiltTables([counting(C, A, B), counting(B, A), counting(A)], data)
    assert {name: tables[name].frame["n"].item() for name in "cba"} == {"a": 1, "b": 2, "c": 4}
    assert list(tables) == ["c", "b", "a", "missing"]
    assert len(tables) == 4
    assert list(tables["missing"].frame["what"]) == ["c", "b", "a"]


def test_a_table_is_made_once_when_it_is_first_asked_for(data):
    told = []
    builders = [counting(C, A, told=told), counting(B, A, told=told), counting(A, told=told)]
    tables = BuiltTables(builders, data)
    assert told == []
    assert tables["b"] is tables["b"]
    assert told == ["a", "b"]
    assert list(tables["missing"].frame["what"]) == ["c", "b", "a"]
    assert told == ["a", "b", "c"]


def test_what_is_kept_of_tables_is_all_of_them(data):
    kept = pickle.loads(pickle.dumps(BuiltTables([counting(B, A), counting(A)], data)))
    assert type(kept) is Tables
    assert {name: len(table.frame) for name, table in kept.items()} == {
        "b": 1,
        "a": 1,
        "missing": 2,
    }


def test_tables_that_need_one_another_are_an_error(data):
    with pytest.raises(CycleError):
        BuiltTables([counting(A, B), counting(B, A)], data)


def test_a_table_that_is_not_declared_as_needed_cannot_be_read(data):
    @rows_of(B)
    def secretly(study):
        yield {"n": len(study.tables["a"].frame)}

    with pytest.raises(UnknownNameError, match="no table 'a'"):
        BuiltTables([counting(A), secretly], data)["b"]


def test_a_need_that_nobody_makes_is_an_error(data):
    with pytest.raises(UnknownNameError, match="no builder makes the table 'a'"):
        BuiltTables([counting(B, A)], data)


def test_a_builder_makes_what_it_declares(data):
    @builds(A, B)
    def one_too_few(study):
        yield A.table([])

    with pytest.raises(ValueError, match="made others"):
        BuiltTables([one_too_few], data)["a"]


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
    tables = BuiltTables([rows], data)
    assert tables["t"].frame.to_dict("list") == {
        "method": ["incremental"] * 3,
        "distribution": ["uniform", "uniform", "exponential"],
        "n": [6, 0, 6],
    }
    assert tables["t"].note == "12 in all"
    assert tables["missing"].frame.to_numpy().tolist() == [
        ["incremental", "uniform", "a statistic", "one row"],
        ["incremental", "exponential", "a statistic", "no more rows"],
    ]


def test_two_builders_of_one_table_are_an_error(data):
    with pytest.raises(ValueError, match="two builders make the table 'a'"):
        BuiltTables([counting(A), counting(B), counting(A)], data)
