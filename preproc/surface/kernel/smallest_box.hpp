// A small box around a part, however it lies.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <vector>

namespace scan2fea {

// Axes, as columns, along which the diagonal of the points' box is the smallest: the identity where no turn makes it
// shorter. Found by turning the axes while the diagonal gets shorter, from the given ones; the diagonal is right to
// some 0.2 %. Linear. Not guaranteed: that no other turn gives a smaller one.
Eigen::Matrix3d smallest_box_axes(const std::vector<Vec3>& points);

}  // namespace scan2fea
