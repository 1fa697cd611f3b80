import assert from "node:assert/strict";
import test from "node:test";

import { load } from "./load.js";
import { meshOf, strip } from "./meshes.js";

const { countsCsv, trianglesCsv } = load(["mesh/downloads.js"], ["countsCsv", "trianglesCsv"]);

test("triangles are saved with what follows them, and what ends them", () => {
  assert.equal(trianglesCsv(meshOf(strip())),
    "triangle,lepp_size,next_triangle,ends_at\n0,5,1,\n1,4,2,\n2,3,3,\n3,2,4,pair\n4,2,3,pair\n");
  assert.match(trianglesCsv(meshOf(strip(true))), /\n2,2,3,\n3,1,,boundary\n/);
});

test("of a part, what follows outside is left empty, and triangles keep their numbers", () => {
  assert.equal(trianglesCsv(meshOf(strip(), [1, 3])),
    "triangle,lepp_size,next_triangle,ends_at\n1,4,,\n3,2,,pair\n");
});

test("a histogram is saved size by size", () => {
  assert.equal(countsCsv("lepp_size,triangles", [[1, 3], [7, 2]]), "lepp_size,triangles\n1,3\n7,2\n");
});
