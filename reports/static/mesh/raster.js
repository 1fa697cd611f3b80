// Many small triangles, pixel by pixel.

/**
 * A colour as the number that a canvas keeps for it.
 * @param {string} color "rgb(1, 2, 3)", as the browser computes it
 */
function packColor(color) {
  const [r, g, b] = (color.match(/[\d.]+/g) ?? []).map(Number);
  return (255 << 24 | b << 16 | g << 8 | r) >>> 0;
}

/**
 * Give every pixel the colour of the triangle at its middle, in space of the one in front.
 * @param {Projection} projection
 * @param {number[][]} colors packed, by class and level of light; in the plane one level each
 * @param {number} width of the canvas, in its own pixels
 * @param {number} height
 * @param {number} ratio of these pixels to the screen's
 * @returns {Uint32Array<ArrayBuffer>} 0 beside the mesh
 */
function rasterize(projection, colors, width, height, ratio) {
  const { mesh, x, y, z } = projection;
  const pixels = new Uint32Array(width * height);
  const depth = mesh.space ? new Float32Array(width * height).fill(-Infinity) : null;
  for (let t = 0; t < mesh.m; t++) {
    const a = mesh.triangles[3 * t], b = mesh.triangles[3 * t + 1], c = mesh.triangles[3 * t + 2];
    if (projection.isOutside(a, b, c)) continue;
    const ax = ratio * x[a], ay = ratio * y[a], bx = ratio * x[b], by = ratio * y[b];
    const cx = ratio * x[c], cy = ratio * y[c];
    const double = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (double === 0) continue;
    const color = colors[mesh.shades[t]][depth ? projection.light(a, b, c) : 0];
    const left = Math.max(0, Math.floor(Math.min(ax, bx, cx)));
    const right = Math.min(width - 1, Math.max(ax, bx, cx));
    const top = Math.max(0, Math.floor(Math.min(ay, by, cy)));
    const bottom = Math.min(height - 1, Math.max(ay, by, cy));
    for (let row = top; row <= bottom; row++) {
      const py = row + 0.5;
      for (let column = left; column <= right; column++) {
        const px = column + 0.5;
        const u = ((bx - px) * (cy - py) - (by - py) * (cx - px)) / double;
        const v = ((cx - px) * (ay - py) - (cy - py) * (ax - px)) / double;
        const w = 1 - u - v;
        if (u < 0 || v < 0 || w < 0) continue;
        const pixel = row * width + column;
        if (depth) {
          const near = u * z[a] + v * z[b] + w * z[c];
          if (near < depth[pixel]) continue;
          depth[pixel] = near;
        }
        pixels[pixel] = color;
      }
    }
  }
  return pixels;
}
