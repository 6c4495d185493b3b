// What a triangle covers of the view from a point: the sum over a closed surface tells inside from outside.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cmath>
#include <numbers>

namespace scan2fea {

// As a part of the whole sphere, positive where the triangle is seen from behind: the winding number of a surface about
// a point is the sum over its triangles, 1 inside of a closed one that faces outwards and 0 outside. Van Oosterom and
// Strackee, "The Solid Angle of a Plane Triangle" (1983). In the triangle's own plane the sign is that of rounding.
inline double winding_of_triangle(const SurfaceMesh& mesh, const Triangle& t, const Vec3& p) {
  const Vec3 a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p, c = mesh.vertices[t[2]] - p;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb) /
         (2 * std::numbers::pi);
}

}  // namespace scan2fea
