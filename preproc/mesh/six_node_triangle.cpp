#include "preproc/mesh/six_node_triangle.hpp"

#include <cmath>

namespace scan2fea {

std::array<double, 6> shape_functions(const std::array<double, 3>& b) {
  return {b[0] * (2 * b[0] - 1), b[1] * (2 * b[1] - 1), b[2] * (2 * b[2] - 1),
          4 * b[0] * b[1],       4 * b[1] * b[2],       4 * b[2] * b[0]};
}

Vec3 point_on(const SixNodeTriangle& x, const std::array<double, 3>& barycentric) {
  const std::array<double, 6> share = shape_functions(barycentric);
  Vec3 p = Vec3::Zero();
  for (std::size_t i = 0; i < 6; ++i) p += share[i] * x[i];
  return p;
}

std::array<Vec3, 2> tangents(const SixNodeTriangle& x, const std::array<double, 3>& b) {
  const Vec3 by_first = (4 * b[0] - 1) * x[0] + 4 * b[1] * x[3] + 4 * b[2] * x[5];
  const Vec3 by_second = (4 * b[1] - 1) * x[1] + 4 * b[0] * x[3] + 4 * b[2] * x[4];
  const Vec3 by_third = (4 * b[2] - 1) * x[2] + 4 * b[1] * x[4] + 4 * b[0] * x[5];
  return {by_second - by_first, by_third - by_first};
}

double curved_area(const SixNodeTriangle& x) {
  // Radon's rule: the centre, and three points on each of two triangles.
  const double root = std::sqrt(15.0), near = (6 - root) / 21, far = (6 + root) / 21;
  const auto at = [&](double u, double v) {
    const auto [by_second, by_third] = tangents(x, {1 - u - v, u, v});
    return by_second.cross(by_third).norm();
  };
  const auto around = [&](double a) { return at(a, a) + at(1 - 2 * a, a) + at(a, 1 - 2 * a); };
  return (0.225 * at(1.0 / 3, 1.0 / 3) + (155 - root) / 1200 * around(near) + (155 + root) / 1200 * around(far)) / 2;
}

}  // namespace scan2fea
