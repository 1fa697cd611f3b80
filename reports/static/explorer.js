// Figure 1: a small triangulation in which a triangle shows its longest-edge propagation path.
const SVG = "http://www.w3.org/2000/svg";
const SIDE = 640;
const SHADES = 5;

/** @typedef {[number, number]} Point */

/**
 * @typedef {object} ExplorerTriangle
 * @property {Point[]} corners
 * @property {Point} center
 * @property {number} size LEPP size
 * @property {number | null} successor the triangle across the longest edge
 * @property {Point[]} ends of the terminal edge
 * @property {boolean} boundary whether the path ends there
 */

/**
 * The path of a triangle: as many triangles, each across the longest edge of the one before, as
 * its LEPP size says.
 * @param {{ size: number, successor: number | null }[]} triangles
 * @param {number} k
 */
function pathFrom(triangles, k) {
  const path = [k];
  let next = triangles[k].successor;
  while (path.length < triangles[k].size && next !== null) {
    path.push(next);
    next = triangles[next].successor;
  }
  return path;
}

/**
 * The shade of a LEPP size: one each where there are enough, else equal steps up to the largest.
 * @param {number} size
 * @param {number} largest
 */
function shadeOfSize(size, largest) {
  if (largest <= SHADES) return size - 1;
  return Math.floor(((size - 1) * (SHADES - 1)) / (largest - 1));
}

/**
 * Height of a triangle over its longest side.
 * @param {Point[]} corners
 */
