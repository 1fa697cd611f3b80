// What the page says of a triangle and its path.

const MOST_NAMED = 12; // triangles of a path

/** @type {(number: number) => string} */
const grouped = (number) => number.toLocaleString("en");

/**
 * @param {MeshData} mesh
 * @param {number} t
 */
function pathSentence(mesh, t) {
  const { path, end } = mesh.path(t);
  const size = mesh.sizes[t];
  const name = grouped(mesh.numbers[t]);
  if (size === 1) return `Triangle ${name}: LEPP size 1. Its longest edge lies on the boundary.`;
  const names = path.map((s) => grouped(mesh.numbers[s]));
  const shown = names.length > MOST_NAMED
    ? [...names.slice(0, MOST_NAMED - 2), "…", names[names.length - 1]] : names;
  const ends = {
    pair: "It ends at an edge that is the longest of both triangles beside it.",
    boundary: "It ends at an edge of the boundary.",
    outside: "It goes on outside the part that is drawn.",
  }[end];
  return `Triangle ${name}: LEPP size ${grouped(size)}. The path goes ${shown.join(" → ")}. ${ends}`;
}

/**
 * Why the triangle with a number cannot be shown.
 * @param {MeshData} mesh
 * @param {string} text of the number, as the reader wrote it
 */
function absentSentence(mesh, text) {
  const number = text.trim() ? Number(text) : NaN;
  if (Number.isInteger(number) && number >= 0 && number < mesh.total) {
    return `Triangle ${grouped(number)} is not among the ${grouped(mesh.m)} that are drawn.`;
  }
  const none = text.trim() ? `There is no triangle ${text.trim()}.` : "No number was given.";
  return `${none} The mesh has ${grouped(mesh.total)} triangles, numbered from 0 to `
    + `${grouped(mesh.total - 1)}.`;
}
