// Plots, drawn when they come near the window; the theme's colours are put in on the way.
const CONFIG = {
  displaylogo: false,
  responsive: true,
  showTips: false,
  modeBarButtons: [["toImage", "resetScale2d"]],
};

class Figures {
  /** @param {ReportData} report */
  constructor(report) {
    this.report = report;
    this.hosts = [.../** @type {NodeListOf<PlotlyHost>} */ (document.querySelectorAll("[data-figure]"))];
    /** @type {Set<PlotlyHost>} */
    this.drawn = new Set();
    this.probe = document.createElement("span");
    this.probe.hidden = true;
    document.body.append(this.probe);
  }

  /**
   * The same node with colours for the style sheet's variables.
   * @param {any} node of JSON
   * @returns {any}
   */
  colored(node) {
    if (typeof node === "string") {
      return node.startsWith("var(--") ? this.color(node) : node;
    }
    if (Array.isArray(node)) return node.map((item) => this.colored(item));
    if (node === null || typeof node !== "object") return node;
    return Object.fromEntries(Object.entries(node).map(([key, item]) => [key, this.colored(item)]));
  }

  /** @param {string} variable */
  color(variable) {
    this.probe.style.color = variable;
    return getComputedStyle(this.probe).color;
  }

  /**
   * @param {PlotlyHost} host
   * @param {Record<string, string>} view
   */
  draw(host, view) {
    const views = this.report.figures[host.dataset.figure ?? ""];
    const spec = views[`${view.method}/${view.distribution}`] ?? views["*"];
    host.hidden = !spec;
    const absent = /** @type {HTMLElement} */ (host.parentElement?.querySelector(".absent"));
    absent.hidden = Boolean(spec);
    this.drawn.add(host);
    if (!spec) return;
    const { data, layout } = this.colored(this.report.resolve(spec));
    layout.font.family = getComputedStyle(document.body).fontFamily;
    layout.dragmode = matchMedia("(pointer: coarse)").matches ? false : "zoom";
    layout.width = undefined;
    Plotly.react(host, data, layout, CONFIG);
    // The finding below the plot says what it shows; its tick labels would only be noise.
    for (const drawing of host.querySelectorAll(".main-svg")) drawing.setAttribute("aria-hidden", "true");
  }

  /** @param {Record<string, string>} view */
  redraw(view) {
    for (const host of this.drawn) this.draw(host, view);
  }

  /** @param {Record<string, string>} view */
  drawRest(view) {
    for (const host of this.hosts) if (!this.drawn.has(host)) this.draw(host, view);
  }

  /**
   * Near the window first, the others one by one whenever the browser has nothing to do.
   * @param {() => Record<string, string>} currentView
   */
  watch(currentView) {
    const near = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        if (!isIntersecting) continue;
        near.unobserve(target);
        const host = /** @type {PlotlyHost} */ (target);
        if (!this.drawn.has(host)) this.draw(host, currentView());
      }
    }, { rootMargin: "600px 0px" });
    this.hosts.forEach((host) => near.observe(host));
    const idle = window.requestIdleCallback ?? ((/** @type {() => void} */ act) => setTimeout(act, 50));
    const next = () => {
      const host = this.hosts.find((candidate) => !this.drawn.has(candidate));
      if (!host) return;
      this.draw(host, currentView());
      idle(next);
    };
    idle(next);
  }

  /** @param {number} width */
  fitToPaper(width) {
    for (const host of this.drawn) {
      if (host.data) Plotly.relayout(host, { width, autosize: false });
    }
  }

  fitToScreen() {
    for (const host of this.drawn) {
      if (host.data) Plotly.relayout(host, { width: null, autosize: true });
    }
  }
}
