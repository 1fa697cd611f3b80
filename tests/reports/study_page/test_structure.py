"""How one finds one's way on the page: links, contents, terms, tables, copies; in a browser."""

import csv
import io
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Page
from tiny_runs import DESIGN

pytestmark = pytest.mark.browser

Open = Callable[..., Page]
SECOND = DESIGN.distributions[1]
#: How far below the bar a place may come to stand, in CSS pixels.
NEAR = 40
#: One place of each kind, far down the page.
PLACES = ("theory", "projections", "made", "figure-regions", "table-anova", "figure-qq-data")


def below_the_bar(page: Page, place: str) -> float:
    """Distance of a place from the lower edge of the bar."""
    return page.evaluate(
        """place => document.getElementById(place).getBoundingClientRect().top
            - document.querySelector('.bar').getBoundingClientRect().bottom""",
        place,
    )


def is_reached(page: Page, place: str) -> bool:
    """Whether a place stands below the bar, or the page ends before it can."""
    at_end = page.evaluate(
        "Math.abs(scrollY + innerHeight - document.documentElement.scrollHeight) < 2"
    )
    distance = below_the_bar(page, place)
    return 0 <= distance <= NEAR or (at_end and distance > 0)


@pytest.mark.parametrize("width", [390, 1280])
@pytest.mark.parametrize("place", PLACES)
def test_deep_links_land_where_they_point(open_report: Open, width: int, place: str) -> None:
    page = open_report(f"#{place}", viewport={"width": width, "height": 900})
    assert is_reached(page, place)
    page.wait_for_timeout(500)  # the figures nearby are drawn meanwhile
    assert is_reached(page, place)


def test_a_link_opens_the_fold_that_it_points_into(open_report: Open) -> None:
    page = open_report("#figure-qq-data")
    assert page.locator("#figure-qq-data tbody tr").count() > 0


def test_link_icons_keep_the_view_and_copy_the_address(open_report: Open) -> None:
    page = open_report(f"#distribution={SECOND}", permissions=["clipboard-read", "clipboard-write"])
    page.get_by_role("link", name="Link to The theory").click()
    copied = page.evaluate("navigator.clipboard.readText()")
    assert copied == page.url
    assert copied.endswith(f"distribution={SECOND}&section=theory")
    assert page.locator("#announcement").inner_text() == "copied"
    again = open_report(copied[copied.index("#") :])
    assert again.evaluate("document.body.dataset.view").endswith(SECOND)
    assert is_reached(again, "theory")


def test_the_reader_moves_away_from_a_place(open_report: Open) -> None:
    page = open_report("#theory")
    page.mouse.move(640, 450)
    page.mouse.wheel(0, 600)
    page.wait_for_function("document.getElementById('theory').getBoundingClientRect().top < -200")
    page.evaluate("document.querySelector('#theory details').open = true")  # the page grows
    page.wait_for_timeout(100)
    assert below_the_bar(page, "theory") < -200


def test_contents_unfold_the_section_that_is_read(open_report: Open) -> None:
    page = open_report("#theory")
    part = page.get_by_role("navigation").locator("a[href='#steps']")
    page.locator(".contents a[href='#theory'][aria-current]").wait_for()
    assert part.is_visible()
    assert not page.get_by_role("navigation").locator("a[href='#projections']").is_visible()
    part.click()
    assert is_reached(page, "steps")
    page.get_by_role("button", name="Parts of: Which model survives").press("Enter")
    assert page.get_by_role("navigation").locator("a[href='#projections']").is_visible()


def test_contents_unfold_on_a_narrow_window(open_report: Open) -> None:
    page = open_report(viewport={"width": 390, "height": 900})
    button = page.get_by_role("button", name="Parts of: Which model survives")
    link = page.get_by_role("navigation").locator("a[href='#projections']")
    assert not link.is_visible()
    button.click()
    link.click()
    assert is_reached(page, "projections")


@pytest.mark.parametrize("width", [390, 1280])
def test_terms_explain_themselves(open_report: Open, width: int) -> None:
    page = open_report(viewport={"width": width, "height": 900})
    term = page.locator("#path .term", has_text="terminal edge")
    box = page.locator("#term-terminal-edge")
    assert not box.is_visible()
    term.hover()
    box.wait_for(state="visible")
    place = box.bounding_box()
    assert place is not None
    assert place["x"] >= 0
    assert place["x"] + place["width"] <= width
    box.hover()  # one can read it with the pointer
    page.wait_for_timeout(400)
    assert box.is_visible()
    page.mouse.move(5, 5)
    box.wait_for(state="hidden")
    term.focus()
    assert box.is_visible()
    page.keyboard.press("Escape")
    assert not box.is_visible()
    described = term.get_attribute("aria-describedby")
    assert described == "term-terminal-edge"


