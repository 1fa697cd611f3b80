import pandas as pd
import pytest
from click.testing import CliRunner

from reports.cli.main import main
from study.run import benchmark
from study.run.benchmark import COLUMNS, Benchmark

ROWS = [
    ("times_scipy", "delaunay", 1000, 1, 31.0),
    ("rate", "", 1_000_000, 2, 5.0),
    ("overhead", "", 1_000_000, 2, 0.093),
]


def bench(*words):
    return CliRunner().invoke(main, ["bench", *map(str, words)])


@pytest.fixture
def measured(monkeypatch):
    made = Benchmark(pd.DataFrame(ROWS, columns=COLUMNS), {"python": "3.11"})
    monkeypatch.setattr(benchmark, "measure", lambda listener: made)


def test_a_row_is_printed_for_each_method():
    result = bench("--points", 2000, "--repeats", 1)
    assert result.exit_code == 0, result.output
    assert "2,000 uniform points, one core; SciPy is scipy.spatial.Delaunay" in result.output
    for method in ("incremental", "delaunay"):
        (line,) = [line for line in result.output.splitlines() if method in line]
        assert len(line.split("│")) == 6


def test_a_full_benchmark_is_printed_and_written(tmp_path, measured):
    result = bench("--full", tmp_path / "new")
    assert result.exit_code == 0, result.output
    assert "Points of a run, report apart, million points a second" in result.output
    assert f"Page: {tmp_path / 'new' / 'benchmark.html'}" in result.output
    assert "takes 9.3" in (tmp_path / "new" / "benchmark.html").read_text()
    file = tmp_path / "new" / "benchmark.parquet"
    again = bench("--full", tmp_path / "newer", "--against", file)
    assert again.exit_code == 0, again.output
    assert "Times as good" in again.output
    assert "2 rates were measured before" in (tmp_path / "newer" / "benchmark.html").read_text()


def test_files_go_to_results_if_nothing_is_said(tmp_path, measured, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert bench("--full").exit_code == 0
    assert {path.name for path in (tmp_path / "results" / "bench").iterdir()} == {
        "benchmark.parquet",
        "benchmark.html",
    }


@pytest.mark.parametrize("words", [["somewhere"], ["--against", "benchmark.parquet"]])
def test_what_goes_with_full_alone_is_refused_without(words):
    result = bench(*words)
    assert result.exit_code == 2
    assert "go with --full" in result.output


def test_what_is_compared_with_is_read_before_anything_is_measured(tmp_path, monkeypatch):
    monkeypatch.setattr(benchmark, "measure", lambda listener: pytest.fail("measured"))
    result = bench("--full", tmp_path / "new", "--against", tmp_path / "none.parquet")
    assert result.exit_code == 2
    assert "Cannot read" in result.output
    assert not (tmp_path / "new").exists()
