// What repair leaves alone, which way it turns faces, what it drops and what it refuses.
#include "preproc/surface/repair/repair.hpp"

#include "tests/analytic_meshes.hpp"
#include "tests/surfaces_to_repair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;

TEST(Repair, SoundInputStaysBitIdentical) {
  for (const SurfaceMesh& original :
       {unit_box(4), analytic::sphere(2, 3), analytic::torus(3, 1, 24, 12), analytic::slab_with_holes(2, 0.5),
        analytic::join(analytic::sphere(3, 2), analytic::reversed(analytic::sphere(1, 2)))}) {
    SurfaceMesh mesh = original;
    const RepairResult result = repair(mesh);
    EXPECT_TRUE(result.unchanged());
    EXPECT_EQ(mesh.vertices, original.vertices);
    EXPECT_EQ(mesh.triangles, original.triangles);
  }
}

TEST(Repair, IsIdempotent) {
  SurfaceMesh mesh = without_faces(analytic::sphere(1, 3), [](const Vec3& c) { return c.z() > 0.95; });
  repair(mesh);
  const SurfaceMesh once = mesh;
  EXPECT_TRUE(repair(mesh).unchanged());
  EXPECT_EQ(mesh.vertices, once.vertices);
  EXPECT_EQ(mesh.triangles, once.triangles);
}

TEST(Repair, IsDeterministic) {
  SurfaceMesh first = analytic::noisy(analytic::sphere(1, 4), 0.03, 3);
  SurfaceMesh second = first;
  repair(first);
  repair(second);
  EXPECT_EQ(first.vertices, second.vertices);
  EXPECT_EQ(first.triangles, second.triangles);
}

TEST(Repair, InsideOutBoxIsTurned) {
  SurfaceMesh mesh = analytic::reversed(unit_box(3));
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-12);
  EXPECT_EQ(result.count(RepairKind::TurnedFaces), 1u);
  EXPECT_NEAR(result.total_size(RepairKind::TurnedFaces), 6, 1e-12);
}

TEST(Repair, FacesOfNoAreaAloneAreRefused) {
  const SurfaceMesh point{{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, {{0, 1, 2}}};
  EXPECT_THAT(message_of_failure(point), HasSubstr("nothing is left"));
}

TEST(Repair, SingleFacesAreTurnedToAgreeWithTheirNeighbours) {
  SurfaceMesh mesh = unit_box(4);
  const SurfaceMesh original = mesh;
  for (std::size_t f = 0; f < mesh.triangles.size(); f += 7) std::swap(mesh.triangles[f][0], mesh.triangles[f][2]);
  repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(mesh.vertices, original.vertices);
  EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-12);
}

TEST(Repair, NestedShellsAlternate) {
  const SurfaceMesh ball = analytic::sphere(4, 3), cavity = analytic::sphere(2, 3), core = analytic::sphere(1, 3);
  SurfaceMesh mesh = analytic::join(analytic::join(core, analytic::reversed(ball)), cavity);
  repair(mesh);
  expect_sound(mesh);
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(ball) - enclosed_volume(cavity) + enclosed_volume(core), 1e-9);
}

TEST(Repair, SpecksAndUnusedVerticesAreDropped) {
  const SurfaceMesh ball = analytic::sphere(10, 3);
  const SurfaceMesh speck = analytic::sphere(0.05, 1);
  SurfaceMesh mesh = analytic::join(ball, analytic::moved(speck, {12, 0, 0}));
  mesh.vertices.push_back({0, 0, 20});
  const RepairResult result = repair(mesh);
  EXPECT_EQ(mesh.vertices, ball.vertices);
  EXPECT_EQ(mesh.triangles, ball.triangles);
  ASSERT_EQ(result.count(RepairKind::DroppedSpeck), 1u);
  EXPECT_NEAR(result.total_size(RepairKind::DroppedSpeck), surface_area(speck), 1e-12);
  EXPECT_EQ(result.count(RepairKind::UnusedVertex), 1u);
}

TEST(Repair, OpenFragmentsAreDropped) {
  const SurfaceMesh ball = analytic::sphere(10, 3);
  const SurfaceMesh sheet = without_faces(unit_box(3), [](const Vec3& c) { return c.z() > 1e-9; });
  SurfaceMesh mesh = analytic::join(ball, analytic::moved(sheet, {12, 0, 0}));
  const RepairResult result = repair(mesh, {.bodies = AllBodies{}});
  EXPECT_EQ(mesh.triangles, ball.triangles);
  EXPECT_EQ(result.count(RepairKind::DroppedFragment), 1u);
}

TEST(Repair, WhatEnclosesNothingIsNotMeshable) {
  const SurfaceMesh triangle{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}};
  message_of_failure(triangle);
  message_of_failure(triangle, closing_all());

  SurfaceMesh flat = unit_box(3);
  for (Vec3& p : flat.vertices) p.z() *= 1e-9;
  EXPECT_THAT(message_of_failure(flat), HasSubstr("no volume"));
  for (Vec3& p : flat.vertices) p.z() = 0;
  message_of_failure(flat);

  const SurfaceMesh sheet = without_faces(unit_box(3), [](const Vec3& c) { return c.z() > 1e-9; });
  message_of_failure(sheet);
  EXPECT_THAT(message_of_failure(sheet, closing_all()), HasSubstr("no volume"));
}

TEST(Repair, BrokenIndicesAndCoordinatesAreInvalid) {
  SurfaceMesh empty;
  EXPECT_THROW(repair(empty), InvalidInput);
  SurfaceMesh out_of_range = unit_box(1);
  out_of_range.triangles[3][1] = 8;
  EXPECT_THROW(repair(out_of_range), InvalidInput);
  SurfaceMesh not_finite = unit_box(1);
  not_finite.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(repair(not_finite), InvalidInput);
}

TEST(Repair, CanBeCancelled) {
  SurfaceMesh mesh = unit_box(2);
  EXPECT_THROW(repair(mesh, {}, Progress([](std::string_view, double) { return false; })), Cancelled);
}

}  // namespace
}  // namespace scan2fea
