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

// Bad are triangles with angles below 30 degrees, folds whose half is sharper, and walls across which elements would
// have less than 25, where `with_walls`; corners between two creases only below 19. O(n); with walls O(n log n), three
// searches a triangle.
ShapeDefects find_shape_defects(const Candidate& candidate, bool with_walls);

}  // namespace scan2fea
