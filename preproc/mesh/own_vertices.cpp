#include "preproc/mesh/own_vertices.hpp"

#include <limits>
#include <utility>

namespace scan2fea {

OwnVertices own_vertices(const std::vector<Vec3>& all, std::vector<Triangle> triangles) {
  constexpr auto unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(all.size(), unused);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) number[v] = 0;
  OwnVertices own;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    if (number[v] == unused) continue;
    number[v] = static_cast<std::uint32_t>(own.of_all.size());
    own.of_all.push_back(v);
    own.mesh.vertices.push_back(all[v]);
  }
  for (Triangle& t : triangles)
    for (std::uint32_t& v : t) v = number[v];
  own.mesh.triangles = std::move(triangles);
  return own;
}

}  // namespace scan2fea
