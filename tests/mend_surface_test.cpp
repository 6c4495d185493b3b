#include "preproc/surface/mending/mend_surface.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/find_features.hpp"
#include "preproc/surface/mending/local_moves.hpp"
#include "quality/triangle_measures.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace scan2fea {
namespace {

MendOptions unshifted() {
  MendOptions options;
  options.keep_volume = false;
  options.least_angle_deg = 25;  // the plate's rim has triangles of 31 degrees
  return options;
}

std::uint32_t nearest_vertex(const SurfaceMesh& mesh, const Vec3& p) {
  std::uint32_t best = 0;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if ((mesh.vertices[v] - p).norm() < (mesh.vertices[best] - p).norm()) best = v;
  }
  return best;
}

// How far from `centre` a vertex lies that differs between the two.
double reach_of_change(const SurfaceMesh& before, const SurfaceMesh& after, const Vec3& centre) {
  double reach = 0;
  for (std::size_t v = 0; v < before.vertices.size(); ++v) {
    if (before.vertices[v] != after.vertices[v]) reach = std::max(reach, (before.vertices[v] - centre).norm());
  }
  return reach;
}

TEST(MendSurface, LeavesASoundSurfaceAlone) {
  const SurfaceMesh scan = analytic::sphere(1, 4);
  SurfaceMesh mesh = analytic::sphere(1, 3);
  const SurfaceMesh before = mesh;
  const MendResult result = mend_surface(mesh, ReferenceSurface(scan), unshifted());
  EXPECT_TRUE(result.clean());
  EXPECT_EQ(result.rounds, 0);
  EXPECT_EQ(mesh.vertices, before.vertices);
  EXPECT_EQ(mesh.triangles, before.triangles);
}

// A vertex dragged over its neighbours along the surface: its star folds over.
TEST(MendSurface, UnfoldsInvertedTriangles) {
  const SurfaceMesh scan = analytic::sphere(1, 5);
  SurfaceMesh mesh = analytic::sphere(1, 4);
  const Vec3 place = Vec3(0.3, 0.5, 0.8).normalized();
  const std::uint32_t v = nearest_vertex(mesh, place);
  mesh.vertices[v] = (mesh.vertices[v] + Vec3(0.15, 0, 0)).normalized();
  const SurfaceMesh before = mesh;
  const ReferenceSurface reference(scan);
  const MendResult result = mend_surface(mesh, reference, unshifted());
  EXPECT_FALSE(result.before.inverted.empty());
  EXPECT_TRUE(result.clean());
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  for (const Triangle& t : mesh.triangles) EXPECT_GT(area_vector(mesh, t).dot(mesh.vertices[t[0]]), 0);
  EXPECT_LT(reach_of_change(before, mesh, mesh.vertices[v]), 0.6);
}

// A thin plate whose upper sheet is pushed through the lower one.
class DentedPlate : public testing::Test {
 protected:
  SurfaceMesh scan = analytic::box({6, 6, 0.3}, 0.25);
  ReferenceSurface reference{scan};
  SurfaceMesh mesh = analytic::box({6, 6, 0.3}, 0.5);
  Vec3 centre{3, 3, 0.15};
  void SetUp() override { mesh.vertices[nearest_vertex(mesh, {3, 3, 0.3})].z() = -0.1; }
};

TEST_F(DentedPlate, SheetsThatCrossArePushedApart) {
  const SurfaceMesh before = mesh;
  const MendResult result = mend_surface(mesh, reference, unshifted());
  EXPECT_FALSE(result.before.crossings.empty());
  EXPECT_TRUE(result.clean());
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  EXPECT_GT(mesh.vertices[nearest_vertex(mesh, {3, 3, 0.3})].z(), 0.15);
  EXPECT_LT(reach_of_change(before, mesh, centre), 2.5);
}

TEST_F(DentedPlate, TheVolumeIsExactAfterwards) {
  const MendResult result = mend_surface(mesh, reference);
  EXPECT_TRUE(result.clean());
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  EXPECT_NEAR(enclosed_volume(mesh) / enclosed_volume(scan), 1, 1e-12);
}

