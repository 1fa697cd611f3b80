// The mesh on a canvas, coloured by LEPP size; the chosen triangle's path on a second one above it.

const DIMMEST = 0.72; // light on what is seen from the side
const FEW = 6000; // triangles of which every frame shows the edges, even while turned
const MANY = 12000; // triangles in view that are no longer drawn as shapes, but pixel by pixel
const LINE = 5; // a triangle of so many pixels is large enough for its edges
const LABEL = 22; // and of so many for its place on the path
const OUTLINE = 3; // pixels of ink around the path, half of them outside
const RING = 12; // radius of the ring around the chosen triangle where that is small
const PRINTED = 2; // pixels of a picture to one of the screen, at least

/**
 * @typedef {object} Palette
 * @property {string[]} scale a colour a class
 * @property {string[][]} lit the same by level of light
 * @property {string} surface
 * @property {string} path
 * @property {string} ink
 * @property {string} edge
 */

class Painter {
  /**
   * @param {HTMLElement} stage
   * @param {Projection} projection
   */
  constructor(stage, projection) {
    const [canvas, overlay] = stage.querySelectorAll("canvas");
    this.stage = stage;
    this.projection = projection;
    this.mesh = projection.mesh;
    this.canvas = canvas;
    this.overlay = overlay;
    this.ratio = 1;
    this.palette = this.colors();
  }

  /**
   * Take the stage's size.
   * @param {number} ratio of the canvas's pixels to the screen's
   */
  resize(ratio = devicePixelRatio || 1) {
    const { clientWidth, clientHeight } = this.stage;
    this.ratio = ratio;
    for (const canvas of [this.canvas, this.overlay]) {
      canvas.width = Math.round(clientWidth * this.ratio);
      canvas.height = Math.round(clientHeight * this.ratio);
    }
    this.projection.resize(clientWidth, clientHeight);
  }

  /**
   * A picture of what is in view, on the stage's background.
   * @param {number} chosen
   */
  picture(chosen) {
    this.resize(Math.max(PRINTED, devicePixelRatio || 1));
    this.paintMesh(false);
    this.paintPath(chosen);
    const picture = document.createElement("canvas");
    Object.assign(picture, { width: this.canvas.width, height: this.canvas.height });
    const pen = /** @type {CanvasRenderingContext2D} */ (picture.getContext("2d"));
    pen.fillStyle = getComputedStyle(this.stage).backgroundColor;
    pen.fillRect(0, 0, picture.width, picture.height);
    for (const canvas of [this.canvas, this.overlay]) pen.drawImage(canvas, 0, 0);
    this.resize();
    return picture;
  }

  /**
   * A cleared canvas.
   * @param {HTMLCanvasElement} canvas
   */
  penOf(canvas) {
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.lineJoin = pen.lineCap = "round";
    return pen;
  }

  /** @param {boolean} turning whether the reader turns the mesh just now */
  paintMesh(turning) {
    const pen = this.penOf(this.canvas);
    this.palette = this.colors();
    if (this.projection.inView() > MANY) this.paintPixels(pen);
    else if (this.mesh.space) this.paintSpace(pen, turning);
    else this.paintPlane(pen);
  }

  /** @param {CanvasRenderingContext2D} pen */
  paintPlane(pen) {
    const { mesh, palette, projection: { typical } } = this;
    const shapes = mesh.classes.map(() => new Path2D());
    for (let t = 0; t < mesh.m; t++) this.trace(shapes[mesh.shades[t]], t);
    for (const [k, shape] of shapes.entries()) {
      pen.fillStyle = pen.strokeStyle = palette.scale[k];
      pen.lineWidth = 0.7; // closes the seams between triangles
      pen.fill(shape);
      pen.stroke(shape);
    }
    if (typical < LINE) return;
    pen.strokeStyle = palette.edge;
    pen.lineWidth = Math.min(1, typical / 20);
    for (const shape of shapes) pen.stroke(shape);
  }

  /** @param {CanvasRenderingContext2D} pen */
  paintPixels(pen) {
    const { width, height } = this.canvas;
    const { scale, lit } = this.palette;
    const colors = this.mesh.space ? lit : scale.map((color) => [color]);
    const pixels = rasterize(this.projection, colors.map((levels) => levels.map(packColor)),
      width, height, this.ratio);
    pen.putImageData(new ImageData(new Uint8ClampedArray(pixels.buffer), width, height), 0, 0);
  }

  /**
   * Triangle by triangle, from the back to the front.
   * @param {CanvasRenderingContext2D} pen
   * @param {boolean} turning
   */
  paintSpace(pen, turning) {
    const { mesh, palette, projection } = this;
    const lines = projection.typical > LINE && (!turning || mesh.m <= FEW);
    pen.lineWidth = 0.7;
    for (const t of projection.order()) {
      const [a, b, c] = mesh.corners(t);
      const color = palette.lit[mesh.shades[t]][projection.light(a, b, c)];
      pen.beginPath();
      this.trace(pen, t);
      pen.fillStyle = color;
      pen.strokeStyle = lines ? palette.edge : color;
      pen.fill();
      pen.stroke();
    }
  }

