// The switch, the address and the printer.
const root = document.documentElement;
const bar = /** @type {HTMLElement} */ (document.querySelector(".bar"));
const PAPER_WIDTH = 680;
const SLICE = 40; // milliseconds of work between two chances for the browser to answer the reader

/**
 * The buttons of a switch.
 * @param {string} name
 * @returns {HTMLInputElement[]}
 */
const inputsOf = (name) => [...bar.querySelectorAll("input")].filter((input) => input.name === name);

const choices = Object.fromEntries(["method", "distribution"].map((name) =>
  [name, inputsOf(name).map((input) => input.value)]));
const address = () => readAddress(location.hash, Object.keys(choices));

/**
 * What the address asks for, where it asks for something that ran.
 * @param {Record<string, string>} asked
 * @returns {Record<string, string>}
 */
function viewOf(asked) {
  return Object.fromEntries(Object.entries(choices).map(([name, values]) =>
    [name, values.find((value) => value === asked[name]) ?? values[0]]));
}

let view = viewOf(address().asked);

function showVariants() {
  const key = `${view.method}/${view.distribution}`;
  document.body.dataset.view = key;
  for (const variant of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("main [data-view]"))) {
    variant.hidden = variant.dataset.view !== key;
  }
  for (const [name, value] of Object.entries(view)) {
    for (const input of inputsOf(name)) input.checked = input.value === value;
  }
}

/** @param {HTMLElement} host */
function isOpen(host) {
  const fold = host.closest("details");
  return !fold || fold.open;
}

/**
 * @param {ParentNode} node
 * @returns {NodeListOf<HTMLElement>}
 */
const tablesIn = (node) => node.querySelectorAll("[data-table]");

/**
 * @param {ReportData} report
 * @param {Iterable<HTMLElement>} hosts
 */
function drawTables(report, hosts) {
  for (const host of hosts) {
    const key = (host.dataset.follows ?? "").split(" ").map((name) => view[name]).join(" ");
    if (host.dataset.drawn === key) continue;
    drawTable(host, report, view, choices);
    host.dataset.drawn = key;
  }
}

/**
 * Draw tables without holding the browser up.
 * @param {ReportData} report
 * @param {HTMLElement[]} hosts
 */
async function drawInSlices(report, hosts) {
  let end = performance.now() + SLICE;
  for (const host of hosts) {
    drawTables(report, [host]);
    if (performance.now() < end) continue;
    await nextTask();
    end = performance.now() + SLICE;
  }
}

/**
 * @param {ReportData} report
 * @param {Figures} figures
 */
function wirePrinter(report, figures) {
  printInLight(() => {
    drawTables(report, tablesIn(document));
    figures.drawForPrint(PAPER_WIDTH);
  }, () => figures.drawForScreen());
}

/**
 * Links to places of the page keep the view in the address; those beside headings copy it.
 * @param {Landing} landing
 */
function wireLinks(landing) {
  document.addEventListener("click", (event) => {
    const link = /** @type {Element} */ (event.target).closest("a");
    if (!link?.getAttribute("href")?.startsWith("#") || link.matches(".skip")
      || event.ctrlKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    const place = link.hash.slice(1);
    history.pushState(null, "", writeAddress(view, choices, place));
    landing.go(place);
    if (link.matches(".anchor")) copy(link, location.href);
  });
}

/** The bar covers the top of the window; how much of it depends on the width. */
function watchBar() {
  new ResizeObserver(() => root.style.setProperty("--bar", `${bar.offsetHeight}px`)).observe(bar);
}

/**
 * How far the page is, for the reader's tools and the tests.
 * @param {string} stage
 */
function settle(stage) {
  performance.mark(stage);
  root.dataset.ready = stage;
}

/** @type {() => Promise<void>} */
const idle = () => new Promise((resolve) => "requestIdleCallback" in window
  ? requestIdleCallback(() => resolve(), { timeout: 2000 })
  : setTimeout(resolve, 50));

async function start() {
  showVariants();
  watchBar();
  const landing = new Landing();
  wireContents();
  wireLinks(landing);
  wireCopying();
  new Glossary();
  const report = new ReportData(await inflate("report-data").json());
  const figures = new Figures(report, () => view);
  wireTheme(() => figures.update());
  const tables = [...tablesIn(document)];
  const host = /** @type {HTMLElement | null} */ (document.querySelector(".explorer"));
  const explorer = host && new Explorer(host, report);
  const drawOpenTables = () => drawTables(report, tables.filter(isOpen));

  const apply = () => {
    showVariants();
    drawOpenTables();
    explorer?.build(view);
    figures.update();
  };
  bar.addEventListener("change", () => {
    view = Object.fromEntries(Object.keys(choices).map((name) =>
      [name, inputsOf(name).find((input) => input.checked)?.value ?? ""]));
    history.pushState(null, "", writeAddress(view, choices));
    apply();
    const said = [...bar.querySelectorAll(".switch:not([hidden]) input:checked + span")];
    announce(`Now showing: ${said.map((label) => label.textContent?.trim()).join(", ")}`);
  });
  addEventListener("popstate", () => {
    const { asked, place } = address();
    const next = viewOf(asked);
    // A plain "#theory" names a place and leaves the view as it is.
    const named = Object.keys(asked).length > 0 || location.hash === "";
    if (named && JSON.stringify(next) !== JSON.stringify(view)) {
      view = next;
      apply();
    }
    landing.go(place);
  });
  document.addEventListener("toggle", (event) => {
    const fold = /** @type {HTMLDetailsElement} */ (event.target);
    if (fold.open) drawTables(report, tablesIn(fold));
  }, true);

  explorer?.build(view);
  await drawInSlices(report, tables.filter(isOpen));
  landing.go(address().place);
  settle("tables");

  wirePrinter(report, figures);
  figures.watch();
  new FigureDownloads(figures, report, () => view);
  await idle();
  await figures.prepare();
  settle("figures");
}

start();
