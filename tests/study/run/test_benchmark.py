from types import SimpleNamespace

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import lepp
from lepp import InputError
from study.design.design import Design
from study.run import benchmark
from study.run.benchmark import COLUMNS, KEY, QUANTITIES, Benchmark, compared


def made(*rows):
    return Benchmark(pd.DataFrame(rows, columns=COLUMNS), {"python": "3.11"})


def test_rates_are_medians_of_turns(monkeypatch):
    seconds = iter([1.0, 5.0, 2.0])

    def turn(n_points):
        second = next(seconds)
        yield ("triangulation", "delaunay"), second
        yield ("times_scipy", "delaunay"), 10 / second

    monkeypatch.setattr(benchmark, "_turn", turn)
    found = benchmark.rates(100, repeats=3)
    assert [(one.quantity, one.value) for one in found] == [
        ("triangulation", 2.0),
        ("times_scipy", 5.0),
    ]


def test_every_quantity_is_measured_for_every_method(monkeypatch):
    clock = iter(range(100))
    monkeypatch.setattr(benchmark, "process_time", lambda: next(clock))
    found = {(one.quantity, one.method): one.value for one in benchmark.rates(500, 1)}
    for method in lepp.METHODS:
        assert found["triangulation", method] == 1e9 / 500
        assert found["sizes", method] == found["counts", method] == 1e9 / 500
        assert found["times_scipy", method] == 0.5
    assert found["sampling", ""] == found["checks", ""] == 1e9 / 500


def test_large_sets_are_not_given_to_the_yardstick(monkeypatch):
    monkeypatch.setattr(benchmark, "_MOST_OF_YARDSTICK", 499)
    assert "times_scipy" not in {one.quantity for one in benchmark.rates(500, 1)}


def test_memory_is_what_is_planned():
    value = benchmark.memory("delaunay", 500_000).value
    assert value == pytest.approx(lepp.METHODS["delaunay"].bytes_per_point, rel=0.2)


@pytest.mark.cluster
def test_a_run_is_measured_and_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "all"))
    (tmp_path / "all").mkdir()
    design = Design.from_settings({"methods": ["delaunay"], "sizes": [500], "repetitions": 3})
    heard = SimpleNamespace(
        begin=lambda *_: None, advance=lambda *_: None, part=lambda *_: None, note=lambda _: None
    )
    rate, overhead = benchmark.runs(design, 1, heard, share=2)
    assert (rate.quantity, overhead.quantity) == ("rate", "overhead")
    assert rate.n_points == 4 * 2 * 500  # of three repetitions a half, rounded up
    assert rate.cores == 1
    assert rate.value > 0
    assert overhead.value > 0
    assert [path.name for path in (tmp_path / "all").iterdir()] in ([], ["dask-scratch-space"])


def test_files_give_back_what_was_written(tmp_path):
    one = made(("rate", "", 100, 2, 1.5))
    one.write(tmp_path / "benchmark.parquet")
    again = Benchmark.read(tmp_path / "benchmark.parquet")
    pd.testing.assert_frame_equal(again.measurements, one.measurements)
    assert again.environment == one.environment


def test_other_files_are_refused(tmp_path):
    path = tmp_path / "other.parquet"
    with pytest.raises(InputError, match="Cannot read"):
        Benchmark.read(path)
    path.write_text("no Parquet")
    with pytest.raises(InputError, match="Cannot read"):
        Benchmark.read(path)
    pq.write_table(pa.table({"quantity": ["rate"]}), path)
    with pytest.raises(InputError, match="is no benchmark"):
        Benchmark.read(path)


def test_a_gain_is_above_one_where_it_is_better():
    new = made(
        ("triangulation", "delaunay", 10, 1, 100.0),
        ("rate", "", 10, 2, 6.0),
        ("rate", "", 10, 4, 7.0),
    )
    old = made(("rate", "", 10, 2, 4.0), ("triangulation", "delaunay", 10, 1, 150.0))
    both = compared(new, old).set_index(list(KEY))
    assert both["gain"].tolist()[:2] == [1.5, 1.5]
    assert both["before"].isna().tolist() == [False, False, True]
    assert both["gain"].isna().tolist() == [False, False, True]


def test_everything_is_measured_in_a_full_benchmark(monkeypatch):
    monkeypatch.setattr(benchmark, "_SIZES", (100, 200))
    monkeypatch.setattr(benchmark, "_POINTS_IN_MEMORY", 1000)
    monkeypatch.setattr(benchmark, "ClusterOptions", lambda: SimpleNamespace(n_workers=lambda _: 4))
    asked = []

    def runs(design, cores, listener, share=1):
        asked.append((cores, share))
        return [benchmark.Measurement(name, "", 10, cores, 1.0) for name in ("rate", "overhead")]

    monkeypatch.setattr(benchmark, "runs", runs)
    heard = []
    full = benchmark.measure(SimpleNamespace(note=heard.append))
    assert set(full.measurements["quantity"]) == set(QUANTITIES)
    assert not full.measurements.duplicated(list(KEY)).any()
    assert asked == [(1, 5), (2, 5), (4, 1)]
    assert len(heard) == 5
    assert "lepp-study" in full.environment
