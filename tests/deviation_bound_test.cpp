#include "quality/deviation_bound.hpp"

#include "preproc/mesh/error.hpp"
#include "quality/deviation.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace scan2fea {
namespace {

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

SurfaceMesh ellipsoid(int levels) {
  SurfaceMesh mesh = analytic::sphere(1, levels);
  for (Vec3& v : mesh.vertices) v = v.cwiseProduct(Vec3(1, 0.7, 0.4));
  return mesh;
}

TEST(DeviationBound, OfASurfaceFromItselfIsZero) {
  const SurfaceMesh mesh = analytic::torus(3, 1, 40, 20);
  const DeviationBound bound = bound_deviation(mesh, mesh, {});
  EXPECT_LT(bound.upper(), 1e-6);
}

TEST(DeviationBound, OfConcentricSpheres) {
  const SurfaceMesh inner = analytic::sphere(1, 4), outer = analytic::sphere(1.1, 4);
  const DeviationBound bound = bound_deviation(outer, inner, {});
  // The outer one is the inner one scaled: no point is farther than a tenth of its own radius, the vertices are so far.
  EXPECT_GE(bound.upper(), 0.1 - 1e-12);
  EXPECT_LE(bound.upper(), 0.1 * 1.02 + 1e-12);
  EXPECT_NEAR(bound.lower(), 0.1, 1e-12);
}

TEST(DeviationBound, SeesWhatHappensInsideOfFaces) {
  // Two triangles of a square, and the same square with its middle raised: only the middle is off, and no vertex of
  // the flat one says so.
  SurfaceMesh flat, tent;
  flat.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 3}};
  tent.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 1}};
  tent.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const DeviationBound bound = bound_deviation(flat, tent, {.limit = 0, .tolerance = 0.001});
  // The flat square's middle lies 1 below the apex, and nearest to the four slopes of 45 degrees.
  EXPECT_NEAR(bound.to_reference.largest_upper, std::sqrt(0.5), 2e-3);
  EXPECT_GE(bound.to_reference.largest_upper, std::sqrt(0.5) - 1e-12);
  EXPECT_NEAR(bound.to_mesh.largest_upper, 1, 2e-3);
  EXPECT_EQ(&bound.worse_side(), &bound.to_mesh);
  EXPECT_EQ(bound.to_mesh.farthest[bound.to_mesh.worst_face], Vec3(1, 1, 1));
}

TEST(DeviationBound, FindsAHoleThatFewSamplesMiss) {
  const SurfaceMesh sphere = analytic::sphere(1, 2);
  SurfaceMesh open = sphere;
  const Triangle t = open.triangles[0];
  const Vec3 a = open.vertices[t[0]], b = open.vertices[t[1]], c = open.vertices[t[2]];
  open.triangles.erase(open.triangles.begin());
  const DeviationBound bound = bound_deviation(sphere, open, {.limit = 0, .tolerance = 0.001});
  // The hole's border is there, so the farthest point of the missing triangle is the centre of its inscribed circle,
  // but for the faces around it, which bend towards it.
  const double in_radius = (b - a).cross(c - a).norm() / ((b - a).norm() + (c - b).norm() + (a - c).norm());
  EXPECT_NEAR(bound.to_reference.largest_upper, in_radius, 0.01 * in_radius);
  EXPECT_EQ(bound.to_reference.worst_face, 0U);
  const Deviation sampled = measure_deviation(sphere, open, {.samples = 1000, .seed = 1});
  EXPECT_LT(sampled.hausdorff, 0.95 * bound.upper());
  EXPECT_LT(bound.to_mesh.largest_upper, 1e-6);
}

