// How coarse the coordinates of a scan are.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

namespace scan2fea {

// The step between neighbouring 32-bit floats at the coordinate farthest from 0, where all coordinates are such floats,
// as in any binary STL; else 0. Far from the origin, as where a site's coordinates are kept, it may be as large as a
// triangle: at 6 million it is half a unit. O(n).
double float_step(const std::vector<Vec3>& points);

}  // namespace scan2fea
