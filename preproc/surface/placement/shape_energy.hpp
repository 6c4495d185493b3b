// How far triangles are from equilateral, with the derivatives that a Newton step wants.
//
// eta = (l1^2 + l2^2 + l3^2) / (4 sqrt(3) area) is 1 for the equilateral triangle and infinite for any degenerate one.
// The energy of a triangle is the entropy-weighted objective's term eta ln eta, which joins the level and the spread of
// the ratios of a star, plus a penalty that only the worse triangles feel:
//   F(eta) = eta ln eta + w max(0, eta - limit)^2.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <Eigen/Core>

namespace scan2fea {

struct ShapeEnergy {
  // Where the penalty on worse triangles begins; above 1. 1.04 is an edge ratio of about 1.3.
  double limit = 1.04;
  // Its weight. With 30 from 1.05 on the mean edge ratio is lower by 0.001, p99 higher by 0.04.
  double weight = 100;
};

struct Derivatives {
  double value = 0;
  Vec3 gradient = Vec3::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

// F of the triangle p, a, b and its derivatives by p. The Hessian is the closed form in the frame (along the edge ab,
// height over it, normal) with negative curvature along the normal dropped, so that it is positive semi-definite.
// Precondition: the triangle has an area.
Derivatives shape_energy(const ShapeEnergy& energy, const Vec3& p, const Vec3& a, const Vec3& b);

}  // namespace scan2fea
