import assert from "node:assert/strict";
import test from "node:test";

import { load } from "./load.js";

const { clicked, matching, sorted } = load(["data.js", "tables.js"], ["clicked", "matching", "sorted"]);
/** @param {{ raw: string[] }} column */
const rowsOf = ({ raw }) => [...raw.keys()];

test("numbers are sorted by value, not by their text, and empty cells come last", () => {
  const column = { name: "x", number: true, raw: ["10", "9", "", "-inf", "1e-30", "inf", "9"] };
  assert.deepEqual(sorted(rowsOf(column), column, false), [3, 4, 1, 6, 0, 5, 2]);
  assert.deepEqual(sorted(rowsOf(column), column, true), [5, 0, 1, 6, 4, 3, 2]);
});

test("what is shown does not decide the order", () => {
  const column = { name: "p", number: true, raw: ["-40.2", "-3.5"], shown: ["6.3 × 10⁻⁴¹", "3.2 × 10⁻⁴"] };
  assert.deepEqual(sorted([1, 0], column, false), [0, 1]);
});

test("words are sorted by the alphabet, whatever their capitals, and numbers in them by value", () => {
  const column = { name: "w", raw: ["Table 10", "table 2", "figure 5", ""] };
  assert.deepEqual(sorted(rowsOf(column), column, false), [2, 1, 0, 3]);
  assert.deepEqual(rowsOf(column), [0, 1, 2, 3]);
});

test("a heading is clicked three times: up, down, and as it was", () => {
  let arrangement = { column: null, descending: false, filter: "a" };
  arrangement = clicked(arrangement, "x");
  assert.deepEqual(arrangement, { column: "x", descending: false, filter: "a" });
  arrangement = clicked(arrangement, "x");
  assert.deepEqual(arrangement, { column: "x", descending: true, filter: "a" });
  assert.deepEqual(clicked(arrangement, "y"), { column: "y", descending: false, filter: "a" });
  assert.deepEqual(clicked(arrangement, "x"), { column: null, descending: false, filter: "a" });
});

test("a filter finds what is shown, as one types it, every word in any cell", () => {
  const columns = [
    { name: "v", raw: ["agrees", "differs", "not run"] },
    { name: "x", number: true, raw: ["-1.5", "2.25", ""], shown: ["−1.50", "2.25\u00a0%", "–"] },
  ];
  assert.deepEqual(matching([0, 1, 2], columns, "-1.50"), [0]);
  assert.deepEqual(matching([0, 1, 2], columns, " DIFFERS 2.25 % "), [1]);
  assert.deepEqual(matching([0, 1, 2], columns, "agrees 2.25"), []);
  assert.deepEqual(matching([2, 0], columns, "  "), [2, 0]);
});
