// Thinning: what it promises of distances, of closedness, and of shapes.
#include "preproc/surface/thinning/vertex_clusters.hpp"

#include "quality/deviation.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <utility>

namespace scan2fea {
namespace {

ClusterSeeds seeds_of(const SurfaceMesh& mesh, double cell) {
  ClusterSeeds seeds(bounding_box(mesh.vertices), cell);
  seeds.add(mesh);
  seeds.choose();
  return seeds;
}

ThinnedSurface thinned(const SurfaceMesh& mesh, double cell) {
  VertexClusters clusters(seeds_of(mesh, cell));
  clusters.add(mesh);
  return std::move(clusters).surface();
}

// In both directions alike along every edge, as of a surface without border.
bool is_closed(const SurfaceMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sum;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      sum[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  return std::ranges::all_of(sum, [](const auto& edge) { return edge.second == 0; });
}

SurfaceMesh with_noise(SurfaceMesh mesh, double sigma) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, sigma);
  for (Vec3& p : mesh.vertices) p += Vec3(noise(random), noise(random), noise(random));
  return mesh;
}

TEST(VertexClusters, ThinnedTorusIsClosedAndAsNearAsIsSaid) {
  const SurfaceMesh torus = analytic::torus(3, 1, 600, 200);
  const double cell = 0.1;
  const ThinnedSurface thin = thinned(torus, cell);
  EXPECT_LT(thin.mesh.triangles.size(), torus.triangles.size() / 5);
  EXPECT_TRUE(is_closed(thin.mesh));
  EXPECT_NEAR(enclosed_volume(thin.mesh) / enclosed_volume(torus), 1, 2e-3);
  ASSERT_TRUE(thin.volume);
  EXPECT_NEAR(*thin.volume / enclosed_volume(thin.mesh), 1, 1e-12);
  const double distance = measure_deviation(thin.mesh, torus).hausdorff;
  EXPECT_LE(distance, thin.largest_distance);
  EXPECT_LE(thin.largest_distance, 2 * std::sqrt(3) * cell);
}

TEST(VertexClusters, NoiseBeyondTheCellsKeepsTheBound) {
  const SurfaceMesh ball = with_noise(analytic::sphere(1, 7), 0.01);
  const ThinnedSurface thin = thinned(ball, 0.02);
  EXPECT_LE(measure_deviation(thin.mesh, ball).hausdorff, thin.largest_distance);
}

TEST(VertexClusters, NoiseIsLessAfterwards) {
  const double sigma = 0.002;
  const SurfaceMesh ball = with_noise(analytic::sphere(1, 8), sigma);
  const ThinnedSurface thin = thinned(ball, 0.03);
  double squared = 0, area = 0;  // by area, since cells with a few points alone are as noisy as these
  for (const Triangle& t : thin.mesh.triangles) {
    const double weight = area_vector(thin.mesh, t).norm();
    for (const std::uint32_t v : t) squared += weight / 3 * std::pow(thin.mesh.vertices[v].norm() - 1, 2);
    area += weight;
  }
  EXPECT_LT(std::sqrt(squared / area), sigma / 2);
}

// Its fin, 8 wide and 24 long, is thinner than the cells.
TEST(VertexClusters, WhatIsTooThinIsInTheBound) {
  const SurfaceMesh block = analytic::block_with_fin(0.25);
  const ThinnedSurface thin = thinned(block, 0.9);
  EXPECT_TRUE(is_closed(thin.mesh));
  EXPECT_LE(measure_deviation(thin.mesh, block).hausdorff, thin.largest_distance);
}

TEST(VertexClusters, EdgesOfACubeStaySharp) {
  const SurfaceMesh cube = analytic::box({1, 1, 1}, 0.01);
  const double cell = 0.07;
  const ThinnedSurface thin = thinned(cube, cell);
  for (const Vec3& p : thin.mesh.vertices)
    EXPECT_LT(std::min(p.minCoeff(), 1 - p.maxCoeff()), 0.05 * cell) << p.transpose();
  EXPECT_NEAR(enclosed_volume(thin.mesh), 1, 2e-3);
}

// Also where cells were widened by little, and what was in one lies in two.
TEST(ClusterSeeds, EveryVertexHasOneNearBy) {
  const SurfaceMesh ball = with_noise(analytic::sphere(1, 6), 0.005);
  for (const double times : {1.0, 1.05, 1.3, 1.9, 4.0}) {
    ClusterSeeds seeds(bounding_box(ball.vertices), 0.05);
    seeds.add(ball);
    seeds = seeds.widened(times);
    seeds.choose();
    for (const Vec3& p : ball.vertices) {
      const Vec3 in_cells = seeds.in_cells(p);
      const std::uint32_t seed = seeds.nearest(in_cells);
      ASSERT_LT(seed, seeds.count());
      EXPECT_LT((seeds.seed(seed) - in_cells).norm(), std::sqrt(3) + 0.6);
    }
  }
}

// What bends as a ball does is not thick for cells far smaller than it; noise is, whatever the cells.
TEST(ClusterSeeds, ThicknessIsNoise) {
  const double sigma = 0.004;
  SurfaceMesh ball = analytic::sphere(1, 7);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, sigma);
  for (Vec3& p : ball.vertices) p += noise(random) * p;
  ClusterSeeds seeds(bounding_box(ball.vertices), 0.02);
  seeds.add(ball);
  EXPECT_NEAR(seeds.widened(4).thickness(), sigma, 0.2 * sigma);
  EXPECT_NEAR(seeds.widened(8).thickness(), sigma, 0.2 * sigma);
}

TEST(VertexClusters, BlocksAreAsGoodAsTheWhole) {
  const SurfaceMesh ball = analytic::sphere(1, 5);
  VertexClusters clusters(seeds_of(ball, 0.1));
  for (std::size_t t = 0; t < ball.triangles.size(); t += 1000) {
    SurfaceMesh block{ball.vertices, {}};
    for (std::size_t i = t; i < std::min(t + 1000, ball.triangles.size()); ++i)
      block.triangles.push_back(ball.triangles[i]);
    clusters.add(block);
  }
  const ThinnedSurface parts = std::move(clusters).surface(), whole = thinned(ball, 0.1);
  EXPECT_EQ(parts.mesh.vertices, whole.mesh.vertices);
  EXPECT_EQ(parts.mesh.triangles, whole.mesh.triangles);
  EXPECT_EQ(parts.origin, whole.origin);
  EXPECT_EQ(parts.largest_distance, whole.largest_distance);
}

TEST(VertexClusters, WhatHasABorderHasNoVolume) {
  SurfaceMesh torus = analytic::torus(3, 1, 600, 200);
  torus.triangles.resize(torus.triangles.size() / 2);
  EXPECT_FALSE(thinned(torus, 0.1).volume);
}

// Which stay one shell.
TEST(VertexClusters, TwoShellsInOnePlaceHaveTwiceTheVolume) {
  const SurfaceMesh torus = analytic::torus(3, 1, 600, 200);
  const ThinnedSurface thin = thinned(analytic::join(torus, torus), 0.1);
  ASSERT_TRUE(thin.volume);
  EXPECT_NEAR(*thin.volume / enclosed_volume(thin.mesh), 2, 1e-12);
}

// Both sides of a plate in one layer of cells.
TEST(VertexClusters, NothingIsLeftOfAPlateThinnerThanItsCells) {
  EXPECT_TRUE(thinned(analytic::box({10, 10, 0.01}, 0.5), 1.3).mesh.triangles.empty());
}

}  // namespace
}  // namespace scan2fea
