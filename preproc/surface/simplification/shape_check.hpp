// Where a surface's triangles are badly shaped, or would make bad tetrahedra, and by how much shorter the edges there
// would have to be.
#pragma once

#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/simplification/surface_candidate.hpp"
#include "preproc/surface/sizing/shorter_edges.hpp"

#include <algorithm>
#include <vector>

namespace scan2fea {

struct ShapeDefects {
  double least_angle_deg = 180;      // but for corners between two creases
  std::vector<ShorterEdges> bad;     // around what is bad, as shorter as it is worse
  double sharpest_corner_deg = 180;  // between two creases
  std::vector<SharpCorner> sharp_corners;

  bool empty() const { return bad.empty() && sharp_corners.empty(); }
  double sharpest() const { return std::min(least_angle_deg, sharpest_corner_deg); }
};

// What counts as bad.
struct ShapeLimits {
  double least_angle_deg = 30;  // of triangles, and of half of a fold
  bool walls = true;            // elements across them, below 25 degrees, or `least_angle_deg` if that is less
};

// Corners between two creases are bad only below 19 degrees, or `least_angle_deg`. O(n); with walls O(n log n), three
// searches a triangle.
ShapeDefects find_shape_defects(const Candidate& candidate, const ShapeLimits& limits);

}  // namespace scan2fea
