// Where a plane goes through tetrahedra: a triangle or a quadrangle in each.

// `plane`: [x, y, z, w]; what has x*px + y*py + z*pz > w is cut away. Returns the corners of triangles, the tetrahedron
// of each, and the ends of the polygons' sides.
export function section(points, tetrahedra, plane) {
  const corners = [], owner = [], sides = [];
  const n = tetrahedra.length / 4, height = new Float32Array(points.length / 3);
  for (let v = 0; v < height.length; ++v)
    height[v] = plane[0] * points[3 * v] + plane[1] * points[3 * v + 1] + plane[2] * points[3 * v + 2] - plane[3];
  const between = (a, b) => {
    const t = height[a] / (height[a] - height[b]);
    return [0, 1, 2].map((k) => points[3 * a + k] + t * (points[3 * b + k] - points[3 * a + k]));
  };
  for (let e = 0; e < n; ++e) {
    const above = [], below = [];
    for (let c = 0; c < 4; ++c) {
      const v = tetrahedra[4 * e + c];
      (height[v] > 0 ? above : below).push(v);
    }
    if (above.length === 0 || below.length === 0) continue;
    const polygon = above.length === 2
      ? [[0, 0], [0, 1], [1, 1], [1, 0]].map(([i, j]) => between(above[i], below[j]))
      : above.length === 1 ? below.map((b) => between(above[0], b)) : above.map((a) => between(a, below[0]));
    for (let k = 2; k < polygon.length; ++k) {
      corners.push(...polygon[0], ...polygon[k - 1], ...polygon[k]);
      owner.push(e);
    }
    polygon.forEach((p, k) => sides.push(...p, ...polygon[(k + 1) % polygon.length]));
  }
  return { corners: new Float32Array(corners), owner, sides: new Float32Array(sides) };
}
