import assert from "node:assert/strict";
import test from "node:test";

import { load } from "./load.js";
import { generator, meshOf, tetrahedron } from "./meshes.js";

const { cross, dot, facing, turnBy, unit } = load(["mesh/rotation.js"], ["cross", "dot", "facing", "turnBy", "unit"]);

/** @param {number[]} matrix */
function assertRotation(matrix) {
  const [right, up, front] = [0, 3, 6].map((k) => matrix.slice(k, k + 3));
  for (const [u, v, product] of /** @type {[number[], number[], number][]} */ ([
    [right, right, 1], [up, up, 1], [front, front, 1], [right, up, 0], [up, front, 0], [front, right, 0],
  ])) assert.ok(Math.abs(dot(u, v) - product) < 1e-12);
  assert.ok(dot(cross(right, up), front) > 0); // and not a reflection
}

test("turning keeps a rotation a rotation", () => {
  const random = generator(1);
  let matrix = [1, 0, 0, 0, 1, 0, 0, 0, 1];
  for (let k = 0; k < 500; k++) {
    matrix = turnBy(matrix, k % 2 ? "x" : "y", 6 * random() - 3);
    assertRotation(matrix);
  }
});

test("turning back undoes turning", () => {
  const matrix = turnBy([1, 0, 0, 0, 1, 0, 0, 0, 1], "x", 0.4);
  for (const axis of ["x", "y"]) {
    const back = turnBy(turnBy(matrix, axis, 0.7), axis, -0.7);
    back.forEach((/** @type {number} */ x, /** @type {number} */ k) => assert.ok(Math.abs(x - matrix[k]) < 1e-15));
  }
});

test("to turn aside brings what is in front to the right, downwards below", () => {
  const start = [1, 0, 0, 0, 1, 0, 0, 0, 1];
  const front = [0, 0, 1];
  assert.ok(dot(turnBy(start, "y", 0.1).slice(0, 3), front) > 0.09);
  assert.ok(dot(turnBy(start, "x", 0.1).slice(3, 6), front) < -0.09);
});

test("every side of a tetrahedron can be brought to the front, whichever way it is oriented", () => {
  const { points: corner, triangles } = tetrahedron();
  const points = corner.map((point) => point.map((x) => x - 0.3)); // about the middle
  const outward = meshOf({ points, triangles });
  const inward = meshOf({ points, triangles: triangles.map(([a, b, c]) => [a, c, b]) });
  for (const [t, mesh] of [0, 1, 2, 3].flatMap((side) => [[side, outward], [side, inward]])) {
    const matrix = facing(mesh, [t]);
    assertRotation(matrix);
    const depth = (/** @type {number[]} */ point) => dot(matrix.slice(6), point);
    const corners = [...mesh.corners(t)];
    const others = [0, 1, 2, 3].filter((p) => !corners.includes(p));
    const middle = corners.reduce((sum, p) => sum + depth(points[p]), 0) / 3;
    assert.ok(others.every((p) => depth(points[p]) < middle));
  }
});

test("a vector without a length has a direction all the same", () => {
  assert.deepEqual(unit([0, 0, 0]), [0, 0, 1]);
  assert.deepEqual(unit([0, 3, 4]), [0, 0.6, 0.8]);
});
