import assert from "node:assert/strict";
import test from "node:test";

import { load } from "./load.js";

const { placeBeside } = load(["glossary.js"], ["placeBeside"]);
const ROOM = { width: 390, height: 800 };
const BOX = { width: 300, height: 100 };

test("a definition stands below its term", () => {
  assert.deepEqual(placeBeside({ left: 40, top: 100, bottom: 120 }, BOX, ROOM), { left: 40, top: 128 });
});

test("it never leaves the window at a side", () => {
  assert.equal(placeBeside({ left: 350, top: 100, bottom: 120 }, BOX, ROOM).left, 82);
  assert.equal(placeBeside({ left: 2, top: 100, bottom: 120 }, BOX, ROOM).left, 8);
});

test("it stands above where there is no room below, if there is room above", () => {
  assert.equal(placeBeside({ left: 40, top: 750, bottom: 770 }, BOX, ROOM).top, 642);
  assert.equal(placeBeside({ left: 40, top: 60, bottom: 770 }, BOX, ROOM).top, 778);
});
