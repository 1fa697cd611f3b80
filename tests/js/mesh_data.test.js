import assert from "node:assert/strict";
import test from "node:test";

import { ascending, fan, lattice, meshOf, randomMesh, sidesByEdge, strip, tetrahedron } from "./meshes.js";

const MESHES = {
  strip: strip(), open: strip(true), lattice: lattice(5), fan: fan(), tetrahedron: tetrahedron(),
  random: randomMesh(60, 3),
};

test("a path grows along the strip, and ends in its pair or on the boundary", () => {
  const pair = meshOf(strip());
  assert.deepEqual(pair.path(0), { path: [0, 1, 2, 3, 4], end: "pair", edge: [4, 5] });
  assert.deepEqual(pair.path(4), { path: [4, 3], end: "pair", edge: [5, 4] });
  const open = meshOf(strip(true));
  assert.deepEqual(open.path(0), { path: [0, 1, 2, 3], end: "boundary", edge: [4, 5] });
  assert.deepEqual(open.path(3), { path: [3], end: "boundary", edge: [4, 5] });
});

for (const [name, small] of Object.entries(MESHES)) {
  test(`a path has as many triangles as its size says, across edges that they share: ${name}`, () => {
    const mesh = meshOf(small);
    const table = sidesByEdge(small.triangles);
    for (let t = 0; t < mesh.m; t++) {
      const { path, end, edge } = mesh.path(t);
      assert.equal(path.length, mesh.sizes[t]);
      assert.equal(new Set(path).size, path.length);
      for (const [k, s] of path.slice(1).entries()) assert.ok(mesh.neighbors(path[k]).includes(s));
      const beside = table.get([...edge].sort(ascending).join(" "))?.map(([s]) => s) ?? [];
      assert.equal(beside.length, end === "pair" ? 2 : 1);
      const last = end === "pair" ? path.slice(-2) : path.slice(-1);
      assert.deepEqual(beside.sort(ascending), last.sort(ascending));
    }
  });

  test(`neighbours are the triangles with a common edge: ${name}`, () => {
    const mesh = meshOf(small);
    const beside = small.triangles.map(() => /** @type {number[]} */ ([]));
    for (const sides of sidesByEdge(small.triangles).values()) {
      for (const [t] of sides) for (const [s] of sides) if (s !== t) beside[t].push(s);
    }
    for (let t = 0; t < mesh.m; t++) {
      assert.deepEqual(mesh.neighbors(t).sort(ascending), beside[t].sort(ascending));
    }
  });
}

test("beside a terminal edge, the two are not always each other's successors", () => {
  for (const small of [lattice(5), fan()]) {
    const mesh = meshOf(small);
    const oneWay = small.triangles.map((_, t) => mesh.path(t))
      .filter(({ path, end }) => end === "pair" && mesh.successors[path[path.length - 1]] !== path[path.length - 2]);
    assert.ok(oneWay.length > 0);
  }
});

test("a path that leaves what is drawn says so, and has no terminal edge", () => {
  const mesh = meshOf(strip(), [0, 1, 4]);
  assert.deepEqual(mesh.path(0), { path: [0, 1], end: "outside", edge: [] });
  assert.deepEqual(mesh.path(2), { path: [2], end: "outside", edge: [] });
  assert.deepEqual([mesh.placeOf(4), mesh.placeOf(3), mesh.placeOf(1.5), mesh.placeOf(9)], [2, -1, -1, -1]);
});

test("every size has its class, and classes have shades that ascend", () => {
  const mesh = meshOf(strip());
  assert.deepEqual([...mesh.shades], [...mesh.sizes].map((size) => size - 1));
  for (let n = 1; n <= 5; n++) {
    mesh.classes = Array.from({ length: n }, () => [1, 1]);
    const shades = mesh.classes.map((/** @type {any} */ _, /** @type {number} */ k) => mesh.shadeOf(k));
    assert.equal(new Set(shades).size, n);
    assert.deepEqual([...shades].sort(ascending), shades);
    if (n > 1) assert.deepEqual([shades[0], shades[n - 1]], [0, 4]);
  }
});
