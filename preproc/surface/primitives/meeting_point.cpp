#include "preproc/surface/primitives/meeting_point.hpp"

#include <Eigen/LU>

#include <cmath>

namespace scan2fea {

std::optional<Vec3> meeting_point(std::span<const Shape* const> shapes, const Vec3& start) {
  constexpr int most_steps = 20;
  constexpr double least_sine = 0.26;  // of 15 degrees
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3>;
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
  const auto count = static_cast<Eigen::Index>(shapes.size());
  Vec3 p = start;
  double last = HUGE_VAL;
  for (int step = 0; step < most_steps; ++step) {
    Rows normals(count, 3);
    Values distances(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      normals.row(i) = shapes[static_cast<std::size_t>(i)]->normal(p).transpose();
      distances[i] = shapes[static_cast<std::size_t>(i)]->signed_distance(p);
    }
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> products = normals * normals.transpose();
    if (!(products.determinant() > least_sine * least_sine * (count == 3 ? least_sine : 1))) return std::nullopt;
    const Vec3 move = -normals.transpose() * products.inverse() * distances;
    if (!move.allFinite()) return std::nullopt;
    p += move;
    const double length = move.norm();
    if (length <= 1e-12 * (1 + p.norm())) return p;
    if (step > 4 && length > 0.9 * last) return std::nullopt;  // it does not converge
    last = length;
  }
  return last < 1e-9 * (1 + p.norm()) ? std::optional(p) : std::nullopt;
}

}  // namespace scan2fea
