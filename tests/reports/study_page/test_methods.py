"""The report of any number of methods, also of such as only this test knows."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import draw_all
from playwright.sync_api import Page
from tiny_runs import SMALL, other_orders, store_run

import lepp
from reports.page.blocks import TableBlock
from reports.page.evidence import Evidence
from reports.study_page.gather import gather
from reports.study_page.page import write_report
from reports.study_page.sections import agreement, methods, summary, theory
from study.analysis.method_comparison import GROWTH, MEAN_LEPP, METHODS_COMPARED
from study.design.design import Design
from study.run.triangulations import TRIANGULATIONS


@pytest.fixture(autouse=True)
def more_methods(monkeypatch: pytest.MonkeyPatch) -> None:
    for method in other_orders():
        monkeypatch.setitem(lepp.METHODS, method.name, method)


def run_by(directory: Path, *names: str) -> Path:
    return store_run(
        directory / "run", SMALL.model_copy(update={"methods": names}), TRIANGULATIONS.perform
    )


def prose(evidence: Evidence) -> str:
    block = methods.section(evidence).parts[0].blocks[0]
    return " ".join(block.paragraphs[evidence.views[0].key])  # type: ignore[union-attr]


def test_the_methods_of_this_test_triangulate() -> None:
    points = np.random.default_rng(1).random((50, 2))
    sizes = {name: len(lepp.triangulate(points, name).triangles) for name in lepp.METHODS}
    assert len(sizes) == 4
    assert len(set(sizes.values())) == 1


@pytest.mark.parametrize(
    "names",
    [
        ("delaunay",),
        ("incremental", "by_x"),
        ("delaunay", "by_x"),
        ("incremental", "delaunay", "by_x"),
        ("incremental", "delaunay", "by_x", "backwards"),
    ],
    ids=lambda names: f"{len(names)} methods, {names[0]} first",
)
def test_every_other_method_is_compared_with_the_reference(
    tmp_path: Path, names: tuple[str, ...]
) -> None:
    directory = run_by(tmp_path, *names)
    assert "What is missing" not in write_report(directory).read_text(encoding="utf-8")
    evidence = gather(directory)
    for declared in (METHODS_COMPARED, GROWTH):
        frame = evidence.rows(declared).frame
        pairs = list(zip(frame["method_1"], frame["method_2"], strict=True))
        assert list(dict.fromkeys(pairs)) == [(names[0], other) for other in names[1:]]
    if len(names) == 1:
        return
    said = prose(evidence)
    for name in names:
        assert lepp.METHODS[name].description in said
        assert len(re.findall(rf"\d\.\d+ \({lepp.METHODS[name].word}\)", said)) == 2
    last = evidence.rows(
        METHODS_COMPARED, n_points=max(SMALL.sizes), quantity=MEAN_LEPP, method_2=names[-1]
    ).first
    assert f"{last['mean_2']:.4f} ({lepp.METHODS[names[-1]].word})" in said
    every = "Both" if len(names) == 2 else "All"
    figure = methods.section(evidence).parts[0].blocks[1]
    assert figure.reading == f"{every} methods triangulate the same points."  # type: ignore[union-attr]


def test_a_method_that_stops_before_the_others_lacks_nothing(tmp_path: Path) -> None:
    names = ("incremental", "delaunay")
    design = SMALL.model_copy(update={"methods": names, "largest": {"delaunay": 600}})
    directory = store_run(tmp_path / "run", design, TRIANGULATIONS.perform)
    text = write_report(directory).read_text(encoding="utf-8")
    assert "What is missing" not in text
    assert "200, 300, 400, 600 and 800; Delaunay up to 600" in text
    assert "36 of 15,200 points in all<" in text
    assert "5 numbers of points, 200 to 800, delaunay up to 600; 4 repetitions" in text
    evidence = gather(directory)
    blocks = [
        block
        for section in (theory.section(evidence), methods.section(evidence))
        for part in section.parts
        for block in part.blocks
        if isinstance(block, TableBlock) and "n_points" in (block.where or {})
    ]
    assert len(blocks) == 2  # of one size: one that all methods have
    for block in blocks:
        assert not evidence.rows(block.table, **block.where).empty
        assert block.where == {"n_points": 600}


def test_only_the_papers_method_is_said_to_reproduce_the_paper(tmp_path: Path) -> None:
    evidence = gather(run_by(tmp_path, "incremental", "by_x"))
    verdicts = agreement.section(evidence).parts[0].blocks[0].paragraphs  # type: ignore[union-attr]
    by_method = {key.partition("/")[0]: " ".join(text) for key, text in verdicts.items()}
    assert "no failure to reproduce" not in by_method["incremental"]
    assert "Swept triangulations are other meshes" in by_method["by_x"]
    tiles = summary.section(evidence).parts[0].blocks[1].tiles  # type: ignore[union-attr]
    assert all(
        "Independent published numbers met" not in [tile.label for tile in tiles[key]]
        for key in tiles
        if key.startswith("by_x")
    )


def test_methods_below_a_third_are_named() -> None:
    shares = {"incremental": 0.48, "delaunay": 0.30, "by_x": 0.2}
    assert "Those of the Delaunay and swept triangulations are below the 1/3" in methods.premise(
        shares
    )
    assert "That of the Delaunay triangulations is below" in methods.premise(
        {"incremental": 0.48, "delaunay": 0.3}
    )
    assert "All are above" in methods.premise(dict.fromkeys(shares, 0.4))
    assert "Both are above" in methods.premise({"incremental": 0.48, "by_x": 0.4})


@pytest.mark.browser
def test_the_page_of_three_methods_opens(open_report: Callable[..., Page], tmp_path: Path) -> None:
    path = write_report(run_by(tmp_path, "incremental", "delaunay", "by_x"))
    page = open_report("#method=by_x&section=methods", path=path)
    draw_all(page)
    assert page.evaluate("document.body.dataset.view") == "by_x/uniform"
    assert page.get_by_role("radio", name="Swept").is_checked()
    traces = page.evaluate(
        "document.querySelector('[data-figure=figure-methods]').data.map(trace => trace.name)"
    )
    assert traces == ["Plain insertion", "Delaunay", "Swept"] * 2
    heads = (
        page.locator("[data-table='methods']:not(details *)")
        .locator("th[scope=col]")
        .all_inner_texts()
    )
    assert "Second triangulation" in heads
    verdicts = page.locator("[data-table='statements_compared'] tbody tr").first
    assert verdicts.locator(".verdict").count() == 3


def test_designs_keep_the_order_of_the_registry() -> None:
    names = ("by_x", "delaunay", "incremental")
    design = Design(methods=names, distributions=("uniform",), sizes=(200,), repetitions=1)
    assert design.methods == ("incremental", "delaunay", "by_x")
