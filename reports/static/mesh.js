// A mesh on a canvas, coloured by LEPP size; the chosen triangle's path on a second canvas above it.
const MARGIN = 16;
const LEVELS = 6; // of light on a surface in space
const DIMMEST = 0.72;
const FEW = 6000; // triangles of which every frame shows the edges, even while turned
const MANY = 12000; // triangles in view that are no longer drawn as shapes, but pixel by pixel
const LINE = 5; // a triangle of so many pixels is large enough for its edges
const LABEL = 22;
const CLOSEST = 4000;

class Mesh {
  constructor({ points, triangles, dimensions, classes, worst, whole }, buffer) {
    Object.assign(this, { dimensions, classes, worst, whole, n: points, m: triangles });
    let start = 0;
    const take = (Kind, length) => {
      const array = new Kind(buffer, start, length);
      start += 4 * length;
      return array;
    };
    this.points = take(Float32Array, dimensions * points);
    this.triangles = take(Int32Array, 3 * triangles);
    this.successors = take(Int32Array, triangles);
    this.sizes = take(Int32Array, triangles);
    this.numbers = take(Int32Array, triangles);
    this.shades = Uint8Array.from(this.sizes,
      (size) => classes.findIndex(([low, high]) => low <= size && size <= high));
  }

  // The path of a triangle, and how it ends: "pair", "boundary" or "outside" what is drawn.
  path(t) {
    const path = [t];
    for (;;) {
      const last = path[path.length - 1];
      const next = this.successors[last];
      if (next < 0) return { path, end: next === -4 ? "outside" : "boundary" };
      if (next === path[path.length - 2]) return { path, end: "pair" };
      path.push(next);
    }
  }

  corners(t) {
    return this.triangles.subarray(3 * t, 3 * t + 3);
  }

  // The two points of the edge at which a path ends.
  terminalEdge({ path, end }) {
    const last = path[path.length - 1];
    const corners = [...this.corners(last)];
    if (end === "boundary") return corners.filter((_, k) => k !== -1 - this.successors[last]);
    const other = [...this.corners(path[path.length - 2] ?? last)];
    return corners.filter((corner) => other.includes(corner));
  }

  // Triangles beside a triangle; the table of all edges is made when it is first asked for.
  neighbors(t) {
    if (!this.edges) {
      this.edges = new Map();
      for (let s = 0; s < this.m; s++) {
        for (const key of this.edgeKeys(s)) {
          const beside = this.edges.get(key);
          if (beside) beside.push(s);
          else this.edges.set(key, [s]);
        }
      }
    }
    return this.edgeKeys(t).flatMap((key) => this.edges.get(key)).filter((s) => s !== t);
  }

  edgeKeys(t) {
    const [a, b, c] = this.corners(t);
    return [[a, b], [b, c], [c, a]].map(([p, q]) => Math.min(p, q) * this.n + Math.max(p, q));
  }

  // The place in what is drawn of the triangle with a number; -1 if it is not there.
  placeOf(number) {
    if (this.whole) return number < this.m ? number : -1;
    return this.numbers.indexOf(number);
  }
}

class MeshView {
  constructor(host, mesh) {
    this.mesh = mesh;
    this.stage = host.querySelector(".stage");
    [this.canvas, this.overlay] = host.querySelectorAll("canvas");
    this.said = host.querySelector(".said");
    this.input = host.querySelector("input");
    this.x = new Float32Array(mesh.n);
    this.y = new Float32Array(mesh.n);
    this.z = new Float32Array(mesh.n);
    this.space = mesh.dimensions === 3;
    this.pointers = new Map();
    this.chosen = mesh.worst;
    if (this.space) this.face(mesh.path(mesh.worst).path);
    this.wire(host);
    new ResizeObserver(() => this.resize()).observe(this.stage);
    this.resize();
    this.choose(mesh.worst);
  }

