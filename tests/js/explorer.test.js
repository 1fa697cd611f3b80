import assert from "node:assert/strict";
import test from "node:test";

import { load } from "./load.js";

const { breadthOf, pathFrom, shadeOfSize } = load(["explorer.js"], ["breadthOf", "pathFrom", "shadeOfSize"]);

test("a path has as many triangles as its size says", () => {
  const chain = [
    { size: 4, successor: 1 }, { size: 3, successor: 2 }, { size: 2, successor: 3 }, { size: 2, successor: 2 },
    { size: 2, successor: 5 }, { size: 1, successor: null },
  ];
  assert.deepEqual(chain.map((_, k) => pathFrom(chain, k)),
    [[0, 1, 2, 3], [1, 2, 3], [2, 3], [3, 2], [4, 5], [5]]);
});

test("where edges are equal, the last triangle's successor is no part of the path", () => {
  const ring = [{ size: 2, successor: 1 }, { size: 2, successor: 2 }, { size: 2, successor: 0 }];
  assert.deepEqual(ring.map((_, k) => pathFrom(ring, k)), [[0, 1], [1, 2], [2, 0]]);
});

test("shades ascend with the size, and use the whole scale where there is enough to show", () => {
  for (let largest = 1; largest <= 40; largest++) {
    const shades = Array.from({ length: largest }, (_, k) => shadeOfSize(k + 1, largest));
    assert.deepEqual([...shades].sort((p, q) => p - q), shades);
    assert.equal(shades[0], 0);
    assert.equal(shades[largest - 1], Math.min(largest - 1, 4));
  }
});

test("breadth is the height over the longest side", () => {
  for (const corners of [[[0, 0], [5, 0], [1.8, 2.4]], [[5, 0], [1.8, 2.4], [0, 0]], [[1.8, 2.4], [0, 0], [5, 0]]]) {
    assert.ok(Math.abs(breadthOf(corners) - 2.4) < 1e-12);
  }
});
