#include "preproc/surface/reconstruction/reconstruct.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/median.hpp"
#include "preproc/surface/kernel/point_neighbours.hpp"
#include "preproc/surface/kernel/unused_vertices.hpp"
#include "preproc/surface/reconstruction/clean_cloud.hpp"
#include "preproc/surface/reconstruction/consistent_surface.hpp"
#include "preproc/surface/reconstruction/hole_voids.hpp"
#include "preproc/surface/reconstruction/point_views.hpp"
#include "preproc/surface/reconstruction/poisson.hpp"
#include "preproc/surface/reconstruction/sided_neighbours.hpp"
#include "preproc/surface/reconstruction/surface_outliers.hpp"
#include "preproc/surface/reconstruction/surface_patches.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace scan2fea {
namespace {

// A patch is a gap of the scan that is closed by what no point shows.
void require_small_gaps(const std::vector<SurfacePatch>& gaps, const BoundingBox& box,
                        const std::optional<double>& largest_of_diagonal) {
  if (gaps.empty() || !largest_of_diagonal) return;
  const double limit = *largest_of_diagonal * box.diagonal();
  if (gaps.front().size <= limit) return;
  throw NotMeshable({.what = "the cloud shows no solid: nothing was measured over a gap",
                     .where = {},
                     .value = error_text(gaps.front().size),
                     .limit = error_text(limit),
                     .advice = "a scan of all sides of the part, or --largest-hole all",
                     .at = gaps.front().place});
}

// Holes that the part's shapes tell, and what long triangles span beside.
void find_bridges(const std::vector<Vec3>& points, const std::vector<double>& spacing, const ConsistentSurface& found,
                  ReconstructResult& result) {
  const std::vector<Triangle>& triangles = found.triangles;
  std::vector<bool> is_long;
  for (const Triangle& t : triangles) is_long.push_back(length_in_spacings(points, spacing, t) > long_for_spacing);
  const std::vector<HoleVoid> voids = find_hole_voids(points, found.shapes);
  for (const BridgedVoid& bridge : find_bridged_voids({points, triangles}, voids)) {
    const HoleVoid& hole = voids[bridge.of];
    const double radius = hole.radius_at(hole.height(bridge.place));
    double widest = 0;
    for (const std::uint32_t f : bridge.triangles) {
      is_long[f] = false;
      for (const std::uint32_t v : triangles[f]) widest = std::max(widest, spacing[v]);
    }
    result.bridges.push_back({bridge.place, 2 * radius, widest, bridge.triangles.size(), radius});
  }
  for (const SurfacePatch& patch : find_patches(points, triangles, is_long)) {
    Bridge bridge{Vec3::Zero(), 0, 0, patch.triangles.size()};
    for (const std::uint32_t f : patch.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles[f][k], b = triangles[f][(k + 1) % 3];
        const double length = (points[a] - points[b]).norm();
        if (length > bridge.length)
          bridge = {0.5 * (points[a] + points[b]), length, std::max(spacing[a], spacing[b]), bridge.triangles};
      }
    result.bridges.push_back(bridge);
  }
  std::ranges::stable_sort(result.bridges, std::greater(), [](const Bridge& bridge) {
    return std::pair(bridge.hole_radius.has_value(), bridge.length);
  });
}

// Of an open scene a closed surface holds what happens to be closed.
void require_solid(const ConsistentSurface& found, std::size_t points) {
  constexpr double most = 0.1;
  const double share = static_cast<double>(found.off_surface.size()) / static_cast<double>(points);
  if (share <= most) return;
  throw NotMeshable({.what = "the cloud shows no solid: points lie off any closed surface through the others",
                     .where = {},
                     .value = error_text(100 * share, 3) + " % of " + std::to_string(points) + " points",
                     .limit = error_text(100 * most, 3) + " %",
                     .advice = "a scan of all sides of the part"});
}

// Whose normals are those of the surface through the points.
void take_poisson(ReconstructResult& result, const Progress& progress) {
  progress("Poisson reconstruction", 0.9);
  const SurfaceMesh& through = result.surface;
  std::vector<Vec3> normals(through.vertices.size(), Vec3::Zero());
  for (const Triangle& t : through.triangles)
    for (const std::uint32_t v : t) normals[v] += area_vector(through, t);
  std::vector<Vec3> points, used;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    if (normals[v].norm() == 0) continue;
    points.push_back(through.vertices[v]);
    used.push_back(normals[v]);
  }
  SurfaceMesh smooth = poisson_surface(points, used, result.spacing);
  if (smooth.triangles.empty())
    throw NotMeshable({.what = "Poisson's reconstruction finds no surface",
                       .where = {},
                       .value = std::to_string(points.size()) + " points",
                       .limit = {},
                       .advice = "--reconstruction advancing-front"});
  result.surface = std::move(smooth);
  result.bridges.clear();
  result.choice = "Poisson's surface, asked for, with normals of " + result.choice;
}

