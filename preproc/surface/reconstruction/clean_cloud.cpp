#include "preproc/surface/reconstruction/clean_cloud.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/median.hpp"
#include "preproc/mesh/vertex_welder.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/kernel/point_neighbours.hpp"
#include "preproc/surface/reconstruction/outliers.hpp"
#include "preproc/surface/reconstruction/thinning.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace scan2fea {
namespace {

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

class Cleaning {
 public:
  Cleaning(const std::vector<Vec3>& given, const std::vector<Vec3>& outwards, std::size_t most)
      : given_outwards_(outwards), most_(most) {
    drop_repeated(given);
    require_extents(points_);
  }

  CleanedCloud run(const Progress& progress) {
    progress("cleaning the cloud", 0.2);
    thin();
    smooth();
    progress("cleaning the cloud", 0.4);
    drop_outliers();
    progress("cleaning the cloud", 0.8);
    merge();
    require_extents(points_);
    result_.points = std::move(points_);
    result_.from = std::move(from_);
    return std::move(result_);
  }

 private:
  enum class Fate : char { stays, goes, outlier };

  void drop_repeated(const std::vector<Vec3>& given);
  std::vector<Vec3> outwards() const;
  void take(MergedPoints&& merged);
  void thin();
  void drop_thin_cells(const ThinnedCloud& thinned);
  void smooth();
  void drop_outliers();
  void merge();
  void apply(const std::vector<Fate>& fate);

  const std::vector<Vec3>& given_outwards_;
  std::vector<Vec3> points_;
  std::vector<std::uint32_t> from_;  // which of the given ones they are
  std::size_t most_;
  std::vector<std::vector<Vec3>> stand_for_;  // of each point those of its cell that went; none where none did
  CleanedCloud result_;
};

void Cleaning::drop_repeated(const std::vector<Vec3>& given) {
  VertexWelder welder(given.size());
  for (std::uint32_t i = 0; i < given.size(); ++i)
    if (welder.add(given[i]) == from_.size()) from_.push_back(i);
  points_ = welder.take_vertices();
  result_.repeated = given.size() - points_.size();
}

std::vector<Vec3> Cleaning::outwards() const {
  std::vector<Vec3> directions;
  if (!given_outwards_.empty())
    for (const std::uint32_t i : from_) directions.push_back(given_outwards_[i]);
  return directions;
}

// Points that go take those with them that they stand for.
void Cleaning::apply(const std::vector<Fate>& fate) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (fate[i] == Fate::outlier) {
      result_.outliers.push_back(points_[i]);
      if (!stand_for_.empty()) {
        result_.outliers.insert(result_.outliers.end(), stand_for_[i].begin(), stand_for_[i].end());
        result_.thinned -= stand_for_[i].size();
      }
    }
    if (fate[i] == Fate::goes) ++result_.thinned;
    if (fate[i] != Fate::stays) continue;
    points_[kept] = points_[i];
    from_[kept] = from_[i];
    if (!stand_for_.empty()) std::swap(stand_for_[kept], stand_for_[i]);
    ++kept;
  }
  points_.resize(kept);
  from_.resize(kept);
  if (!stand_for_.empty()) stand_for_.resize(kept);
}

void Cleaning::thin() {
  const ThinnedCloud thinned = thin_by_cells(points_, most_);
  if (thinned.cell == 0) return;
  std::vector<Vec3> kept;
  std::vector<std::uint32_t> from;
  for (std::size_t c = 0; c < thinned.kept.size(); ++c) {
    kept.push_back(points_[thinned.kept[c]]);
    from.push_back(from_[thinned.kept[c]]);
    std::vector<Vec3>& others = stand_for_.emplace_back();
    for (std::size_t m = thinned.first[c]; m < thinned.first[c + 1]; ++m)
      if (thinned.members[m] != thinned.kept[c]) others.push_back(points_[thinned.members[m]]);
  }
  result_.cell = thinned.cell;
  result_.thinned = points_.size() - kept.size();
  points_ = std::move(kept);
  from_ = std::move(from);
  constexpr std::size_t telling = 8;  // points in a cell, mean
  if (result_.thinned / points_.size() >= telling) drop_thin_cells(thinned);
}

