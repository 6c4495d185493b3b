#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/simplification/simplify.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace scan2fea {
namespace {

SimplifyOptions of_faces(std::size_t faces) {
  SimplifyOptions options;
  options.size = FaceCount{faces};
  return options;
}

void expect_sound(const SurfaceMesh& mesh, const SurfaceMesh& scan) {
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_TRUE(validity.closed());
  EXPECT_TRUE(validity.manifold());
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  EXPECT_NEAR(enclosed_volume(mesh) / enclosed_volume(scan), 1, 1e-9);
}

TEST(ShapeSearch, ABlockOfFewTrianglesIsWellShapedAndKeepsItsEdges) {
  const SurfaceMesh scan = analytic::box({4, 4, 2}, 4);
  SurfaceMesh mesh = scan;
  const SimplifyResult result = simplify(mesh, of_faces(30));
  expect_sound(mesh, scan);
  EXPECT_GE(measure_triangles(mesh).min_angle_deg.min, 25);
  EXPECT_EQ(result.faces_after, mesh.triangles.size());
  EXPECT_EQ(result.size_remark.empty(), mesh.triangles.size() <= 31);
  const BoundingBox before = bounding_box(scan.vertices), after = bounding_box(mesh.vertices);
  EXPECT_NEAR((before.high - after.high).norm() + (before.low - after.low).norm(), 0, 1e-6);
}

TEST(ShapeSearch, AThinWallGetsTrianglesThatLeaveElementsAHeight) {
  const SurfaceMesh scan = analytic::box({10, 10, 0.5}, 0.5);
  SurfaceMesh mesh = scan;
  simplify(mesh, of_faces(200));  // edges of about 1.6
  expect_sound(mesh, scan);
  EXPECT_GE(0.5 / mean_edge_length(mesh), 0.35);
}

constexpr std::uint32_t points_a_ray = 10;

// A fan around the origin of rays at 0, 15, 90, 180 and 270 degrees; the first hangs down, so that the steep
// sector between it and the second makes that the sharper crease.
SurfaceMesh fan() {
  SurfaceMesh mesh;
  mesh.vertices.push_back(Vec3::Zero());
  for (const double degrees : {0., 15., 90., 180., 270.}) {
    const double angle = degrees * std::acos(-1.0) / 180;
    for (std::uint32_t k = 1; k <= points_a_ray; ++k)
      mesh.vertices.push_back(0.2 * k * Vec3(std::cos(angle), std::sin(angle), degrees == 0 ? -0.5 : 0));
  }
  const auto at = [](std::uint32_t ray, std::uint32_t k) { return 1 + ray % 5 * points_a_ray + k - 1; };
  for (std::uint32_t ray = 0; ray < 5; ++ray) {
    mesh.triangles.push_back({0, at(ray, 1), at(ray + 1, 1)});
    for (std::uint32_t k = 1; k < points_a_ray; ++k) {
      mesh.triangles.push_back({at(ray, k), at(ray, k + 1), at(ray + 1, k + 1)});
      mesh.triangles.push_back({at(ray, k), at(ray + 1, k + 1), at(ray + 1, k)});
    }
  }
  return mesh;
}

// The edges of one of its rays.
std::vector<FeatureEdge> ray_of_fan(std::uint32_t ray) {
  std::vector<FeatureEdge> edges{{0, 1 + ray * points_a_ray}};
  for (std::uint32_t k = 1; k < points_a_ray; ++k)
    edges.push_back({ray * points_a_ray + k, ray * points_a_ray + k + 1});
  return edges;
}

TEST(NarrowCorners, LoseTheSmootherCreaseUntilTheOtherIsFarEnough) {
  const SurfaceMesh mesh = fan();
  std::vector<FeatureEdge> creases;
  for (const std::uint32_t ray : {0u, 1u, 3u})
    for (const FeatureEdge& e : ray_of_fan(ray)) creases.push_back(e);
  std::sort(creases.begin(), creases.end());
  EXPECT_EQ(without_narrow_corners(mesh, creases, {}), creases);
  // A corner of a border, where no crease is.
  EXPECT_TRUE(without_narrow_corners(mesh, {}, {SharpCorner{Vec3::Zero(), 1}}).empty());

  const double edge = 0.4;
  const std::vector<FeatureEdge> left = without_narrow_corners(mesh, creases, {{Vec3::Zero(), edge}});
  std::vector<FeatureEdge> dropped;
  std::set_difference(creases.begin(), creases.end(), left.begin(), left.end(), std::back_inserter(dropped));
  ASSERT_FALSE(dropped.empty());
  EXPECT_EQ(left.size() + dropped.size(), creases.size());
  const std::vector<FeatureEdge> smoother = ray_of_fan(0);
  double reached = 0;
  for (const FeatureEdge& e : dropped) {
    EXPECT_NE(std::find(smoother.begin(), smoother.end(), e), smoother.end());
    reached = std::max(reached, mesh.vertices[e[1]].norm());
  }
  // How far the ray is from the other there.
  const Vec3 other = mesh.vertices[2 * points_a_ray].normalized(),
             end = reached * mesh.vertices[points_a_ray].normalized();
  EXPECT_GT(end.cross(other).norm(), 0.6 * edge);
  EXPECT_LT(end.cross(other).norm(), edge);
}

TEST(CreasesNearPlaces, LoseTheEdgesThatComeNearAndKeepTheRest) {
  const SurfaceMesh mesh = fan();
  std::vector<FeatureEdge> creases;
  for (const std::uint32_t ray : {0u, 2u})
    for (const FeatureEdge& e : ray_of_fan(ray)) creases.push_back(e);
  std::sort(creases.begin(), creases.end());
  const Vec3 place = mesh.vertices[points_a_ray];  // the end of the first ray
  const double reach = 0.25 * place.norm();
  const std::vector<FeatureEdge> left = without_creases_near(mesh, creases, {place}, reach);
  EXPECT_LT(left.size(), creases.size());
  for (const FeatureEdge& e : creases) {
    const bool near = (mesh.vertices[e[0]] - place).norm() < reach || (mesh.vertices[e[1]] - place).norm() < reach;
    EXPECT_EQ(std::binary_search(left.begin(), left.end(), e), !near);
  }
  EXPECT_EQ(without_creases_near(mesh, creases, {}, reach), creases);
}

}  // namespace
}  // namespace scan2fea
