#include "preproc/surface/reconstruction/local_plane.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace scan2fea {

LocalPlane fit_plane(std::span<const Vec3> points) {
  const auto count = static_cast<double>(points.size());
  LocalPlane plane;
  for (const Vec3& p : points) plane.centre += p;
  plane.centre /= count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) {
    const Vec3 way = p - plane.centre;
    covariance += way * way.transpose();
    plane.reach = std::max(plane.reach, way.norm());
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  plane.normal = solver.eigenvectors().col(0);
  plane.residual = std::sqrt(std::max(0.0, solver.eigenvalues()[0]) / count);
  return plane;
}

}  // namespace scan2fea