TEST(DeviationBound, IsNeverBelowADenseSamplingAndNearIt) {
  for (const double noise : {0.0, 0.002, 0.02}) {
    const SurfaceMesh fine = analytic::noisy(ellipsoid(4), noise, 1);
    const SurfaceMesh coarse = ellipsoid(2);
    const DeviationBound bound = bound_deviation(coarse, fine, {.limit = 0, .tolerance = 0.01});
    const Deviation sampled = measure_deviation(coarse, fine, {.samples = 100'000, .seed = 1});
    EXPECT_GE(bound.upper(), sampled.hausdorff);
    EXPECT_GE(bound.lower(), 0.99 * sampled.hausdorff);
    EXPECT_LE(bound.upper(), 1.03 * sampled.hausdorff);
  }
}

TEST(DeviationBound, LimitSavesWorkButNeverBreaksABound) {
  const SurfaceMesh fine = ellipsoid(4), coarse = ellipsoid(2);
  const DeviationBound close = bound_deviation(coarse, fine, {});
  const double largest_deviation = close.upper();
  for (const double factor : {0.5, 0.9, 1.1, 2.0}) {
    const double limit = factor * largest_deviation;
    const DeviationBound bound = bound_deviation(coarse, fine, {.limit = limit});
    EXPECT_EQ(bound.holds(limit), factor > 1);
    for (std::size_t f = 0; f < coarse.triangles.size(); ++f) {
      EXPECT_LE(bound.to_reference.lower[f], bound.to_reference.upper[f]);
      EXPECT_GE(bound.to_reference.upper[f], close.to_reference.lower[f]);
      EXPECT_LE(bound.to_reference.lower[f], close.to_reference.upper[f]);
    }
  }
}

TEST(DeviationBound, TrianglesWithoutAreaAreSegmentsAndPoints) {
  SurfaceMesh mesh = analytic::box({1, 1, 1}, 0.5), with_needles = mesh;
  const auto outside = static_cast<std::uint32_t>(with_needles.vertices.size());
  with_needles.vertices.push_back({1, 1, 2});
  std::uint32_t corner = 0;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.vertices[v] == Vec3(1, 1, 1)) corner = v;
  with_needles.triangles.push_back({corner, outside, corner});
  const DeviationBound bound = bound_deviation(with_needles, mesh, {});
  EXPECT_NEAR(bound.to_reference.largest_upper, 1, 0.02);
  EXPECT_EQ(bound.to_reference.worst_face, mesh.triangles.size());
  EXPECT_LT(bound.to_mesh.largest_upper, 1e-6);
}

// All that the bounds promise, against points of each face: random ones, many near its edges.
void expect_bounds_hold(const SurfaceMesh& mesh, const DeviationReference& reference, const OneSidedDeviation& bound,
                        const DeviationBoundOptions& options, unsigned seed) {
  const double rounding = 1e-12 * bounding_box(reference.mesh().vertices).diagonal();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto distance = [&](const Vec3& p) { return std::sqrt(reference.tree().closest(p).squared_distance); };
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& [a, b, c] = mesh.triangles[f];
    for (int i = 0; i < 12; ++i) {
      const int power = 1 + i % 3;
      Vec3 weight(std::pow(uniform(random), power), std::pow(uniform(random), power), std::pow(uniform(random), power));
      weight /= weight.sum() + 1e-300;
      const Vec3 p = weight[0] * mesh.vertices[a] + weight[1] * mesh.vertices[b] + weight[2] * mesh.vertices[c];
      ASSERT_LE(distance(p), bound.upper[f] + rounding) << "face " << f;
    }
    ASSERT_LE(bound.lower[f], bound.upper[f]);
    ASSERT_NEAR(distance(bound.farthest[f]), bound.lower[f], rounding);
    const Vec3 on_face =
        closest_point_on_triangle(bound.farthest[f], mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    ASSERT_LE((on_face - bound.farthest[f]).norm(), rounding);
    const double close_enough = bound.lower[f] + options.tolerance * std::max(bound.lower[f], options.limit);
    ASSERT_LE(bound.upper[f], std::max(options.limit, close_enough) + rounding);
  }
}

void expect_bounds_hold(const SurfaceMesh& mesh, const SurfaceMesh& reference) {
  static unsigned seed = 0;
  const DeviationReference mesh_ready(mesh), reference_ready(reference);
  const double diagonal = bounding_box(reference.vertices).diagonal();
  for (const double limit : {0.0, 0.003, 0.03})
    for (const double tolerance : {0.02, 0.3}) {
      const DeviationBoundOptions options{limit * diagonal, tolerance};
      const DeviationBound bound = bound_deviation(mesh, reference_ready, options);
      const DeviationBoundOptions used{std::max(options.limit, 1e-7 * diagonal), tolerance};
      expect_bounds_hold(mesh, reference_ready, bound.to_reference, used, ++seed);
      expect_bounds_hold(reference, mesh_ready, bound.to_mesh, used, ++seed);
    }
}

SurfaceMesh turned(SurfaceMesh mesh, double angle) {
  const Eigen::AngleAxisd turn(angle, Vec3(1, 2, 3).normalized());
  for (Vec3& v : mesh.vertices) v = turn * v;
  return mesh;
}

// Each face with vertices of its own.
SurfaceMesh soup_of(const SurfaceMesh& mesh) {
  SurfaceMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

// A sheet that turns back over itself, so that a line across meets it once or three times.
SurfaceMesh fold(double edge_length) {
  SurfaceMesh mesh = analytic::sheet(3, 1, edge_length);
  for (Vec3& v : mesh.vertices) {
    const double x = v.x();
    v = {x + 0.9 * std::sin(2 * x), v.y(), 0.1 * std::cos(2 * x)};
  }
  return mesh;
}

SurfaceMesh without(SurfaceMesh mesh, std::size_t one_of) {
  std::vector<Triangle> kept;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    if (f % one_of != one_of / 2) kept.push_back(mesh.triangles[f]);
  mesh.triangles = std::move(kept);
  return mesh;
}

TEST(DeviationBound, HoldsForPointsOfClosedSurfaces) {
  for (const double noise : {0.0, 0.01, 0.1}) {
    expect_bounds_hold(ellipsoid(1), analytic::noisy(ellipsoid(3), noise, 1));
    expect_bounds_hold(ellipsoid(2), analytic::noisy(ellipsoid(3), noise, 2));
    expect_bounds_hold(turned(analytic::box({2, 1, 0.5}, 0.5), 0.01),
                       analytic::noisy(analytic::box({2, 1, 0.5}, 0.12), noise, 3));
  }
}

TEST(DeviationBound, HoldsOverBordersAndHoles) {
  const SurfaceMesh fine = analytic::noisy(analytic::sheet(3, 1, 0.05), 0.01, 1);
  expect_bounds_hold(analytic::sheet(3, 1, 0.4), fine);
  expect_bounds_hold(analytic::sheet(3.3, 1.2, 0.5), fine);
  expect_bounds_hold(analytic::sheet(3, 1, 0.4), without(fine, 37));
  expect_bounds_hold(analytic::sheet(3, 1, 0.4), soup_of(fine));
  expect_bounds_hold(ellipsoid(2), without(ellipsoid(4), 101));
}

TEST(DeviationBound, HoldsOverFoldsAndThinWalls) {
  expect_bounds_hold(analytic::sheet(3, 1, 0.3), fold(0.04));
  expect_bounds_hold(analytic::noisy(fold(0.25), 0.01, 1), fold(0.04));
  const SurfaceMesh fin = analytic::block_with_fin(1.1);
  expect_bounds_hold(analytic::noisy(analytic::block_with_fin(4), 0.2, 1), fin);
  const SurfaceMesh sheets = analytic::join(
      analytic::sheet(3, 1, 0.05), analytic::moved(analytic::reversed(analytic::sheet(3, 1, 0.06)), {0, 0, 0.002}));
  expect_bounds_hold(analytic::noisy(analytic::sheet(3, 1, 0.3), 0.01, 1), sheets);
  expect_bounds_hold(sheets, analytic::noisy(analytic::sheet(3, 1, 0.3), 0.01, 1));
}

TEST(DeviationBound, HoldsForWhatIsNoSurface) {
  // A wall on the sheet's middle row of edges, faces turned over, faces twice, faces without area.
  SurfaceMesh fine = analytic::noisy(analytic::sheet(2, 1, 0.1), 0.01, 1);
  const auto top = static_cast<std::uint32_t>(fine.vertices.size());
  fine.vertices.push_back({1, 0.5, 0.4});
  for (std::size_t f = 0, count = fine.triangles.size(); f < count; ++f) {
    const Triangle t = fine.triangles[f];
    if (f % 17 == 3) fine.triangles.push_back({t[0], t[1], top});
    if (f % 29 == 4) fine.triangles.push_back(t);
    if (f % 23 == 5) fine.triangles.push_back({t[0], t[1], t[0]});
    if (f % 23 == 6) fine.triangles.push_back({t[2], t[2], t[2]});
    if (f % 31 == 7) std::swap(fine.triangles[f][0], fine.triangles[f][1]);
  }
  expect_bounds_hold(analytic::sheet(2, 1, 0.3), fine);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  SurfaceMesh soup;
  for (std::uint32_t v = 0; v < 60; ++v) soup.vertices.push_back({uniform(random), uniform(random), uniform(random)});
  for (int f = 0; f < 80; ++f)
    soup.triangles.push_back({static_cast<std::uint32_t>(60 * uniform(random)),
                              static_cast<std::uint32_t>(60 * uniform(random)),
                              static_cast<std::uint32_t>(60 * uniform(random))});
  expect_bounds_hold(analytic::box({1, 1, 1}, 0.5), soup);
}

TEST(DeviationBound, IsTheSameForAnyNumberOfThreads) {
  const SurfaceMesh fine = analytic::noisy(ellipsoid(4), 0.002, 1), coarse = ellipsoid(2);
  const auto bound_with = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return bound_deviation(coarse, fine, {.limit = 0.001});
  };
  const DeviationBound one = bound_with(1), four = bound_with(4);
  EXPECT_EQ(one.to_mesh.upper, four.to_mesh.upper);
  EXPECT_EQ(one.to_reference.upper, four.to_reference.upper);
  EXPECT_EQ(one.to_reference.lower, four.to_reference.lower);
  EXPECT_EQ(largest(one.to_reference.upper), one.to_reference.largest_upper);
}

TEST(DeviationBound, RefusesNonsense) {
  const SurfaceMesh box = analytic::box({1, 1, 1}, 1);
  EXPECT_THROW(bound_deviation(box, box, {.limit = -1}), WrongUsage);
  EXPECT_THROW(bound_deviation(box, box, {.limit = 0, .tolerance = 0}), WrongUsage);
  EXPECT_THROW(bound_deviation(SurfaceMesh{}, box, {}), InvalidInput);
}

}  // namespace
}  // namespace scan2fea
