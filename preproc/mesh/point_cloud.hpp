// What a scanner measured before anything joined the points to a surface.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <vector>

namespace scan2fea {

struct PointCloud {
  std::vector<Vec3> points;  // model units, all finite
  std::vector<Vec3>
      normals;  // of unit length, or zero where unknown, outwards if the file is right; one a point or none
  std::vector<Vec3> scanners;  // where the scanner stood: one a point, not finite where unknown, one for all, or none
  std::size_t left_out = 0;    // what the file itself marks as no measurement: no return, withheld, noise
};

}  // namespace scan2fea