function breadthOf([a, b, c]) {
  const double = Math.abs((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
  return double / Math.max(Math.hypot(b[0] - a[0], b[1] - a[1]),
    Math.hypot(c[0] - b[0], c[1] - b[1]), Math.hypot(a[0] - c[0], a[1] - c[1]));
}

/**
 * @param {string} name
 * @param {Record<string, string | number>} attributes
 */
function svg(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  return made;
}

class Explorer {
  /**
   * @param {HTMLElement} host
   * @param {ReportData} report
   */
  constructor(host, report) {
    this.host = host;
    this.report = report;
    this.stage = /** @type {SVGSVGElement} */ (host.querySelector("svg"));
    this.sentence = /** @type {HTMLElement} */ (host.querySelector(".said"));
    /** @type {ExplorerTriangle[]} */
    this.triangles = [];
    /** @type {SVGElement[]} */
    this.shapes = [];
    this.marks = svg("g", { "aria-hidden": "true" });
    this.largest = 0;
    this.height = 0;
    this.current = 0;
    for (const name of /** @type {const} */ (["pointerover", "click", "focusin"])) {
      this.stage.addEventListener(name, (event) => this.pointAt(event));
    }
    this.stage.addEventListener("keydown", (event) => this.key(event));
  }

  /** @param {Event} event */
  pointAt(event) {
    const k = event.target instanceof SVGElement ? event.target.dataset.triangle : undefined;
    if (k !== undefined) this.show(Number(k), event.type !== "pointerover");
  }

  /** @param {Record<string, string>} view */
  build(view) {
    const points = this.columns("explorer_points", view);
    const [xs, ys] = [points.x.map(Number), points.y.map(Number)];
    const scale = this.scaleOf(xs, ys);
    const drawn = xs.map((x, k) => scale(x, ys[k]));
    const of = this.columns("explorer_triangles", view);
    this.triangles = of.lepp_size.map((size, k) => {
      const [a, b, c] = [of.a, of.b, of.c].map((vertex) => drawn[Number(vertex[k])]);
      const successor = of.successor[k];
      return {
        corners: [a, b, c],
        center: [(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3],
        size: Number(size),
        successor: successor === null ? null : Number(successor),
        ends: [of.terminal_a, of.terminal_b].map((vertex) => drawn[Number(vertex[k])]),
        boundary: of.terminal_edge[k] === "boundary",
      };
    });
    this.largest = Math.max(...this.triangles.map(({ size }) => size));
    this.draw();
  }

  /**
   * The columns of a table in this view, by name.
   * @param {string} name
   * @param {Record<string, string>} view
   * @returns {Record<string, Cell[]>}
   */
  columns(name, view) {
    const table = this.report.table(name);
    const rows = table.select(view);
    return Object.fromEntries(table.columns.map((column) =>
      [column.name, table.values(column.name, rows)]));
  }

  /**
   * @param {number[]} xs
   * @param {number[]} ys
   * @returns {(x: number, y: number) => Point}
   */
  scaleOf(xs, ys) {
    const [left, right] = [Math.min(...xs), Math.max(...xs)];
    const [low, high] = [Math.min(...ys), Math.max(...ys)];
    const room = SIDE - 32;
    const factor = room / Math.max(right - left, high - low);
    const margin = [(SIDE - factor * (right - left)) / 2, 16];
    this.height = factor * (high - low) + 32;
    return (x, y) => [margin[0] + factor * (x - left), margin[1] + factor * (high - y)];
  }

  draw() {
    this.stage.setAttribute("viewBox", `0 0 ${SIDE} ${this.height.toFixed(1)}`);
    const list = svg("g", { role: "listbox", "aria-label": "Triangles", "aria-orientation": "horizontal" });
    this.shapes = this.triangles.map((triangle, k) => svg("polygon", {
      points: triangle.corners.map((corner) => corner.map((v) => v.toFixed(2)).join(",")).join(" "),
      role: "option",
      tabindex: -1,
      "aria-selected": "false",
      "aria-label": `Triangle ${k}, LEPP size ${triangle.size}`,
      "data-triangle": k,
      fill: `var(--scale-${shadeOfSize(triangle.size, this.largest)})`,
    }));
    list.append(...this.shapes);
    this.stage.replaceChildren(list, this.marks);
    this.current = this.opening();
    this.shapes[this.current].setAttribute("tabindex", "0");
    this.show(this.current, false);
    this.drawKey();
  }

  /** Where to begin: a long path whose thinnest triangle is as fat as can be. */
  opening() {
    const least = Math.min(4, this.largest);
    const breadths = this.triangles.map(({ size, boundary }, k) => boundary || size < least
      ? -1
      : Math.min(...pathFrom(this.triangles, k).map((t) => breadthOf(this.triangles[t].corners))));
    return breadths.indexOf(Math.max(...breadths));
  }

  drawKey() {
    /** @type {Map<number, [number, number]>} */
    const sizes = new Map();
    for (const { size } of this.triangles) {
      const shade = shadeOfSize(size, this.largest);
      const [low, high] = sizes.get(shade) ?? [size, size];
      sizes.set(shade, [Math.min(low, size), Math.max(high, size)]);
    }
    const items = [...sizes].sort(([a], [b]) => a - b).map(([shade, [low, high]]) => {
      const box = element("i");
      box.style.background = `var(--scale-${shade})`;
      return element("li", {}, box, low === high ? String(low) : `${low}–${high}`);
    });
    this.host.querySelector(".size-key ul")?.replaceChildren(...items);
  }

  /**
   * @param {number} k
   * @param {boolean} takesFocus
   */
  show(k, takesFocus) {
    const path = pathFrom(this.triangles, k);
    this.shapes[this.current].setAttribute("tabindex", "-1");
    this.current = k;
    this.shapes.forEach((shape, t) => {
      const place = path.indexOf(t);
      shape.setAttribute("class", place === 0 ? "start" : place > 0 ? "path" : "");
      shape.setAttribute("aria-selected", String(t === k));
    });
    this.shapes[k].setAttribute("tabindex", "0");
    const { ends: [[x1, y1], [x2, y2]], boundary, corners, size } = this.triangles[k];
    this.marks.replaceChildren(svg("polygon", { class: "focus", points: corners.join(" ") }),
      svg("line", { class: "terminal", x1, y1, x2, y2 }),
      ...path.map((t, place) => this.label(t, place + 1)));
    const end = boundary ? "an edge of the boundary" : "an edge that is the longest of both triangles beside it";
    this.sentence.textContent = size === 1
      ? `Triangle ${k}: LEPP size 1. Its longest edge lies on the boundary.`
      : `Triangle ${k}: LEPP size ${size}. The path goes ${path.join(" → ")} and ends at ${end}.`;
    if (takesFocus && document.activeElement !== this.shapes[k]) {
      this.shapes[k].focus({ preventScroll: true });
    }
  }

  /**
   * @param {number} t
   * @param {number} place on the path
   */
  label(t, place) {
    const [x, y] = this.triangles[t].center;
    const text = svg("text", { x, y });
    text.textContent = String(place);
    return text;
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    /** @type {Record<string, Point>} */
    const directions = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    let next;
    if (event.key in directions) next = this.toward(directions[event.key]);
    else if (event.key === "Home") next = 0;
    else if (event.key === "End") next = this.triangles.length - 1;
    else if (event.key === "Enter" || event.key === " ") next = pathFrom(this.triangles, this.current)[1];
    else return;
    event.preventDefault();
    if (next !== undefined) this.show(next, true);
  }

  /**
   * The nearest triangle whose centre lies within 45 degrees of the direction.
   * @param {Point} direction
   */
  toward([dx, dy]) {
    const [x, y] = this.triangles[this.current].center;
    /** @type {number | undefined} */
    let best;
    let least = Infinity;
    this.triangles.forEach(({ center }, t) => {
      const along = (center[0] - x) * dx + (center[1] - y) * dy;
      const across = Math.abs((center[0] - x) * dy) + Math.abs((center[1] - y) * dx);
      if (t !== this.current && along > 0 && across <= along && along + across < least) {
        best = t;
        least = along + across;
      }
    });
    return best;
  }
}
