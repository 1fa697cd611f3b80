// Figure 1: a small triangulation in which a triangle shows its longest-edge propagation path.
const SVG = "http://www.w3.org/2000/svg";
const SIDE = 640;
const SHADES = 5;

function svg(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

class Explorer {
  constructor(host, report) {
    this.host = host;
    this.report = report;
    this.stage = host.querySelector("svg");
    this.said = host.querySelector(".said");
    this.stage.addEventListener("pointerover", (event) => this.pointAt(event));
    this.stage.addEventListener("click", (event) => this.pointAt(event));
    this.stage.addEventListener("focusin", (event) => this.pointAt(event));
    this.stage.addEventListener("keydown", (event) => this.key(event));
  }

  pointAt(event) {
    const k = event.target.dataset?.triangle;
    if (k !== undefined) this.show(Number(k), event.type !== "pointerover");
  }

  build(view) {
    const points = this.columns("explorer_points", view);
    const scale = this.scaleOf(points.x, points.y);
    this.points = points.x.map((x, k) => scale(x, points.y[k]));
    const of = this.columns("explorer_triangles", view);
    this.triangles = of.lepp_size.map((size, k) => ({
      corners: [of.a, of.b, of.c].map((vertex) => this.points[vertex[k]]),
      size,
      successor: of.successor[k],
      ends: [this.points[of.terminal_a[k]], this.points[of.terminal_b[k]]],
      boundary: of.terminal_edge[k] === "boundary",
    }));
    for (const triangle of this.triangles) {
      triangle.center = [0, 1].map((i) => triangle.corners.reduce((sum, c) => sum + c[i], 0) / 3);
    }
    this.largest = Math.max(...this.triangles.map((triangle) => triangle.size));
    this.draw();
  }

  // The columns of a table in this view, by name.
  columns(name, view) {
    const table = this.report.table(name);
    const rows = table.select(view);
    return Object.fromEntries(table.columns.map((column) =>
      [column.name, table.values(column.name, rows)]));
  }

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
      fill: `var(--scale-${this.shade(triangle.size)})`,
    }));
    list.append(...this.shapes);
    this.marks = svg("g", { "aria-hidden": "true" });
    this.stage.replaceChildren(list, this.marks);
    this.current = this.telling();
    this.shapes[this.current].setAttribute("tabindex", "0");
    this.show(this.current, false);
    this.drawKey();
  }

  // Where to begin: a long path whose thinnest triangle is as fat as can be.
  telling() {
    const width = ({ corners: [a, b, c] }) => {
      const area = Math.abs((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 2;
      return area / Math.max(Math.hypot(b[0] - a[0], b[1] - a[1]),
        Math.hypot(c[0] - b[0], c[1] - b[1]), Math.hypot(a[0] - c[0], a[1] - c[1]));
    };
    const worth = this.triangles.map(({ size, boundary }, k) =>
      boundary || size < Math.min(4, this.largest) ? -1 : Math.min(...this.path(k).map((t) => width(this.triangles[t]))));
    return worth.indexOf(Math.max(...worth));
  }

  shade(size) {
    if (this.largest <= SHADES) return Math.min(size - 1, SHADES - 1);
    return Math.floor(((size - 1) * (SHADES - 1)) / (this.largest - 1));
  }

  drawKey() {
    const sizes = new Map();
    for (const { size } of this.triangles) {
      const shade = this.shade(size);
      const [low, high] = sizes.get(shade) ?? [size, size];
      sizes.set(shade, [Math.min(low, size), Math.max(high, size)]);
    }
    const items = [...sizes].sort(([a], [b]) => a - b).map(([shade, [low, high]]) => {
      const box = element("i");
      box.style.background = `var(--scale-${shade})`;
      return element("li", {}, box, low === high ? String(low) : `${low}–${high}`);
    });
    this.host.querySelector(".size-key ul").replaceChildren(...items);
  }

  path(k) {
    const path = [k];
    const seen = new Set(path);
    for (let next = this.triangles[k].successor; next !== null && next >= 0 && !seen.has(next);
      next = this.triangles[next].successor) {
      path.push(next);
      seen.add(next);
    }
    return path;
  }

  show(k, takesFocus) {
    const path = this.path(k);
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
    this.said.textContent = size === 1
      ? `Triangle ${k}: LEPP size 1. Its longest edge lies on the boundary.`
      : `Triangle ${k}: LEPP size ${size}. The path goes ${path.join(" → ")} and ends at ${end}.`;
    if (takesFocus && document.activeElement !== this.shapes[k]) {
      this.shapes[k].focus({ preventScroll: true });
    }
  }

  label(t, place) {
    const [x, y] = this.triangles[t].center;
    const text = svg("text", { x, y });
    text.textContent = place;
    return text;
  }

  key(event) {
    const directions = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    let next;
    if (event.key in directions) next = this.toward(directions[event.key]);
    else if (event.key === "Home") next = 0;
    else if (event.key === "End") next = this.triangles.length - 1;
    else if (event.key === "Enter" || event.key === " ") next = this.path(this.current)[1];
    else return;
    event.preventDefault();
    if (next !== undefined) this.show(next, true);
  }

  // The nearest triangle whose centre lies within 45 degrees of the direction.
  toward([dx, dy]) {
    const [x, y] = this.triangles[this.current].center;
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
