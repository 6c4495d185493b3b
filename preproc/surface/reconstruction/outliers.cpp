#include "preproc/surface/reconstruction/outliers.hpp"

#include "preproc/mesh/median.hpp"
#include "preproc/mesh/union_find.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/kernel/point_neighbours.hpp"
#include "preproc/surface/reconstruction/local_plane.hpp"
#include "preproc/surface/reconstruction/sided_neighbours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace scan2fea {
namespace {

using Neighbour = PointNeighbours::Neighbour;

constexpr std::size_t support = 7;      // points of a plane: about what lies on one side of a crease
constexpr std::size_t candidates = 12;  // neighbours whose planes are tried
constexpr std::size_t ring = 6;         // neighbours by which spacing is measured

// Of the points beside one another, without one of them.
LocalPlane plane_of(const std::vector<Vec3>& points, std::span<const Neighbour> near,
                    const std::vector<std::uint32_t>& number, std::uint32_t without) {
  std::array<Vec3, support> used;
  std::size_t count = 0;
  for (const Neighbour& n : near)
    if (number[n.point] != without && count < support) used[count++] = points[n.point];
  return fit_plane({used.data(), count});
}

// One pass: planes of the points that `is_outlier` does not name, for all points.
class Pass {
 public:
  Pass(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards, const std::vector<bool>& is_outlier)
      : points_(points), outwards_(outwards) {
    for (std::uint32_t i = 0; i < points.size(); ++i)
      if (!is_outlier[i]) kept_.push_back(i);
    for (const std::uint32_t i : kept_) kept_points_.push_back(points[i]);
    if (!outwards.empty())
      for (const std::uint32_t i : kept_) kept_outwards_.push_back(outwards[i]);
    find_neighbours();
    find_distances();
  }

  std::vector<double> distance;   // from the flattest plane
  std::vector<double> spacing;    // of the neighbours, median
  std::vector<double> isolation;  // distance of the fourth neighbour

 private:
  void find_neighbours();
  void find_distances();

  // Of kept points, nearest first.
  struct Near {
    std::array<Neighbour, candidates + 1> all;
    std::size_t count = 0;
    std::span<const Neighbour> found() const { return std::span(all).first(count); }
  };

  const std::vector<Vec3>&points_, &outwards_;
  std::vector<std::uint32_t> kept_;
  std::vector<Vec3> kept_points_, kept_outwards_;
  std::vector<Near> near_kept_, near_;
};

void Pass::find_neighbours() {
  const SidedNeighbours neighbours(kept_points_, kept_outwards_);
  near_kept_.resize(kept_.size());
  near_.resize(points_.size());
  for_each_block(points_.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Vec3 outwards = outwards_.empty() ? Vec3(Vec3::Zero()) : outwards_[i];
      near_[i].count = neighbours.nearest(points_[i], outwards, near_[i].all).size();
    }
  });
  for (std::size_t k = 0; k < kept_.size(); ++k) near_kept_[k] = near_[kept_[k]];
}

void Pass::find_distances() {
  constexpr double far_beside = 1.5;  // reaches
  distance.resize(points_.size());
  spacing.resize(points_.size());
  isolation.resize(points_.size());
  for_each_block(points_.size(), [&](std::size_t first, std::size_t last) {
    std::vector<double> spacings;
    for (std::size_t i = first; i < last; ++i) {
      double best = std::numeric_limits<double>::infinity();
      spacings.clear();
      for (const Neighbour& n : near_[i].found()) {
        if (kept_[n.point] == i) continue;
        const std::span<const Neighbour> own = near_kept_[n.point].found();
        if (own.size() <= ring) continue;
        double sum = 0;
        for (std::size_t k = 1; k <= ring; ++k) sum += own[k].distance / ring;
        spacings.push_back(sum);
        const LocalPlane plane = plane_of(kept_points_, own, kept_, static_cast<std::uint32_t>(i));
        const Vec3 way = points_[i] - plane.centre;
        const double off = std::abs(way.dot(plane.normal));
        if (std::sqrt(std::max(0.0, way.squaredNorm() - off * off)) > far_beside * plane.reach) continue;
        best = std::min(best, std::hypot(off, plane.residual));
      }
      distance[i] = best;
      constexpr std::size_t fourth = 4;
      spacing[i] = spacings.empty() ? 0 : median(spacings);
      isolation[i] = near_[i].count > fourth ? near_[i].all[fourth].distance : std::numeric_limits<double>::infinity();
    }
  });
}

