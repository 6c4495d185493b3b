#include "preproc/surface/reconstruction/clean_cloud.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/vertex_welder.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/reconstruction/outliers.hpp"
#include "preproc/surface/reconstruction/point_neighbours.hpp"
#include "preproc/surface/reconstruction/thinning.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace scan2fea {
namespace {

std::vector<Vec3> without_repeated(const std::vector<Vec3>& points) {
  VertexWelder welder(points.size());
  for (const Vec3& p : points) welder.add(p);
  return welder.take_vertices();
}

// That they are no cloud about a solid, by the extents along their principal axes.
void require_extents(const std::vector<Vec3>& points) {
  constexpr std::size_t fewest = 4;
  if (points.size() < fewest)
    throw NotMeshable(
        {.what = points.size() == 1 ? "all points are in one place" : "too few different points for a solid",
         .where = points.empty() ? "" : error_text(points.front()),
         .value = std::to_string(points.size()),
         .limit = std::to_string(fewest),
         .advice = "a scan of all sides of the part"});
  const BoundingBox box = bounding_box(points);
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += (p - box.low) / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) covariance += (p - box.low - mean) * (p - box.low - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  Vec3 low = Vec3::Zero(), high = low;
  for (const Vec3& p : points) {
    const Vec3 along = axes.eigenvectors().transpose() * (p - box.low - mean);
    low = low.cwiseMin(along);
    high = high.cwiseMax(along);
  }
  const Vec3 extent = high - low;
  constexpr double flat = 1e-6;  // of the largest extent: 32-bit floats in a plane are no flatter
  if (extent[0] > flat * extent[2]) return;
  const bool on_line = extent[1] <= flat * extent[2];
  throw NotMeshable({.what = on_line ? "all points lie on a line" : "all points lie in a plane",
                     .where = error_text(Vec3(box.low + mean)),
                     .value = error_text(on_line ? extent[1] : extent[0], 3),
                     .limit = error_text(flat * extent[2], 3),
                     .advice = "a scan of all sides of the part"});
}

// Cells that hold far fewer points than those about them: of no use, and where none of those is beside them, outliers.
void drop_thin_cells(const ThinnedCloud& thinned, std::vector<Vec3>& points, CleanedCloud& result) {
  constexpr std::size_t about = 9;
  constexpr double few = 0.15, beside = 2;  // of the median; cells
  const PointNeighbours neighbours(points);
  enum class Fate : char { stays, goes, outlier };
  std::vector<Fate> fate(points.size(), Fate::stays);
  for_each_block(points.size(), [&](std::size_t first, std::size_t last) {
    std::array<PointNeighbours::Neighbour, about> found;
    for (std::size_t i = first; i < last; ++i) {
      const auto near = neighbours.nearest(points[i], found);
      std::array<std::uint32_t, about> count{};
      for (std::size_t k = 0; k < near.size(); ++k) count[k] = thinned.count[near[k].point];
      std::sort(count.begin(), count.begin() + static_cast<std::ptrdiff_t>(near.size()));
      const double usual = count[near.size() / 2];
      const double mean = static_cast<double>(result.thinned) / static_cast<double>(points.size());
      if (thinned.count[i] > few * std::max(usual, 0.5 * mean)) continue;
      const bool is_beside_full = std::ranges::any_of(near, [&](const auto& n) {
        return n.distance < beside * thinned.cell && thinned.count[n.point] >= 0.5 * std::max(usual, mean);
      });
      fate[i] = is_beside_full ? Fate::goes : Fate::outlier;
    }
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (fate[i] == Fate::stays) points[kept++] = points[i];
    if (fate[i] == Fate::outlier) result.outliers.push_back(points[i]);
    if (fate[i] == Fate::goes) ++result.thinned;
  }
  points.resize(kept);
}

void thin(std::vector<Vec3>& points, std::size_t most, CleanedCloud& result) {
  const ThinnedCloud thinned = thin_by_cells(points, most);
  std::vector<Vec3> kept;
  if (thinned.cell > 0) {
    for (const std::uint32_t i : thinned.kept) kept.push_back(points[i]);
    result.cell = thinned.cell;
    result.thinned = points.size() - kept.size();
    points = std::move(kept);
    constexpr std::size_t telling = 8;  // points in a cell, mean
    if (result.thinned / points.size() >= telling) drop_thin_cells(thinned, points, result);
  }
}

// A triangle whose edges are as short as the noise is has any normal. Where noise is small beside the spacing,
// curvature counts as noise, too, and what is left to merge is what overlaps.
double merging_radius(const std::vector<Vec3>& points, double noise) {
  constexpr double of_noise = 4, of_spacing = 0.25;
  std::vector<double> spacing = point_spacing(points, PointNeighbours(points));
  const auto middle = spacing.begin() + static_cast<std::ptrdiff_t>(spacing.size() / 2);
  std::ranges::nth_element(spacing, middle);
  return *middle < of_noise * noise ? of_noise * noise : std::min(of_noise * noise, of_spacing * *middle);
}

}  // namespace

CleanedCloud clean_cloud(const std::vector<Vec3>& given, std::size_t most, const Progress& progress) {
  CleanedCloud result;
  std::vector<Vec3> points = without_repeated(given);
  result.repeated = given.size() - points.size();
  require_extents(points);
  progress("cleaning the cloud", 0.2);
  thin(points, most, result);
  progress("cleaning the cloud", 0.4);
  const OutlierSearch search = find_outliers(points);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!search.is_outlier.empty() && search.is_outlier[i])
      result.outliers.push_back(points[i]);
    else
      points[kept++] = points[i];
  }
  points.resize(kept);
  result.noise = search.noise;
  progress("cleaning the cloud", 0.8);
  result.points = points;
  if (const double radius = merging_radius(points, result.noise); radius > 0) {
    result.points = merge_near(points, radius).points;
    result.merged = points.size() - result.points.size();
  }
  require_extents(result.points);
  return result;
}

}  // namespace scan2fea