  resize() {
    const { clientWidth, clientHeight } = this.stage;
    const ratio = devicePixelRatio || 1;
    const first = !this.width;
    Object.assign(this, { width: clientWidth, height: clientHeight, ratio });
    for (const canvas of [this.canvas, this.overlay]) {
      canvas.width = Math.round(clientWidth * ratio);
      canvas.height = Math.round(clientHeight * ratio);
    }
    if (first || this.atWhole) this.fit();
    this.draw();
  }

  // Show the whole mesh.
  fit() {
    this.view = { x: 0, y: 0, scale: 1 };
    this.project();
    const [left, right, low, high] = this.bounds(null);
    this.view.scale = Math.min((this.width - 2 * MARGIN) / (right - left || 1),
      (this.height - 2 * MARGIN) / (high - low || 1));
    this.view.x = this.width / 2 - this.view.scale * ((left + right) / 2);
    this.view.y = this.height / 2 - this.view.scale * ((low + high) / 2);
    this.fitted = this.view.scale;
    this.atWhole = true;
  }

  // Bring triangles into view, and close enough to be seen.
  zoomTo(triangles, share = 0.5) {
    this.project();
    const [left, right, low, high] = this.bounds(triangles);
    const factor = Math.min(share * this.width / (right - left || 1), share * this.height / (high - low || 1));
    this.zoom(factor, (left + right) / 2, (low + high) / 2, this.width / 2, this.height / 2);
  }

  // Turn a surface so that triangles are in front.
  face(triangles) {
    const { points } = this.mesh;
    const point = (p) => points.subarray(3 * p, 3 * p + 3);
    const toward = [0, 0, 0];
    const middle = [0, 0, 0];
    for (const t of triangles) {
      const [a, b, c] = [...this.mesh.corners(t)].map(point);
      const [u, v] = [b, c].map((end) => [0, 1, 2].map((k) => end[k] - a[k]));
      const normal = cross(u, v);
      const sign = dot(normal, toward) < 0 ? -1 : 1; // neighbours may be oriented differently
      for (let k = 0; k < 3; k++) {
        toward[k] += sign * normal[k];
        middle[k] += a[k];
      }
    }
    const outward = dot(toward, middle) < 0 ? toward.map((x) => -x) : toward;
    // Not quite from above, so that the shape is seen.
    const front = unit(unit(outward).map((x, k) => x + [0.25, -0.35, 0.2][k]));
    const right = unit(cross(Math.abs(front[2]) < 0.98 ? [0, 0, 1] : [0, 1, 0], front));
    this.turned = [...right, ...cross(front, right), ...front];
  }

  // Bring triangles into view if they are not.
  reveal(triangles) {
    const [left, right, low, high] = this.bounds(triangles);
    if (left < 0 || right > this.width || low < 0 || high > this.height) {
      this.zoom(Math.min(1, this.width / (right - left || 1), this.height / (high - low || 1)),
        (left + right) / 2, (low + high) / 2, this.width / 2, this.height / 2);
    }
  }

  bounds(triangles) {
    const { mesh, x, y } = this;
    const box = [Infinity, -Infinity, Infinity, -Infinity];
    const add = (p) => {
      box[0] = Math.min(box[0], x[p]); box[1] = Math.max(box[1], x[p]);
      box[2] = Math.min(box[2], y[p]); box[3] = Math.max(box[3], y[p]);
    };
    if (triangles) for (const t of triangles) mesh.corners(t).forEach(add);
    else for (let p = 0; p < mesh.n; p++) add(p);
    return box;
  }

  // Scale about a point of the screen, which goes to another.
  zoom(factor, x, y, toX = x, toY = y) {
    const { view } = this;
    const scale = Math.min(Math.max(view.scale * factor, this.fitted / 4), this.fitted * CLOSEST);
    const by = scale / view.scale;
    this.view = { scale, x: toX - by * (x - view.x), y: toY - by * (y - view.y) };
    this.atWhole = false;
    this.draw();
  }