// Cells that hold far fewer points than those about them: of no use, and where none of those is beside them, outliers.
void Cleaning::drop_thin_cells(const ThinnedCloud& thinned) {
  constexpr std::size_t about = 9;
  constexpr double few = 0.15, beside = 2;  // of the median; cells
  const double mean = static_cast<double>(result_.thinned) / static_cast<double>(points_.size());
  const PointNeighbours neighbours(points_);
  std::vector<Fate> fate(points_.size(), Fate::stays);
  for_each_block(points_.size(), [&](std::size_t first, std::size_t last) {
    std::array<PointNeighbours::Neighbour, about> found;
    for (std::size_t i = first; i < last; ++i) {
      const auto near = neighbours.nearest(points_[i], found);
      std::array<double, about> count{};
      for (std::size_t k = 0; k < near.size(); ++k) count[k] = static_cast<double>(thinned.count(near[k].point));
      const double own = static_cast<double>(thinned.count(i));
      const auto middle = count.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
      std::nth_element(count.begin(), middle, count.begin() + static_cast<std::ptrdiff_t>(near.size()));
      const double usual = std::max(*middle, 0.5 * mean);
      if (own > few * usual) continue;
      const bool is_beside_full = std::ranges::any_of(near, [&](const auto& n) {
        return n.distance < beside * thinned.cell && static_cast<double>(thinned.count(n.point)) >= 0.5 * usual;
      });
      fate[i] = is_beside_full ? Fate::goes : Fate::outlier;
    }
  });
  apply(fate);
}

void Cleaning::take(MergedPoints&& merged) {
  result_.merged += points_.size() - merged.points.size();
  for (std::uint32_t& i : merged.stayed) i = from_[i];
  from_ = std::move(merged.stayed);
  points_ = std::move(merged.points);
}

// Where noise is larger than the spacing, a cloud is thick instead of a surface: points within its thickness become
// their mean, until it is thin for its spacing.
void Cleaning::smooth() {
  constexpr double thick = 0.15;
  for (int round = 0; round < 5; ++round) {
    const Roughness rough = measure_roughness(points_, outwards());
    if (rough.relative < thick) return;
    MergedPoints merged = merge_near(points_, outwards(), rough.reach, MergeTo::mean);
    constexpr std::size_t fewest = 200;  // of which a surface can be made at all
    if (merged.points.size() < fewest) return;
    take(std::move(merged));
    stand_for_.clear();
  }
}

void Cleaning::drop_outliers() {
  const OutlierSearch search = find_outliers(points_, outwards());
  result_.noise = search.noise;
  result_.has_outliers = search.has_outliers;
  std::vector<Fate> fate(points_.size(), Fate::stays);
  for (std::size_t i = 0; i < search.is_outlier.size(); ++i)
    if (search.is_outlier[i]) fate[i] = Fate::outlier;
  apply(fate);
}

// A triangle whose edges are as short as the noise is has any normal. Where noise is small beside the spacing,
// curvature counts as noise, too, and what is left to merge is what overlaps.
void Cleaning::merge() {
  constexpr double of_noise = 4, of_spacing = 0.25;
  const double spacing = median(point_spacing(points_, PointNeighbours(points_)));
  const double noise = of_noise * result_.noise;
  const double radius = spacing < noise ? noise : std::min(noise, of_spacing * spacing);
  if (radius == 0) return;
  take(merge_near(points_, outwards(), radius, MergeTo::plane));
}

}  // namespace

CleanedCloud clean_cloud(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards, std::size_t most,
                         const Progress& progress) {
  return Cleaning(points, outwards, most).run(progress);
}

}  // namespace scan2fea
