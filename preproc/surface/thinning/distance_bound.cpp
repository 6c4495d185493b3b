#include "preproc/surface/thinning/distance_bound.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {

double bound_of_distance(const std::array<Vec3, 3>& corners, const TriangleTree& surface, double enough,
                         double resolution) {
  const Vec3 centre = (corners[0] + corners[1] + corners[2]) / 3;
  double radius = 0;
  for (const Vec3& corner : corners) radius = std::max(radius, (corner - centre).norm());
  const double bound = std::sqrt(surface.closest(centre).squared_distance) + radius;
  if (bound <= enough || radius <= resolution) return bound;
  std::size_t longest = 0;  // the edge from this corner to the next
  const auto length = [&](std::size_t k) { return (corners[(k + 1) % 3] - corners[k]).squaredNorm(); };
  for (std::size_t k = 1; k < 3; ++k)
    if (length(k) > length(longest)) longest = k;
  const Vec3 middle = (corners[longest] + corners[(longest + 1) % 3]) / 2;
  std::array<Vec3, 3> one = corners, other = corners;
  one[longest] = middle;
  other[(longest + 1) % 3] = middle;
  const double of_one = bound_of_distance(one, surface, enough, resolution);
  return std::max(of_one, bound_of_distance(other, surface, std::max(enough, of_one), resolution));
}

}  // namespace scan2fea
