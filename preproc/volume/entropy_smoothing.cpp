#include "preproc/volume/entropy_smoothing.hpp"

#include <Eigen/LU>

#include <cmath>

namespace scan2fea {
namespace {

struct Derivatives {
  Vec3 gradient = Vec3::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

// With S the sum of squared edges and D = 6 V: eta = S / (12 (D/2)^(2/3)), both S and D polynomials of x.
Derivatives entropy_derivatives(const StarFaces& faces, const Vec3& x) {
  const double scale = std::cbrt(4.0) / 12;
  Derivatives sum;
  for (const auto& f : faces) {
    const Vec3 u = x - f[0], v = x - f[1], w = x - f[2];
    const Vec3 e = f[1] - f[0], g = f[2] - f[0];
    const Vec3 normal = e.cross(g);  // the gradient of D
    const double d = normal.dot(u);
    const double s =
        u.squaredNorm() + v.squaredNorm() + w.squaredNorm() + e.squaredNorm() + g.squaredNorm() + (g - e).squaredNorm();
    const Vec3 s_gradient = 2 * (u + v + w);
    const double root = std::cbrt(d), power = scale / (root * root);  // eta = s * power
    const double eta = s * power;
    const Vec3 m = normal / d;
    const Vec3 gradient = power * s_gradient - (2.0 / 3.0 * eta) * m;
    const double slope = 1 + std::log(eta);
    sum.gradient += slope * gradient;
    const Vec3 t = (2.0 / 3.0 * power) * s_gradient;
    sum.hessian += slope * ((10.0 / 9.0 * eta) * m * m.transpose() - t * m.transpose() - m * t.transpose()) +
                   (gradient / eta) * gradient.transpose();
    sum.hessian.diagonal().array() += slope * 6 * power;
  }
  return sum;
}

}  // namespace

bool smooth_by_entropy(const StarFaces& faces, Vec3& x, double& quality) {
  const Derivatives at = entropy_derivatives(faces, x);
  Vec3 step = -at.hessian.inverse() * at.gradient;
  if (!step.allFinite() || !(step.dot(at.gradient) < 0)) return false;
  for (int attempt = 0; attempt < 3; ++attempt, step /= 2) {
    const Vec3 candidate = x + step;
    const double reached = star_quality(faces, candidate, quality);
    if (reached <= quality) continue;
    x = candidate;
    quality = reached;
    return true;
  }
  return false;
}

}  // namespace scan2fea
