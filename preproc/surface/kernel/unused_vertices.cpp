#include "preproc/surface/kernel/unused_vertices.hpp"

#include <algorithm>
#include <cstdint>

namespace scan2fea {

std::vector<Vec3> drop_unused_vertices(SurfaceMesh& mesh) {
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) used[v] = 1;
  if (std::find(used.begin(), used.end(), 0) == used.end()) return {};
  std::vector<std::uint32_t> new_index(mesh.vertices.size());
  std::vector<Vec3> unused;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!used[v]) {
      unused.push_back(mesh.vertices[v]);
      continue;
    }
    new_index[v] = kept;
    mesh.vertices[kept++] = mesh.vertices[v];
  }
  mesh.vertices.resize(kept);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = new_index[v];
  return unused;
}

}  // namespace scan2fea
