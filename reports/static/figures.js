// Plots, drawn when they come near the window; the theme's colours are put in on the way.
const CONFIG = {
  displaylogo: false,
  responsive: true,
  showTips: false,
  modeBarButtons: [["toImage", "resetScale2d"]],
};

class Figures {
  constructor(report) {
    this.report = report;
    this.hosts = [...document.querySelectorAll("[data-figure]")];
    this.drawn = new Set();
    this.probe = document.createElement("span");
    this.probe.hidden = true;
    document.body.append(this.probe);
  }

  // The same node with colours for the style sheet's variables.
  colored(node) {
    if (typeof node === "string") {
      return node.startsWith("var(--") ? this.color(node) : node;
    }
    if (Array.isArray(node)) return node.map((item) => this.colored(item));
    if (node === null || typeof node !== "object") return node;
    return Object.fromEntries(Object.entries(node).map(([key, item]) => [key, this.colored(item)]));
  }

  color(variable) {
    this.probe.style.color = variable;
    return getComputedStyle(this.probe).color;
  }

  draw(host, view) {
    const views = this.report.figures[host.dataset.figure];
    const spec = views[`${view.method}/${view.distribution}`] ?? views["*"];
    host.hidden = !spec;
    host.parentElement.querySelector(".absent").hidden = Boolean(spec);
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

  redraw(view) {
    for (const host of this.drawn) this.draw(host, view);
  }

  drawRest(view) {
    for (const host of this.hosts) if (!this.drawn.has(host)) this.draw(host, view);
  }

  // Near the window first, the others one by one whenever the browser has nothing to do.
  watch(currentView) {
    const near = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        if (!isIntersecting) continue;
        near.unobserve(target);
        if (!this.drawn.has(target)) this.draw(target, currentView());
      }
    }, { rootMargin: "600px 0px" });
    this.hosts.forEach((host) => near.observe(host));
    const idle = window.requestIdleCallback ?? ((act) => setTimeout(act, 50));
    const next = () => {
      const host = this.hosts.find((candidate) => !this.drawn.has(candidate));
      if (!host) return;
      this.draw(host, currentView());
      idle(next);
    };
    idle(next);
  }

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
