#include "preproc/surface/placement/shape_energy.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {

Derivatives shape_energy(const ShapeEnergy& energy, const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double length = edge.norm();
  const Vec3 along = edge / length;
  const Vec3 from_middle = p - 0.5 * (a + b);
  const double u = from_middle.dot(along);
  const Vec3 upwards = from_middle - u * along;
  const double h = upwards.norm();
  const Vec3 up = upwards / h;

  // eta(u, h) = (3/4 l^2 + u^2 + h^2) / (sqrt(3) l h)
  const double c = 1 / (std::numbers::sqrt3 * length * h);
  const double base = 0.75 * length * length + u * u;
  const double eta = (base + h * h) * c;
  const double eta_u = 2 * u * c;
  const double eta_h = (h * h - base) * c / h;
  const double eta_uu = 2 * c;
  const double eta_uh = -2 * u * c / h;
  const double eta_hh = 2 * base * c / (h * h);

  const double log_eta = std::log(eta);
  const double over = std::max(0.0, eta - energy.limit);
  const double first = log_eta + 1 + 2 * energy.weight * over;
  const double second = 1 / eta + (over > 0 ? 2 * energy.weight : 0.0);

  Derivatives d;
  d.value = eta * log_eta + energy.weight * over * over;
  d.gradient = first * (eta_u * along + eta_h * up);
  const double uu = second * eta_u * eta_u + first * eta_uu;
  const double uh = second * eta_u * eta_h + first * eta_uh;
  const double hh = second * eta_h * eta_h + first * eta_hh;
  const Vec3 of_along = uu * along + uh * up;
  const Vec3 of_up = uh * along + hh * up;
  d.hessian.noalias() = of_along * along.transpose();
  d.hessian.noalias() += of_up * up.transpose();
  if (eta_h > 0) {
    const Vec3 normal = along.cross(up);
    d.hessian.noalias() += (first * eta_h / h) * normal * normal.transpose();
  }
  return d;
}

}  // namespace scan2fea
