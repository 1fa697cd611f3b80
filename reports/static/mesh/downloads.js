// What a reader takes away: triangles and histograms as CSV, the drawing as PNG.

/**
 * The triangles that are drawn, a row each: number, LEPP size, the triangle across the longest edge
 * (empty where none is, or none is drawn), and what ends the path at that edge (empty where it goes on).
 * @param {MeshData} mesh
 */
function trianglesCsv({ m, numbers, sizes, successors, ends }) {
  const rows = ["triangle,lepp_size,next_triangle,ends_at"];
  for (let t = 0; t < m; t++) {
    const next = successors[t] < 0 ? "" : numbers[successors[t]];
    const end = ends[t] === 0 ? "" : ends[t] > 3 ? "pair" : "boundary";
    rows.push(`${numbers[t]},${sizes[t]},${next},${end}`);
  }
  return rows.join("\n") + "\n";
}

/**
 * A histogram, a row a size.
 * @param {string} header names of the two columns
 * @param {[number, number][]} counts a size, and how many have it
 */
function countsCsv(header, counts) {
  return [header, ...counts.map((pair) => pair.join(","))].join("\n") + "\n";
}
