// The pages' scripts share one scope and export nothing: what is tested of them is taken from there.
import { readFileSync } from "node:fs";
import { compileFunction } from "node:vm";

/**
 * Run scripts of a page, in the page's order, and return some of the names that they define.
 * @param {string[]} scripts below reports/static
 * @param {string[]} names
 * @returns {Record<string, any>}
 */
export function load(scripts, names) {
  const texts = scripts.map((script) =>
    readFileSync(new URL(`../../reports/static/${script}`, import.meta.url), "utf8"));
  const code = `"use strict";\n${texts.join("")}\nreturn { ${names.join(", ")} };`;
  return compileFunction(code, [], { filename: scripts.join("+") })();
}
