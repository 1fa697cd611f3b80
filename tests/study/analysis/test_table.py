"""Tables and their CSV text."""

import csv
import io

import numpy as np
import pandas as pd
import pytest

from study.analysis.table import Column, Declaration, Table, Tables, UnknownNameError, select

COLUMNS = (
    Column("method", "Triangulation"),
    Column("n_points", "Points", "points", "int"),
    Column("value", "Value", "", "g3"),
)


def table(rows):
    return Table(
        "t", "A table", pd.DataFrame(rows, columns=["method", "n_points", "value"]), COLUMNS
    )


def test_floats_survive_the_csv_bit_for_bit():
    values = [1 / 3, 0.1 + 0.2, 5e-324, 1.7976931348623157e308, -0.0, 7.535e-5]
    text = table([("a, b", 10, value) for value in values]).to_csv()
    back = list(csv.DictReader(io.StringIO(text)))
    read = np.array([float(row["value"]) for row in back])
    assert read.tobytes() == np.array(values).tobytes()
    assert {row["method"] for row in back} == {"a, b"}


def test_header_has_names_with_units():
    assert table([]).to_csv() == "method,n_points [points],value\n"


def test_null_cells_are_empty():
    assert table([("a", 1, None)]).to_csv().splitlines()[1] == "a,1,"


def test_described_columns_must_be_the_frames():
    with pytest.raises(ValueError, match="described"):
        Table("t", "A table", pd.DataFrame({"other": [1]}), COLUMNS)


def test_formats_are_checked():
    with pytest.raises(ValueError, match="unknown format"):
        Column("x", "X", format="pretty")


DECLARED = Declaration("t", "A table", COLUMNS, note="{n} rows")


def test_cells_are_quoted_as_csv_readers_expect():
    texts = ["plain", "a, b", 'say "a"', "two\nlines", "", " x "]
    made = table([(text, 1, np.inf) for text in texts])
    assert made.to_csv() == made.frame.to_csv(
        index=False, header=[column.header for column in COLUMNS], lineterminator="\n"
    )
    back = list(csv.DictReader(io.StringIO(made.to_csv(), newline="")))
    assert [row["method"] for row in back] == texts


def test_what_a_row_lacks_is_null():
    made = DECLARED.table([{"method": "a", "value": 2}, {"method": "b", "n_points": 7}], n=2)
    assert made.note == "2 rows"
    assert made.to_csv() == "method,n_points [points],value\na,,2.0\nb,7,\n"


def test_a_typo_is_an_error_that_says_what_there_is():
    made = DECLARED.table([{"method": "a", "n_points": 1, "value": 2}], n=1)
    tables = Tables([made])
    for typo in (
        lambda: tables["T"],
        lambda: tables.rows(Declaration("s", "S", COLUMNS)),
        lambda: tables.rows(DECLARED, n_point=1),
        lambda: tables.rows(DECLARED).select(n_point=1),
        lambda: tables.rows(DECLARED)["n_point"],
        lambda: tables.rows(DECLARED).column("n_point"),
        lambda: select(made.frame, {"n_point": 1}),
        lambda: DECLARED.table([{"n_point": 1}], n=1),
    ):
        with pytest.raises(UnknownNameError, match=r"only (t|method, n_points, value)$"):
            typo()


def test_rows_know_where_they_stand():
    made = DECLARED.table(
        [{"method": m, "n_points": n, "value": n / 7} for m in "ab" for n in (1, 2)], n=4
    )
    rows = made.rows(method="b")
    assert len(rows) == 2
    assert rows.select(n_points=2).where == {"method": "b", "n_points": 2}
    assert rows.last["n_points"] == 2
    value = rows.column("value")
    assert (value.table, value.column, value.where) == ("t", "value", {"method": "b"})
    assert (list(value), value.min(), value.max(), len(value)) == ([1 / 7, 2 / 7], 1 / 7, 2 / 7, 2)
    assert made.rows(method="c").empty