def test_terms_explain_themselves_by_touch(open_report: Open) -> None:
    page = open_report(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    page.locator("#path .term", has_text="LEPP").tap()
    assert page.locator("#term-lepp").is_visible()
    page.locator("h1").tap()
    page.locator("#term-lepp").wait_for(state="hidden")


def column(page: Page, table: str, name: str) -> list[str]:
    return page.evaluate(
        """([table, name]) => {
            const host = document.querySelector(`[data-table="${table}"]`);
            const heads = [...host.querySelectorAll("thead th")];
            const k = heads.findIndex((head) => head.dataset.column === name);
            return [...host.querySelectorAll("tbody tr")].map((row) => row.children[k].textContent);
        }""",
        [table, name],
    )


def test_tables_are_sorted_by_their_headings(open_report: Open) -> None:
    page = open_report()
    host = page.locator("[data-table='statements']").first
    as_it_was = column(page, "statements", "holds")
    head = host.locator("th[data-column='holds']")
    assert head.get_attribute("aria-sort") == "none"
    head.get_by_role("button").press("Enter")
    assert head.get_attribute("aria-sort") == "ascending"
    assert column(page, "statements", "holds") == sorted(as_it_was)
    head.get_by_role("button").press("Enter")
    assert head.get_attribute("aria-sort") == "descending"
    assert column(page, "statements", "holds") == sorted(as_it_was, reverse=True)
    page.get_by_role("radio", name="Bivariate normal").check()
    assert head.get_attribute("aria-sort") == "descending"  # the view changes, the order stays
    head.get_by_role("button").press("Enter")
    page.get_by_role("radio", name="Uniform").check()
    assert column(page, "statements", "holds") == as_it_was


def test_tables_are_filtered_and_downloaded_as_shown(open_report: Open) -> None:
    page = open_report()
    host = page.locator("[data-table='statements']").first
    n_rows = host.locator("tbody tr").count()
    host.get_by_role("searchbox").fill("THEOREM  2")
    shown = column(page, "statements", "source")
    texts = [text.lower() for text in host.locator("tbody tr").all_inner_texts()]
    assert all("theorem" in text and "2" in text for text in texts)
    assert host.locator(".state").inner_text() == f"{len(shown)} of {n_rows} rows"
    assert 0 < len(shown) < n_rows
    with page.expect_download() as started:
        host.locator("button.csv-shown").click()
    assert started.value.suggested_filename == "statements_shown.csv"
    text = Path(started.value.path()).read_text(encoding="utf-8")
    rows = list(csv.reader(io.StringIO(text, newline="")))
    assert rows[0] == ["source", "holds", "statement", "evidence"]
    assert [row[0] for row in rows[1:]] == shown
    host.get_by_role("searchbox").fill("no such words")
    assert host.locator("tbody tr").count() == 0


def test_a_note_is_of_the_columns_that_are_shown(open_report: Open) -> None:
    page = open_report()
    criteria, lack = "AIC and BIC are on the scale of y", "Lack of fit compares"
    page.locator("#table-regressions-weighted summary").click()
    weighted, of_paper = (
        page.locator(f"#{place} .note").inner_text()
        for place in ("table-regressions-weighted", "table-regressions")
    )
    assert criteria in weighted
    assert lack in weighted
    assert lack in of_paper
    assert criteria not in of_paper
    assert weighted.count(criteria) == 1


@pytest.mark.parametrize(("width", "scheme"), [(390, "dark"), (390, "light"), (1280, "light")])
def test_no_table_is_clipped_without_a_sign(open_report: Open, width: int, scheme: str) -> None:
    page = open_report(viewport={"width": width, "height": 900}, color_scheme=scheme)
    silent = page.evaluate(
        """() => [...document.querySelectorAll("[data-table] .scroll")].filter((scroll) => {
            const clipped = scroll.scrollWidth > scroll.clientWidth + 1;
            const shadow = getComputedStyle(scroll.parentElement, "::before").opacity === "1";
            return clipped && !(shadow && scroll.tabIndex === 0);
        }).map((scroll) => scroll.ariaLabel)"""
    )
    assert silent == []
    if width == 390:
        host = page.locator("[data-table='statements']").first
        scroll = host.locator(".scroll")
        holds = scroll.locator(".verdict").first.bounding_box()
        assert holds is not None
        assert holds["x"] + holds["width"] < width
        scroll.evaluate("scroll => scroll.scrollTo(scroll.scrollWidth, 0)")
        host.locator(".window:not([data-clipped~='right'])").wait_for()
        first = scroll.locator("tbody th").first.bounding_box()
        assert first is not None
        assert first["x"] >= 0  # the first column stays


def test_a_citation_is_copied(open_report: Open) -> None:
    page = open_report(permissions=["clipboard-read", "clipboard-write"])
    box = page.locator(".quotation", has_text="The paper")
    box.get_by_role("button", name="Copy").click()
    text = page.evaluate("navigator.clipboard.readText()")
    assert text == box.locator("pre").inner_text()
    assert text.startswith("@inproceedings{vilcahuayta2020,")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_theme_button_names_the_theme_that_it_switches_to(
    open_report: Open, scheme: str
) -> None:
    page = open_report(color_scheme=scheme)
    other = "Dark" if scheme == "light" else "Light"
    button = page.locator("#theme")
    assert button.inner_text().strip() == other
    button.click()
    assert button.inner_text().strip() == scheme.capitalize()


def test_key_tables_and_contents_need_no_script(browser: object, report: Path) -> None:
    context = browser.new_context(java_script_enabled=False)  # type: ignore[attr-defined]
    page = context.new_page()
    page.goto(report.as_uri())
    rows = page.locator("[data-table='statements'] tbody tr")
    assert rows.first.is_visible()
    assert rows.count() > 10
    for host in page.locator("[data-table]:visible").all():
        assert host.inner_text().strip(), host.get_attribute("data-table")
    assert page.locator(".contents a[href='#projections']").is_visible()
    assert page.locator("button.copy:visible").count() == 0
    context.close()
