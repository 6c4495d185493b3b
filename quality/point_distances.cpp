#include "quality/point_distances.hpp"

#include "quality/triangle_tree.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

bool comes_before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

}  // namespace

PointDistances measure_point_distances(const std::vector<Vec3>& points, const SurfaceMesh& surface,
                                       std::vector<Vec3> without) {
  constexpr std::size_t block = 2048;
  const TriangleTree tree(surface);
  std::ranges::sort(without, comes_before);
  constexpr double left_out = -1;
  std::vector<double> squared(points.size(), left_out);
  tbb::parallel_for(std::size_t{0}, (points.size() + block - 1) / block, [&](std::size_t b) {
    std::uint32_t hint = 0;
    for (std::size_t i = b * block; i < std::min(points.size(), (b + 1) * block); ++i) {
      if (std::binary_search(without.begin(), without.end(), points[i], comes_before)) continue;
      const ClosestPoint closest = tree.closest(points[i], hint);
      hint = closest.triangle;
      squared[i] = closest.squared_distance;
    }
  });
  PointDistances result;
  double sum = 0, largest = left_out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (squared[i] == left_out) continue;
    ++result.points;
    sum += squared[i];
    if (squared[i] <= largest) continue;
    largest = squared[i];
    result.farthest = points[i];
  }
  if (result.points == 0) return result;
  result.largest = std::sqrt(largest);
  result.rms = std::sqrt(sum / static_cast<double>(result.points));
  return result;
}

}  // namespace scan2fea
