#include "preproc/volume/tet_quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

constexpr double sin_22_deg = 0.37460659341591203541;
constexpr double one_plus_cos_138_deg = 0.25685517452260579474;
constexpr double good_scaled_jacobian = 0.28;

struct Ingredients {
  double scaled_jacobian;
  double largest_cosine, smallest_cosine;  // of the dihedral angles; unset where the scaled Jacobian is not positive
};

Ingredients ingredients(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a;
  // Outward area vectors of the faces opposite b, c, d and a.
  const Vec3 nb = ad.cross(ac), nc = ab.cross(ad), nd = ac.cross(ab);
  const Vec3 na = -(nb + nc + nd);
  const double jacobian = -nd.dot(ad);
  const double l_ab = ab.squaredNorm(), l_ac = ac.squaredNorm(), l_ad = ad.squaredNorm();
  const double l_bc = (c - b).squaredNorm(), l_bd = (d - b).squaredNorm(), l_cd = (d - c).squaredNorm();
  const double product =
      std::max(std::max(l_ab * l_ac * l_ad, l_ab * l_bc * l_bd), std::max(l_ac * l_bc * l_cd, l_ad * l_bd * l_cd));
  Ingredients result{};
  result.scaled_jacobian = product > 0 ? jacobian * std::numbers::sqrt2 / std::sqrt(product) : 0;
  if (!(result.scaled_jacobian > 0)) return result;
  const double ra = 1 / std::sqrt(na.squaredNorm()), rb = 1 / std::sqrt(nb.squaredNorm());
  const double rc = 1 / std::sqrt(nc.squaredNorm()), rd = 1 / std::sqrt(nd.squaredNorm());
  const double cos_ab = -na.dot(nb) * (ra * rb), cos_ac = -na.dot(nc) * (ra * rc), cos_ad = -na.dot(nd) * (ra * rd);
  const double cos_bc = -nb.dot(nc) * (rb * rc), cos_bd = -nb.dot(nd) * (rb * rd), cos_cd = -nc.dot(nd) * (rc * rd);
  result.largest_cosine =
      std::max(std::max(std::max(cos_ab, cos_ac), std::max(cos_ad, cos_bc)), std::max(cos_bd, cos_cd));
  result.smallest_cosine =
      std::min(std::min(std::min(cos_ab, cos_ac), std::min(cos_ad, cos_bc)), std::min(cos_bd, cos_cd));
  return result;
}

double degrees(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

}  // namespace

double goal_quality(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Ingredients x = ingredients(a, b, c, d);
  const double jacobian = x.scaled_jacobian / good_scaled_jacobian;
  if (!(x.scaled_jacobian > 0)) return std::min(jacobian, 0.0);
  const double sine = std::sqrt(std::max(0.0, 1 - x.largest_cosine * x.largest_cosine));
  return std::min(jacobian, std::min(sine / sin_22_deg, (1 + x.smallest_cosine) / one_plus_cos_138_deg));
}

TetMeasures tet_measures(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Ingredients x = ingredients(a, b, c, d);
  if (!(x.scaled_jacobian > 0)) return {0, 180, x.scaled_jacobian};
  return {degrees(x.largest_cosine), degrees(x.smallest_cosine), x.scaled_jacobian};
}

}  // namespace scan2fea
