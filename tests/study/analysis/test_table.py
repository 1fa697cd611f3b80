"""Tables and their CSV text."""

import csv
import io

import numpy as np
import pandas as pd
import pytest

from study.analysis import Column, Table

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
