// Where a mesh lies on the screen: moved, scaled and turned; and what follows from that.

const MARGIN = 16; // pixels around the whole mesh
const LEVELS = 6; // of light on a surface in space
const FARTHEST = 1 / 4; // scales, in those at which the whole is shown
const CLOSEST = 4000;
const DEPTHS = 4096; // that the order by depth tells apart

class Projection {
  /** @param {MeshData} mesh */
  constructor(mesh) {
    this.mesh = mesh;
    /** Of every point, in pixels; z, towards the reader, in the mesh's units. */
    this.x = new Float32Array(mesh.n);
    this.y = new Float32Array(mesh.n);
    this.z = new Float32Array(mesh.n);
    this.width = 0;
    this.height = 0;
    this.view = { x: 0, y: 0, scale: 1 };
    this.turned = [1, 0, 0, 0, 1, 0, 0, 0, 1];
    this.fitted = 1; // the scale at which the whole is shown
    this.atWhole = true;
  }

  project() {
    const { mesh, x, y, z, view, turned } = this;
    const { points, n } = mesh;
    if (!mesh.space) {
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

  /**
   * Take a screen of another size; what was in its middle stays there, and the whole stays whole.
   * @param {number} width
   * @param {number} height
   */
  resize(width, height) {
    const { view } = this;
    const [aside, down] = [(width - this.width) / 2, (height - this.height) / 2];
    Object.assign(this, { width, height });
    if (this.atWhole) {
      this.fit();
      return;
    }
    this.view = { ...view, x: view.x + aside, y: view.y + down };
    this.project();
  }

  /** Show the whole mesh. */
  fit() {
    this.view = { x: 0, y: 0, scale: 1 };
    this.project();
    const [left, right, top, bottom] = this.bounds();
    const scale = Math.min((this.width - 2 * MARGIN) / (right - left || 1),
      (this.height - 2 * MARGIN) / (bottom - top || 1));
    this.view = {
      scale,
      x: this.width / 2 - scale * ((left + right) / 2),
      y: this.height / 2 - scale * ((top + bottom) / 2),
    };
    this.fitted = scale;
    this.atWhole = true;
    this.project();
  }

  /**
   * Scale about a point of the screen, which goes to another.
   * @param {number} factor
   * @param {number} x
   * @param {number} y
   */
  zoom(factor, x, y, toX = x, toY = y) {
    const { view, fitted } = this;
    const scale = Math.min(Math.max(view.scale * factor, fitted * FARTHEST), fitted * CLOSEST);
    const by = scale / view.scale;
    this.view = { scale, x: toX - by * (x - view.x), y: toY - by * (y - view.y) };
    this.atWhole = false;
    this.project();
  }

  /**
   * Bring triangles to the middle, where they take a share of the screen.
   * @param {number[]} triangles
   */
  zoomTo(triangles, share = 0.5) {
    const [left, right, top, bottom] = this.bounds(triangles);
    const factor = share * Math.min(this.width / (right - left || 1), this.height / (bottom - top || 1));
    this.zoom(factor, (left + right) / 2, (top + bottom) / 2, this.width / 2, this.height / 2);
  }

  /**
   * Bring triangles into view; returns whether that changed anything.
   * @param {number[]} triangles
   */
  reveal(triangles) {
    const [left, right, top, bottom] = this.bounds(triangles);
    if (left >= 0 && right <= this.width && top >= 0 && bottom <= this.height) return false;
    this.zoom(Math.min(1, this.width / (right - left || 1), this.height / (bottom - top || 1)),
      (left + right) / 2, (top + bottom) / 2, this.width / 2, this.height / 2);
    return true;
  }

  /**
   * Turn a surface.
   * @param {number} aside in radians, to the right
   * @param {number} down
   */
  turn(aside, down) {
    this.turned = turnBy(turnBy(this.turned, "y", aside), "x", down);
    this.project();
  }

  /**
   * Turn a surface so that triangles are in front.
   * @param {number[]} triangles
   */
  face(triangles) {
    this.turned = facing(this.mesh, triangles);
    this.project();
  }

  /**
   * Left, right, top and bottom of triangles, or of the whole mesh.
   * @param {number[]} [triangles]
   */
  bounds(triangles) {
    const { mesh, x, y } = this;
    const box = [Infinity, -Infinity, Infinity, -Infinity];
    const add = (/** @type {number} */ p) => {
      box[0] = Math.min(box[0], x[p]); box[1] = Math.max(box[1], x[p]);
      box[2] = Math.min(box[2], y[p]); box[3] = Math.max(box[3], y[p]);
    };
    if (triangles) for (const t of triangles) mesh.corners(t).forEach(add);
    else for (let p = 0; p < mesh.n; p++) add(p);
    return box;
  }

  /**
   * The longer side of the box around triangles, in pixels.
   * @param {number[]} triangles
   */
  extent(triangles) {
    const [left, right, top, bottom] = this.bounds(triangles);
    return Math.max(right - left, bottom - top);
  }

  /** Width of a typical triangle, in pixels. */
  get typical() {
    const [left, right, top, bottom] = this.bounds();
    return Math.sqrt(Math.max(right - left, 1) * Math.max(bottom - top, 1) / this.mesh.m);
  }

  /**
   * Whether a triangle with these vertices is surely not in view.
   * @param {number} a
   * @param {number} b
   * @param {number} c
   */
  isOutside(a, b, c) {
    const { x, y, width, height } = this;
    return Math.max(x[a], x[b], x[c]) < 0 || Math.min(x[a], x[b], x[c]) > width
      || Math.max(y[a], y[b], y[c]) < 0 || Math.min(y[a], y[b], y[c]) > height;
  }

  /** Number of triangles in view. */
  inView() {
    const { triangles, m } = this.mesh;
    let count = 0;
    for (let t = 0; t < m; t++) {
      if (!this.isOutside(triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2])) count++;
    }
    return count;
  }

  /**
   * @param {number} t
   * @returns {[number, number]}
   */
  center(t) {
    const { x, y } = this;
    const [a, b, c] = this.mesh.corners(t);
    return [(x[a] + x[b] + x[c]) / 3, (y[a] + y[b] + y[c]) / 3];
  }

  /**
   * Height over the longest side, in pixels.
   * @param {number} t
   */
  breadth(t) {
    const { x, y } = this;
    const [a, b, c] = this.mesh.corners(t);
    const double = Math.abs((x[b] - x[a]) * (y[c] - y[a]) - (y[b] - y[a]) * (x[c] - x[a]));
    return double / Math.max(Math.hypot(x[b] - x[a], y[b] - y[a]),
      Math.hypot(x[c] - x[b], y[c] - y[b]), Math.hypot(x[a] - x[c], y[a] - y[c]), 1e-9);
  }

  /**
   * How much a triangle with these vertices faces the reader: 0 not at all, LEVELS - 1 fully.
   * @param {number} a
   * @param {number} b
   * @param {number} c
   */
  light(a, b, c) {
    const { x, y, z, view } = this;
    const normal = cross([x[b] - x[a], y[b] - y[a], view.scale * (z[b] - z[a])],
      [x[c] - x[a], y[c] - y[a], view.scale * (z[c] - z[a])]);
    const length = Math.hypot(...normal);
    const share = length ? Math.abs(normal[2]) / length : 1;
    return Math.min(LEVELS - 1, Math.floor(LEVELS * share));
  }

  /** Triangles from the back to the front, in as many steps as a counting sort can tell apart. */
  order() {
    const { mesh: { triangles, m }, z } = this;
    const depth = new Uint16Array(m);
    const end = new Uint32Array(DEPTHS + 1);
    let reach = 0;
    for (const height of z) reach = Math.max(reach, Math.abs(height));
    for (let t = 0; t < m; t++) {
      const middle = (z[triangles[3 * t]] + z[triangles[3 * t + 1]] + z[triangles[3 * t + 2]]) / 3;
      depth[t] = Math.min(DEPTHS - 1, Math.floor((middle / (reach || 1) + 1) / 2 * DEPTHS));
      end[depth[t] + 1]++;
    }
    for (let k = 0; k < DEPTHS; k++) end[k + 1] += end[k];
    const order = new Uint32Array(m);
    for (let t = 0; t < m; t++) order[end[depth[t]]++] = t;
    return order;
  }

  /**
   * The triangle under a point of the screen, in space the one in front; -1 beside the mesh.
   * @param {number} px
   * @param {number} py
   */
  hit(px, py) {
    const { mesh: { triangles, m, space }, x, y, z } = this;
    let best = -1;
    let front = -Infinity;
    for (let t = 0; t < m; t++) {
      const a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
      const u = (x[b] - px) * (y[c] - py) - (y[b] - py) * (x[c] - px);
      const v = (x[c] - px) * (y[a] - py) - (y[c] - py) * (x[a] - px);
      const w = (x[a] - px) * (y[b] - py) - (y[a] - py) * (x[b] - px);
      if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) continue;
      const sum = u + v + w;
      if (sum === 0) continue;
      if (!space) return t;
      const depth = (u * z[a] + v * z[b] + w * z[c]) / sum;
      if (depth > front) { front = depth; best = t; }
    }
    return best;
  }

  /**
   * The triangle beside another that lies most in a direction of the screen, if any does.
   * @param {number} t
   * @param {number[]} direction
   */
  toward(t, [dx, dy]) {
    const [x, y] = this.center(t);
    /** @type {number | undefined} */
    let best;
    let most = 0;
    for (const s of this.mesh.neighbors(t)) {
      const [sx, sy] = this.center(s);
      const along = ((sx - x) * dx + (sy - y) * dy) / (Math.hypot(sx - x, sy - y) || 1);
      if (along > most) { most = along; best = s; }
    }
    return best;
  }
}
