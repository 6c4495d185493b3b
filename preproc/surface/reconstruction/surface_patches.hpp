// Triangles of one kind that hang together.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

struct SurfacePatch {
  std::vector<std::uint32_t> triangles;  // their numbers
  Vec3 place = Vec3::Zero();             // the middle of its bounding box
  double size = 0;                       // the diagonal of that
  double area = 0;
};

// The patches of the triangles that are marked, joined where they share an edge, largest first. O(n log n).
std::vector<SurfacePatch> find_patches(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                       const std::vector<bool>& is_marked);

}  // namespace scan2fea
