"""A task of triangulations, held against the slow twins of everything in it."""

from collections import Counter
from dataclasses import dataclass, replace
from fractions import Fraction

import naive
import naive_delaunay
import numpy as np
import pyarrow as pa
import pytest

import lepp
import lepp.triangulate
from lepp.triangulate import METHODS
from study.design.design import Design
from study.design.sampling import DISTRIBUTIONS, sample_points
from study.results.store import Store, load
from study.run.measures import columns_of, measure
from study.run.point_checks import check_randomness
from study.run.triangulations import TRIANGULATIONS, Measures, Task, Triangulations

DESIGN = Design.from_settings({"methods": list(METHODS), "sizes": [60], "repetitions": 2})

TWINS = {
    "incremental": naive.incremental,
    "delaunay": naive_delaunay.delaunay,
}


def hull_of(triangles):
    """The number of edges beside which there is one triangle."""
    edges = Counter(edge for t in triangles for edge in naive.edges_of(t))
    return sum(count == 1 for count in edges.values())


def moments(counts):
    """Mean, standard deviation, skewness and kurtosis of a histogram."""
    n = sum(counts.values())
    mean = Fraction(sum(size * count for size, count in counts.items()), n)
    second, third, fourth = (
        sum((size - mean) ** k * count for size, count in counts.items()) / n for k in (2, 3, 4)
    )
    sd = float(second) ** 0.5
    return float(mean), sd, float(third) / sd**3, float(fourth / second**2) - 3


def twin_of(points, method):
    """Measures, and the tables that count something, of one triangulation."""
    triangles, repeated = TWINS[method](points)
    paths = naive.Paths(points, sorted(triangles))
    everything = range(len(triangles))
    sizes = Counter(paths.sizes())
    types = Counter(paths.neighbor_type(t) for t in everything)
    regions = Counter(paths.path(t)[1] for t in everything)
    mean, sd, skewness, kurtosis = moments(sizes)
    nearly = 0
    for t in everything:
        longest, second = sorted(
            (float(paths.square(edge)) ** 0.5 for edge in naive.edges_of(paths.triangles[t])),
            reverse=True,
        )[:2]
        nearly += longest <= second * (1 + lepp.NEARLY_EQUAL)
    measures = {
        "n_triangles": len(triangles),
        "n_hull": hull_of(triangles),
        "n_repeated": len(repeated),
        "mean_lepp": mean,
        "sd_lepp": sd,
        "skewness_lepp": skewness,
        "kurtosis_lepp": kurtosis,
        "max_lepp": max(sizes),
        "n_interior_longest": types[1] + types[2] + types[3],
        "n_type_a": types[1],
        "n_type_b": types[2],
        "n_type_c": types[3],
        "n_regions": len(regions),
        "max_region": max(regions.values()),
        "n_equal_longest": paths.n_equal(),
        "n_nearly_equal_longest": nearly,
    }
    layers = naive.layers(paths.triangles, lepp.INTERIOR_LAYER)
    bars = {
        "histograms": sizes,
        "layers": Counter(zip(layers, paths.sizes(), strict=True)),
        "regions": Counter(regions.values()),
    }
    return measures, bars