  project() {
    const { mesh, x, y, z, view, turned } = this;
    const { points, n } = mesh;
    if (!this.space) {
      for (let p = 0; p < n; p++) {
        x[p] = view.x + view.scale * points[2 * p];
        y[p] = view.y - view.scale * points[2 * p + 1];
      }
      return;
    }
    for (let p = 0; p < n; p++) {
      const [a, b, c] = [points[3 * p], points[3 * p + 1], points[3 * p + 2]];
      x[p] = view.x + view.scale * (turned[0] * a + turned[1] * b + turned[2] * c);
      y[p] = view.y - view.scale * (turned[3] * a + turned[4] * b + turned[5] * c);
      z[p] = turned[6] * a + turned[7] * b + turned[8] * c;
    }
  }

  draw() {
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    this.frame = 0;
    this.project();
    const pen = this.canvas.getContext("2d");
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.clearRect(0, 0, this.width, this.height);
    pen.lineJoin = "round";
    const colors = this.palette = this.colors();
    if (this.inView() > MANY) this.paintPixels(pen, colors);
    else if (this.space) this.paintSpace(pen, colors);
    else this.paintPlane(pen, colors);
    this.drawPath();
    this.stage.dataset.drawn = this.mesh.m;
  }

  inView() {
    const { triangles, m } = this.mesh;
    let count = 0;
    for (let t = 0; t < m; t++) {
      count += !this.isOutside(triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]);
    }
    return count;
  }

  // Width of a typical triangle on the screen.
  get typical() {
    const [left, right, low, high] = this.bounds(null);
    return Math.sqrt(Math.max(right - left, 1) * Math.max(high - low, 1) / this.mesh.m);
  }

  isOutside(a, b, c) {
    const { x, y, width, height } = this;
    return Math.max(x[a], x[b], x[c]) < 0 || Math.min(x[a], x[b], x[c]) > width
      || Math.max(y[a], y[b], y[c]) < 0 || Math.min(y[a], y[b], y[c]) > height;
  }

  paintPlane(pen, colors) {
    const { mesh } = this;
    const shapes = mesh.classes.map(() => new Path2D());
    for (let t = 0; t < mesh.m; t++) this.trace(shapes[mesh.shades[t]], t);
    for (const [k, shape] of shapes.entries()) {
      pen.fillStyle = pen.strokeStyle = colors.scale[k];
      pen.lineWidth = 0.7; // closes the seams between triangles
      pen.fill(shape);
      pen.stroke(shape);
    }
    if (this.typical < LINE) return;
    pen.strokeStyle = colors.edge;
    pen.lineWidth = Math.min(1, this.typical / 20);
    for (const shape of shapes) pen.stroke(shape);
  }

  // Every pixel gets the colour of the triangle at its middle, in space of the one in front.
  paintPixels(pen, colors) {
    const { mesh, x, y, z, ratio } = this;
    const { width, height } = this.canvas;
    const image = new ImageData(width, height);
    const pixels = new Uint32Array(image.data.buffer);
    const depth = this.space ? new Float32Array(width * height).fill(-Infinity) : null;
    const packed = (this.space ? colors.lit : colors.scale.map((color) => [color]))
      .map((levels) => levels.map(packColor));
    for (let t = 0; t < mesh.m; t++) {
      const a = mesh.triangles[3 * t], b = mesh.triangles[3 * t + 1], c = mesh.triangles[3 * t + 2];
      if (this.isOutside(a, b, c)) continue;
      const ax = ratio * x[a], ay = ratio * y[a], bx = ratio * x[b], by = ratio * y[b];
      const cx = ratio * x[c], cy = ratio * y[c];
      const double = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
      if (double === 0) continue;
      const color = packed[mesh.shades[t]][this.space ? this.light(a, b, c) : 0];
      const left = Math.max(0, Math.floor(Math.min(ax, bx, cx))), right = Math.min(width - 1, Math.max(ax, bx, cx));
      const top = Math.max(0, Math.floor(Math.min(ay, by, cy))), bottom = Math.min(height - 1, Math.max(ay, by, cy));
      for (let row = top; row <= bottom; row++) {
        const py = row + 0.5;
        for (let column = left; column <= right; column++) {
          const px = column + 0.5;
          const u = ((bx - px) * (cy - py) - (by - py) * (cx - px)) / double;
          const v = ((cx - px) * (ay - py) - (cy - py) * (ax - px)) / double;
          const w = 1 - u - v;
          if (u < 0 || v < 0 || w < 0) continue;
          const pixel = row * width + column;
          if (depth) {
            const near = u * z[a] + v * z[b] + w * z[c];
            if (near < depth[pixel]) continue;
            depth[pixel] = near;
          }
          pixels[pixel] = color;
        }
      }
    }
    pen.putImageData(image, 0, 0);
  }

  trace(shape, t) {
    const { x, y } = this;
    const [a, b, c] = this.mesh.corners(t);
    if (this.isOutside(a, b, c)) return;
    shape.moveTo(x[a], y[a]);
    shape.lineTo(x[b], y[b]);
    shape.lineTo(x[c], y[c]);
    shape.closePath();
  }

  // From the back to the front.
  paintSpace(pen, colors) {
    const { mesh, x, y } = this;
    const lines = this.typical > LINE && (!this.turning || mesh.m <= FEW);
    pen.lineWidth = 0.7;
    for (const t of this.order()) {
      const [a, b, c] = mesh.corners(t);
      if (this.isOutside(a, b, c)) continue;
      const color = colors.lit[mesh.shades[t]][this.light(a, b, c)];
      pen.beginPath();
      pen.moveTo(x[a], y[a]);
      pen.lineTo(x[b], y[b]);
      pen.lineTo(x[c], y[c]);
      pen.closePath();
      pen.fillStyle = color;
      pen.strokeStyle = lines ? colors.edge : color;
      pen.fill();
      pen.stroke();
    }
  }

  // Triangles by depth, in as many steps as a counting sort can tell apart.
  order() {
    const { mesh, z } = this;
    const steps = 4096;
    const depth = new Uint16Array(mesh.m);
    const end = new Uint32Array(steps + 1);
    let reach = 0;
    for (let p = 0; p < mesh.n; p++) reach = Math.max(reach, Math.abs(z[p]));
    for (let t = 0; t < mesh.m; t++) {
      const middle = (z[mesh.triangles[3 * t]] + z[mesh.triangles[3 * t + 1]] + z[mesh.triangles[3 * t + 2]]) / 3;
      depth[t] = Math.min(steps - 1, Math.floor((middle / (reach || 1) + 1) / 2 * steps));
      end[depth[t] + 1]++;
    }
    for (let k = 0; k < steps; k++) end[k + 1] += end[k];
    const order = new Uint32Array(mesh.m);
    for (let t = 0; t < mesh.m; t++) order[end[depth[t]]++] = t;
    return order;
  }

  // How much a triangle faces the reader, in levels.
  light(a, b, c) {
    const { x, y, z, view } = this;
    const [ux, uy, uz] = [x[b] - x[a], y[b] - y[a], view.scale * (z[b] - z[a])];
    const [vx, vy, vz] = [x[c] - x[a], y[c] - y[a], view.scale * (z[c] - z[a])];
    const across = Math.abs(ux * vy - uy * vx);
    const whole = Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
    return Math.min(LEVELS - 1, Math.floor(LEVELS * (whole ? across / whole : 1)));
  }

  // The style sheet's colours as the theme has them now.
  colors() {
    const read = (name) => {
      this.stage.style.color = `var(${name})`;
      return getComputedStyle(this.stage).color;
    };
    const scale = this.mesh.classes.map((_, k) => read(`--scale-${this.shadeOf(k)}`));
    const dim = (color, by) => {
      const [r, g, b] = color.match(/[\d.]+/g).map(Number);
      return `rgb(${[r, g, b].map((v) => Math.round(v * by)).join(" ")})`;
    };
    const lit = scale.map((color) => Array.from({ length: LEVELS },
      (_, k) => dim(color, DIMMEST + (1 - DIMMEST) * k / (LEVELS - 1))));
    const colors = { scale, lit, surface: read("--surface"), path: read("--series-2"), ink: read("--ink"),
      edge: read("--mesh-edge") };
    this.stage.style.color = "";
    return colors;
  }

  // Few classes take shades that are far apart.
  shadeOf(k) {
    const classes = this.mesh.classes.length;
    return classes === 1 ? 2 : Math.round(k * 4 / (classes - 1));
  }

  // The chosen triangle, its path and the terminal edge.
  drawPath() {
    const { mesh, x, y } = this;
    const pen = this.overlay.getContext("2d");
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.clearRect(0, 0, this.width, this.height);
    const colors = this.palette;
    const found = mesh.path(this.chosen);
    pen.lineJoin = pen.lineCap = "round";
    for (const [place, t] of [...found.path.entries()].reverse()) {
      const shape = new Path2D();
      this.trace(shape, t);
      pen.fillStyle = colors.surface;
      pen.fill(shape);
      pen.globalAlpha = place === 0 ? 1 : 0.55;
      pen.fillStyle = colors.path;
      pen.fill(shape);
      pen.globalAlpha = 1;
      pen.strokeStyle = place === 0 ? colors.ink : colors.surface;
      pen.lineWidth = Math.min(place === 0 ? 2 : 1, this.breadth(t) / 4); // small ones keep their colour
      pen.stroke(shape);
    }
    if (found.end !== "outside") {
      const [a, b] = mesh.terminalEdge(found);
      pen.strokeStyle = colors.ink;
      pen.lineWidth = 3.5;
      pen.beginPath();
      pen.moveTo(x[a], y[a]);
      pen.lineTo(x[b], y[b]);
      pen.stroke();
    }
    this.label(pen, found.path, colors);
  }

  label(pen, path, colors) {
    pen.font = `700 13px ${getComputedStyle(document.body).fontFamily}`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.lineWidth = 3;
    for (const [place, t] of path.entries()) {
      if (this.breadth(t) < LABEL) continue;
      const [px, py] = this.center(t);
      pen.strokeStyle = colors.surface;
      pen.strokeText(place + 1, px, py);
      pen.fillStyle = colors.ink;
      pen.fillText(place + 1, px, py);
    }
  }

  center(t) {
    const [a, b, c] = this.mesh.corners(t);
    return [(this.x[a] + this.x[b] + this.x[c]) / 3, (this.y[a] + this.y[b] + this.y[c]) / 3];
  }

  // Height over the longest side, in pixels.
  breadth(t) {
    const { x, y } = this;
    const [a, b, c] = this.mesh.corners(t);
    const double = Math.abs((x[b] - x[a]) * (y[c] - y[a]) - (y[b] - y[a]) * (x[c] - x[a]));
    return double / Math.max(Math.hypot(x[b] - x[a], y[b] - y[a]),
      Math.hypot(x[c] - x[b], y[c] - y[b]), Math.hypot(x[a] - x[c], y[a] - y[c]), 1e-9);
  }

  // The triangle under a point of the screen, in space the one in front; -1 beside the mesh.
  hit(px, py) {
    const { mesh, x, y, z } = this;
    let best = -1;
    let front = -Infinity;
    for (let t = 0; t < mesh.m; t++) {
      const a = mesh.triangles[3 * t], b = mesh.triangles[3 * t + 1], c = mesh.triangles[3 * t + 2];
      const u = (x[b] - px) * (y[c] - py) - (y[b] - py) * (x[c] - px);
      const v = (x[c] - px) * (y[a] - py) - (y[c] - py) * (x[a] - px);
      const w = (x[a] - px) * (y[b] - py) - (y[a] - py) * (x[b] - px);
      if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) continue;
      const sum = u + v + w;
      if (sum === 0) continue;
      if (!this.space) return t;
      const depth = (u * z[a] + v * z[b] + w * z[c]) / sum;
      if (depth > front) { front = depth; best = t; }
    }
    return best;
  }

  choose(t) {
    this.chosen = t;
    const { mesh } = this;
    const { path, end } = mesh.path(t);
    const name = (s) => mesh.numbers[s].toLocaleString("en");
    const size = mesh.sizes[t];
    const names = path.map(name);
    const shown = names.length > 12 ? [...names.slice(0, 10), "…", names[names.length - 1]] : names;
    const ends = {
      pair: "It ends at an edge that is the longest of both triangles beside it.",
      boundary: "It ends at an edge of the boundary.",
      outside: "It goes on outside the part that is drawn.",
    }[end];
    this.said.textContent = size === 1
      ? `Triangle ${name(t)}: LEPP size 1. Its longest edge lies on the boundary.`
      : `Triangle ${name(t)}: LEPP size ${size.toLocaleString("en")}. The path goes ${shown.join(" → ")}. ${ends}`;
    this.stage.dataset.chosen = mesh.numbers[t];
    if (document.activeElement !== this.input) this.input.value = mesh.numbers[t];
    if (!this.frame) this.drawPath();
  }

  wire(host) {
    const { stage } = this;
    const at = (event) => {
      const box = stage.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    stage.addEventListener("pointerdown", (event) => this.press(event, at(event)));
    stage.addEventListener("pointermove", (event) => this.move(event, at(event)));
    for (const name of ["pointerup", "pointercancel"]) {
      stage.addEventListener(name, (event) => this.release(event));
    }
    stage.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.metaKey) return; // a plain wheel scrolls the page
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY / 300), ...at(event));
    }, { passive: false });
    stage.addEventListener("keydown", (event) => this.key(event));
    for (const button of host.querySelectorAll("[data-do]")) {
      button.addEventListener("click", () => this.act(button.dataset.do));
    }
    this.input.addEventListener("change", () => {
      const place = this.mesh.placeOf(Number(this.input.value));
      if (place < 0 || !Number.isInteger(place)) {
        this.said.textContent = `Triangle ${this.input.value} is not drawn here.`;
        return;
      }
      this.choose(place);
      this.zoomTo(this.mesh.path(place).path);
    });
  }

  act(what) {
    if (what === "whole") { this.fit(); this.draw(); }
    else if (what === "worst") {
      this.choose(this.mesh.worst);
      if (this.space) this.face(this.mesh.path(this.mesh.worst).path);
      this.zoomTo(this.mesh.path(this.mesh.worst).path, 0.8);
    } else this.zoom(what === "in" ? 1.5 : 1 / 1.5, this.width / 2, this.height / 2);
  }

  press(event, [x, y]) {
    this.stage.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [x, y]);
    this.moved = 0;
    this.pick(x, y);
  }

  pick(x, y) {
    const t = this.hit(x, y);
    if (t >= 0 && t !== this.chosen) this.choose(t);
  }

  move(event, [x, y]) {
    const before = this.pointers.get(event.pointerId);
    if (!before) {
      if (event.pointerType === "mouse" || event.pointerType === "pen") this.pick(x, y);
      return;
    }
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId);
    this.pointers.set(event.pointerId, [x, y]);
    const [dx, dy] = [x - before[0], y - before[1]];
    this.moved += Math.hypot(dx, dy);
    if (this.moved < 4) return; // a hand is never quite still
    this.stage.dataset.dragged = "";
    if (others.length) this.pinch(before, [x, y], others[0][1]);
    else if (this.space && !event.shiftKey) this.turn(dx / 150, dy / 150);
    else this.zoom(1, before[0], before[1], x, y);
  }

  pinch(before, [x, y], [otherX, otherY]) {
    const apart = Math.hypot(before[0] - otherX, before[1] - otherY);
    const factor = Math.hypot(x - otherX, y - otherY) / (apart || 1);
    this.zoom(factor, (before[0] + otherX) / 2, (before[1] + otherY) / 2, (x + otherX) / 2, (y + otherY) / 2);
  }

  release(event) {
    this.pointers.delete(event.pointerId);
    delete this.stage.dataset.dragged;
    if (this.turning) { this.turning = false; this.draw(); }
  }

  turn(aside, up) {
    this.turned = turnBy(turnBy(this.turned, "y", aside), "x", up);
    this.turning = this.pointers.size > 0;
    this.draw();
  }

  key(event) {
    const directions = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const { mesh, chosen } = this;
    let next;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key in directions && event.shiftKey && this.space) {
      const [x, y] = directions[event.key];
      this.turn(x * 0.15, y * 0.15);
    } else if (event.key in directions) next = this.toward(directions[event.key]);
    else if (event.key === "Home") next = 0;
    else if (event.key === "End") next = mesh.m - 1;
    else if (event.key === "Enter" || event.key === " ") next = mesh.path(chosen).path[1];
    else if (event.key === "+" || event.key === "=") this.act("in");
    else if (event.key === "-") this.act("out");
    else if (event.key === "0") this.act("whole");
    else return;
    event.preventDefault();
    if (next !== undefined) {
      this.choose(next);
      this.reveal([next]);
    }
  }

  // The triangle beside the chosen one that lies most in a direction.
  toward([dx, dy]) {
    const [x, y] = this.center(this.chosen);
    let best;
    let most = 0;
    for (const t of this.mesh.neighbors(this.chosen)) {
      const [tx, ty] = this.center(t);
      const along = ((tx - x) * dx + (ty - y) * dy) / (Math.hypot(tx - x, ty - y) || 1);
      if (along > most) { most = along; best = t; }
    }
    return best;
  }

  drawKey(list) {
    const { classes } = this.mesh;
    list.replaceChildren(...classes.map(([low, high], k) => {
      const item = document.createElement("li");
      const box = document.createElement("i");
      box.style.background = `var(--scale-${this.shadeOf(k)})`;
      item.append(box, low === high ? String(low) : `${low}–${high}`);
      return item;
    }));
  }
}