PointViews views_of(const TrustedViews& trusted, const CleanedCloud& cleaned) {
  PointViews views = trusted.of(cleaned.points, cleaned.from);
  views.noise = cleaned.noise;
  return views;
}

// Points go to the outliers, or come back from there, and the surface is made again.
void look_again(const TrustedViews& trusted, ConsistentSurface& found, CleanedCloud& cleaned,
                std::vector<double>& spacing, const Progress& progress) {
  std::vector<Vec3> all = cleaned.points;
  all.insert(all.end(), cleaned.outliers.begin(), cleaned.outliers.end());
  const std::vector<bool> is_outlier = find_surface_outliers({cleaned.points, found.triangles}, found.shapes, all);
  bool is_changed = false;
  for (std::size_t i = 0; i < all.size(); ++i) is_changed = is_changed || is_outlier[i] != (i >= cleaned.points.size());
  if (!is_changed) return;
  std::vector<std::uint32_t> number(all.size()), from = std::move(cleaned.from);
  from.resize(all.size(), no_point);
  cleaned.points.clear();
  cleaned.outliers.clear();
  cleaned.from.clear();
  for (std::size_t i = 0; i < all.size(); ++i) {
    number[i] = static_cast<std::uint32_t>(cleaned.points.size());
    (is_outlier[i] ? cleaned.outliers : cleaned.points).push_back(all[i]);
    if (!is_outlier[i]) cleaned.from.push_back(from[i]);
  }
  const std::vector<Vec3>& points = cleaned.points;
  const PointViews views = views_of(trusted, cleaned);
  spacing = sided_spacing(points, views.normals);
  // Where points are few, fronts go another way for one of them.
  constexpr std::size_t few = 20'000;
  if (points.size() < few) {
    found = find_consistent_surface(points, spacing, views, progress);
    return;
  }
  ConsistentSurface before;
  before.choice = std::move(found.choice);
  for (std::size_t f = 0; f < found.triangles.size(); ++f) {
    Triangle t = found.triangles[f];
    if (std::ranges::any_of(t, [&](std::uint32_t v) { return is_outlier[v]; })) continue;
    for (std::uint32_t& v : t) v = number[v];
    before.triangles.push_back(t);
    before.is_made_up.push_back(found.is_made_up[f]);
  }
  found = renew_surface(points, spacing, before, views, progress);
}

}  // namespace

ReconstructResult reconstruct(const PointCloud& cloud, const ReconstructOptions& options, const Progress& progress) {
  ReconstructResult result;
  const TrustedViews trusted(cloud, options.scanners);
  CleanedCloud cleaned = clean_cloud(cloud.points, trusted.outwards(), options.largest_cloud, progress);
  result.repeated = cleaned.repeated;
  result.thinned = cleaned.thinned;
  result.merged = cleaned.merged;
  result.cell = cleaned.cell;
  result.noise = cleaned.noise;
  result.views = trusted.told();
  const PointViews views = views_of(trusted, cleaned);
  std::vector<double> spacing = sided_spacing(cleaned.points, views.normals);
  ConsistentSurface found = find_consistent_surface(cleaned.points, spacing, views, progress);
  if (cleaned.has_outliers) look_again(trusted, found, cleaned, spacing, progress);
  std::vector<Vec3> points = std::move(cleaned.points);
  result.outliers = std::move(cleaned.outliers);
  result.spacing = median(spacing);
  const std::vector<SurfacePatch> gaps = find_patches(points, found.triangles, found.is_made_up);
  require_solid(found, points.size());
  require_small_gaps(gaps, bounding_box(points), options.largest_gap_of_diagonal);
  for (const SurfacePatch& gap : gaps) result.made_up_area += gap.area;
  result.gaps = gaps.size();
  result.off_surface = found.off_surface.size();
  if (cleaned.has_outliers)
    for (const std::uint32_t i : found.off_surface) result.outliers.push_back(points[i]);
  result.choice = std::move(found.choice);
  find_bridges(points, spacing, found, result);
  result.surface = {std::move(points), std::move(found.triangles)};
  drop_unused_vertices(result.surface);
  result.is_made_up = std::move(found.is_made_up);
  result.kept = result.surface.vertices.size();
  if (options.method == ReconstructionMethod::poisson) {
    take_poisson(result, progress);
    result.is_made_up.clear();
  }
  progress("reconstruction", 0.95);
  result.distances = measure_point_distances(cloud.points, result.surface, result.outliers);
  return result;
}

}  // namespace scan2fea