def of_method(rows, method):
    return [row for row in rows if row[0] == method]


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
@pytest.mark.parametrize("lattice", [False, True])
def test_every_measure_is_the_twins(distribution, lattice, monkeypatch):
    task = Task(distribution, 60, 1)
    points = sample_points(distribution, 60, 1, seed=DESIGN.seed, correlation=DESIGN.correlation)
    if lattice:  # repeated points, equal lengths
        points = np.round(points * (12 if distribution == "uniform" else 4))
        monkeypatch.setattr("study.run.triangulations.sample_points", lambda *_, **__: points)
    outcome = TRIANGULATIONS.perform(task, DESIGN)
    assert outcome.error is None
    rows = {row[0]: row[1:] for row in outcome.rows["results"]}
    assert list(rows) == list(DESIGN.methods)
    for method in DESIGN.methods:
        if lattice and method == "delaunay":
            continue  # which diagonals of a square are drawn is not the twin's
        measures, bars = twin_of(points, method)
        assert set(measures) == {column.name for column in columns_of(Measures)}
        for column, cell in zip(columns_of(Measures), rows[method][:-1], strict=True):
            assert type(cell) is column.type
            assert cell == pytest.approx(measures[column.name], rel=1e-12, abs=1e-12), column.name
        assert rows[method][-1] is None
        for name, counts in bars.items():
            assert of_method(outcome.rows[name], method) == [
                (method, *np.atleast_1d(place).tolist(), counts[place]) for place in sorted(counts)
            ]
    checks = check_randomness(points, distribution)
    assert outcome.rows["point_sets"] == [tuple(vars(checks).values())]
    stages = [row[:2] for row in outcome.rows["timings"]]
    both = [(m, stage) for m in DESIGN.methods for stage in ("triangulate", "lepp")]
    assert stages == [("", "sample"), ("", "check"), *both]
    assert outcome.seconds == sum(row[2] for row in outcome.rows["timings"]) > 0


@dataclass(frozen=True)
class MoreMeasures(Measures):
    n_ending_at_once: int = measure(
        "Paths of two", unit="triangles", format="int", of=lambda c: c.lepp.counts[2]
    )


def test_a_measure_more_is_one_line(tmp_path, monkeypatch):
    monkeypatch.setattr(Triangulations, "measures", MoreMeasures)
    design = Design.from_settings({"sizes": [60], "repetitions": 1})
    with Store(tmp_path, TRIANGULATIONS, design) as store:
        tasks = store.unfinished
        store.add(TRIANGULATIONS.perform(task, design) for task in tasks[1:])
        store.add([TRIANGULATIONS.failed(tasks[0], design, "MemoryError: no room")])
        store.finish()
    schema = pa.parquet.read_schema(tmp_path / "results.parquet")
    assert schema.names[-2:] == ["n_ending_at_once", "error"]
    assert schema.field("n_ending_at_once").type == pa.int64()
    loaded = load(tmp_path)
    twos = loaded["histograms"].query("lepp_size == 2")["count"].tolist()
    assert loaded["results"]["n_ending_at_once"].tolist()[1:] == twos
    assert loaded["results"].loc[0, "n_ending_at_once"] is loaded["results"].loc[0, "n_hull"]


def failing(points):
    raise ValueError("no triangles today")


def test_a_method_that_fails_leaves_the_others_rows(tmp_path, monkeypatch):
    monkeypatch.setitem(METHODS, "delaunay", replace(METHODS["delaunay"], build=failing))
    with Store(tmp_path, TRIANGULATIONS, DESIGN) as store:
        outcomes = [TRIANGULATIONS.perform(task, DESIGN) for task in store.unfinished]
        assert {o.error for o in outcomes} == {"delaunay: ValueError: no triangles today"}
        store.add(outcomes)
        store.finish()
        assert len(store.failures) == len(outcomes) == 8
    loaded = load(tmp_path)
    errors = loaded["results"].groupby("method")["error"].unique()
    assert errors["delaunay"].tolist() == ["ValueError: no triangles today"]
    assert loaded["results"].query("method == 'incremental'")["error"].isna().all()
    assert len(loaded["point_sets"]) == 8
    assert set(loaded["histograms"]["method"]) == {"incremental"}
    monkeypatch.undo()
    whole = tmp_path / "whole"
    for directory in (tmp_path, whole):
        with Store(directory, TRIANGULATIONS, DESIGN) as store:
            assert len(store.unfinished) == 8
            store.add([TRIANGULATIONS.perform(task, DESIGN) for task in store.unfinished])
            store.finish()
    for name, table in TRIANGULATIONS.tables.items():
        if table.reproducible:
            file = f"{name}.parquet"
            assert (tmp_path / file).read_bytes() == (whole / file).read_bytes()


