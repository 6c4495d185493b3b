// A damaged part comes out the same wherever it lies in space and in whatever order and winding its faces are given.
#include "preproc/surface/repair/repair.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/surfaces_to_repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>

namespace scan2fea {
namespace {

// Whole caps of some parts face inwards: as CAD exports them.
SurfaceMesh holed_and_flipped() {
  SurfaceMesh mesh = without_faces(analytic::cylinder(5, 20, 32, 10), [](const Vec3& c) {
    return (c - Vec3(5, 0, 10)).norm() < 1.2 || (c - Vec3(-5, 0, 4)).norm() < 0.9;
  });
  for (Triangle& t : mesh.triangles)
    if (mesh.vertices[t[0]].z() == 20) std::swap(t[1], t[2]);
  return mesh;
}

SurfaceMesh two_balls() {
  const SurfaceMesh ball = analytic::sphere(10, 3);
  return analytic::join(ball, analytic::moved(ball, {11.3, 3.1, 2.2}));
}

SurfaceMesh ball_apart() {
  SurfaceMesh mesh = torn(analytic::sphere(10, 3));
  return analytic::noisy(mesh, 1e-4, 5);
}

SurfaceMesh boxes_in_contact() {
  return analytic::join(analytic::box({20, 20, 20}, 5), analytic::moved(analytic::box({20, 20, 20}, 5), {20, 0, 0}));
}

SurfaceMesh ring_with_specks_and_a_cavity() {
  SurfaceMesh mesh =
      analytic::join(analytic::torus(20, 8, 60, 24), analytic::moved(analytic::sphere(3, 2), {20, 0, 0}));
  for (int i = 0; i < 20; ++i)
    mesh = analytic::join(mesh, analytic::moved(analytic::sphere(0.1 + 0.02 * i, 1), Vec3(3.0 * i - 30, 40, i % 3)));
  return mesh;
}

void expect_the_same_everywhere(const SurfaceMesh& part, double turned_faces = 0) {
  SurfaceMesh first = part;
  const RepairResult result = repair(first);
  expect_sound(first);
  const SurfaceValidity wanted = check_validity(first);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    SurfaceMesh mesh = analytic::elsewhere(part, seed, turned_faces);
    const RepairResult of_mesh = repair(mesh);
    expect_sound(mesh);
    const SurfaceValidity validity = check_validity(mesh);
    EXPECT_EQ(validity.components, wanted.components);
    EXPECT_EQ(validity.genus, wanted.genus);
    // Of patches over a hole that are equally good another one may be taken.
    EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(first), 1e-4 * enclosed_volume(first));
    for (const RepairKind kind :
         {RepairKind::ClosedHole, RepairKind::DroppedSpeck, RepairKind::DroppedFragment, RepairKind::UnitedShell,
          RepairKind::FilledCavity, RepairKind::InnerWall, RepairKind::Intersection})
      EXPECT_EQ(of_mesh.count(kind), result.count(kind)) << name(kind);
  }
}

TEST(RepairInvariance, HolesAndFlippedCaps) {
  expect_the_same_everywhere(holed_and_flipped());
  expect_the_same_everywhere(holed_and_flipped(), 0.1);
}

TEST(RepairInvariance, BallsThatCross) {
  expect_the_same_everywhere(two_balls());
}

TEST(RepairInvariance, CornersApart) {
  expect_the_same_everywhere(ball_apart());
}

TEST(RepairInvariance, BoxesInContact) {
  expect_the_same_everywhere(boxes_in_contact());
  expect_the_same_everywhere(boxes_in_contact(), 0.2);
}

TEST(RepairInvariance, SpecksAndACavity) {
  expect_the_same_everywhere(ring_with_specks_and_a_cavity());
  expect_the_same_everywhere(ring_with_specks_and_a_cavity(), 0.05);
}

}  // namespace
}  // namespace scan2fea
