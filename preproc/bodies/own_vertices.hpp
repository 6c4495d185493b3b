// Some triangles of many as a mesh of their own.
#pragma once

#include "preproc/bodies/body_complex.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// Vertices that the triangles use, renumbered in their order.
struct OwnVertices {
  std::vector<std::uint32_t> of_all;  // per own vertex
  SurfaceMesh mesh;
};
OwnVertices own_vertices(const std::vector<Vec3>& all, std::vector<Triangle> triangles);

// The closed surface of one body, turned outwards.
inline OwnVertices surface_of_body(const BodyComplex& complex, std::uint32_t body) {
  return own_vertices(complex.mesh.vertices, triangles_of_body(complex, body));
}

}  // namespace scan2fea
