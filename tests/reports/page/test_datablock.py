import numpy as np
import pandas as pd

from reports.page.data import ColumnIndex, decode, encode, plain, select
from study.analysis.table import Column, Table

FRAME = pd.DataFrame({"model": ["a"] * 6 + ["b"] * 6, "x": np.arange(12) / 7})
TABLE = Table("curves", "Curves", FRAME, (Column("model", "Model"), Column("x", "x", "", "g3")))


def test_arrays_that_are_columns_become_references() -> None:
    where: dict[str, object] = {"model": "b"}
    index = ColumnIndex({"curves": TABLE}, [("curves", where)])
    spec = {"data": [{"x": select(FRAME, where)["x"], "y": [1.5] * 6, "name": "b"}]}
    assert index.replace(spec) == {
        "data": [{"x": {"$": ["curves", "x", where]}, "y": [1.5] * 6, "name": "b"}]
    }


def test_unknown_arrays_stay_what_they_are() -> None:
    index = ColumnIndex({"curves": TABLE}, [("curves", {})])
    assert index.replace({"x": np.arange(12) / 7 + 1e-15})["x"] != {"$": ["curves", "x", {}]}
    assert index.replace([(0.5, 2), ("a",)]) == [[0.5, 2], ["a"]]


def test_missing_and_infinite_values_are_null() -> None:
    values = [1, np.int64(2), np.float64(3.0), float("nan"), float("inf"), None, pd.NA, True, "x"]
    assert plain(values) == [1, 2, 3, None, None, None, None, True, "x"]


def test_a_block_is_read_back_and_always_the_same() -> None:
    data = {"text": "p ≥ 1/3 </script>", "numbers": [0.1, 1e-300, None]}
    assert decode(encode(data)) == data
    assert encode(data) == encode(dict(data))
    assert "<" not in encode(data)
