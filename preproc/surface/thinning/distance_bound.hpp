// How far a triangle is from a surface, at most.
#pragma once

#include "quality/triangle_tree.hpp"

#include <array>

namespace scan2fea {

// Such that no point of the triangle, which may be an edge or a point, is farther: at most `enough`, or else within
// twice `resolution` of the distance of its farthest point. A piece's bound is its centre's distance and its radius;
// pieces for which that is too much are halved.
double bound_of_distance(const std::array<Vec3, 3>& corners, const TriangleTree& surface, double enough,
                         double resolution);

}  // namespace scan2fea
