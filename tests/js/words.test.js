import assert from "node:assert/strict";
import test from "node:test";

import { load } from "./load.js";
import { meshOf, strip } from "./meshes.js";

const { absentSentence, pathSentence } = load(["mesh/words.js"], ["absentSentence", "pathSentence"]);

test("a path is told from its first triangle to its end", () => {
  assert.equal(pathSentence(meshOf(strip()), 3),
    "Triangle 3: LEPP size 2. The path goes 3 → 4. It ends at an edge that is the longest of both "
    + "triangles beside it.");
  const open = meshOf(strip(true));
  assert.equal(pathSentence(open, 2),
    "Triangle 2: LEPP size 2. The path goes 2 → 3. It ends at an edge of the boundary.");
  assert.equal(pathSentence(open, 3), "Triangle 3: LEPP size 1. Its longest edge lies on the boundary.");
  assert.equal(pathSentence(meshOf(strip(), [0, 1]), 1),
    "Triangle 1: LEPP size 4. The path goes 1. It goes on outside the part that is drawn.");
});

test("of a long path the first ten are named, and the last", () => {
  const path = [...Array(40).keys()];
  const mesh = { path: () => ({ path, end: "pair" }), sizes: [1040], numbers: path };
  assert.match(pathSentence(mesh, 0), /LEPP size 1,040\. The path goes 0 → .* 8 → 9 → … → 39\. /);
});

test("what is not drawn is told from what does not exist", () => {
  const part = meshOf(strip(), [0, 1]);
  assert.equal(absentSentence(part, "4"), "Triangle 4 is not among the 2 that are drawn.");
  for (const asked of ["5", "-1", "1.5", "many"]) {
    assert.equal(absentSentence(part, asked),
      `There is no triangle ${asked}. The mesh has 5 triangles, numbered from 0 to 4.`);
  }
  assert.equal(absentSentence(part, " "), "No number was given. The mesh has 5 triangles, numbered from 0 to 4.");
});
