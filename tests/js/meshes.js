// Small meshes as the page's data block has them, their paths found by the definition.
import { load } from "./load.js";

const { MeshData } = load(["mesh/mesh_data.js"], ["MeshData"]);

/**
 * @typedef {object} Small
 * @property {number[][]} points in the plane or in space
 * @property {number[][]} triangles
 */

/** @type {(p: number, q: number) => number} */
export const ascending = (p, q) => p - q;

/**
 * The triangles at each edge, and the sides at which they have it.
 * @param {number[][]} triangles
 */
export function sidesByEdge(triangles) {
  /** @type {Map<string, [number, number][]>} */
  const table = new Map();
  for (const [t, corners] of triangles.entries()) {
    for (let k = 0; k < 3; k++) {
      const key = corners.filter((_, vertex) => vertex !== k).sort(ascending).join(" ");
      table.set(key, [...table.get(key) ?? [], [t, k]]);
    }
  }
  return table;
}

/**
 * Squares of the sides of a triangle; the k-th is across from vertex k.
 * @param {Small} small
 * @param {number} t
 */
function squares({ points, triangles }, t) {
  return triangles[t].map((_, k) => {
    const [p, q] = triangles[t].filter((_corner, vertex) => vertex !== k).map((vertex) => points[vertex]);
    return p.reduce((sum, x, i) => sum + (x - q[i]) ** 2, 0);
  });
}

/**
 * By definition: a path goes on across the longest edge while the longest edge beyond is greater;
 * of several equal ones it takes the last that gives the shortest path.
 * @param {Small} small
 */
function pathsOf(small) {
  const { triangles } = small;
  const edges = [...sidesByEdge(triangles).values()];
  /** @type {Map<number, { size: number, successor: number, end: number }>} */
  const known = new Map();
  const pathOf = (/** @type {number} */ t) => {
    const sides = squares(small, t);
    let best = { size: Infinity, successor: -1, end: 0 };
    for (let k = 0; k < 3; k++) {
      if (sides[k] < Math.max(...sides)) continue;
      const beside = edges.find((edge) => edge.some(([s, side]) => s === t && side === k))
        ?.find(([s]) => s !== t);
      let way;
      if (!beside) way = { size: 1, successor: -1, end: 1 + k };
      else if (Math.max(...squares(small, beside[0])) <= sides[k]) {
        way = { size: 2, successor: beside[0], end: 4 + k };
      } else {
        const next = known.get(beside[0]) ?? pathOf(beside[0]);
        way = { size: next.size + 1, successor: beside[0], end: 0 };
      }
      if (way.size <= best.size) best = way;
    }
    known.set(t, best);
    return best;
  };
  return triangles.map((_, t) => pathOf(t));
}

/**
 * Make the page's mesh of a small one; with `drawn`, of these triangles of it only.
 * @param {Small} small
 * @param {number[]} [drawn] ascending
 */
export function meshOf(small, drawn = small.triangles.map((_, t) => t)) {
  const paths = pathsOf(small);
  const used = drawn.map((t) => paths[t]);
  const largest = Math.max(...paths.map(({ size }) => size));
  const [n, m, dimensions] = [small.points.length, drawn.length, small.points[0].length];
  const buffer = new ArrayBuffer(4 * (n * dimensions + 6 * m) + m);
  new Float32Array(buffer, 0, n * dimensions).set(small.points.flat());
  new Int32Array(buffer, 4 * n * dimensions, 6 * m).set([
    ...drawn.flatMap((t) => small.triangles[t]),
    ...used.map(({ successor }) => drawn.indexOf(successor)),
    ...used.map(({ size }) => size),
    ...drawn,
  ]);
  new Uint8Array(buffer, 4 * (n * dimensions + 6 * m)).set(used.map(({ end }) => end));
  return new MeshData({
    points: n,
    triangles: m,
    dimensions,
    classes: Array.from({ length: largest }, (_, k) => [k + 1, k + 1]),
    worst: used.findIndex(({ size }) => size === Math.max(...used.map((path) => path.size))),
    total: small.triangles.length,
  }, buffer);
}

/**
 * Triangles each longer than the one before, up to a pair; and, with `open`, to the boundary.
 * @returns {Small}
 */
export function strip(open = false) {
  const points = [[0, 0], [0, 1], [1.2, 0], [-0.4, 1.4], [3, 1.2], [-3, 3], [1, 4]];
  const triangles = [[0, 2, 1], [2, 4, 1], [1, 4, 3], [3, 4, 5], [5, 4, 6]];
  return { points, triangles: open ? triangles.slice(0, 4) : triangles };
}

/**
 * Equilateral triangles: in space their coordinates are whole.
 * @param {number} k points a side
 * @returns {Small}
 */
export function lattice(k) {
  const points = [];
  const triangles = [];
  for (let a = 0; a < k; a++) {
    for (let b = 0; b < k; b++) {
      points.push([a, b - a, -b]);
      const corner = a * k + b;
      if (a === k - 1 || b === k - 1) continue;
      triangles.push([corner, corner + k, corner + k + 1], [corner, corner + k + 1, corner + 1]);
    }
  }
  return { points, triangles };
}

/**
 * Triangles about a point of which the two sides there are equal and the longest.
 * @returns {Small}
 */
export function fan() {
  const rim = [[5, 0], [4, 3], [3, 4], [0, 5], [-3, 4], [-4, 3], [-5, 0], [-4, -3], [-3, -4], [0, -5],
    [3, -4], [4, -3]];
  return {
    points: [[0, 0], ...rim],
    triangles: rim.map((_, k) => [0, k + 1, (k + 1) % rim.length + 1]),
  };
}

/**
 * A tetrahedron: closed, in space.
 * @returns {Small}
 */
export function tetrahedron() {
  return {
    points: [[0, 0, 0], [1, 0, 0], [0, 1.1, 0], [0, 0, 1.2]],
    triangles: [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
  };
}

/**
 * Points at random in the unit square, in triangles: each splits the one that it lies in.
 * @param {number} inside
 * @param {number} seed
 * @returns {Small}
 */
export function randomMesh(inside, seed) {
  const random = generator(seed);
  const points = [[0, 0], [1, 0.01], [1.02, 1], [-0.03, 0.98]];
  let triangles = [[0, 1, 2], [0, 2, 3]];
  for (let k = 0; k < inside; k++) {
    const point = [random(), 0.02 + 0.95 * random()];
    const hit = triangles.find((corners) => isInside(point, corners.map((p) => points[p])));
    if (!hit) continue;
    points.push(point);
    const [a, b, c] = hit;
    const p = points.length - 1;
    triangles = triangles.filter((corners) => corners !== hit);
    triangles.push([a, b, p], [b, c, p], [c, a, p]);
  }
  return { points, triangles };
}

/**
 * Numbers between 0 and 1, the same for the same seed.
 * @param {number} seed
 */
export function generator(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/**
 * @param {number[]} point
 * @param {number[][]} corners counter-clockwise
 */
export function isInside([x, y], corners) {
  return corners.every(([ax, ay], k) => {
    const [bx, by] = corners[(k + 1) % 3];
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0;
  });
}
