#include "preproc/surface/reconstruction/thinning.hpp"

#include "preproc/mesh/median.hpp"
#include "preproc/mesh/morton_code.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/reconstruction/local_plane.hpp"
#include "preproc/surface/reconstruction/sided_neighbours.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace scan2fea {
namespace {

struct InCell {
  std::uint64_t cell;
  std::uint32_t point;
  bool operator<(const InCell& other) const { return cell < other.cell || (cell == other.cell && point < other.point); }
};

// Along a Morton curve, so that cells of twice the size are runs of it.
std::vector<InCell> in_order(const std::vector<Vec3>& points, const Vec3& origin, double cell) {
  std::vector<InCell> order(points.size());
  for_each_block(points.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Vec3 at = (points[i] - origin) / cell;
      order[i] = {morton_code(static_cast<std::uint64_t>(at.x()), static_cast<std::uint64_t>(at.y()),
                              static_cast<std::uint64_t>(at.z())),
                  static_cast<std::uint32_t>(i)};
    }
  });
  tbb::parallel_sort(order.begin(), order.end());
  return order;
}

using Neighbour = PointNeighbours::Neighbour;

constexpr std::size_t most_near = 48;

LocalPlane plane_of(const std::vector<Vec3>& points, std::span<const Neighbour> near) {
  std::array<Vec3, most_near> used;
  for (std::size_t k = 0; k < near.size(); ++k) used[k] = points[near[k].point];
  return fit_plane({used.data(), near.size()});
}

std::size_t cells_of(const std::vector<InCell>& order) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) count += i == 0 || order[i].cell != order[i - 1].cell;
  return count;
}

}  // namespace

ThinnedCloud thin_by_cells(const std::vector<Vec3>& points, std::size_t most) {
  ThinnedCloud result;
  if (points.size() <= most) return result;
  const BoundingBox box = bounding_box(points);
  const double side = (box.high - box.low).maxCoeff();
  // Points on a surface are in proportion to the square of one over the cell, more or less.
  double cell = side / std::sqrt(static_cast<double>(most));
  const double finest = side / static_cast<double>((1U << morton_bits) - 1);
  std::vector<InCell> order = in_order(points, box.low, std::max(cell, finest));
  for (int round = 0; round < 8; ++round) {
    const double share = static_cast<double>(cells_of(order)) / static_cast<double>(most);
    constexpr double near_enough = 0.8;
    if (share <= 1 && (share > near_enough || cell <= finest || round > 2)) break;
    cell = std::max(finest, cell * std::sqrt(share / 0.9));
    order = in_order(points, box.low, cell);
  }
  result.cell = cell;
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    Vec3 mean = Vec3::Zero();
    for (; last < order.size() && order[last].cell == order[first].cell; ++last) mean += points[order[last].point];
    mean /= static_cast<double>(last - first);
    const auto nearest =
        std::min_element(order.begin() + static_cast<std::ptrdiff_t>(first),
                         order.begin() + static_cast<std::ptrdiff_t>(last), [&](const InCell& a, const InCell& b) {
                           return (points[a.point] - mean).squaredNorm() < (points[b.point] - mean).squaredNorm();
                         });
    result.kept.push_back(nearest->point);
    result.first.push_back(first);
    first = last;
  }
  result.first.push_back(order.size());
  for (const InCell& in : order) result.members.push_back(in.point);
  return result;
}

MergedPoints merge_near(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards, double radius, MergeTo to) {
  constexpr std::size_t fewest_for_plane = 5;
  const SidedNeighbours neighbours(points, outwards);
  std::vector<bool> dropped(points.size(), false);
  MergedPoints merged;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (dropped[i]) continue;
    std::array<Neighbour, most_near> found;
    const auto near = neighbours.nearest(i, found);
    std::size_t count = 0;
    for (; count < near.size() && near[count].distance < radius; ++count)
      if (near[count].point > i) dropped[near[count].point] = true;
    Vec3 place = points[i];
    if (to == MergeTo::mean || count >= fewest_for_plane) {
      const LocalPlane plane = plane_of(points, near.first(count));
      place = to == MergeTo::mean ? plane.centre : Vec3(place + plane.normal.dot(plane.centre - place) * plane.normal);
    }
    merged.points.push_back(place);
    merged.stayed.push_back(i);
  }
  return merged;
}

Roughness measure_roughness(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards) {
  constexpr std::size_t about = 8;
  if (points.size() < about) return {};
  const SidedNeighbours neighbours(points, outwards);
  std::vector<double> relative(points.size()), reach(points.size());
  for_each_block(points.size(), [&](std::size_t first, std::size_t last) {
    std::array<Neighbour, about> found;
    for (std::size_t i = first; i < last; ++i) {
      const LocalPlane plane = plane_of(points, neighbours.nearest(i, found));
      relative[i] = plane.residual / plane.reach;
      reach[i] = plane.reach;
    }
  });
  return {median(std::move(relative)), median(std::move(reach))};
}

}  // namespace scan2fea