  /**
   * Add the outline of a triangle, if it may be in view.
   * @param {CanvasPath} shape
   * @param {number} t
   */
  trace(shape, t) {
    const { x, y } = this.projection;
    const [a, b, c] = this.mesh.corners(t);
    if (this.projection.isOutside(a, b, c)) return;
    shape.moveTo(x[a], y[a]);
    shape.lineTo(x[b], y[b]);
    shape.lineTo(x[c], y[c]);
    shape.closePath();
  }

  /**
   * The path of a triangle, the triangle itself and the terminal edge brought out.
   * @param {number} chosen
   */
  paintPath(chosen) {
    const { palette } = this;
    const pen = this.penOf(this.overlay);
    const { path, edge } = this.mesh.path(chosen);
    const outline = new Path2D();
    for (const t of path) this.trace(outline, t);
    pen.strokeStyle = palette.ink;
    pen.lineWidth = OUTLINE;
    pen.stroke(outline); // what of it lies on the path is painted over
    for (const t of [...path].reverse()) {
      const shape = new Path2D();
      this.trace(shape, t);
      pen.fillStyle = palette.surface;
      pen.fill(shape);
      pen.globalAlpha = t === chosen ? 1 : 0.7;
      pen.fillStyle = palette.path;
      pen.fill(shape);
      pen.globalAlpha = 1;
      pen.strokeStyle = t === chosen ? palette.ink : palette.surface;
      // Small triangles keep their colour.
      pen.lineWidth = Math.min(t === chosen ? 2 : 1, this.projection.breadth(t) / 4);
      pen.stroke(shape);
    }
    if (edge.length) this.paintTerminalEdge(pen, edge);
    this.paintPlaces(pen, path);
    if (this.projection.breadth(chosen) < LABEL) this.paintRing(pen, chosen);
  }

  /**
   * Lead the eye to a small triangle.
   * @param {CanvasRenderingContext2D} pen
   * @param {number} t
   */
  paintRing(pen, t) {
    const ring = new Path2D();
    ring.arc(...this.projection.center(t), RING, 0, 2 * Math.PI);
    for (const [color, width] of /** @type {const} */ ([["surface", 5], ["ink", 2]])) {
      pen.strokeStyle = this.palette[color];
      pen.lineWidth = width;
      pen.stroke(ring);
    }
  }

  /**
   * @param {CanvasRenderingContext2D} pen
   * @param {number[]} edge
   */
  paintTerminalEdge(pen, [a, b]) {
    const { x, y } = this.projection;
    pen.strokeStyle = this.palette.ink;
    // A line no thicker than a tenth of its length leaves the triangles beside it to be seen.
    pen.lineWidth = Math.min(3.5, Math.max(1, Math.hypot(x[b] - x[a], y[b] - y[a]) / 10));
    pen.beginPath();
    pen.moveTo(x[a], y[a]);
    pen.lineTo(x[b], y[b]);
    pen.stroke();
  }

  /**
   * @param {CanvasRenderingContext2D} pen
   * @param {number[]} path
   */
  paintPlaces(pen, path) {
    pen.font = `700 13px ${getComputedStyle(document.body).fontFamily}`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.lineWidth = 3;
    pen.strokeStyle = this.palette.surface;
    pen.fillStyle = this.palette.ink;
    for (const [k, t] of path.entries()) {
      if (this.projection.breadth(t) < LABEL) continue;
      const [px, py] = this.projection.center(t);
      pen.strokeText(String(k + 1), px, py);
      pen.fillText(String(k + 1), px, py);
    }
  }

  /**
   * The style sheet's colours as the theme has them now.
   * @returns {Palette}
   */
  colors() {
    const read = (/** @type {string} */ name) => {
      this.stage.style.color = `var(${name})`;
      return getComputedStyle(this.stage).color;
    };
    const scale = this.mesh.classes.map((_, k) => read(`--scale-${this.mesh.shadeOf(k)}`));
    const dim = (/** @type {string} */ color, /** @type {number} */ by) => {
      const [r, g, b] = (color.match(/[\d.]+/g) ?? []).map(Number);
      return `rgb(${[r, g, b].map((v) => Math.round(v * by)).join(" ")})`;
    };
    const lit = scale.map((color) => Array.from({ length: LEVELS },
      (_, k) => dim(color, DIMMEST + (1 - DIMMEST) * k / (LEVELS - 1))));
    const palette = { scale, lit, surface: read("--surface"), path: read("--series-2"),
      ink: read("--ink"), edge: read("--mesh-edge") };
    this.stage.style.color = "";
    return palette;
  }
}