const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
const cross = (u, v) => [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];

function unit(v) {
  const length = Math.hypot(...v);
  return length ? v.map((x) => x / length) : [0, 0, 1];
}

// "rgb(1 2 3)" as the number that a canvas keeps for it.
function packColor(color) {
  const [r, g, b] = color.match(/[\d.]+/g).map(Number);
  return (255 << 24 | b << 16 | g << 8 | r) >>> 0;
}

// A rotation matrix, row by row, turned further about an axis of the screen.
function turnBy(matrix, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const [p, q] = { x: [1, 2], y: [2, 0], z: [0, 1] }[axis];
  const result = [...matrix];
  for (let k = 0; k < 3; k++) {
    result[3 * p + k] = c * matrix[3 * p + k] - s * matrix[3 * q + k];
    result[3 * q + k] = s * matrix[3 * p + k] + c * matrix[3 * q + k];
  }
  return result;
}

function wireTheme(view) {
  const root = document.documentElement;
  const button = document.getElementById("theme");
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const isDark = () => (root.dataset.theme ?? (dark.matches ? "dark" : "light")) === "dark";
  const settle = () => {
    button.setAttribute("aria-pressed", String(isDark()));
    view.draw();
  };
  button.addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    try { localStorage.setItem("theme", root.dataset.theme); } catch { /* for this visit only */ }
    settle();
  });
  dark.addEventListener("change", settle);
  settle();
  let theme;
  addEventListener("beforeprint", () => {
    theme = root.dataset.theme;
    root.dataset.theme = "light";
    view.drawNow();
  });
  addEventListener("afterprint", () => {
    if (theme) root.dataset.theme = theme;
    else delete root.dataset.theme;
    view.draw();
  });
}

async function start() {
  const host = document.querySelector(".mesh");
  const about = JSON.parse(document.getElementById("mesh-drawing").textContent);
  const view = new MeshView(host, new Mesh(about, await inflate("mesh-data").arrayBuffer()));
  view.drawKey(host.querySelector(".size-key ul"));
  wireTheme(view);
  document.documentElement.dataset.ready = "mesh";
}

start();
