#include "quality/deviation_bound.hpp"

#include "preproc/mesh/error.hpp"
#include "quality/deviation.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

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
