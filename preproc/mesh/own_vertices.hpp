// Some triangles of many as a mesh of their own.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// Vertices that the triangles use, renumbered in their order.
struct OwnVertices {
  std::vector<std::uint32_t> of_all;  // per own vertex
  SurfaceMesh mesh;
};
OwnVertices own_vertices(const std::vector<Vec3>& all, std::vector<Triangle> triangles);

}  // namespace scan2fea