// Nothing may move, so nothing can be mended; that must be told.
TEST_F(DentedPlate, WhatCannotBeMendedIsReported) {
  MendOptions options = unshifted();
  options.constraints.assign(mesh.vertices.size(), VertexConstraint::fixed);
  const SurfaceMesh before = mesh;
  const MendResult result = mend_surface(mesh, reference, options);
  EXPECT_FALSE(result.clean());
  EXPECT_FALSE(result.after.crossings.empty());
  EXPECT_EQ(mesh.vertices, before.vertices);
}

TEST(MendSurface, RaisesSmallAngles) {
  const SurfaceMesh scan = analytic::sphere(1, 5);
  SurfaceMesh mesh = analytic::sphere(1, 3);
  const std::uint32_t v = nearest_vertex(mesh, {0, 0, 1});
  mesh.vertices[v] = (mesh.vertices[v] + Vec3(0.1, 0, 0)).normalized();
  const MendResult result = mend_surface(mesh, ReferenceSurface(scan), unshifted());
  EXPECT_FALSE(result.before.small_angles.empty());
  EXPECT_TRUE(result.after.none());
}

TEST(MendSurface, RefusesOptionsOutOfRange) {
  SurfaceMesh mesh = analytic::sphere(1, 2);
  const SurfaceMesh scan = mesh;
  MendOptions options;
  options.least_angle_deg = 60;
  EXPECT_THROW(mend_surface(mesh, ReferenceSurface(scan), options), WrongUsage);
}

TEST(Defects, NoFaceIsInvertedBesideACreaseThatEndsInsideItsPatch) {
  // A fold of 120 degrees that fades out: both of its sides are one patch, and their normals oppose one another.
  SurfaceMesh fold = analytic::sheet(20, 10, 0.5);
  for (Vec3& v : fold.vertices) {
    const double half = (120 - 12 * v[1]) * std::numbers::pi / 360;
    v = {(v[0] - 10) * std::cos(half), v[1], -std::abs(v[0] - 10) * std::sin(half)};
  }
  const SurfaceMesh measured = analytic::noisy(fold, 0.02, 1);
  const FeatureScan features(measured, find_features(fold).edges, {.least = 0.01});
  ASSERT_FALSE(features.sharp.empty());
  const ReferenceSurface scan(features);
  std::set<std::uint32_t> on_crease;
  for (const auto& [a, b] : features.sharp) on_crease.insert({a, b});
  FeatureNet net;
  net.patch_of_face.assign(fold.triangles.size(), 0);
  net.lines.emplace_back();
  for (const std::uint32_t v : on_crease) {  // ascending in y, as the sheet's vertices are
    net.lines[0].vertices.push_back({v, static_cast<double>(net.lines[0].points.size())});
    net.lines[0].points.push_back(fold.vertices[v]);
  }
  EXPECT_TRUE(find_defects(fold, scan, scan_vertices_of_faces(fold, net, scan), 0).inverted.empty());
}

// A vertex in the middle of its neighbours' edge: the face between has no area, and a flip gives it some.
TEST(Caps, AreFlippedAway) {
  SurfaceMesh mesh = analytic::sphere(1, 3);
  const Triangle cap = mesh.triangles[100];
  mesh.vertices[cap[0]] = (mesh.vertices[cap[1]] + mesh.vertices[cap[2]]) / 2;
  const double volume = enclosed_volume(mesh);
  SurfaceMesh held = mesh;
  EXPECT_EQ(flip_caps(held, {feature_edge(cap[1], cap[2])}), 0U);
  EXPECT_EQ(flip_caps(mesh, {}), 1U);
  for (const Triangle& t : mesh.triangles) EXPECT_GT(area_vector(mesh, t).norm(), 1e-4);
  EXPECT_NEAR(enclosed_volume(mesh), volume, 1e-12);
  EXPECT_EQ(flip_caps(mesh, {}), 0U);
}

}  // namespace
}  // namespace scan2fea
