// The plane of a few points of a cloud.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <span>

namespace scan2fea {

struct LocalPlane {
  Vec3 centre = Vec3::Zero(), normal = Vec3::Zero();
  double residual = 0;  // RMS of the points
  double reach = 0;     // of the farthest of them from the centre
};

// By least squares. Precondition: a point.
LocalPlane fit_plane(std::span<const Vec3> points);

}  // namespace scan2fea
