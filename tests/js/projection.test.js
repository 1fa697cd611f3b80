import assert from "node:assert/strict";
import test from "node:test";

import { load } from "./load.js";
import { generator, isInside, lattice, meshOf, randomMesh, strip, tetrahedron } from "./meshes.js";

const { Projection, LEVELS, packColor, rasterize } = load(
  ["mesh/rotation.js", "mesh/projection.js", "mesh/raster.js"],
  ["Projection", "LEVELS", "packColor", "rasterize"]);

/**
 * A mesh of which the whole is shown.
 * @param {import("./meshes.js").Small} small
 */
function shown(small, width = 400, height = 300) {
  const projection = new Projection(meshOf(small));
  projection.resize(width, height);
  return projection;
}

/**
 * @param {any} projection
 * @returns {number[][]}
 */
const places = (projection) => [...projection.x].map((x, p) => [x, projection.y[p]]);

/**
 * @param {number[][]} some
 * @param {number[][]} others
 */
function assertClose(some, others, within = 1e-3) {
  some.forEach((place, p) => place.forEach((x, k) =>
    assert.ok(Math.abs(x - others[p][k]) <= within, `${x} is not ${others[p][k]}`)));
}

test("the whole fits, in the middle, and touches the margin", () => {
  for (const [width, height] of [[400, 300], [100, 800]]) {
    const projection = shown(randomMesh(40, 2), width, height);
    const [left, right, top, bottom] = projection.bounds();
    const gaps = [left, width - right, top, height - bottom];
    assert.ok(Math.abs(gaps[0] - gaps[1]) < 1e-3 && Math.abs(gaps[2] - gaps[3]) < 1e-3);
    assert.ok(Math.abs(Math.min(...gaps) - 16) < 1e-3);
  }
});

test("what is above in the mesh is above on the screen", () => {
  const projection = shown({ points: [[0, 0], [1, 0], [0, 1]], triangles: [[0, 1, 2]] });
  assert.ok(projection.y[2] < projection.y[0]);
  assert.ok(projection.x[1] > projection.x[0]);
});

test("zooming keeps the point that it is about, and scales all others", () => {
  const random = generator(5);
  for (let k = 0; k < 50; k++) {
    const projection = shown(randomMesh(10, k));
    const p = Math.floor(random() * projection.mesh.n);
    const before = places(projection);
    const factor = 0.5 + 3 * random();
    projection.zoom(factor, ...before[p]);
    const about = before.map(([x, y]) =>
      [before[p][0] + factor * (x - before[p][0]), before[p][1] + factor * (y - before[p][1])]);
    assertClose(places(projection), about);
    assert.equal(projection.atWhole, false);
  }
});

test("zooming in and out again changes nothing, and neither limit can be passed", () => {
  const projection = shown(strip());
  const before = places(projection);
  projection.zoom(3, 20, 30);
  projection.zoom(1 / 3, 20, 30);
  assertClose(places(projection), before);
  projection.zoom(1e9, 20, 30);
  assert.equal(projection.view.scale, projection.fitted * 4000);
  projection.zoom(1e-9, 20, 30);
  assert.equal(projection.view.scale, projection.fitted / 4);
});

test("a drag takes every point along", () => {
  const projection = shown(strip());
  const before = places(projection);
  projection.zoom(1, 10, 20, 17, 11);
  assertClose(places(projection), before.map(([x, y]) => [x + 7, y - 9]));
});

test("triangles are brought to the middle, in their share of the screen", () => {
  const projection = shown(randomMesh(60, 7));
  projection.zoomTo([5, 6], 0.25);
  const [left, right, top, bottom] = projection.bounds([5, 6]);
  assert.ok(Math.abs((left + right) / 2 - 200) < 0.1 && Math.abs((top + bottom) / 2 - 150) < 0.1);
  assert.ok(Math.abs(Math.max((right - left) / 400, (bottom - top) / 300) - 0.25) < 1e-3);
  assert.equal(projection.extent([5, 6]), Math.max(right - left, bottom - top));
});

test("a triangle out of view is brought into view, one in view stays", () => {
  const projection = shown(randomMesh(60, 7));
  assert.equal(projection.reveal([3]), false);
  assert.equal(projection.inView(), projection.mesh.m);
  for (const [x, y] of [[5000, 0], [-5000, 0], [0, 5000], [0, -5000]]) {
    projection.zoom(1, 0, 0, x, y);
    assert.equal(projection.inView(), 0);
    assert.equal(projection.reveal([3]), true);
    const [left, right, top, bottom] = projection.bounds([3]);
    assert.ok(left >= 0 && right <= 400 && top >= 0 && bottom <= 300);
  }
});

test("another size of the screen keeps the whole whole, and the middle of a part", () => {
  const projection = shown(strip());
  projection.resize(200, 200);
  assert.deepEqual(places(projection), places(shown(strip(), 200, 200)));
  projection.zoomTo([2]);
  const before = projection.center(2);
  projection.resize(300, 260);
  assertClose([projection.center(2)], [[before[0] + 50, before[1] + 30]]);
});

