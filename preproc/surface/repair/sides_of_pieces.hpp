// What lies on either side of the pieces into which a surface is cut where it crosses itself.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/arrangement.hpp"

#include <vector>

namespace scan2fea {

// How often the surface winds about points on either side of one of its faces; the same on both where nobody knows.
struct Sides {
  int outside = 0;  // where its normal points
  int inside = 0;
  bool first = true;  // of the faces that lie upon one another there
  bool operator==(const Sides&) const = default;
};

// Of each triangle of the arrangement the sides of its piece: the triangles that hang together with it across edges of
// two. `surface` is what was arranged; closed and oriented. O(n) for each piece.
std::vector<Sides> find_sides(const SurfaceMesh& surface, const Arrangement& arrangement);

// What is narrower than this cannot be told from rounding: lines that should meet in a point, or lie upon each other,
// meet in several points, and leave slivers between them.
double rounding_of(const SurfaceMesh& mesh);

}  // namespace scan2fea
