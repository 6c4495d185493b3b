#include "preproc/surface/simplification/vertices_beyond.hpp"

#include "quality/triangle_tree.hpp"

#include <algorithm>

namespace scan2fea {

std::vector<std::uint32_t> triangles_beyond(const SurfaceMesh& mesh, const DeviationBound& bound, double distance) {
  std::vector<Vec3> places;
  for (const OneSidedDeviation* side : {&bound.to_reference, &bound.to_mesh})
    for (std::size_t f = 0; f < side->upper.size(); ++f)
      if (side->upper[f] > distance) places.push_back(side->farthest[f]);
  std::vector<std::uint32_t> triangles;
  if (places.empty()) return triangles;
  const TriangleTree tree(mesh);
  for (const Vec3& p : places) triangles.push_back(tree.closest(p).triangle);
  std::ranges::sort(triangles);
  triangles.erase(std::ranges::unique(triangles).begin(), triangles.end());
  return triangles;
}

std::vector<std::uint32_t> vertices_beyond(const SurfaceMesh& mesh, const DeviationBound& bound, double distance) {
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t f : triangles_beyond(mesh, bound, distance))
    vertices.insert(vertices.end(), mesh.triangles[f].begin(), mesh.triangles[f].end());
  return vertices;
}

}  // namespace scan2fea