def backwards(points):
    """Plain insertion in the opposite order, numbered as the points are given."""
    triangles, neighbors, repeated, ranks = METHODS["incremental"].build(points[::-1].copy())
    assert len(repeated) == 0
    return (len(points) - 1 - triangles).astype(triangles.dtype), neighbors, repeated, ranks


def test_a_third_method_goes_through(tmp_path, monkeypatch):
    third = lepp.Method("backwards", "Backwards", "backward", "inserts the last first", backwards)
    monkeypatch.setitem(METHODS, "backwards", third)
    design = Design.from_settings(
        {"methods": ["backwards", "incremental"], "sizes": [60], "repetitions": 3}
    )
    assert design.methods == ("incremental", "backwards")
    with Store(tmp_path, TRIANGULATIONS, design) as store:
        store.add([TRIANGULATIONS.perform(task, design) for task in store.unfinished])
        store.finish()
    results = load(tmp_path)["results"]
    assert results["error"].isna().all()
    assert list(dict.fromkeys(results["method"])) == ["incremental", "backwards"]
    first = results.query("method == 'backwards'").iloc[0]
    points = sample_points("uniform", 60, 0, seed=design.seed)[::-1]
    measures, *_ = twin_of(points, "incremental")
    assert first["n_triangles"] == measures["n_triangles"]
    assert first["mean_lepp"] == pytest.approx(measures["mean_lepp"])
    assert first["n_type_b"] == measures["n_type_b"]


def test_a_method_that_stops_leaves_out_what_is_larger(tmp_path):
    settings = {"sizes": [40, 60], "repetitions": 1, "distributions": ["normal"]}
    both = {"methods": ["incremental", "delaunay"]}
    stops = Design.from_settings(settings | both | {"largest": {"delaunay": 40}})
    small, large = TRIANGULATIONS.tasks_of(stops)
    assert [row[0] for row in TRIANGULATIONS.perform(large, stops).rows["results"]] == [
        "incremental"
    ]
    alike = TRIANGULATIONS.perform(small, Design.from_settings(settings | both))
    assert TRIANGULATIONS.perform(small, stops).rows["results"] == alike.rows["results"]
    assert TRIANGULATIONS.size_of(small, stops) == (2, 80)
    assert TRIANGULATIONS.size_of(large, stops) == (1, 60)
    assert len(TRIANGULATIONS.failed(large, stops, "no room").rows["results"]) == 1
    plain = lepp.METHODS["incremental"].bytes_per_point
    assert TRIANGULATIONS.memory_of(large, stops).n_bytes == 60 * plain
    assert TRIANGULATIONS.memory_of(small, stops).n_bytes > 40 * plain


def test_what_a_design_needs_is_compiled(monkeypatch):
    asked = []
    monkeypatch.setattr(lepp, "compile_kernels", lambda *args, **which: asked.append((args, which)))
    plain = DESIGN.model_copy(update={"methods": ("incremental",), "sizes": (60, 10_000_000)})
    whole = TRIANGULATIONS.memory_of(Task("uniform", 10_000_000, 0), plain).n_bytes
    TRIANGULATIONS.prepare(plain, whole)
    TRIANGULATIONS.prepare(plain, whole - 1)
    TRIANGULATIONS.prepare(DESIGN, 1)
    stops = {"methods": ("incremental", "delaunay"), "largest": {"delaunay": 60}}
    TRIANGULATIONS.prepare(plain.model_copy(update=stops), whole - 1)
    assert asked == [
        ((("incremental",),), {"tiles": False, "meshes": False}),
        ((("incremental",),), {"tiles": True, "meshes": False}),
        ((tuple(METHODS),), {"tiles": False, "meshes": False}),
        ((("incremental", "delaunay"),), {"tiles": True, "meshes": False}),
    ]
