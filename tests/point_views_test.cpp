#include "preproc/surface/reconstruction/point_views.hpp"

#include "examples/scanner.hpp"
#include "preproc/surface/kernel/point_neighbours.hpp"
#include "preproc/surface/reconstruction/reconstruct.hpp"
#include "preproc/surface/reconstruction/seen_cells.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace scan2fea {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<Vec3> no_positions;

PointCloud scanned_torus() {
  return scan_surface(analytic::torus(2, 0.7, 90, 40), {.points = 1500, .noise = 0.001}).cloud;
}

PointCloud with_normals(PointCloud cloud, const std::function<Vec3(const Vec3&)>& change) {
  cloud.scanners.clear();
  for (Vec3& n : cloud.normals) n = change(n);
  return cloud;
}

std::vector<std::uint32_t> all_of(const PointCloud& cloud) {
  std::vector<std::uint32_t> from;
  for (std::uint32_t i = 0; i < cloud.points.size(); ++i) from.push_back(i);
  return from;
}

TEST(PointViews, RightNormalsAreUsedAndInwardOnesTurned) {
  const PointCloud cloud = scanned_torus();
  for (const double sign : {1.0, -1.0}) {
    const PointCloud given = with_normals(cloud, [&](const Vec3& n) { return Vec3(sign * n); });
    const TrustedViews views(given, no_positions);
    EXPECT_EQ(views.outwards(), cloud.normals);
    EXPECT_EQ(views.of(cloud.points, all_of(cloud)).normals, cloud.normals);
    EXPECT_THAT(views.told(), ElementsAre(HasSubstr(sign < 0 ? "were turned" : "were used")));
  }
}

TEST(PointViews, NormalsAtRandomOrOfMixedSignsAreNot) {
  const PointCloud cloud = scanned_torus();
  std::mt19937 generator(1);
  std::normal_distribution<double> any;
  const PointCloud random = with_normals(
      cloud, [&](const Vec3&) { return Vec3(any(generator), any(generator), any(generator)).normalized(); });
  const PointCloud mixed = with_normals(cloud, [&](const Vec3& n) { return any(generator) < 0 ? Vec3(-n) : n; });
  const PointCloud half = with_normals(cloud, [&](const Vec3& n) { return n.x() < 0 ? Vec3(-n) : n; });
  for (const PointCloud* given : {&random, &mixed, &half}) {
    const TrustedViews views(*given, no_positions);
    EXPECT_THAT(views.told(), ElementsAre(HasSubstr("were not used")));
    EXPECT_TRUE(views.outwards().empty());
    EXPECT_TRUE(views.of(given->points, all_of(*given)).is_empty());
  }
}

TEST(PointViews, UselessNormalsChangeNothing) {
  const PointCloud cloud = scanned_torus();
  std::mt19937 generator(1);
  std::normal_distribution<double> any;
  const PointCloud random = with_normals(
      cloud, [&](const Vec3&) { return Vec3(any(generator), any(generator), any(generator)).normalized(); });
  const ReconstructResult with = reconstruct(random),
                          without = reconstruct({.points = cloud.points, .normals = {}, .scanners = {}});
  EXPECT_EQ(with.surface.triangles, without.surface.triangles);
  EXPECT_EQ(with.surface.vertices, without.surface.vertices);
}

// Cosines of the estimated normals to the true ones.
double share_right(const PointCloud& cloud, const PointViews& views) {
  std::size_t right = 0, known = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    known += !views.normals[i].isZero();
    right += views.normals[i].dot(cloud.normals[i]) > 0.5;
  }
  return static_cast<double>(right) / static_cast<double>(known);
}

TEST(PointViews, ScannersGiveNormalsTheirSide) {
  PointCloud cloud = scanned_torus();
  PointCloud given = cloud;
  given.normals.clear();
  const TrustedViews views(given, no_positions);
  EXPECT_THAT(views.told(), ElementsAre("the scanner's positions were used"));
  const PointViews seen = views.of(given.points, all_of(given));
  EXPECT_EQ(seen.scanners, cloud.scanners);
  EXPECT_GT(share_right(cloud, seen), 0.98);
}

