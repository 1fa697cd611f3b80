import assert from "node:assert/strict";
import test from "node:test";

import { load } from "./load.js";

const { fileNameOf, heightAt } = load(["figures.js", "figure_downloads.js"], ["fileNameOf", "heightAt"]);

test("a file is named by the figure and what the switches say", () => {
  assert.equal(fileNameOf("figure-pairs", ["bivariate_normal", "incremental"], "svg"),
    "lepp-figure-pairs-bivariate-normal-incremental.svg");
  assert.equal(fileNameOf("figure-points", [], "png"), "lepp-figure-points.png");
});

test("a plot whose panels keep their shape is lower on a narrow screen", () => {
  assert.equal(heightAt({ height: 700, meta: { ratio: 1.2 } }, 300), 360);
  assert.equal(heightAt({ height: 700, meta: { ratio: 1.2 } }, 1000), 700);
  assert.equal(heightAt({ height: 380 }, 300), 380);
});
