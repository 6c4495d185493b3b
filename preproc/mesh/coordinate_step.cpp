#include "preproc/mesh/coordinate_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan2fea {

double float_step(const std::vector<Vec3>& points) {
  double farthest = 0;
  for (const Vec3& p : points)
    for (const double x : p) {
      if (static_cast<double>(static_cast<float>(x)) != x) return 0;
      farthest = std::max(farthest, std::abs(x));
    }
  const auto at = static_cast<float>(farthest);
  return static_cast<double>(std::nextafter(at, std::numeric_limits<float>::infinity())) - static_cast<double>(at);
}

}  // namespace scan2fea
