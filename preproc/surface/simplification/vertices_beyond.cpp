#include "preproc/surface/simplification/vertices_beyond.hpp"

#include "quality/triangle_tree.hpp"

namespace scan2fea {

std::vector<std::uint32_t> vertices_beyond(const SurfaceMesh& mesh, const DeviationBound& bound, double distance) {
  std::vector<Vec3> places;
  for (const OneSidedDeviation* side : {&bound.to_reference, &bound.to_mesh})
    for (std::size_t f = 0; f < side->upper.size(); ++f)
      if (side->upper[f] > distance) places.push_back(side->farthest[f]);
  std::vector<std::uint32_t> vertices;
  if (places.empty()) return vertices;
  const TriangleTree tree(mesh);
  for (const Vec3& p : places) {
    const Triangle& t = mesh.triangles[tree.closest(p).triangle];
    vertices.insert(vertices.end(), t.begin(), t.end());
  }
  return vertices;
}

}  // namespace scan2fea
