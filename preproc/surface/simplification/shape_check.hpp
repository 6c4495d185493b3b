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

// Bad are triangles and halves of folds below `least_angle_deg`; corners between two creases only below 19 degrees, and
// elements across walls below 25, or `least_angle_deg` if that is less. O(n log n), three searches a triangle.
ShapeDefects find_shape_defects(const Candidate& candidate, double least_angle_deg);

// Whether a part came out far from where it was. The bound is above that of the default job.
bool is_far(const Candidate& candidate);

// What isotropic remeshing reaches on parts, and more.
bool is_ill_shaped(const Candidate& candidate);

// The smallest angle but for those between two creases, with where those below the limit are.
double smallest_angle_beside_creases_deg(const Candidate& candidate, double limit_deg, std::vector<Vec3>& below);

}  // namespace scan2fea
