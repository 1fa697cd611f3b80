import numpy as np
import pandas as pd

from reports.page.data import decode, encode, figure_data, plain, table_data
from study.analysis.table import Column, Declaration

CURVES = Declaration(
    "curves",
    "Curves",
    (
        Column("model", "Model"),
        Column("x", "x", "points", "fixed2"),
        Column("p", "log10 p", "", "log10p"),
        Column("holds", "Holds", "", "verdict"),
    ),
)
TABLE = CURVES.table(
    {"model": "ab"[k // 6], "x": k / 7, "p": -k - 1.0, "holds": ("yes", "no", "undecided")[k % 3]}
    for k in range(12)
)


def test_columns_are_referred_to() -> None:
    rows = TABLE.rows(model="b")
    spec = {"data": [{"x": rows.column("x"), "y": rows["x"], "name": "b"}]}
    assert figure_data(spec) == {
        "data": [
            {
                "x": {"$": ["curves", "x", {"model": "b"}]},
                "y": [k / 7 if k != 7 else 1 for k in range(6, 12)],
                "name": "b",
            }
        ]
    }


def test_short_columns_and_derived_arrays_are_values() -> None:
    short = TABLE.rows(model="b", holds="yes")
    assert figure_data(short.column("x")) == [6 / 7, 9 / 7]
    assert figure_data([(np.float64(0.5), 2), ("a",), np.arange(2)]) == [[0.5, 2], ["a"], [0, 1]]


def test_cells_are_as_on_disk_and_as_shown() -> None:
    model, x, p, holds = table_data(TABLE)["columns"]
    assert model == {
        "name": "model",
        "label": "Model",
        "header": "model",
        "raw": list("aaaaaabbbbbb"),
    }
    assert x["raw"][1] == "0.14285714285714285"
    assert x["shown"][1] == "0.14"
    assert (x["unit"], x["header"], x["number"]) == ("points", "x [points]", True)
    assert (p["label"], p["shown"][0], p["raw"][0]) == ("p", "0.1000", "-1.0")
    assert holds["senses"] == {"yes": "good", "no": "bad"}
    assert "shown" not in holds


def test_halves_and_infinities_are_shown_as_python_rounds_them() -> None:
    column = Column("x", "x", "", "fixed2")
    table = Declaration("t", "T", (column,)).table(
        {"x": x} for x in (39972.125, 3.625, float("-inf"), float("inf"), None)
    )
    (data,) = table_data(table)["columns"]
    assert data["shown"] == ["39,972.12", "3.62", "−∞", "∞", "–"]
    assert data["raw"] == ["39972.125", "3.625", "-inf", "inf", ""]


def test_missing_and_infinite_values_are_null() -> None:
    values = [1, np.int64(2), np.float64(3.0), float("nan"), float("inf"), None, pd.NA, True, "x"]
    assert plain(values) == [1, 2, 3, None, None, None, None, True, "x"]


def test_a_block_is_read_back_and_always_the_same() -> None:
    data = {"text": "p ≥ 1/3 </script>", "numbers": [0.1, 1e-300, None]}
    assert decode(encode(data)) == data
    assert encode(data) == encode(dict(data))
    assert "<" not in encode(data)
