// The distance to the scan as a function of the vertices alone.
//
// A sample at barycentric (b_0, b_1, b_2) on a face with normal N, at signed distance r along N, is at distance
// r - sum b_i N.d_i once the corners have moved by d_i. Its square, summed over a face's samples, needs only the six
// second moments sum w b_i b_j and the three first moments sum w b_i r: a sweep over the vertices then costs the same
// however many samples the scan gives. Samples whose nearest point lies on an edge or vertex keep their distance vector
// (point to point) in moments of the same form.
#pragma once

#include "preproc/surface/kernel/locate.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace scan2fea {

// Symmetric 3 x 3 by corners, stored 00 11 22 01 12 20.
using CornerMoments = std::array<double, 6>;
inline constexpr std::size_t corner_pair(std::size_t i, std::size_t j) {
  return i == j ? i : i + j == 1 ? 3 : i + j == 3 ? 4 : 5;
}

struct FaceFit {
  Vec3 normal = Vec3::Zero();              // N when the moments were taken
  CornerMoments plane{};                   // sum w b_i b_j of samples against the plane
  std::array<double, 3> plane_residual{};  // sum w b_i r
  bool has_points = false;                 // whether the face's PointFit holds anything
};

// The same of clamped samples. Apart, since few faces have any and sweeps read the others' moments all the time.
struct PointFit {
  CornerMoments point{};
  std::array<Vec3, 3> residual{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

// Adds a sample at `at` with distance vector `to_target` (from its place on the face to where it should be).
inline void add_sample(FaceFit& fit, PointFit& points, const std::array<double, 3>& b, const Vec3& to_target,
                       double weight, bool clamped) {
  CornerMoments& second = clamped ? points.point : fit.plane;
  second[0] += weight * b[0] * b[0];
  second[1] += weight * b[1] * b[1];
  second[2] += weight * b[2] * b[2];
  second[3] += weight * b[0] * b[1];
  second[4] += weight * b[1] * b[2];
  second[5] += weight * b[2] * b[0];
  if (clamped) {
    fit.has_points = true;
    for (std::size_t i = 0; i < 3; ++i) points.residual[i] += weight * b[i] * to_target;
  } else {
    const double r = fit.normal.dot(to_target);
    for (std::size_t i = 0; i < 3; ++i) fit.plane_residual[i] += weight * b[i] * r;
  }
}

// Adds gradient and Hessian of sum w (distance)^2 by the position of corner i, the corners having moved by `moved`
// since the moments were taken.
inline void add_derivatives(const FaceFit& fit, const PointFit& points, std::size_t i, const std::array<Vec3, 3>& moved,
                            Vec3& gradient, Eigen::Matrix3d& hessian) {
  double along = -fit.plane_residual[i];
  for (std::size_t j = 0; j < 3; ++j) along += fit.plane[corner_pair(i, j)] * fit.normal.dot(moved[j]);
  gradient += 2 * along * fit.normal;
  hessian.noalias() += (2 * fit.plane[i]) * fit.normal * fit.normal.transpose();
  if (!fit.has_points) return;
  Vec3 pull = -points.residual[i];
  for (std::size_t j = 0; j < 3; ++j) pull += points.point[corner_pair(i, j)] * moved[j];
  gradient += 2 * pull;
  hessian.diagonal().array() += 2 * points.point[i];
}

// Sum w (distance)^2 once the corners have moved, less what it was when the moments were taken.
inline double change_of_fit(const FaceFit& fit, const PointFit& points, const std::array<Vec3, 3>& moved) {
  double change = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double along = fit.normal.dot(moved[i]);
    change -= 2 * along * fit.plane_residual[i];
    for (std::size_t j = 0; j < 3; ++j) change += fit.plane[corner_pair(i, j)] * along * fit.normal.dot(moved[j]);
    if (!fit.has_points) continue;
    change -= 2 * moved[i].dot(points.residual[i]);
    for (std::size_t j = 0; j < 3; ++j) change += points.point[corner_pair(i, j)] * moved[i].dot(moved[j]);
  }
  return change;
}

}  // namespace scan2fea
