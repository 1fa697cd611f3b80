// Plots. Plotly is run when the first of them comes near the window, and only those near are drawn,
// one a task; the theme's colours are put in on the way.
const CONFIG = { displayModeBar: false, responsive: true, showTips: false };

/** How far from the window a figure is near. */
const NEAR = "600px 0px";

/** Height of a figure on paper, as a share of that on the screen. */
const HEIGHT_ON_PAPER = 0.8;

/** Let the browser paint and answer the reader. */
const nextTask = () => new Promise((resolve) => setTimeout(resolve));

/**
 * The height of a plot at a width: less where its panels keep their shape.
 * @param {{ height: number, meta?: { ratio: number } }} layout
 * @param {number} width
 */
function heightAt({ height, meta }, width) {
  return meta ? Math.min(height, Math.round(meta.ratio * width)) : height;
}

class Figures {
  /**
   * @param {ReportData} report
   * @param {() => Record<string, string>} currentView
   */
  constructor(report, currentView) {
    this.report = report;
    this.currentView = currentView;
    this.hosts = [.../** @type {NodeListOf<PlotlyHost>} */ (document.querySelectorAll("[data-figure]"))];
    /** @type {Set<PlotlyHost>} */
    this.near = new Set();
    /** What each plot shows. @type {Map<PlotlyHost, string>} */
    this.drawn = new Map();
    /** Of the paper, while the page is printed. @type {number | undefined} */
    this.width = undefined;
    this.busy = false;
    this.source = "";
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
   * The name of the variant that a figure shows in this view; none if there is no such plot.
   * @param {PlotlyHost} host
   */
  variantOf(host) {
    const views = this.report.figures[host.dataset.figure ?? ""];
    const { method, distribution } = this.currentView();
    return [`${method}/${distribution}`, "*"].find((key) => key in views);
  }

  /**
   * Data and layout of a figure in this view and theme.
   * @param {PlotlyHost} host
   */
  specOf(host) {
    const spec = this.report.figures[host.dataset.figure ?? ""][this.variantOf(host) ?? ""];
    const { data, layout } = this.colored(this.report.resolve(spec));
    layout.font.family = getComputedStyle(document.body).fontFamily;
    return { data, layout };
  }

  /**
   * What a plot would show if it were drawn now.
   * @param {PlotlyHost} host
   */
  stateOf(host) {
    return [this.variantOf(host), isDark(), this.width].join();
  }

  /** @param {PlotlyHost} host */
  draw(host) {
    const { data, layout } = this.specOf(host);
    layout.dragmode = matchMedia("(pointer: coarse)").matches ? false : "zoom";
    layout.width = this.width;
    if (this.width) layout.height *= HEIGHT_ON_PAPER;
    layout.height = heightAt(layout, this.width ?? host.clientWidth);
    host.style.minHeight = "0";
    Plotly.react(host, data, layout, CONFIG);
    // The finding below the plot says what it shows; its tick labels would only be noise.
    for (const drawing of host.querySelectorAll(".main-svg")) drawing.setAttribute("aria-hidden", "true");
    this.drawn.set(host, this.stateOf(host));
  }

  /** The next plot near the window that does not show what it should. */
  next() {
    return [...this.near].find((host) => !host.hidden && this.drawn.get(host) !== this.stateOf(host));
  }

  /** Draw what is near the window, one plot a task. */
  async drawNear() {
    if (this.busy || !this.next()) return;
    this.busy = true;
    await this.run();
    for (let host = this.next(); host; host = this.next()) {
      try {
        this.draw(host);
      } catch (error) { // one plot that cannot be drawn does not keep the others from it
        this.drawn.set(host, this.stateOf(host));
        reportError(error);
      }
      await nextTask();
    }
    this.busy = false;
  }

  /** Follow the view and the theme: those near at once, the others when they come near. */
  update() {
    for (const host of this.hosts) {
      host.hidden = this.variantOf(host) === undefined;
      const absent = /** @type {HTMLElement} */ (host.parentElement?.querySelector(".absent"));
      absent.hidden = !host.hidden;
    }
    this.drawNear();
  }

  /** Draw plots as the reader comes near them. */
  watch() {
    const observer = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        const host = /** @type {PlotlyHost} */ (target);
        if (isIntersecting) this.near.add(host);
        else this.near.delete(host);
      }
      this.drawNear();
    }, { rootMargin: NEAR });
    this.hosts.forEach((host) => observer.observe(host));
    this.update();
  }

  /** Inflate Plotly without running it. */
  async prepare() {
    this.source ||= await inflate("plotly-source").text();
  }

  /** Run Plotly; from a blob the browser compiles it beside the page, not in its way. */
  async run() {
    if (window.Plotly) return;
    await this.prepare();
    await runScript(new Blob([this.source]));
  }

  /**
   * Draw all plots before this returns, as the printer asks for it.
   * @param {number} width in CSS pixels
   */
  drawForPrint(width) {
    if (!window.Plotly && this.source) runText(this.source);
    this.width = width;
    if (!window.Plotly) return;
    for (const host of this.hosts) {
      if (!host.hidden && this.drawn.get(host) !== this.stateOf(host)) this.draw(host);
    }
  }

  drawForScreen() {
    this.width = undefined;
    this.drawNear();
  }
}
