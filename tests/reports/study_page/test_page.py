import csv
import io
import json
import re
from html import unescape
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path

import plotly.graph_objects as go
import pytest
from tiny_runs import DESIGN, store_run

from reports.page import plotly
from reports.page.blocks import FigureBlock, Section
from reports.page.data import decode
from reports.page.evidence import Evidence
from reports.study_page import sections
from reports.study_page.gather import gather
from reports.study_page.page import write_report
from study.analysis.table import ColumnReference
from study.paper.statements import STATEMENTS
from study.text.numbers import show

MOST_BYTES = 3_000_000
VOID = {"meta", "link", "input", "br", "path", "polygon", "img", "hr"}


class Reader(HTMLParser):
    """Collects ids, links, headings, and the text of scripts."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.addresses: list[str] = []
        self.headings: list[str] = []
        self.scripts: dict[str, str] = {}
        self.open: list[str] = []
        self._script = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.ids += [given["id"]] if given.get("id") else []
        self.addresses += [v for k, v in attrs if k in ("src", "href") and v]
        self.headings += [tag] if re.fullmatch("h[1-6]", tag) else []
        self._script = given.get("id") or "" if tag == "script" else ""
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        self._script = ""
        if tag not in VOID:
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self._script:
            self.scripts[self._script] = self.scripts.get(self._script, "") + data


@pytest.fixture(scope="module")
def evidence(run_directory: Path) -> Evidence:
    return gather(run_directory)


@pytest.fixture(scope="module")
def parts(evidence: Evidence) -> list[Section]:
    return sections.all_sections(evidence)


@pytest.fixture(scope="module")
def read(report: Path) -> Reader:
    return Reader(report.read_text(encoding="utf-8"))


def figures(parts: list[Section]) -> list[FigureBlock]:
    blocks = [block for section in parts for part in section.parts for block in part.blocks]
    return [block for block in blocks if isinstance(block, FigureBlock)]


def without_references(node: object) -> object:
    """A specification with the values of columns in place of references to them."""
    if isinstance(node, ColumnReference):
        return node.values
    if isinstance(node, dict):
        return {key: without_references(value) for key, value in node.items()}
    if isinstance(node, list):
        return [without_references(value) for value in node]
    return node


def test_sections_come_in_the_order_of_the_questions(parts: list[Section]) -> None:
    compared = ["distributions"] if len(DESIGN.distributions) > 1 else []
    compared += ["methods"] if len(DESIGN.methods) > 1 else []
    assert [section.id for section in parts] == [
        "path", "found", "agreement", "theory", "statistics", "edge", "regressions", *compared,
        "regions",
        "data", "made",
    ]  # fmt: skip


def test_figures_are_numbered_in_the_order_of_the_page(report: Path) -> None:
    text = report.read_text(encoding="utf-8")
    numbers = re.findall(r"<h4[^>]*>Figure (\d+)\. (?!Figure|Table)\w", text)
    assert [int(number) for number in numbers] == list(range(1, len(numbers) + 1))
    assert len(numbers) == text.count("<h4") > 15


def test_all_figures_and_tables_of_the_paper_are_there(report: Path) -> None:
    text = report.read_text(encoding="utf-8")
    assert {f"the paper's Figure {k}." for k in range(1, 8)} <= set(
        re.findall(r"the paper's Figure \d\.", text)
    )
    assert set(re.findall(r'data-paper="(Table \d)"', text)) == {f"Table {k}" for k in range(1, 8)}


def test_every_part_figure_and_table_has_a_link_to_itself(report: Path, read: Reader) -> None:
    text = report.read_text(encoding="utf-8")
    anchors = re.findall(r'class="anchor" href="#([\w-]+)"', text)
    assert len(anchors) == len(set(anchors)) == len(re.findall("<h[234]", text))
    tables = re.findall(r'data-address="([\w-]+)"', text)
    assert len(tables) == len(set(tables)) == text.count("data-table=")
    assert {*anchors, *tables} <= set(read.ids)


def test_every_link_inside_the_page_has_a_target(read: Reader) -> None:
    inside = {address[1:] for address in read.addresses if address.startswith("#")}
    assert len(inside) > 40
    assert inside <= set(read.ids)


def test_contents_list_every_heading(report: Path, parts: list[Section]) -> None:
    text = report.read_text(encoding="utf-8")
    contents = text[text.index('<nav class="contents"') : text.index("</nav>")]
    listed = re.findall(r'href="#([\w-]+)"', contents)
    wanted = []
    for section in parts:
        wanted += [section.id, *(part.id for part in section.parts if part.title)]
    assert listed == wanted


def test_a_path_is_explained_before_the_first_number(report: Path) -> None:
    text = report.read_text(encoding="utf-8")
    head = text[text.index("<header class=") : text.index("<form")]
    assert "Study on the Average Size" in head
    assert "María-Cecilia Rivara" in head
    assert f"seed {DESIGN.seed}" in head
    order = [text.index(what) for what in ('id="figure-path"', 'id="found"', 'class="tiles"')]
    assert order == sorted(order)
    before = text[text.index('id="path"') : text.index('id="figure-path"')]
    before = unescape(re.sub("<[^>]*>", "", before))
    assert "terminal edge" in before
    assert "One path is the first step of a refinement" in before
    assert re.search(r"\d", before) is None


def test_link_previews_have_a_title_and_a_description(report: Path) -> None:
    text = report.read_text(encoding="utf-8")
    properties = dict(re.findall(r'<meta property="og:(\w+)" content="([^"]+)">', text))
    assert properties["type"] == "article"
    assert properties["title"] == re.search("<title>(.*)</title>", text)[1]  # type: ignore[index]
    assert re.search(r"\d", properties["description"])
    assert "image/svg+xml,%3Csvg" in text


def test_short_tables_stand_in_the_markup(report: Path, evidence: Evidence) -> None:
    text = report.read_text(encoding="utf-8")
    start = text.index('data-table="statements"')
    markup = text[start : text.index("</table>", start)]
    first = evidence.views[0]
    rows = evidence.rows(STATEMENTS, first)
    assert markup.count("<tr>") == len(rows) + 1
    for holds in rows["holds"]:
        assert f">{holds}</span>" in markup
    assert re.findall(r'<th scope="col"[^>]*>([^<]*)<', markup) == [
        "Where", "Holds", "The paper&#39;s statement", "Measured",
    ]  # fmt: skip


def test_terms_are_explained_once_a_section(report: Path) -> None:
    text = report.read_text(encoding="utf-8")
    main = text[text.index("<main") : text.index("</main>")]
    defined = set(re.findall(r'<div popover id="([\w-]+)"', text))
    for section in re.split("<section ", main)[1:]:
        common = re.sub(r"<div data-view.*?</div>", "", section, flags=re.DOTALL)
        used = re.findall(r'class="term" popovertarget="([\w-]+)"', common)
        assert len(used) == len(set(used))
        assert set(used) <= defined
    assert {"term-lepp", "term-terminal-edge", "term-p"} <= set(
        re.findall(r'popovertarget="([\w-]+)"', main)
    )


def test_markup_is_closed_and_ids_are_unique(read: Reader) -> None:
    assert read.open == []
    assert len(read.ids) == len(set(read.ids))


def test_headings_step_down_one_level_at_a_time(read: Reader) -> None:
    levels = [int(heading[1]) for heading in read.headings]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(b - a <= 1 for a, b in pairwise(levels))


def test_captions_tell_tables_apart(report: Path) -> None:
    captions = re.findall(r'data-caption="([^"]*)"', report.read_text(encoding="utf-8"))
    assert len(captions) == len(set(captions))


def test_nothing_is_fetched(read: Reader) -> None:
    assert [a for a in read.addresses if not a.startswith(("#", "data:"))] == []


def test_every_view_of_every_figure_is_drawn_and_said(
    parts: list[Section], evidence: Evidence
) -> None:
    keys = {view.key for view in evidence.views}
    for block in figures(parts):
        for by_view in (block.specs, block.alternatives):
            assert set(by_view) in (keys, {"*"}), block.id
        assert all(re.search(r"\d", text) for text in block.alternatives.values()), block.id


def test_plots_keep_to_plotlys_schema(parts: list[Section]) -> None:
    for block in figures(parts):
        for spec in block.specs.values():
            go.Figure(without_references(spec))  # raises ValueError for what Plotly does not know


def test_plots_use_the_kinds_of_traces_that_the_page_has(parts: list[Section]) -> None:
    kinds = {
        trace["type"]
        for block in figures(parts)
        for spec in block.specs.values()
        for trace in spec["data"]
    }
    assert kinds == set(plotly.TRACES)


def test_data_block_holds_the_files_on_disk(read: Reader, report: Path) -> None:
    tables = decode(read.scripts["report-data"])["tables"]
    files = {path.stem: path for path in report.parent.glob("tables/*.csv")}
    assert tables.keys() == files.keys()
    for name, path in files.items():
        columns = tables[name]["columns"]
        rows = list(csv.reader(io.StringIO(path.read_text("utf-8"), newline="")))
        assert rows[0] == [column["header"] for column in columns]
        assert [list(row) for row in zip(*(c["raw"] for c in columns), strict=True)] == rows[1:]


def test_every_cell_has_the_text_that_the_readme_has(read: Reader, evidence: Evidence) -> None:
    shown = decode(read.scripts["report-data"])["tables"]
    for name, table in evidence.tables.items():
        for column, data in zip(table.columns, shown[name]["columns"], strict=True):
            texts = [show(value, column.format) for value in table.frame[column.name]]
            assert data.get("shown", data["raw"]) == texts, (name, column.name)


def test_figures_repeat_no_number_of_a_table(read: Reader) -> None:
    def longest(node: object) -> int:
        if isinstance(node, dict):
            return 0 if "$" in node else max(map(longest, node.values()), default=0)
        if isinstance(node, list):
            return max([len(node), *map(longest, node)])
        return 0

    # What stays inline grows with the numbers of groups and of sizes, not with the tasks.
    assert longest(decode(read.scripts["report-data"])["figures"]) < 100


def test_a_report_fits_into_its_bytes(report: Path) -> None:
    assert report.stat().st_size < MOST_BYTES


def test_same_results_give_the_same_bytes(report: Path, tmp_path: Path) -> None:
    from study.run.triangulations import TRIANGULATIONS

    again = write_report(store_run(tmp_path / "again", DESIGN, TRIANGULATIONS.perform))
    assert again.read_bytes() == report.read_bytes()
    for path in sorted(report.parent.glob("tables/*.csv")):
        assert (again.parent / "tables" / path.name).read_bytes() == path.read_bytes()


def test_a_new_report_removes_what_an_older_one_wrote_and_nothing_else(report: Path) -> None:
    tables = report.parent / "tables"
    written = tables / ".lepp-study.json"
    old, users = tables / "of_an_older_version.csv", tables / "my_notes.csv"
    for path in (old, users, report.parent / "kept.csv"):
        path.write_text("a\n1\n")
    names = json.loads(written.read_text())["tables"]
    written.write_text(json.dumps({"tables": [*names, old.name, "../kept.csv"]}))
    before = report.read_bytes()
    write_report(report.parent)
    assert not old.exists()
    assert users.exists()
    assert (report.parent / "kept.csv").exists()
    assert json.loads(written.read_text())["tables"] == names
    users.unlink()
    (report.parent / "kept.csv").unlink()
    assert report.read_bytes() == before
    assert not list(report.parent.glob(".*.html*"))
