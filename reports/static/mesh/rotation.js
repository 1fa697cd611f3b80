// Rotations of a surface in space. A matrix has nine numbers, row by row: the directions that lie
// to the right, upwards, and towards the reader.

/** @typedef {[number, number, number]} Vector */

/** @type {(u: ArrayLike<number>, v: ArrayLike<number>) => number} */
const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];

/** @type {(u: ArrayLike<number>, v: ArrayLike<number>) => Vector} */
const cross = (u, v) =>
  [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];

/** @type {(v: Vector) => Vector} */
function unit(v) {
  const length = Math.hypot(...v);
  return length ? [v[0] / length, v[1] / length, v[2] / length] : [0, 0, 1];
}

/**
 * A rotation turned further about an axis of the screen.
 * @param {number[]} matrix
 * @param {"x" | "y"} axis
 * @param {number} angle in radians
 */
function turnBy(matrix, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const [p, q] = { x: [1, 2], y: [2, 0] }[axis];
  const turned = [...matrix];
  for (let k = 0; k < 3; k++) {
    turned[3 * p + k] = c * matrix[3 * p + k] - s * matrix[3 * q + k];
    turned[3 * q + k] = s * matrix[3 * p + k] + c * matrix[3 * q + k];
  }
  return turned;
}

/**
 * The rotation that brings triangles of a surface to the front.
 * @param {MeshData} mesh
 * @param {number[]} triangles
 */
function facing(mesh, triangles) {
  const toward = [0, 0, 0];
  const middle = [0, 0, 0];
  for (const t of triangles) {
    const [a, b, c] = [...mesh.corners(t)].map((p) => mesh.points.subarray(3 * p, 3 * p + 3));
    const [u, v] = [b, c].map((end) => [end[0] - a[0], end[1] - a[1], end[2] - a[2]]);
    const normal = cross(u, v);
    const sign = dot(normal, toward) < 0 ? -1 : 1; // neighbours may be oriented differently
    for (let k = 0; k < 3; k++) {
      toward[k] += sign * normal[k];
      middle[k] += a[k];
    }
  }
  const outward = dot(toward, middle) < 0 ? -1 : 1;
  const [x, y, z] = unit([outward * toward[0], outward * toward[1], outward * toward[2]]);
  const front = unit([x + 0.25, y - 0.35, z + 0.2]); // not quite from above: the shape is seen
  const right = unit(cross(Math.abs(front[2]) < 0.98 ? [0, 0, 1] : [0, 1, 0], front));
  return [...right, ...cross(front, right), ...front];
}
