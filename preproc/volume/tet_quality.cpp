#include "preproc/volume/tet_quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

constexpr double sin_22_deg = 0.37460659341591203541;
constexpr double one_plus_cos_138_deg = 0.25685517452260579474;
constexpr double good_scaled_jacobian = 0.28;

// The outward area vectors of the faces, doubled, and six times the volume. (Inlined by force: half of the time of the
// optimisation is spent here, and a fifth of that on passing this structure.)
struct Shape {
  Vec3 na, nb, nc, nd;  // opposite a, b, c, d
  double jacobian;
  double largest_product;  // of the squares of three edges at a corner
};

[[gnu::always_inline]] inline Shape shape_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  Shape s;
  s.nb = ad.cross(ac);
  s.nc = ab.cross(ad);
  s.nd = ac.cross(ab);
  s.na = -(s.nb + s.nc + s.nd);
  s.jacobian = -s.nd.dot(ad);
  const double l_ab = ab.squaredNorm(), l_ac = ac.squaredNorm(), l_ad = ad.squaredNorm();
  const double l_bc = (c - b).squaredNorm(), l_bd = (d - b).squaredNorm(), l_cd = (d - c).squaredNorm();
  s.largest_product =
      std::max(std::max(l_ab * l_ac * l_ad, l_ab * l_bc * l_bd), std::max(l_ac * l_bc * l_cd, l_ad * l_bd * l_cd));
  return s;
}

// The extreme cosines of the dihedral angles, each times its own absolute value: that needs no root and one division.
struct SignedSquares {
  double largest, smallest;
};

[[gnu::always_inline]] inline SignedSquares squared_cosines(const Shape& s) {
  const double a = s.na.squaredNorm(), b = s.nb.squaredNorm(), c = s.nc.squaredNorm(), d = s.nd.squaredNorm();
  const double ab = a * b, cd = c * d, ac = a * c, bd = b * d, ad = a * d, bc = b * c;
  const auto signed_square = [](double x) { return -x * std::abs(x); };
  // (n_i . n_j)^2 / (n_i^2 n_j^2) = (n_i . n_j)^2 n_k^2 n_l^2 / (product of all four)
  const double xab = signed_square(s.na.dot(s.nb)) * cd, xcd = signed_square(s.nc.dot(s.nd)) * ab;
  const double xac = signed_square(s.na.dot(s.nc)) * bd, xbd = signed_square(s.nb.dot(s.nd)) * ac;
  const double xad = signed_square(s.na.dot(s.nd)) * bc, xbc = signed_square(s.nb.dot(s.nc)) * ad;
  const double scale = 1 / (ab * cd);
  return {scale * std::max(std::max(std::max(xab, xcd), std::max(xac, xbd)), std::max(xad, xbc)),
          scale * std::min(std::min(std::min(xab, xcd), std::min(xac, xbd)), std::min(xad, xbc))};
}

double signed_root(double x) {
  return x < 0 ? -std::sqrt(-x) : std::sqrt(x);
}

}  // namespace

double goal_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double floor) {
  const Shape s = shape_of(a, b, c, d);
  const double least_jacobian = std::max(floor, 0.0) * (good_scaled_jacobian / std::numbers::sqrt2);
  if (!(s.jacobian > 0)) return 0;
  if (s.jacobian * s.jacobian <= least_jacobian * least_jacobian * s.largest_product) return std::max(floor, 0.0);
  const SignedSquares cosines = squared_cosines(s);
  const double sine = std::sqrt(std::max(0.0, 1 - cosines.largest));
  const double jacobian = s.jacobian / std::sqrt(s.largest_product);
  return std::min(jacobian * (std::numbers::sqrt2 / good_scaled_jacobian),
                  std::min(sine / sin_22_deg, (1 + signed_root(cosines.smallest)) / one_plus_cos_138_deg));
}

GoalTerms goal_terms(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double jacobian_counts) {
  const Shape s = shape_of(a, b, c, d);
  const std::array<Vec3, 4> normals{s.na.normalized(), s.nb.normalized(), s.nc.normalized(), s.nd.normalized()};
  GoalTerms terms;
  std::size_t k = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      const double cosine = std::clamp(-normals[i].dot(normals[j]), -1.0, 1.0);
      const double of_sine = std::sqrt(1 - cosine * cosine) / sin_22_deg;
      terms[k++] = cosine > 0 ? of_sine : std::min(of_sine, (1 + cosine) / one_plus_cos_138_deg);
    }
  const double ab = (b - a).norm(), ac = (c - a).norm(), ad = (d - a).norm();
  const double bc = (c - b).norm(), bd = (d - b).norm(), cd = (d - c).norm();
  for (const double product : {ab * ac * ad, ab * bc * bd, ac * bc * cd, ad * bd * cd})
    terms[k++] = s.jacobian / product * (jacobian_counts * std::numbers::sqrt2 / good_scaled_jacobian);
  return terms;
}

}  // namespace scan2fea
