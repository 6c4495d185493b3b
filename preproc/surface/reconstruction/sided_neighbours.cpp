#include "preproc/surface/reconstruction/sided_neighbours.hpp"

#include "preproc/surface/kernel/parallel_blocks.hpp"

#include <algorithm>
#include <array>

namespace scan2fea {

std::span<SidedNeighbours::Neighbour> SidedNeighbours::nearest(const Vec3& p, const Vec3& outwards,
                                                               std::span<Neighbour> found) const {
  if (outwards_.empty()) return all_.nearest(p, found);
  constexpr std::size_t most = 64;
  // Cosine of 102 degrees: the sides of a right-angled edge see each other, those of a wall do not.
  constexpr double opposed = -0.2;
  std::array<Neighbour, most> around;
  std::size_t count = 0;
  // Mostly half of them are enough.
  for (const std::size_t asked : {std::min(most, 2 * found.size()), most}) {
    count = 0;
    for (const Neighbour& n : all_.nearest(p, std::span(around).first(asked)))
      if (count < found.size() && outwards_[n.point].dot(outwards) > opposed) found[count++] = n;
    if (count == found.size()) break;
  }
  return found.first(count);
}

std::vector<double> sided_spacing(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards) {
  std::vector<double> spacing = point_spacing(points, PointNeighbours(points));
  if (outwards.empty()) return spacing;
  const SidedNeighbours neighbours(points, outwards);
  for_each_block(points.size(), [&](std::size_t first, std::size_t last) {
    constexpr std::size_t ring = 6;
    std::array<SidedNeighbours::Neighbour, ring + 1> found;
    for (std::size_t i = first; i < last; ++i) {
      const auto near = neighbours.nearest(i, found);
      if (near.size() < found.size() || outwards[i].isZero()) continue;
      double sum = 0;
      for (const auto& n : near) sum += n.distance;
      spacing[i] = sum / ring;
    }
  });
  return spacing;
}

}  // namespace scan2fea