TEST(PointViews, ScannersInsideAreNotUsed) {
  PointCloud cloud{.points = analytic::sphere(1, 4).vertices, .normals = {}, .scanners = {{0.1, 0, 0}}};
  EXPECT_THAT(TrustedViews(cloud, no_positions).told(), ElementsAre(HasSubstr("seen from inside")));
  cloud.scanners = {{5, 0, 0}};  // cannot have seen the far side
  EXPECT_THAT(TrustedViews(cloud, no_positions).told(), ElementsAre(HasSubstr("were not used")));
}

TEST(PointViews, OfSeveralPositionsThoseThatCanHaveSeenAPoint) {
  const SurfaceMesh ball = analytic::sphere(1, 4);
  const PointCloud cloud{.points = ball.vertices, .normals = ball.vertices, .scanners = {}};
  const PointCloud given{.points = ball.vertices, .normals = {}, .scanners = {}};
  // From far off each point has some of the six before it and some behind.
  const std::vector<Vec3> far{{9, 0, 0}, {-9, 0, 0}, {0, 9, 0}, {0, -9, 0}, {0, 0, 9}, {0, 0, -9}};
  EXPECT_TRUE(TrustedViews(given, far).of(given.points, all_of(given)).normals.empty());
  // An open scene, as a terrain, is seen from above alone.
  PointCloud hills{.points = {}, .normals = {}, .scanners = {}};
  for (int i = 0; i < 40; ++i)
    for (int k = 0; k < 40; ++k) hills.points.emplace_back(i, k, std::sin(0.3 * i) * std::cos(0.2 * k));
  const std::vector<Vec3> above{{0, 0, 50}, {40, 40, 50}};
  const PointViews seen = TrustedViews(hills, above).of(hills.points, all_of(hills));
  ASSERT_EQ(seen.normals.size(), hills.points.size());
  for (const Vec3& n : seen.normals) EXPECT_GE(n.z(), 0);
}

TEST(SeenCells, ABallsInsideAndOutside) {
  const SurfaceMesh ball = analytic::sphere(1, 3);
  std::vector<Vec3> points = ball.vertices;
  points.emplace_back(0, 0, 3);  // the cells to it are outside
  std::vector<Vec3> normals = ball.vertices;
  normals.push_back(Vec3::Zero());
  const std::vector<double> spacing = point_spacing(points, PointNeighbours(points));
  const DelaunayCells cells = Delaunay(points).cells();
  std::vector<Vec3> scanners(points.size(), Vec3(0, 0, 50));
  const SeenCells seen = see_cells(points, spacing, cells, {.normals = normals, .scanners = scanners, .noise = 0}, 1);
  for (std::size_t c = 0; c < cells.corners.size(); ++c) {
    const auto& corners = cells.corners[c];
    if (std::ranges::find(corners, DelaunayCells::infinite) != corners.end()) continue;
    const bool is_outside = std::ranges::find(corners, points.size() - 1) != corners.end();
    // Beside the rim that is seen from the far point cells lie along the ball.
    const bool is_clear = std::ranges::all_of(corners, [&](std::uint32_t v) { return points[v].z() > 0.5; });
    if (!is_outside) {
      EXPECT_GT(seen.inside[c], 0);
    } else if (is_clear) {
      EXPECT_LT(seen.inside[c], 0);
    }
  }
  double crossed = 0;
  for (const auto& c : seen.crossed)
    for (const double of_facet : c) crossed += of_facet;
  EXPECT_GT(crossed, 0);
}

// Thinner than its points are apart.
TEST(Reconstruct, AThinSheetByItsNormalsOrScanners) {
  const SurfaceMesh sheet = analytic::box({20, 20, 0.4}, 0.4);
  PointCloud cloud = scan_surface(sheet, {.points = 3000, .positions = 14}).cloud;
  PointCloud seen = cloud;
  seen.normals.clear();
  cloud.scanners.clear();
  for (const PointCloud* given : {&cloud, &seen}) {
    const SurfaceMesh surface = reconstruct(*given).surface;
    EXPECT_TRUE(check_validity(surface).closed());
    EXPECT_NEAR(enclosed_volume(surface) / enclosed_volume(sheet), 1, 0.15);
  }
}

}  // namespace
}  // namespace scan2fea