// Points about in space, a few together at most, far from all others: whatever planes they lie in.
std::vector<bool> find_stray_points(const std::vector<Vec3>& points) {
  constexpr double near = 4;         // typical spacings: what is sampled so much less by area is no surface any more
  constexpr std::size_t crowd = 20;  // a body of fewer points has no shape
  const PointNeighbours neighbours(points);
  const double reach = near * median(point_spacing(points, neighbours));
  std::vector<std::array<std::uint32_t, candidates>> beside(points.size());
  for_each_block(points.size(), [&](std::size_t first, std::size_t last) {
    std::array<Neighbour, candidates> found;
    for (std::size_t i = first; i < last; ++i) {
      beside[i].fill(static_cast<std::uint32_t>(i));
      const auto near_by = neighbours.nearest(points[i], found);
      for (std::size_t k = 0; k < near_by.size() && near_by[k].distance < reach; ++k) beside[i][k] = near_by[k].point;
    }
  });
  UnionFind groups(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    for (const std::uint32_t j : beside[i]) groups.unite(i, j);
  std::vector<std::size_t> count(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) ++count[groups.find(i)];
  std::vector<bool> is_stray(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) is_stray[i] = count[groups.find(i)] < crowd;
  return is_stray;
}

// Outliers are few and far between; where more neighbours of a point are said to be some than chance puts there, the
// points are too few for what they show, as on a thin leg, or on the wall of a hole. What is `isolated` is so whatever
// its neighbours are.
std::vector<bool> without_crowds(const std::vector<Vec3>& points, const std::vector<bool>& is_outlier,
                                 const std::vector<bool>& isolated) {
  constexpr std::size_t wide = 64;
  constexpr std::size_t crowd = 2;  // of the nearest
  std::size_t all = 0;
  for (std::size_t i = 0; i < points.size(); ++i) all += is_outlier[i] && !isolated[i];
  const double usual = static_cast<double>(wide * all) / static_cast<double>(points.size());
  const double wide_crowd = usual + 3 * std::sqrt(usual) + 1;  // Poisson's three sigmas, and one for so few
  const PointNeighbours neighbours(points);
  std::vector<char> stays(points.size());
  for_each_block(points.size(), [&](std::size_t first, std::size_t last) {
    std::array<Neighbour, wide> found;
    for (std::size_t i = first; i < last; ++i) {
      if (!is_outlier[i] || isolated[i]) continue;
      std::size_t beside = 0, about = 0;
      const auto near = neighbours.nearest(points[i], found);
      for (std::size_t k = 0; k < near.size(); ++k) {
        const std::uint32_t j = near[k].point;
        if (j == i || !is_outlier[j] || isolated[j]) continue;
        ++about;
        beside += k <= candidates;
      }
      stays[i] = beside >= crowd || static_cast<double>(about) > wide_crowd;
    }
  });
  std::vector<bool> result = is_outlier;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (stays[i]) result[i] = false;
  return result;
}

}  // namespace

OutlierSearch find_outliers(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards) {
  // Set by three scanned shapes with and without an outlier in a hundred points. Corners and thin parts with too few
  // points lie off all planes as the nearest outliers do: a quarter to seven tenths of the spacing. So those are taken
  // for outliers only where many points are farther off than that: at most two in a thousand of scans without outliers,
  // at least five of those with them.
  constexpr double of_noise = 5, near = 0.28, far = 0.7, telling_share = 0.003, isolated = 5;
  constexpr std::size_t fewest = 4 * candidates;  // fewer say nothing about what is usual
  OutlierSearch result;
  if (points.size() < fewest) return {};
  const std::vector<bool> is_stray = find_stray_points(points);
  result.is_outlier = is_stray;
  for (int pass = 0; pass < 2; ++pass) {
    if (static_cast<std::size_t>(std::ranges::count(result.is_outlier, false)) < fewest) return {};
    const Pass found(points, outwards, result.is_outlier);
    result.noise = median(found.distance);
    const auto is_beyond = [&](std::size_t i, double of_spacing) {
      return found.distance[i] > std::max(of_spacing * found.spacing[i], of_noise * result.noise);
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) count += is_beyond(i, far);
    result.has_outliers = static_cast<double>(count) > telling_share * static_cast<double>(points.size());
    std::vector<bool> is_alone = is_stray;
    for (std::size_t i = 0; i < points.size(); ++i) {
      is_alone[i] = is_stray[i] || found.isolation[i] > isolated * found.spacing[i];
      result.is_outlier[i] = is_alone[i] || is_beyond(i, result.has_outliers ? near : far);
    }
    result.is_outlier = without_crowds(points, result.is_outlier, is_alone);
  }
  return result;
}

}  // namespace scan2fea
