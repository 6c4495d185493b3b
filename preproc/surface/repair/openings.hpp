// Where a scan leaks: the openings that keep it from bounding a volume.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <vector>

namespace scan2fea {

struct Opening {
  std::vector<Vec3> border;   // a closed line: the last point joins the first
  double length = 0;          // of that line
  double size = 0;            // the diagonal of its bounding box
  Vec3 place = Vec3::Zero();  // the centre of that box
};

// The openings that are left when borders that meet are joined and debris is dropped, as the repair does with its
// default options before it closes holes; the largest first. Empty where the scan bounds a volume. O(n log n).
std::vector<Opening> find_openings(const SurfaceMesh& scan);

}  // namespace scan2fea
