// The switch, the address and the printer.
const root = document.documentElement;
const bar = document.querySelector(".bar");
const PAPER_WIDTH = 680;

const choices = Object.fromEntries(["method", "distribution"].map((name) =>
  [name, [...bar.querySelectorAll(`input[name="${name}"]`)].map((input) => input.value)]));
const address = () => new URLSearchParams(location.hash.slice(1));

// What the address asks for, where it asks for something that ran.
function viewOf(parameters) {
  return Object.fromEntries(Object.entries(choices).map(([name, values]) =>
    [name, values.includes(parameters.get(name)) ? parameters.get(name) : values[0]]));
}

let view = viewOf(address());

function hashOf(section) {
  const parts = Object.entries(view).filter(([name]) => choices[name].length > 1)
    .map(([name, value]) => `${name}=${value}`);
  if (section) parts.push(`section=${section}`);
  return "#" + parts.join("&");
}

function scrollToSection(section) {
  const target = section && document.getElementById(section);
  if (!target) return;
  target.scrollIntoView();
  (target.querySelector("h2") ?? target).focus({ preventScroll: true });
}

function showVariants() {
  const key = `${view.method}/${view.distribution}`;
  document.body.dataset.view = key;
  for (const variant of document.querySelectorAll("main [data-view]")) {
    variant.hidden = variant.dataset.view !== key;
  }
  for (const [name, value] of Object.entries(view)) {
    for (const input of bar.querySelectorAll(`input[name="${name}"]`)) {
      input.checked = input.value === value;
    }
  }
}

function isOpen(host) {
  const fold = host.closest("details");
  return !fold || fold.open;
}

function drawTables(report, hosts) {
  for (const host of hosts) {
    const key = host.dataset.follows.split(" ").map((name) => view[name]).join(" ");
    if (host.dataset.drawn === key) continue;
    drawTable(host, report, view, choices);
    host.dataset.drawn = key;
  }
}

function wirePrinter(report, figures) {
  let opened = [];
  printInLight(() => {
    opened = [...document.querySelectorAll("details:not([open])")];
    for (const fold of opened) fold.open = true;
    drawTables(report, document.querySelectorAll("[data-table]"));
    if (window.Plotly) {
      figures.drawRest(view);
      figures.redraw(view);
      figures.fitToPaper(PAPER_WIDTH);
    }
  }, () => {
    for (const fold of opened) fold.open = false;
    if (window.Plotly) {
      figures.redraw(view);
      figures.fitToScreen();
    }
  });
}

function wireContents() {
  const links = [...document.querySelectorAll(".contents a")];
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

// How far the page is, for the reader's tools and the tests.
function settle(stage) {
  performance.mark(stage);
  root.dataset.ready = stage;
}

async function start() {
  showVariants();
  wireContents();
  const report = new Report(await inflate("report-data").json());
  const figures = new Figures(report);
  const tables = [...document.querySelectorAll("[data-table]")];
  const host = document.querySelector(".explorer");
  const explorer = host && new Explorer(host, report);
  const drawOpenTables = () => drawTables(report, tables.filter(isOpen));

  const apply = () => {
    showVariants();
    drawOpenTables();
    explorer?.build(view);
    figures.redraw(view);
  };
  bar.addEventListener("change", () => {
    view = Object.fromEntries(Object.keys(choices).map((name) =>
      [name, bar.querySelector(`input[name="${name}"]:checked`).value]));
    history.pushState(null, "", hashOf());
    apply();
    const said = [...bar.querySelectorAll(".switch:not([hidden]) input:checked + span")];
    document.getElementById("announcement").textContent =
      `Now showing: ${said.map((label) => label.textContent.trim()).join(", ")}`;
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
    if (event.target.open) drawTables(report, event.target.querySelectorAll("[data-table]"));
  }, true);

  drawOpenTables();
  explorer?.build(view);
  scrollToSection(address().get("section"));
  settle("tables");

  wireTheme(() => figures.redraw(view));
  wirePrinter(report, figures);
  await runInflated("plotly-source");
  figures.watch(() => view);
  settle("figures");
}

start();
