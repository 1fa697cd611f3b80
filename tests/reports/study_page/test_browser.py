"""The page in a real browser: drawn, switched, linked, explored, downloaded and printed."""

import base64
import re
import struct
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest
from conftest import draw_all
from playwright.sync_api import Page
from tiny_runs import DESIGN

from reports.page import plotly
from reports.study_page.gather import gather
from study.text.numbers import show

pytestmark = pytest.mark.browser

Open = Callable[..., Page]
#: What a number or a formula is not written with on the page.
FOREIGN = re.compile(r"sqrt|\^|\de[+-]?\d|log10|\brho\b|(?<![\w)\]])-\d|\d ?%| - ")
CHECKSUM = re.compile(r"[0-9a-f]{64}")
#: Colour of an image's upper right corner, which no drawing reaches.
CORNER = """async (bytes) => {
    const image = new Image();
    image.src = `data:image/png;base64,${bytes}`;
    await image.decode();
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    return [...context.getImageData(image.width - 1, 0, 1, 1).data];
}"""
MOST_PAGES = 25
SECOND = DESIGN.distributions[1]
#: Lengths of the tasks longer than 50 ms, in milliseconds.
LONG_TASKS = """new Promise(resolve => {
    new PerformanceObserver(list => resolve(list.getEntries().map(e => Math.round(e.duration))))
        .observe({ type: 'longtask', buffered: true });
    setTimeout(() => resolve([]), 200);
})"""


def shown_rows(page: Page, table: str) -> list[list[str]]:
    return page.evaluate(
        """name => [...document.querySelectorAll(`[data-table="${name}"]:not(details *) tbody tr`)]
            .map(row => [...row.children].map(cell => cell.textContent))""",
        table,
    )


@pytest.mark.parametrize("width", [360, 1280, 1600])
def test_everything_is_drawn_and_fits(open_report: Open, width: int) -> None:
    page = open_report(viewport={"width": width, "height": 800})
    draw_all(page)
    assert page.locator("main > section").count() >= 8
    for host in page.locator("[data-figure]").all():
        assert host.is_visible()
        assert host.locator(".main-svg").count() > 0
        assert host.bounding_box()["height"] > 200  # type: ignore[index]
    assert page.locator(".absent:visible").count() == 0
    assert page.locator(".explorer polygon").count() > 50
    assert page.evaluate("document.documentElement.scrollWidth") == width
    for table in page.locator("[data-table]:visible").all():
        assert table.locator("tbody tr").count() > 0, table.get_attribute("data-table")


def drawn_figures(page: Page) -> list[str]:
    return page.evaluate(
        """[...document.querySelectorAll('[data-figure]')]
            .filter(host => host.querySelector('.main-svg')).map(host => host.dataset.figure)"""
    )


def near_figures(page: Page) -> list[str]:
    """Figures at most 600 pixels above or below the window."""
    return page.evaluate(
        """[...document.querySelectorAll('[data-figure]')].filter(host => {
            const { top, bottom } = host.getBoundingClientRect();
            return !host.hidden && bottom > -600 && top < innerHeight + 600;
        }).map(host => host.dataset.figure)"""
    )


