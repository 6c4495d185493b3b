#include "preproc/surface/reconstruction/reconstruct.hpp"

#include "examples/scanner.hpp"
#include "preproc/mesh/error.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/error_from.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace scan2fea {
namespace {

using testing::HasSubstr;

bool less(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

ReconstructResult of_vertices(const SurfaceMesh& mesh, const ReconstructOptions& options = {}) {
  return reconstruct({.points = mesh.vertices, .normals = {}, .scanners = {}}, options);
}

ErrorParts failure(const std::vector<Vec3>& points) {
  return error_from<NotMeshable>([&] { reconstruct({.points = points, .normals = {}, .scanners = {}}); }).parts();
}

TEST(Reconstruct, ABallThroughAllItsPoints) {
  const SurfaceMesh ball = analytic::sphere(1, 4);
  const ReconstructResult result = of_vertices(ball);
  const SurfaceValidity validity = check_validity(result.surface);
  EXPECT_TRUE(validity.closed() && validity.manifold());
  EXPECT_EQ(validity.genus, 0);
  EXPECT_EQ(result.surface.vertices.size(), ball.vertices.size());
  EXPECT_NEAR(enclosed_volume(result.surface), enclosed_volume(ball), 1e-3);
  EXPECT_TRUE(result.outliers.empty());
  EXPECT_EQ(result.distances.points, ball.vertices.size());
  EXPECT_LT(result.distances.largest, 1e-12);
  EXPECT_TRUE(result.bridges.empty());
}

// No shapes are looked for in so many.
TEST(Reconstruct, ABallOfManyPoints) {
  const SurfaceMesh ball = analytic::sphere(1, 6);
  const ReconstructResult result = of_vertices(ball);
  EXPECT_TRUE(check_validity(result.surface).closed());
  EXPECT_NEAR(enclosed_volume(result.surface) / enclosed_volume(ball), 1, 1e-4);
}

TEST(Reconstruct, ATorusKeepsItsHole) {
  const SurfaceMesh torus = analytic::torus(2, 0.7, 90, 40);
  const ReconstructResult result = of_vertices(torus);
  EXPECT_EQ(check_validity(result.surface).genus, 1);
  EXPECT_NEAR(enclosed_volume(result.surface) / enclosed_volume(torus), 1, 0.005);
}

TEST(Reconstruct, ABoxKeepsItsCorners) {
  const SurfaceMesh box = analytic::box({4, 3, 2}, 0.2);
  const ReconstructResult result = of_vertices(box);
  EXPECT_TRUE(check_validity(result.surface).closed());
  EXPECT_NEAR(enclosed_volume(result.surface), 24, 0.05);
  EXPECT_TRUE(result.outliers.empty());
}

TEST(Reconstruct, TheSameForAnyNumberOfThreadsAndEveryTime) {
  const ScannedCloud scanned =
      scan_surface(analytic::torus(2, 0.7, 90, 40), {.points = 3000, .noise = 0.0005, .outliers = 0.01});
  const ReconstructResult first = reconstruct(scanned.cloud);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const std::vector<std::unique_ptr<int>> elsewhere_in_memory(1000);
  const ReconstructResult second = reconstruct(scanned.cloud);
  EXPECT_EQ(first.surface.vertices, second.surface.vertices);
  EXPECT_EQ(first.surface.triangles, second.surface.triangles);
  EXPECT_EQ(first.choice, second.choice);
}

// Of a regular cloud all triangles are the best ones: what is taken must not be what lies first in memory.
TEST(Reconstruct, TheSameWhereManyChoicesWeighTheSame) {
  const SurfaceMesh torus = analytic::torus(10, 3, 64, 32);
  const ReconstructResult first = of_vertices(torus);
  // Every other gap is free, the last ones first.
  std::vector<std::unique_ptr<std::array<char, 104>>> in_memory(100'000);
  for (auto& block : in_memory) block = std::make_unique<std::array<char, 104>>();
  for (std::size_t i = 0; i < in_memory.size(); i += 2) in_memory[i].reset();
  const ReconstructResult second = of_vertices(torus);
  EXPECT_EQ(first.surface.triangles, second.surface.triangles);
}

struct OutlierShares {
  double gone = 0, lost = 0;  // of the outliers; of the true points
};

OutlierShares outlier_shares(const ScannedCloud& scanned, std::vector<Vec3> dropped) {
  std::ranges::sort(dropped, less);
  double outliers = 0, gone = 0, lost = 0;
  for (std::size_t i = 0; i < scanned.cloud.points.size(); ++i) {
    const bool is_dropped = std::binary_search(dropped.begin(), dropped.end(), scanned.cloud.points[i], less);
    outliers += scanned.is_outlier[i];
    gone += scanned.is_outlier[i] && is_dropped;
    lost += !scanned.is_outlier[i] && is_dropped;
  }
  return {gone / outliers, lost / (static_cast<double>(scanned.cloud.points.size()) - outliers)};
}

void expect_outliers_gone(const SurfaceMesh& truth, OutlierKind kind) {
  const ScannedCloud scanned = scan_surface(
      truth, {.points = 4000, .noise = 0.001, .outliers = 0.01, .outlier_kind = kind, .thinned_patches = 4});
  const ReconstructResult result = reconstruct(scanned.cloud);
  const OutlierShares shares = outlier_shares(scanned, result.outliers);
  EXPECT_GE(shares.gone, 0.9);
  EXPECT_LE(shares.lost, 0.01);
  EXPECT_NEAR(enclosed_volume(result.surface) / enclosed_volume(truth), 1, 0.01);  // chords of patches lie inside
}

TEST(Reconstruct, OutliersGoAndTruePointsStay) {
  SurfaceMesh lump = analytic::sphere(1, 5);
  for (Vec3& p : lump.vertices) p *= 1 + 0.15 * std::sin(3 * p[0] + 1) * std::cos(4 * p[1] - p[2]);
  expect_outliers_gone(lump, OutlierKind::along_view);
}

TEST(Reconstruct, OutliersAnywhereInTheBoxGo) {
  expect_outliers_gone(analytic::torus(2, 0.7, 200, 80), OutlierKind::in_box);
}

// Its edges and corners lie off planes through their neighbours as near outliers do; the box's faces tell them apart.
TEST(Reconstruct, OutliersOfAPartGoAndItsEdgesStay) {
  expect_outliers_gone(analytic::box({4, 3, 2}, 0.1), OutlierKind::along_view);
}

TEST(Reconstruct, NoiseLargerThanTheSpacingIsSmoothed) {
  const SurfaceMesh ball = analytic::sphere(1, 5);
  const ReconstructResult result = reconstruct(scan_surface(ball, {.points = 20'000, .noise = 0.01}).cloud);
  EXPECT_GT(result.merged, 10'000);
  EXPECT_TRUE(check_validity(result.surface).closed());
  EXPECT_NEAR(enclosed_volume(result.surface) / enclosed_volume(ball), 1, 0.03);
}

TEST(Reconstruct, PoissonIsSmoothAndNear) {
  const SurfaceMesh ball = analytic::sphere(1, 4);
  const ReconstructResult result = of_vertices(ball, {.method = ReconstructionMethod::poisson});
  EXPECT_TRUE(check_validity(result.surface).closed());
  EXPECT_EQ(check_validity(result.surface).genus, 0);
  EXPECT_NEAR(enclosed_volume(result.surface) / enclosed_volume(ball), 1, 0.02);
  EXPECT_LT(result.distances.largest, result.spacing);
  EXPECT_EQ(result.kept, ball.vertices.size());
}

TEST(Reconstruct, RepeatedPointsCountOnce) {
  SurfaceMesh ball = analytic::sphere(1, 3);
  const std::size_t once = ball.vertices.size();
  ball.vertices.insert(ball.vertices.end(), ball.vertices.begin(), ball.vertices.begin() + 100);
  const ReconstructResult result = of_vertices(ball);
  EXPECT_EQ(result.repeated, 100);
  EXPECT_EQ(result.surface.vertices.size(), once);
}

TEST(Reconstruct, LargeCloudsAreThinnedAndItIsTold) {
  const SurfaceMesh ball = analytic::sphere(1, 6);
  const ReconstructResult result = of_vertices(ball, {.largest_cloud = 5000});
  EXPECT_LE(result.surface.vertices.size(), 5000);
  EXPECT_GT(result.surface.vertices.size(), 2500);
  EXPECT_EQ(result.surface.vertices.size() + result.thinned + result.merged + result.off_surface, ball.vertices.size());
  EXPECT_GT(result.cell, 0);
  EXPECT_LT(result.distances.largest, result.cell);
  EXPECT_TRUE(check_validity(result.surface).closed());
}

TEST(Reconstruct, GapsAreClosedOrAnErrorThatNamesThePlace) {
  SurfaceMesh ball = analytic::sphere(1, 4);
  std::erase_if(ball.vertices, [](const Vec3& p) { return p.z() > 0.93; });
  EXPECT_TRUE(check_validity(of_vertices(ball).surface).closed());
  std::erase_if(ball.vertices, [](const Vec3& p) { return p.z() > 0.2; });
  const ErrorParts parts = failure(ball.vertices);
  EXPECT_THAT(parts.what, HasSubstr("no solid"));
}

TEST(Reconstruct, AnOpenSceneIsNoSolid) {
  std::vector<Vec3> points;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j) points.emplace_back(i, j, 3 * std::sin(i / 9.0) * std::cos(j / 7.0));
  EXPECT_THAT(failure(points).what, HasSubstr("no solid"));
}

TEST(Reconstruct, WhatIsNoCloudAboutASolidIsNamed) {
  EXPECT_THAT(failure(std::vector<Vec3>(10, Vec3(1, 2, 3))).what, HasSubstr("one place"));
  EXPECT_THAT(failure({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}}).what, HasSubstr("too few"));
  std::vector<Vec3> line, plane;
  for (int i = 0; i < 50; ++i) {
    line.emplace_back(i, 2.0 * i, 3.0 * i);
    for (int j = 0; j < 50; ++j) plane.emplace_back(i, j, 0.5 * i + 0.25 * j);
  }
  EXPECT_THAT(failure(line).what, HasSubstr("on a line"));
  EXPECT_THAT(failure(plane).what, HasSubstr("in a plane"));
}

TEST(Reconstruct, CanBeCancelled) {
  const SurfaceMesh ball = analytic::sphere(1, 4);
  const Progress progress([](std::string_view, double fraction) { return fraction < 0.5; });
  EXPECT_THROW(reconstruct({.points = ball.vertices, .normals = {}, .scanners = {}}, {}, progress), Cancelled);
}

}  // namespace
}  // namespace scan2fea
