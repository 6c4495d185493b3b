// The refined scan as it was before it was cut along its features.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace scan2fea {

// `welded`: per vertex of `cut`, the vertex that it is a copy of. Faces keep their order.
inline SurfaceMesh welded_scan(const SurfaceMesh& cut, const std::vector<std::uint32_t>& welded) {
  SurfaceMesh mesh;
  mesh.vertices.resize(*std::max_element(welded.begin(), welded.end()) + std::size_t{1});
  for (std::size_t i = 0; i < welded.size(); ++i) mesh.vertices[welded[i]] = cut.vertices[i];
  mesh.triangles = cut.triangles;
  for (Triangle& t : mesh.triangles) t = {welded[t[0]], welded[t[1]], welded[t[2]]};
  return mesh;
}

}  // namespace scan2fea
