import pandas as pd
import pytest

from reports.bench_page.page import render
from reports.bench_page.tables import tables_of
from study.run.benchmark import COLUMNS, Benchmark

ROWS = [
    ("triangulation", "incremental", 1000, 1, 250.0),
    ("triangulation", "delaunay", 1000, 1, 400.0),
    ("times_scipy", "incremental", 1000, 1, 41.0),
    ("times_scipy", "delaunay", 1000, 1, 31.0),
    ("times_scipy", "incremental", 100, 1, 3.0),
    ("memory", "incremental", 4_000_000, 1, 158.0),
    ("rate", "", 1_000_000, 1, 2.5),
    ("overhead", "", 1_000_000, 1, 0.04),
    ("rate", "", 1_000_000, 2, 5.0),
    ("overhead", "", 1_000_000, 2, 0.093),
]


def benchmark(rows=ROWS, **environment):
    return Benchmark(pd.DataFrame(rows, columns=COLUMNS), {"python": "3.11.7"} | environment)


def slower(factor):
    """The same measurements, as if all that is timed had taken so many times as long."""
    times = {"triangulation": factor, "times_scipy": 1 / factor, "rate": 1 / factor}
    return benchmark([(*row[:-1], row[-1] * times.get(row[0], 1.0)) for row in ROWS])


def test_a_table_has_the_columns_that_tell_its_rows_apart():
    tables = {table.id: table for table in tables_of(benchmark(), None)}
    assert list(tables) == ["triangulation", "times_scipy", "memory", "rate", "overhead"]
    assert tables["triangulation"].headings == ["Triangulation", "Here"]
    assert tables["triangulation"].rows == [["Plain insertion", "250.0"], ["Delaunay", "400.0"]]
    assert tables["memory"].rows == [["158.0"]]
    assert tables["rate"].rows == [["1", "2.50"], ["2", "5.00"]]
    assert tables["overhead"].rows == [["1", "4.0\u00a0%"], ["2", "9.3\u00a0%"]]


def test_an_earlier_benchmark_stands_beside():
    tables = {table.id: table for table in tables_of(benchmark(), slower(2))}
    headings = ["Triangulation", "Here", "Before", "Times as good"]
    assert tables["triangulation"].headings == headings
    assert tables["triangulation"].rows[0] == ["Plain insertion", "250.0", "500.0", "2.00"]
    assert tables["rate"].rows[0] == ["1", "2.50", "1.25", "2.00"]


@pytest.mark.parametrize(("factor", "words"), [(2, "2.00"), (0.5, "0.50")])
def test_the_page_says_how_much_higher_the_rates_are(factor, words):
    page = render(benchmark(), slower(factor))
    assert "7 rates were measured before, too: they are now" in page
    assert f"{words} times as high in the geometric mean, from {words} to {words} times." in page


def test_benchmarks_with_nothing_in_common_are_said_to_be():
    other = benchmark([("rate", "", 5, 1, 1.0)])
    assert "The two benchmarks have no rate in common." in render(benchmark(), other)


def test_the_page_leads_with_the_ratio_and_the_overhead():
    page = render(benchmark()).replace("\u00a0", " ")
    assert (
        "SciPy&#39;s Delaunay triangulation of 1,000 points takes 41.0 times as long as plain "
        "insertion and 31.0 times as long as Delaunay here, path sizes included."
    ) in page
    assert "A run of 1,000,000 points on 2 cores takes 9.3 % longer than its tasks." in page
    assert "Before" not in page
    alone = benchmark([row for row in ROWS if row[3] == 1])
    assert "on one core takes 4.0 % longer" in render(alone).replace("\u00a0", " ")


def test_versions_stand_beside_each_other():
    page = render(benchmark(numba="0.62"), benchmark(numba="0.61", dask="2026.1"))
    for cells in (("numba", "0.62", "0.61"), ("dask", "–", "2026.1")):
        assert "".join(f'<td class="text">{cell}</td>' for cell in cells) in page
