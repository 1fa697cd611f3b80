// A mesh as its page has it: arrays, the path of a triangle, the triangles beside one.

/**
 * What the page says of the arrays in its data block.
 * @typedef {object} MeshAbout
 * @property {number} points that the triangles drawn have
 * @property {number} triangles that are drawn
 * @property {number} dimensions 2 or 3
 * @property {[number, number][]} classes first and last LEPP size of each shade
 * @property {number} worst place of the triangle with the longest path
 * @property {number} total triangles of the whole mesh
 * @property {string} name of the mesh's file, without its extension
 * @property {Record<string, { header: string, counts: [number, number][] }>} histograms
 */

/**
 * @typedef {object} LeppPath
 * @property {number[]} path triangles, from the first
 * @property {"pair" | "boundary" | "outside"} end "outside" where it leaves what is drawn
 * @property {number[]} edge the two points of the terminal edge; none where it is outside
 */

const SHADES = 5; // of the style sheet's scale

class MeshData {
  /**
   * @param {MeshAbout} about
   * @param {ArrayBuffer} buffer the arrays, one after the other
   */
  constructor({ points, triangles, dimensions, classes, worst, total }, buffer) {
    let start = 0;
    const whole = (/** @type {number} */ length) => {
      start += 4 * length;
      return new Int32Array(buffer, start - 4 * length, length);
    };
    this.n = points;
    this.m = triangles;
    this.space = dimensions === 3;
    this.classes = classes;
    this.worst = worst;
    this.total = total;
    /** Coordinates, point by point. */
    this.points = new Float32Array(buffer, 0, dimensions * points);
    start = this.points.byteLength;
    /** Vertices, triangle by triangle. */
    this.triangles = whole(3 * triangles);
    /** Place of the triangle across the longest edge; -1 where none is drawn. */
    this.successors = whole(triangles);
    this.sizes = whole(triangles);
    /** Numbers that the triangles have in the whole mesh, ascending. */
    this.numbers = whole(triangles);
    /**
     * Whether the longest edge is terminal: 0 where the path goes on; 1 + k on the boundary and
     * 4 + k in a pair, where the edge is across from vertex k.
     */
    this.ends = new Uint8Array(buffer, start, triangles);
    /** Class of the LEPP size of each triangle. */
    this.shades = Uint8Array.from(this.sizes,
      (size) => classes.findIndex(([low, high]) => low <= size && size <= high));
  }

  /**
   * The path of a triangle: as many triangles, each across the longest edge of the one before, as
   * its LEPP size says. Where edges are equal, the two beside a terminal edge need not be each
   * other's successors.
   * @param {number} t
   * @returns {LeppPath}
   */
  path(t) {
    const size = this.sizes[t];
    const path = [t];
    for (let next = this.successors[t]; path.length < size && next >= 0; next = this.successors[next]) {
      path.push(next);
    }
    if (path.length < size) return { path, end: "outside", edge: [] };
    const crossed = path[size - 2]; // the triangle whose longest edge the path crossed last
    if (size > 1 && this.ends[crossed] > 3) {
      return { path, end: "pair", edge: this.edgeAcross(crossed, this.ends[crossed] - 4) };
    }
    const last = path[size - 1];
    return { path, end: "boundary", edge: this.edgeAcross(last, this.ends[last] - 1) };
  }

  /**
   * The two points of a triangle's edge across from its vertex k.
   * @param {number} t
   * @param {number} k
   */
  edgeAcross(t, k) {
    return [...this.corners(t)].filter((_, vertex) => vertex !== k);
  }

  /** @param {number} t */
  corners(t) {
    return this.triangles.subarray(3 * t, 3 * t + 3);
  }

  /**
   * Triangles that have an edge in common with a triangle.
   * @param {number} t
   * @returns {number[]}
   */
  neighbors(t) {
    return this.edgeKeys(t).flatMap((key) => this.trianglesByEdge.get(key) ?? [])
      .filter((s) => s !== t);
  }

  /**
   * The triangles at every edge; made when it is first needed.
   * @type {Map<number, number[]>}
   */
  get trianglesByEdge() {
    /** @type {Map<number, number[]>} */
    const table = new Map();
    for (let s = 0; s < this.m; s++) {
      for (const key of this.edgeKeys(s)) {
        const beside = table.get(key);
        if (beside) beside.push(s);
        else table.set(key, [s]);
      }
    }
    Object.defineProperty(this, "trianglesByEdge", { value: table });
    return table;
  }

  /** @param {number} t */
  edgeKeys(t) {
    const [a, b, c] = this.corners(t);
    return [[a, b], [b, c], [c, a]].map(([p, q]) => Math.min(p, q) * this.n + Math.max(p, q));
  }

  /**
   * The place in what is drawn of the triangle with a number; -1 if it is not there.
   * @param {number} number
   */
  placeOf(number) {
    return this.numbers.indexOf(number);
  }

  /**
   * The style sheet's shade of a class; few classes take shades that are far apart.
   * @param {number} k
   */
  shadeOf(k) {
    const classes = this.classes.length;
    return classes === 1 ? 2 : Math.round(k * (SHADES - 1) / (classes - 1));
  }
}
