// Downloads below each figure: an image in the page's theme, as lines or as pixels, and its data.
const PIXELS_A_UNIT = 2;
const LEAST_WIDTH = 720; // of an image, in CSS pixels: one saved on a telephone is shown on a slide, too
const TITLE_HEIGHT = 36;
const TITLE_SIZE = 15;

/** What the style sheet decides in a drawing, and an image has to say itself. */
const DRAWN = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-linecap", "stroke-linejoin", "paint-order",
  "font-family", "font-size", "font-weight", "text-anchor", "dominant-baseline", "vector-effect"];

/**
 * The name of a file made of a figure.
 * @param {string} id of the figure
 * @param {string[]} parts what else tells it from others
 * @param {string} kind
 */
function fileNameOf(id, parts, kind) {
  const words = ["lepp", id, ...parts].map((part) => part.replaceAll("_", "-"));
  return `${words.join("-")}.${kind}`;
}

/** @param {string} svgText */
const addressOf = (svgText) => `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svgText)}`;

/**
 * A copy of a drawing of the page that needs no style sheet.
 * @param {SVGSVGElement} drawing
 */
function standalone(drawing) {
  const copy = /** @type {SVGSVGElement} */ (drawing.cloneNode(true));
  const shown = [drawing, ...drawing.querySelectorAll("*")];
  [copy, ...copy.querySelectorAll("*")].forEach((node, k) => {
    const styles = getComputedStyle(shown[k]);
    for (const name of node.getAttributeNames()) {
      if (/^(aria-|data-|role$|tabindex$|class$|style$)/.test(name)) node.removeAttribute(name);
    }
    if (k > 0) for (const name of DRAWN) node.setAttribute(name, styles.getPropertyValue(name));
  });
  copy.setAttribute("xmlns", SVG);
  return copy;
}

/**
 * Put a drawing below a title and before the page's background.
 * @param {SVGSVGElement} drawing
 * @param {string} title
 */
function framed(drawing, title) {
  const { x, y, width, height } = drawing.viewBox.baseVal;
  const box = { x, y: y - TITLE_HEIGHT, width, height: Math.ceil(height + TITLE_HEIGHT) };
  drawing.setAttribute("viewBox", Object.values(box).join(" "));
  drawing.setAttribute("width", String(box.width));
  drawing.setAttribute("height", String(box.height));
  const page = getComputedStyle(document.body);
  const head = svg("text", {
    x: x + 12, y: y - 12, "font-size": TITLE_SIZE, "font-weight": 600, "font-family": page.fontFamily, fill: page.color,
  });
  head.textContent = title;
  drawing.prepend(svg("rect", { ...box, fill: page.backgroundColor }), head);
  return drawing;
}

/**
 * Pixels of a drawing that stands alone.
 * @param {SVGSVGElement} drawing
 * @returns {Promise<Blob>}
 */
async function pixelsOf(drawing) {
  const image = new Image();
  image.src = addressOf(new XMLSerializer().serializeToString(drawing));
  await image.decode();
  const canvas = element("canvas");
  canvas.width = PIXELS_A_UNIT * image.width;
  canvas.height = PIXELS_A_UNIT * image.height;
  canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => blob ? resolve(blob) : reject(new Error("the image is too large"))));
}

class FigureDownloads {
  /**
   * @param {Figures} figures
   * @param {ReportData} report
   * @param {() => Record<string, string>} currentView
   */
  constructor(figures, report, currentView) {
    this.figures = figures;
    this.report = report;
    this.currentView = currentView;
    for (const figure of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("main figure[id]"))) {
      this.addButtons(figure);
    }
  }

  /** @param {HTMLElement} figure */
  addButtons(figure) {
    const title = this.titleOf(figure);
    const tables = [.../** @type {NodeListOf<HTMLElement>} */ (figure.querySelectorAll("[data-table]"))];
    figure.querySelector("figcaption")?.before(element("div", { class: "figure-tools" },
      this.button("svg", title, () => this.saveImage(figure, "svg")),
      this.button("png", title, () => this.saveImage(figure, "png")),
      ...tables.map((host) => this.button("csv", host.dataset.caption ?? title,
        () => this.saveData(figure, host, tables.length > 1), tables.length > 1 ? `: ${host.dataset.caption}` : ""))));
  }

  /**
   * @param {string} kind
   * @param {string} what is saved
   * @param {() => void} save
   * @param {string} which of several of its kind
   */
  button(kind, what, save, which = "") {
    const shown = kind.toUpperCase() + which;
    const made = element("button", { type: "button", "data-save": kind, title: what }, shown);
    made.setAttribute("aria-label", `Download ${which ? shown : `${shown} of: ${what}`}`);
    made.addEventListener("click", save);
    return made;
  }

  /** @param {HTMLElement} figure */
  titleOf(figure) {
    return figure.querySelector("h4")?.textContent?.trim().replace(/\s+/g, " ") ?? "";
  }

  /**
   * What the switches say, where the figure follows them.
   * @param {HTMLElement} figure
   */
  partsOf(figure) {
    const { distribution, method } = this.currentView();
    return figure.querySelector(".finding [data-view]") ? [distribution, method] : [];
  }

  /**
   * @param {HTMLElement} figure
   * @param {string} kind
   */
  async saveImage(figure, kind) {
    const host = /** @type {PlotlyHost | null} */ (figure.querySelector("[data-figure]"));
    const drawing = host ? await this.plot(host)
      : standalone(/** @type {SVGSVGElement} */ (figure.querySelector("svg")));
    const image = framed(drawing, this.titleOf(figure));
    const content = kind === "png" ? await pixelsOf(image)
      : new Blob([new XMLSerializer().serializeToString(image)], { type: "image/svg+xml" });
    saveFile(fileNameOf(figure.id, this.partsOf(figure), kind), content);
  }

  /** @param {PlotlyHost} host */
  async plot(host) {
    await this.figures.run();
    const { data, layout } = this.figures.specOf(host);
    const width = Math.max(host.clientWidth, LEAST_WIDTH);
    const height = heightAt(layout, width);
    const image = await Plotly.toImage({ data, layout: { ...layout, width, height } },
      { format: "svg", width, height });
    const text = await (await fetch(image)).text();
    return /** @type {SVGSVGElement} */ (/** @type {unknown} */ (
      new DOMParser().parseFromString(text, "image/svg+xml").documentElement));
  }

  /**
   * The rows of a figure's table that belong to what is shown, with all columns.
   * @param {HTMLElement} figure
   * @param {HTMLElement} host of the table
   * @param {boolean} several whether the figure has further tables
   */
  saveData(figure, host, several) {
    const view = this.currentView();
    const table = this.report.table(host.dataset.table ?? "");
    const values = followedBy(host, view).map(([, value]) => value).reverse();
    const parts = [...several ? [table.name] : [], ...values];
    saveCsv(fileNameOf(figure.id, parts, "csv"), table.csvOf(table.columns, table.select(whereOf(host, view))));
  }
}