def test_plotly_runs_when_a_figure_is_near_and_draws_no_other(
    open_report: Open, capsys: pytest.CaptureFixture[str]
) -> None:
    page = open_report()
    order = page.evaluate("performance.getEntriesByType('mark').map(mark => mark.name)")
    assert order == ["tables", "figures"]
    assert page.locator(".explorer polygon").count() > 50
    assert page.evaluate("scrollY") == 0
    assert near_figures(page) == []
    page.wait_for_timeout(500)  # long enough to draw them all
    assert page.evaluate("typeof Plotly") == "undefined"
    lengths = page.evaluate(LONG_TASKS)
    ready = page.evaluate("Math.round(performance.getEntriesByName('tables')[0].startTime)")
    with capsys.disabled():
        print(
            f"\n  page: tables after {ready} ms; longest task {max(lengths, default=0)} ms, total "
            f"blocking time {sum(length - 50 for length in lengths)} ms before scrolling"
        )
    hosts = page.locator("[data-figure]")
    hosts.nth(hosts.count() // 2).scroll_into_view_if_needed()
    page.wait_for_function("window.Plotly && document.querySelector('.main-svg')")
    page.wait_for_timeout(500)
    assert drawn_figures(page) == near_figures(page)
    assert 0 < len(drawn_figures(page)) < hosts.count()
    kinds = page.evaluate("Object.keys(Plotly.PlotSchema.get().traces)")
    assert sorted(kinds) == sorted(plotly.TRACES)


def test_switch_acts_on_the_whole_page_and_on_the_address(open_report: Open) -> None:
    page = open_report()
    draw_all(page)
    before = (page.locator(".finding:visible").all_inner_texts(), shown_rows(page, "table_4"))
    page.locator("[data-figure=figure-triangulations]").scroll_into_view_if_needed()
    drawn = page.evaluate(
        "document.querySelector('[data-figure=figure-triangulations]').data[0].y[0]"
    )
    page.get_by_role("radio", name="Bivariate normal").check()
    assert f"distribution={SECOND}" in page.url
    after = (page.locator(".finding:visible").all_inner_texts(), shown_rows(page, "table_4"))
    assert before[0] != after[0]
    assert before[1] != after[1]
    page.wait_for_function(
        f"document.querySelector('[data-figure=figure-triangulations]').data[0].y[0] !== {drawn}"
    )
    assert "Bivariate normal" in page.locator("#announcement").inner_text()
    page.go_back()
    page.wait_for_function("document.body.dataset.view.endsWith('/uniform')")
    assert shown_rows(page, "table_4") == before[1]
    page.go_forward()
    page.wait_for_function(f"document.body.dataset.view.endsWith('/{SECOND}')")
    assert shown_rows(page, "table_4") == after[1]


def test_a_view_can_be_linked(open_report: Open) -> None:
    method = DESIGN.methods[-1]
    page = open_report(f"#distribution={SECOND}&method={method}&section=theory")
    assert page.evaluate("document.body.dataset.view") == f"{method}/{SECOND}"
    assert page.get_by_role("radio", name="Bivariate normal").is_checked()
    assert page.evaluate("document.activeElement.id") == "theory-title"


def test_unknown_values_in_the_address_are_ignored(open_report: Open) -> None:
    page = open_report("#distribution=cauchy&method=sorcery&section=nowhere")
    assert page.evaluate("document.body.dataset.view") == f"{DESIGN.methods[0]}/uniform"


def test_sections_are_reached_without_losing_the_view(open_report: Open) -> None:
    page = open_report(f"#distribution={SECOND}")
    page.get_by_role("navigation").get_by_role("link", name="The data").click()
    assert f"distribution={SECOND}" in page.url
    assert "section=data" in page.url
    page.wait_for_function(
        "Math.abs(document.querySelector('#data').getBoundingClientRect().top) < 200"
    )
    page.evaluate("location.hash = '#regions'")  # as a plain link from elsewhere would
    page.wait_for_timeout(50)
    assert page.evaluate("document.body.dataset.view").endswith(SECOND)


def test_a_choice_of_one_is_no_switch(open_report: Open) -> None:
    page = open_report()
    methods = page.locator("fieldset", has_text="Triangulation")
    assert methods.is_visible() == (len(DESIGN.methods) > 1)


def test_explorer_by_mouse(open_report: Open) -> None:
    page = open_report()
    said = page.locator(".explorer .said")
    triangles = page.evaluate(
        """() => [...document.querySelectorAll('polygon[role=option]')].map((shape, k) => {
            const box = shape.getBoundingClientRect();
            return {k, area: box.width * box.height, label: shape.getAttribute('aria-label')};
        }).sort((a, b) => b.area - a.area)"""
    )
    for triangle in triangles[:3]:
        shape = page.locator(f".explorer polygon[data-triangle='{triangle['k']}']")
        shape.dispatch_event("pointerover")
        size = int(triangle["label"].rsplit(" ", 1)[1])
        assert f"Triangle {triangle['k']}: LEPP size {size}." in said.inner_text()
        assert page.locator(".explorer polygon.start, .explorer polygon.path").count() == size
        assert page.locator(".explorer line.terminal").count() == 1


def test_explorer_by_keyboard(open_report: Open) -> None:
    page = open_report()
    page.locator(".explorer polygon[tabindex='0']").focus()
    said = page.locator(".explorer .said")
    seen = {said.inner_text()}
    for key in ("ArrowLeft", "ArrowDown", "ArrowRight", "ArrowUp", "Home", "End"):
        page.keyboard.press(key)
        seen.add(said.inner_text())
        focused = page.evaluate("document.activeElement.dataset.triangle")
        assert said.inner_text().startswith(f"Triangle {focused}:")
        assert page.locator(".explorer polygon[tabindex='0']").count() == 1
    assert len(seen) >= 5
    long = page.locator(".explorer polygon[aria-label$='LEPP size 4']").first
    long.focus()
    start = said.inner_text()
    page.keyboard.press("Enter")
    following = start.split("goes ")[1].split(" → ")[1]
    assert said.inner_text().startswith(f"Triangle {following}:")


def test_csv_downloads_are_the_files_on_disk(open_report: Open, report: Path) -> None:
    page = open_report()
    page.evaluate("document.querySelectorAll('details').forEach(fold => fold.open = true)")
    page.wait_for_function(
        "[...document.querySelectorAll('[data-table]')].every(host => host.querySelector('table'))"
    )
    names = set(page.locator("[data-table]").evaluate_all("all => all.map(h => h.dataset.table)"))
    assert len(names) > 25
    for k, name in enumerate(sorted(names), start=1):
        if k % 8 == 0:
            page.wait_for_timeout(1500)  # Chromium drops downloads beyond ten a second
        with page.expect_download() as started:
            # Not by the mouse: plots that are drawn meanwhile move the buttons.
            page.locator(f"[data-table='{name}'] button.csv").first.dispatch_event("click")
        assert started.value.suggested_filename == f"{name}.csv"
        on_disk = report.parent / "tables" / f"{name}.csv"
        assert Path(started.value.path()).read_bytes() == on_disk.read_bytes()


@pytest.mark.parametrize(
    ("scheme", "figure"),
    [
        ("light", "figure-path"),
        ("dark", "figure-worst-case"),
        ("light", "figure-triangulations"),
        ("dark", "figure-pairs"),
    ],
)
def test_a_figure_can_be_saved_in_the_theme_of_the_page(
    open_report: Open, scheme: str, figure: str
) -> None:
    page = open_report(color_scheme=scheme, viewport={"width": 390, "height": 800})
    place = page.locator(f"#{figure}")
    view = "" if figure == "figure-worst-case" else f"-uniform-{DESIGN.methods[0]}"
    title = " ".join(place.locator("h4").inner_text().split())
    paper = page.evaluate("getComputedStyle(document.body).backgroundColor")

    def saved(kind: str) -> tuple[str, bytes]:
        with page.expect_download() as started:
            place.locator(f"button[data-save={kind}]").first.click()
        return started.value.suggested_filename, Path(started.value.path()).read_bytes()

    name, text = saved("svg")
    assert name == f"lepp-{figure}{view}.svg"
    drawing = ElementTree.fromstring(text)
    assert drawing.tag == "{http://www.w3.org/2000/svg}svg"
    assert drawing[0].get("fill") == paper
    assert drawing[1].text == title
    assert b"var(--" not in text
    name, pixels = saved("png")
    assert name == f"lepp-{figure}{view}.png"
    width, height = struct.unpack(">II", pixels[16:24])
    assert (width, height) == tuple(
        2 * float(drawing.get(side, "")) for side in ("width", "height")
    )
    corner = page.evaluate(CORNER, base64.b64encode(pixels).decode())
    assert f"rgb({', '.join(map(str, corner[:3]))})" == paper
    assert corner[3] == 255
    assert saved("csv")[0].startswith(f"lepp-{figure}")


def test_the_data_of_a_figure_are_those_shown(open_report: Open, report: Path) -> None:
    page = open_report(f"#distribution={SECOND}")
    with page.expect_download() as started:
        page.locator("#figure-pairs button[data-save=csv]").click()
    rows = Path(started.value.path()).read_text(encoding="utf-8").splitlines()
    every = (report.parent / "tables/pairs.csv").read_text(encoding="utf-8").splitlines()
    shown = [row for row in every[1:] if row.startswith(f"{DESIGN.methods[0]},{SECOND},")]
    assert rows == [every[0], *shown]
    assert 0 < len(shown) < len(every) - 1


def test_cells_show_the_texts_of_the_tables(open_report: Open, run_directory: Path) -> None:
    """Table 4 of the first view, cell by cell; and the sense of verdicts."""
    page = open_report()
    table = gather(run_directory).tables["table_4"]
    rows = table.rows(method=DESIGN.methods[0], distribution=DESIGN.distributions[0]).frame
    shown = [column for column in table.columns if column.name not in ("method", "distribution")]
    texts = [[show(row[c.name], c.format) for c in shown] for _, row in rows.iterrows()]
    assert shown_rows(page, "table_4") == texts
    verdicts = page.locator("[data-table='statements'] tbody .verdict")
    words = {"yes": "good", "no": "bad"}
    assert verdicts.count() > 10
    for cell in verdicts.all():
        assert cell.get_attribute("data-sense") == words.get(cell.inner_text().lower(), "")


def test_the_script_asks_for_no_column_that_is_not_there(open_report: Open) -> None:
    page = open_report()
    said = page.evaluate(
        """async () => {
            const report = new ReportData(await inflate('report-data').json());
            const ask = (act) => { try { act(); } catch (error) { return error.message; } };
            const groups = report.table('groups');
            return [ask(() => report.table('group')), ask(() => groups.select({n_point: 1})),
                ask(() => groups.values('mean', [0]))];
        }"""
    )
    assert said == [
        "there is no table group",
        "table groups has no column n_point",
        "table groups has no column mean",
    ]


def test_numbers_and_formulas_have_one_notation(open_report: Open) -> None:
    """All text of the page, of every view and fold, and that of the plots."""
    page = open_report()
    page.evaluate("document.querySelectorAll('details').forEach(fold => fold.open = true)")
    page.wait_for_function(
        "[...document.querySelectorAll('[data-table]')].every(host => host.querySelector('table'))"
    )
    page.evaluate("dispatchEvent(new Event('beforeprint'))")  # draws all plots
    texts = page.evaluate(
        """() => {
            const main = document.querySelector('main');
            const nodes = document.createTreeWalker(main, NodeFilter.SHOW_TEXT);
            const texts = [];
            while (nodes.nextNode()) {
                const parent = nodes.currentNode.parentElement;
                if (!parent.closest('code, pre, style')) texts.push(nodes.currentNode.textContent);
            }
            return texts;
        }"""
    )
    assert len(texts) > 1000
    texts = [text for text in texts if not CHECKSUM.fullmatch(text.strip())]
    assert sorted({text.strip() for text in texts if FOREIGN.search(text)}) == []


def test_dark_theme_follows_the_system_and_the_button(open_report: Open) -> None:
    colors = """() => [getComputedStyle(document.body).backgroundColor,
        document.querySelector('[data-figure=figure-triangulations]').layout.font.color]"""

    def paint(page: Page) -> list[str]:
        figure = page.locator("[data-figure=figure-triangulations]")
        figure.scroll_into_view_if_needed()
        figure.locator(".main-svg").first.wait_for()
        page.wait_for_timeout(300)  # those near are drawn one by one
        return page.evaluate(colors)

    light, dark = open_report(color_scheme="light"), open_report(color_scheme="dark")
    lit, unlit = paint(light), paint(dark)
    assert lit[0] != unlit[0]
    assert lit[1] != unlit[1]
    light.get_by_role("button", name="Dark").click()
    assert paint(light) == unlit
    light.reload()
    light.wait_for_selector("html[data-ready='figures']", state="attached")
    assert paint(light) == unlit


def test_a_figure_that_was_far_away_follows_the_theme_when_it_comes_near(
    open_report: Open,
) -> None:
    page = open_report(color_scheme="light")
    draw_all(page)  # and go back to the top
    color = "document.querySelector('[data-figure=figure-triangulations]').layout.font.color"
    before = page.evaluate(color)
    page.get_by_role("button", name="Dark").click()
    page.wait_for_timeout(300)
    assert page.evaluate(color) == before
    page.locator("[data-figure=figure-triangulations]").scroll_into_view_if_needed()
    page.wait_for_function(f"{color} !== '{before}'")


def test_a_print_out_has_every_figure_in_light(open_report: Open, tmp_path: Path) -> None:
    page = open_report(color_scheme="dark")
    assert page.evaluate("typeof Plotly") == "undefined"  # printing runs it
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.locator("details[open]").count() == 0
    assert len(drawn_figures(page)) == page.locator("[data-figure]:visible").count()
    color = "document.querySelector('[data-figure=figure-triangulations]').layout.font.color"
    light = page.evaluate(color)
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    page.locator("[data-figure=figure-triangulations]").scroll_into_view_if_needed()
    page.wait_for_function(f"{color} !== '{light}'")
    pdf = tmp_path / "report.pdf"
    page.pdf(path=pdf, prefer_css_page_size=True)
    pages = len(re.findall(rb"/Type\s*/Page\b", pdf.read_bytes()))
    assert 5 < pages <= MOST_PAGES


def test_keyboard_reaches_the_page(open_report: Open) -> None:
    page = open_report()
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.className") == "skip"
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "main"


def test_page_works_without_its_script(browser: object, report: Path) -> None:
    context = browser.new_context(java_script_enabled=False)  # type: ignore[attr-defined]
    page = context.new_page()
    page.goto(report.as_uri())
    assert "tables" in page.locator("main > noscript").inner_text()
    assert page.locator(".tiles:visible").count() == 1
    context.close()


@pytest.mark.parametrize(("scheme", "width"), [("light", 1280), ("dark", 390)])
def test_axe_finds_no_violation(
    open_report: Open, violations: Callable, scheme: str, width: int
) -> None:
    page = open_report(color_scheme=scheme, viewport={"width": width, "height": 900})
    page.evaluate("document.querySelectorAll('details').forEach(fold => fold.open = true)")
    draw_all(page)
    # Rows of a long table are alike, and take axe the most of its time.
    page.evaluate(
        "document.querySelectorAll('tbody tr:nth-child(n+9):not(:has(.verdict))')"
        ".forEach(row => row.remove())"
    )
    assert violations(page) == []
