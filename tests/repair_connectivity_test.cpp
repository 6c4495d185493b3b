// Faces that are there twice, that hang on others by an edge or a vertex, or that miss their neighbours.
#include "preproc/surface/repair/repair.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/surfaces_to_repair.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

TEST(RepairConnectivity, DoubledFacesAreHalved) {
  const SurfaceMesh box = unit_box(3);
  // The same faces again, and the same faces inside out: a shell drawn from both sides.
  for (const SurfaceMesh& copy : {box, analytic::reversed(box)}) {
    SurfaceMesh mesh = box;
    mesh.triangles.insert(mesh.triangles.end(), copy.triangles.begin(), copy.triangles.end());
    const RepairResult result = repair(mesh);
    expect_sound(mesh);
    EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-12);
    EXPECT_EQ(result.count(RepairKind::DuplicateFace), box.triangles.size());
  }
  SurfaceMesh mesh = box;
  mesh.triangles.push_back(mesh.triangles[5]);
  mesh.triangles.push_back({mesh.triangles[9][2], mesh.triangles[9][1], mesh.triangles[9][0]});
  repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(mesh.triangles.size(), box.triangles.size());
}

TEST(RepairConnectivity, DoubleWallBetweenBoxesIsTakenOut) {
  SurfaceMesh mesh = welded(analytic::join(unit_box(3), analytic::moved(unit_box(3), {1, 0, 0})));
  // Exactly coincident walls need exactly coincident vertices: thirds do not add up to one, places at x = 1 do.
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 1u);
  EXPECT_NEAR(enclosed_volume(mesh), 2, 1e-12);
  EXPECT_EQ(result.count(RepairKind::DuplicateFace), 36u);
}

TEST(RepairConnectivity, SingleWallInABoxIsTakenOut) {
  SurfaceMesh mesh = welded(analytic::join(
      unit_box(3), analytic::moved(without_faces(unit_box(3), [](const Vec3& c) { return c.x() < 1e-9; }), {1, 0, 0})));
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 1u);
  EXPECT_NEAR(enclosed_volume(mesh), 2, 1e-12);
  ASSERT_EQ(result.count(RepairKind::InnerWall), 1u);
  EXPECT_NEAR(result.total_size(RepairKind::InnerWall), 1, 1e-12);
}

TEST(RepairConnectivity, FlapIsTakenOff) {
  SurfaceMesh mesh = unit_box(2);
  const SurfaceMesh original = mesh;
  const auto tip = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0.5, 0.5, 2});
  mesh.triangles.push_back({mesh.triangles[0][0], mesh.triangles[0][1], tip});
  repair(mesh);
  EXPECT_EQ(mesh.triangles, original.triangles);
  EXPECT_EQ(mesh.vertices, original.vertices);
}

TEST(RepairConnectivity, BoxesThatShareAnEdgeComeApart) {
  SurfaceMesh mesh = welded(analytic::join(unit_box(2), analytic::moved(unit_box(2), {1, 1, 0})));
  ASSERT_GT(check_validity(mesh).non_manifold_edges, 0u);
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 2u);
  EXPECT_EQ(result.count(RepairKind::SplitVertex), 3u);
  EXPECT_NEAR(enclosed_volume(mesh), 2, 1e-12);
}

TEST(RepairConnectivity, BoxesThatShareAVertexComeApart) {
  SurfaceMesh mesh = welded(analytic::join(unit_box(2), analytic::moved(unit_box(2), {1, 1, 1})));
  ASSERT_EQ(check_validity(mesh).non_manifold_vertices, 1u);
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 2u);
  EXPECT_EQ(result.count(RepairKind::SplitVertex), 1u);
  EXPECT_EQ(result.count(RepairKind::PartedTouch), 1u);
  EXPECT_NEAR(enclosed_volume(mesh), 2, 1e-12);
}

// Of a body that touches itself, or others in a ring, none can be moved as a whole.
TEST(RepairConnectivity, WhatTouchesAtEdgesIsPartedByAMillionth) {
  SurfaceMesh checker, winding = unit_box(1);
  for (int i = 0; i < 27; ++i)
    if (i % 2 == 0) checker = analytic::join(checker, analytic::moved(unit_box(1), Vec3(i % 3, i / 3 % 3, i / 9)));
  for (const Vec3& at : {Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(2, 0, 1), Vec3(2, 1, 1), Vec3(1, 1, 1)})
    winding = analytic::join(winding, analytic::moved(unit_box(1), at));
  for (const SurfaceMesh& touching : {checker, winding}) {
    SurfaceMesh mesh = welded(touching);
    const double volume = enclosed_volume(mesh), diagonal = bounding_box(mesh.vertices).diagonal();
    const RepairResult result = repair(mesh);
    expect_sound(mesh);
    EXPECT_GT(result.count(RepairKind::PartedTouch), 0U);
    EXPECT_EQ(result.count(RepairKind::SmoothedFold), 0U);
    for (const RepairChange& change : result.changes)
      if (change.kind == RepairKind::PartedTouch) {
        EXPECT_LE(change.size, 1.01e-6 * diagonal);
      }
    EXPECT_NEAR(enclosed_volume(mesh), volume, 1e-4 * volume);
  }
}

TEST(RepairConnectivity, SoupOfSeparateFacesIsWelded) {
  const SurfaceMesh box = unit_box(4);
  SurfaceMesh mesh = torn(box);
  repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(mesh.vertices.size(), box.vertices.size());
  EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-12);
}

TEST(RepairConnectivity, TouchingVerticesThatCloseNoBorderAreNotWelded) {
  SurfaceMesh mesh = analytic::join(unit_box(2), analytic::moved(unit_box(2), {1, 1, 1}));
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(result.count(RepairKind::WeldedVertex), 0u);
  EXPECT_EQ(check_validity(mesh).components, 2u);
}

TEST(RepairConnectivity, DegenerateFacesLeaveNoSlit) {
  // A vertex on an edge of one neighbour only, bridged by a face of no area; and an edge of no length.
  SurfaceMesh mesh = unit_box(2);
  const Triangle split = mesh.triangles[0];
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back((mesh.vertices[split[0]] + mesh.vertices[split[1]]) / 2);
  mesh.triangles[0] = {middle, split[1], split[2]};
  mesh.triangles.push_back({split[0], middle, split[2]});
  mesh.triangles.push_back({split[0], split[1], middle});
  mesh.triangles.push_back({split[0], split[0], split[1]});
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(result.count(RepairKind::DegenerateFace), 2u);
  EXPECT_EQ(result.count(RepairKind::Intersection), 0u);
  EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-12);
}

TEST(RepairConnectivity, TJunctionIsClosed) {
  SurfaceMesh mesh = unit_box(2);
  const Triangle split = mesh.triangles[0];
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back((mesh.vertices[split[0]] + mesh.vertices[split[1]]) / 2);
  mesh.triangles[0] = {middle, split[1], split[2]};
  mesh.triangles.push_back({split[0], middle, split[2]});
  repair(mesh);
  expect_sound(mesh);
  EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-12);
}

}  // namespace
}  // namespace scan2fea
