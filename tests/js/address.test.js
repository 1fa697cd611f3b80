import assert from "node:assert/strict";
import test from "node:test";

import { load } from "./load.js";

const { readAddress, writeAddress } = load(["address.js"], ["readAddress", "writeAddress"]);
const NAMES = ["method", "distribution"];
const CHOICES = { method: ["incremental"], distribution: ["uniform", "normal"] };
const VIEW = { method: "incremental", distribution: "normal" };

test("a place stands alone or beside the view", () => {
  assert.deepEqual(readAddress("#figure-models", NAMES), { asked: {}, place: "figure-models" });
  assert.deepEqual(readAddress("#distribution=normal&section=theory", NAMES),
    { asked: { distribution: "normal" }, place: "theory" });
  assert.deepEqual(readAddress("#theory&method=delaunay", NAMES),
    { asked: { method: "delaunay" }, place: "theory" });
  assert.deepEqual(readAddress("", NAMES), { asked: {}, place: null });
  assert.deepEqual(readAddress("#other=1", NAMES), { asked: {}, place: null });
});

test("an address names what there is a choice of", () => {
  assert.equal(writeAddress(VIEW, CHOICES), "#distribution=normal");
  assert.equal(writeAddress(VIEW, CHOICES, "theory"), "#distribution=normal&section=theory");
  assert.equal(writeAddress(VIEW, { method: ["incremental"], distribution: ["normal"] }, "theory"), "#theory");
});

test("what is written is read back", () => {
  for (const place of ["theory", "figure-models"]) {
    assert.deepEqual(readAddress(writeAddress(VIEW, CHOICES, place), NAMES),
      { asked: { distribution: "normal" }, place });
  }
});
