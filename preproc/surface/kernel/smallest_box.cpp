#include "preproc/surface/kernel/smallest_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

// Of the points in each narrow cone about the middle the farthest, in units of the box: what sticks out is among them,
// or beside one.
std::vector<Vec3> farthest_in_cones(const std::vector<Vec3>& points) {
  constexpr int cells = 32;  // across each face of a cube about the middle
  const BoundingBox box = bounding_box(points);
  const Vec3 middle = (box.low + box.high) / 2;
  const Vec3 unit = (box.high - box.low).cwiseMax(std::numeric_limits<double>::min());
  std::vector<Vec3> farthest(6 * cells * cells, Vec3::Zero());
  for (const Vec3& point : points) {
    const Vec3 p = (point - middle).cwiseQuotient(unit);
    Eigen::Index axis = 0;
    const double height = p.cwiseAbs().maxCoeff(&axis);
    if (!(height > 0)) continue;
    const auto cell = [&](Eigen::Index across) {
      return std::min(static_cast<int>((p[across] / height + 1) / 2 * cells), cells - 1);
    };
    const int side = 2 * static_cast<int>(axis) + (p[axis] > 0 ? 1 : 0);
    Vec3& kept =
        farthest[static_cast<std::size_t>((side * cells + cell((axis + 1) % 3)) * cells + cell((axis + 2) % 3))];
    if (p.squaredNorm() > kept.squaredNorm()) kept = p;
  }
  std::erase_if(farthest, [](const Vec3& p) { return p == Vec3::Zero(); });
  for (Vec3& p : farthest) p = p.cwiseProduct(unit);
  return farthest;
}

double diagonal_along(const Eigen::Matrix3d& axes, const std::vector<Vec3>& points) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : points) {
    const Vec3 at = axes.transpose() * p;
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  return (high - low).norm();
}

}  // namespace

Eigen::Matrix3d smallest_box_axes(const std::vector<Vec3>& points) {
  constexpr double first_turn = 0.4, last_turn = 0.003;  // radians
  constexpr double worth_it = 1 - 1e-4;                  // of the diagonal; what lies along the axes stays there
  const std::vector<Vec3> outer = farthest_in_cones(points);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (outer.empty()) return axes;
  double diagonal = diagonal_along(axes, outer);
  for (double turn = first_turn; turn > last_turn;) {
    Eigen::Matrix3d best = axes;
    double smallest = diagonal;
    for (const double angle : {turn, -turn})
      for (int k = 0; k < 3; ++k) {
        const Eigen::Matrix3d turned = Eigen::AngleAxisd(angle, axes.col(k)) * axes;
        const double along = diagonal_along(turned, outer);
        if (along < worth_it * smallest) smallest = along, best = turned;
      }
    if (smallest < diagonal)
      diagonal = smallest, axes = best;
    else
      turn /= 2;
  }
  return axes;
}

}  // namespace scan2fea
