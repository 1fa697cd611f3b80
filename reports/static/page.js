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
const address = () => new URLSearchParams(location.hash.slice(1));

/**
 * What the address asks for, where it asks for something that ran.
 * @param {URLSearchParams} parameters
 * @returns {Record<string, string>}
 */
function viewOf(parameters) {
  return Object.fromEntries(Object.entries(choices).map(([name, values]) =>
    [name, values.find((value) => value === parameters.get(name)) ?? values[0]]));
}

let view = viewOf(address());

/** @param {string} [section] */
function hashOf(section) {
  const parts = Object.entries(view).filter(([name]) => choices[name].length > 1)
    .map(([name, value]) => `${name}=${value}`);
  if (section) parts.push(`section=${section}`);
  return "#" + parts.join("&");
}

/** @param {string | null} section */
function scrollToSection(section) {
  const target = section && document.getElementById(section);
  if (!target) return;
  target.scrollIntoView();
  /** @type {HTMLElement} */ (target.querySelector("h2") ?? target).focus({ preventScroll: true });
}

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

function wireContents() {
  const links = [.../** @type {NodeListOf<HTMLAnchorElement>} */ (document.querySelectorAll(".contents a"))];
  for (const link of links) {
    link.addEventListener("click", (event) => {
      event.preventDefault();
      const section = link.hash.slice(1);
      history.pushState(null, "", hashOf(section));
      scrollToSection(section);
    });
  }
  const reading = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) continue;
      for (const link of links) {
        if (link.hash === `#${target.id}`) link.setAttribute("aria-current", "true");
        else link.removeAttribute("aria-current");
      }
    }
  }, { rootMargin: "-20% 0px -75% 0px" });
  document.querySelectorAll("main > section").forEach((section) => reading.observe(section));
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
  wireContents();
  const report = new ReportData(await inflate("report-data").json());
  const figures = new Figures(report, () => view);
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
    history.pushState(null, "", hashOf());
    apply();
    const said = [...bar.querySelectorAll(".switch:not([hidden]) input:checked + span")];
    /** @type {HTMLElement} */ (document.getElementById("announcement")).textContent =
      `Now showing: ${said.map((label) => label.textContent?.trim()).join(", ")}`;
  });
  addEventListener("popstate", () => {
    const asked = address();
    const next = viewOf(asked);
    // A plain "#theory" names a section and leaves the view as it is.
    const named = [...asked.keys()].some((name) => name in choices) || location.hash === "";
    if (named && JSON.stringify(next) !== JSON.stringify(view)) {
      view = next;
      apply();
    }
    scrollToSection(asked.get("section"));
  });
  document.addEventListener("toggle", (event) => {
    const fold = /** @type {HTMLDetailsElement} */ (event.target);
    if (fold.open) drawTables(report, tablesIn(fold));
  }, true);

  explorer?.build(view);
  await drawInSlices(report, tables.filter(isOpen));
  scrollToSection(address().get("section"));
  settle("tables");

  wireTheme(() => figures.update());
  wirePrinter(report, figures);
  figures.watch();
  new FigureDownloads(figures, report, () => view);
  await idle();
  await figures.prepare();
  settle("figures");
}

start();
