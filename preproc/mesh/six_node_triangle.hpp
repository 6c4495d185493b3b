// A triangle of second order.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <array>

namespace scan2fea {

// Corners, then the nodes between 12, 23 and 31.
using SixNodeTriangle = std::array<Vec3, 6>;

// The position at barycentric coordinates is the sum of N_i x_i.
std::array<double, 6> shape_functions(const std::array<double, 3>& barycentric);
Vec3 point_on(const SixNodeTriangle& x, const std::array<double, 3>& barycentric);

// Derivatives of the position by the second and the third barycentric coordinate, the first being the rest. Their cross
// product is as long as the map stretches areas.
std::array<Vec3, 2> tangents(const SixNodeTriangle& x, const std::array<double, 3>& barycentric);

// By a rule of degree five, exact to about the fourth power of the bend.
double curved_area(const SixNodeTriangle& x);

}  // namespace scan2fea
