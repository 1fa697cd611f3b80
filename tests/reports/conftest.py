"""Results of tiny real runs, their reports, and a browser to look at them."""

import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, sync_playwright
from tiny_runs import DESIGN, store_run

from reports.study_page.page import write_report
from study.run.triangulations import TRIANGULATIONS

#: The first that is there; a page opens in the headless shell in a quarter of the time.
BROWSERS = ("chromium-headless-shell", "chromium", "google-chrome")
_FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]


@pytest.fixture(scope="session")
def run_directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return store_run(tmp_path_factory.mktemp("results") / "run", DESIGN, TRIANGULATIONS.perform)


@pytest.fixture(scope="session")
def report(run_directory: Path) -> Path:
    return write_report(run_directory)


def _missing(what: str) -> None:
    if os.environ.get("LEPP_BROWSER_REQUIRED"):
        pytest.fail(f"{what}, and LEPP_BROWSER_REQUIRED is set")
    pytest.skip(what)  # the reason is what the caller says is not there


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        own = playwright.chromium.executable_path  # what `playwright install chromium` leaves
        path = next(filter(None, map(shutil.which, (*BROWSERS, own))), None)
        if path is None:
            _missing(f"there is no browser among {', '.join(BROWSERS)}")
        launched = playwright.chromium.launch(executable_path=path, args=_FLAGS)
        yield launched
        launched.close()


@pytest.fixture(scope="session")
def violations() -> Callable[[Page], list[tuple]]:
    """Ask axe-core about a page: the rules that are broken, and the first places."""
    path = os.environ.get("LEPP_AXE")
    if not path:
        _missing("LEPP_AXE does not name axe-core's axe.min.js")
    axe = Path(str(path)).read_text(encoding="utf-8")

    def ask(page: Page) -> list[tuple]:
        page.evaluate(axe)
        found = page.evaluate(
            "axe.run({ resultTypes: ['violations'] }).then(found => found.violations)"
        )
        return [(one["id"], [node["target"] for node in one["nodes"]][:5]) for one in found]

    return ask


@pytest.fixture
def open_report(browser: Browser, report: Path) -> Iterator[Callable[..., Page]]:
    """Open the report in a page of its own; fail if the page complains or asks the network."""
    contexts = []
    complaints: list[str] = []

    def open_page(address: str = "", path: Path = report, **options: object) -> Page:
        options.setdefault("viewport", {"width": 1280, "height": 900})
        options.setdefault("reduced_motion", "reduce")
        context = browser.new_context(accept_downloads=True, **options)  # type: ignore[arg-type]
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda m: complaints.append(f"{m.type}: {m.text}"))
        page.on("pageerror", lambda error: complaints.append(f"error: {error}"))
        page.on("request", lambda request: _local(request.url, complaints))
        page.goto(path.as_uri() + address)
        page.wait_for_selector("html[data-ready='figures']", state="attached")
        return page

    yield open_page
    for context in contexts:
        context.close()
    assert complaints == []


def _local(url: str, complaints: list[str]) -> None:
    # A blob is the page's own memory: the inflated Plotly runs from one.
    if not url.startswith(("file:", "blob:", "data:")):
        complaints.append(f"request: {url}")


def draw_all(page: Page) -> None:
    """Go to every plot that has data and wait until it is drawn; then back to the top."""
    page.evaluate(
        """async () => {
            for (const host of document.querySelectorAll('[data-figure]')) {
                if (host.hidden) continue;
                const late = performance.now() + 30000;
                while (!host.querySelector('.main-svg')) {
                    if (performance.now() > late) throw new Error(`no plot: ${host.id}`);
                    // Again and again: what is filled above it moves it.
                    host.scrollIntoView({ block: 'center', behavior: 'instant' });
                    await new Promise(resolve => setTimeout(resolve, 20));
                }
            }
            scrollTo({ top: 0, behavior: 'instant' });
        }"""
    )