test("turning keeps distances", () => {
  const projection = shown(tetrahedron());
  const lengths = () => [1, 2, 3].map((p) => Math.hypot(projection.x[p] - projection.x[0],
    projection.y[p] - projection.y[0], projection.view.scale * (projection.z[p] - projection.z[0])));
  const before = lengths();
  projection.turn(0.7, -0.4);
  assertClose([lengths()], [before]);
});

test("a point in a triangle hits it, in the plane", () => {
  const small = randomMesh(80, 4);
  const projection = shown(small);
  const random = generator(8);
  let beside = 0;
  for (let k = 0; k < 400; k++) {
    const [x, y] = [440 * random() - 20, 340 * random() - 20];
    const point = [(x - projection.view.x) / projection.view.scale, (projection.view.y - y) / projection.view.scale];
    const expected = small.triangles.findIndex((corners) => isInside(point, corners.map((p) => small.points[p])));
    beside += Number(expected < 0);
    assert.equal(projection.hit(x, y), expected);
  }
  assert.ok(beside > 20 && beside < 380);
});

test("of a surface the triangle in front is hit, whichever it is", () => {
  const fronts = new Set();
  for (let t = 0; t < 4; t++) {
    const small = tetrahedron();
    small.points = small.points.map((point) => point.map((x) => x - 0.3));
    const projection = shown(small);
    projection.face([t]);
    fronts.add(projection.hit(...projection.center(t)));
  }
  assert.deepEqual([...fronts].sort(), [0, 1, 2, 3]);
});

test("the order by depth has every triangle once, the back before the front", () => {
  const projection = shown(tetrahedron());
  projection.turn(0.3, 0.5);
  const depth = (/** @type {number} */ t) =>
    [...projection.mesh.corners(t)].reduce((sum, p) => sum + projection.z[p], 0);
  const order = [...projection.order()];
  assert.deepEqual([...order].sort(), [0, 1, 2, 3]);
  for (let k = 1; k < 4; k++) assert.ok(depth(order[k]) >= depth(order[k - 1]) - 1e-3);
});

test("a triangle seen from above has all the light, one seen from the side none", () => {
  const projection = shown({ points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], triangles: [[0, 1, 2], [0, 1, 3]] });
  assert.equal(projection.light(0, 1, 2), LEVELS - 1);
  assert.equal(projection.light(0, 1, 3), 0);
});

test("breadth is the height over the longest side", () => {
  const projection = shown({ points: [[0, 0], [5, 0], [1.8, 2.4]], triangles: [[0, 1, 2]] });
  assert.ok(Math.abs(projection.breadth(0) / projection.view.scale - 2.4) < 1e-5);
});

test("an arrow goes to the triangle beside that lies that way, if any does", () => {
  const projection = shown(randomMesh(60, 7));
  for (let t = 0; t < projection.mesh.m; t++) {
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      const [x, y] = projection.center(t);
      const along = projection.mesh.neighbors(t).map((/** @type {number} */ s) => {
        const [sx, sy] = projection.center(s);
        return [s, ((sx - x) * dx + (sy - y) * dy) / Math.hypot(sx - x, sy - y)];
      }).filter((/** @type {number[]} */ [, cosine]) => cosine > 0);
      along.sort((/** @type {number[]} */ [, p], /** @type {number[]} */ [, q]) => q - p);
      assert.equal(projection.toward(t, [dx, dy]), along[0]?.[0]);
    }
  }
});

test("colours are packed as a canvas keeps them, red first", () => {
  assert.deepEqual([...new Uint8Array(Uint32Array.of(packColor("rgb(1, 2, 254)")).buffer)], [1, 2, 254, 255]);
  assert.equal(packColor("rgb(255 255 255)"), 0xffffffff);
});

/** @type {[string, import("./meshes.js").Small, number][]} */
const RASTERED = [["plane", randomMesh(80, 4), 0], ["flat in space", lattice(3), 0.5],
  ["space", tetrahedron(), 0.5], ["the same from behind", tetrahedron(), 0.5 + Math.PI]];
for (const [name, small, aside] of RASTERED) {
  test(`every pixel has the colour of the triangle that its middle hits: ${name}`, () => {
    const projection = shown(small, 60, 40);
    if (projection.mesh.space) projection.turn(aside, 0.4);
    projection.mesh.shades = Uint8Array.from(small.triangles, (_, t) => t); // a colour each
    const colors = small.triangles.map((_, t) => Array(LEVELS).fill(t + 1));
    const pixels = rasterize(projection, colors, 120, 80, 2);
    let differ = 0;
    for (let row = 0; row < 80; row++) {
      for (let column = 0; column < 120; column++) {
        const hit = projection.hit((column + 0.5) / 2, (row + 0.5) / 2);
        differ += Number(pixels[120 * row + column] !== hit + 1);
      }
    }
    assert.ok(differ <= 5, `${differ} pixels differ`); // those whose middle is on an edge
  });
}
