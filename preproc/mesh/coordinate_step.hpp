// How coarse the coordinates of a scan are, and whether its surface shows it.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <optional>

namespace scan2fea {

// The step between neighbouring values along each axis, at the coordinates farthest from 0; 0 where it is too fine to
// matter.
struct CoordinateStep {
  Vec3 length = Vec3::Zero();
  std::optional<int> digits;  // the decimal places that numbers were written with; unset: they are 32-bit floats
};

// Coordinates that are all 32-bit floats, as in any binary STL, have the steps of these: at 6 million half a unit.
// Otherwise, or where these are finer, they have those of the decimal digits with which text was written: 12.3, 0.456
// and 12 have three, and so a step of 0.1 at 12.3. Nothing where no step is above `least`, and none along an axis with
// fewer than ten values. O(n log n).
std::optional<CoordinateStep> coordinate_step(const std::vector<Vec3>& points, double least);

// The steps, where the surface shows them instead of the part: where at most of the edges that are neither flat nor
// creases one face is off the plane of the other by no more than a step, though a step tilts it by more than half a
// degree. Corners that equal one another must be one vertex. O(n).
std::optional<CoordinateStep> visible_coordinate_step(const SurfaceMesh& scan);

}  // namespace scan2fea
