// What a triangle covers of the view from a point: the sum over a closed surface tells inside from outside.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cmath>
#include <numbers>

namespace scan2fea {

// Of the triangle of these corners, seen from the origin, in steradians; positive where it is seen from behind. Van
// Oosterom and Strackee, "The Solid Angle of a Plane Triangle" (1983). In the triangle's own plane the sign is that of
// rounding.
inline double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

// As a part of the whole sphere: the winding number of a surface about a point is the sum over its triangles, 1 inside
// of a closed one that faces outwards and 0 outside.
inline double winding_of_triangle(const SurfaceMesh& mesh, const Triangle& t, const Vec3& p) {
  return solid_angle(mesh.vertices[t[0]] - p, mesh.vertices[t[1]] - p, mesh.vertices[t[2]] - p) /
         (4 * std::numbers::pi);
}

}  // namespace scan2fea
