// Surfaces that pass through themselves or through each other.
#include "preproc/surface/repair/repair.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/surfaces_to_repair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;

TEST(RepairIntersections, CrossingSolidsBecomeOne) {
  const SurfaceMesh ball = analytic::sphere(1, 4);
  const double distance = 1.21;
  SurfaceMesh mesh = analytic::join(ball, analytic::moved(ball, {distance, 0.07, 0.03}));
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 1u);
  EXPECT_EQ(result.count(RepairKind::UnitedShell), 2u);
  // Two balls less the lens that they have in common.
  const double d = Vec3(distance, 0.07, 0.03).norm();
  const double lens = std::numbers::pi * (4 + d) * (2 - d) * (2 - d) / 12;
  EXPECT_NEAR(enclosed_volume(mesh), 2 * enclosed_volume(ball) - lens, 0.01);
  EXPECT_EQ(result.count(RepairKind::DroppedInside), 2u);
  EXPECT_NEAR(result.total_size(RepairKind::DroppedInside), 2 * surface_area(ball) - surface_area(mesh), 1e-5);
}

// Thousands of crossings take minutes, in which an interrupt or the end of the time must count.
TEST(RepairIntersections, CanBeCancelledWhileManyCrossingsAreUnited) {
  SurfaceMesh rough = analytic::sphere(1, 5);
  for (std::size_t v = 0; v < rough.vertices.size(); v += 2) rough.vertices[v] *= 1.02;
  SurfaceMesh mesh = analytic::join(analytic::sphere(1.01, 5), rough);
  ASSERT_GT(find_self_intersections(mesh).size(), 4096u);
  std::size_t looks = 0;
  const Progress progress(
      [&](std::string_view stage, double) { return stage != "remove self-intersections" || ++looks < 3; });
  EXPECT_THROW(repair(mesh, {}, progress), Cancelled);
}

TEST(RepairIntersections, BoxesThatTouchAlongFacesBecomeOne) {
  SurfaceMesh mesh = analytic::join(analytic::box({2, 2, 1}, 1), analytic::moved(unit_box(1), {0.5, 0.5, 1}));
  repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 1u);
  EXPECT_NEAR(enclosed_volume(mesh), 5, 1e-9);
}

// Whether the faces of the two are the same, others of the same outline, or neither.
TEST(RepairIntersections, WhereSolidsTouchBothFacesAreLost) {
  const SurfaceMesh box = analytic::box({2, 2, 2}, 1);
  for (const SurfaceMesh& other :
       {analytic::moved(box, {0, 0, 2}), analytic::moved(analytic::box({2, 2, 1}, 0.5), {0, 0, 2}),
        analytic::moved(box, {0.7, 0.3, 2}), analytic::moved(unit_box(1), {0.2, 0.6, 2})}) {
    SurfaceMesh mesh = analytic::join(box, other);
    const double area = surface_area(mesh);
    const RepairResult result = repair(mesh);
    expect_sound(mesh);
    double lost = 0;
    for (const RepairChange& change : result.changes)
      if (is_lost(change.kind)) {
        lost += change.area;
        EXPECT_NEAR(change.place.z(), 2, 1e-5);
      }
    EXPECT_NEAR(lost, area - surface_area(mesh), 1e-5);
    EXPECT_GE(lost, 2 - 1e-5);
  }
}

TEST(RepairIntersections, BoxWithinABoxThatReachesOutIsUnited) {
  SurfaceMesh mesh = analytic::join(unit_box(3), analytic::moved(analytic::box({0.2, 0.2, 2}, 0.2), {0.4, 0.4, -0.5}));
  repair(mesh);
  expect_sound(mesh);
  EXPECT_NEAR(enclosed_volume(mesh), 1 + 0.04, 1e-9);
}

TEST(RepairIntersections, ASpikeThroughTheFarSideIsCutWhereItIs) {
  const SurfaceMesh original = analytic::sphere(1, 4);
  SurfaceMesh mesh = original;
  const Vec3 place = original.vertices[100];
  mesh.vertices[100] = -1.2 * place;
  ASSERT_FALSE(find_self_intersections(mesh).empty());
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_GT(result.intersecting_pairs, 0u);
  EXPECT_GT(result.count(RepairKind::Intersection), 0u);
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(original), 0.02);
  for (const Vec3& p : original.vertices)
    if (std::abs(p.dot(place)) < 0.8) {
      EXPECT_THAT(mesh.vertices, ::testing::Contains(p));
    }
}

// Where solids are united, a spike of one that passes through its own far side does not decide for the whole.
TEST(RepairIntersections, SolidsWithSpikesThroughThemselvesAreUnited) {
  const SurfaceMesh ball = analytic::sphere(1, 4);
  for (const std::size_t v : {100, 700, 1500}) {
    SurfaceMesh spiked = ball;
    spiked.vertices[v] *= -3;
    SurfaceMesh mesh = analytic::join(spiked, analytic::moved(ball, {1.2, 0.07, 0.03}));
    SurfaceMesh wanted = analytic::join(ball, analytic::moved(ball, {1.2, 0.07, 0.03}));
    repair(wanted);
    repair(mesh);
    expect_sound(mesh);
    EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(wanted), 0.02 * enclosed_volume(wanted));
  }
}

// A surface and its copy, with vertices of its own, turned round or not: in a time that grows with its size, not with
// its square.
TEST(RepairIntersections, ASurfaceAndItsCopyAreOne) {
  const SurfaceMesh ball = analytic::sphere(1, 5);
  for (const SurfaceMesh& copy : {ball, analytic::reversed(ball)}) {
    SurfaceMesh mesh = analytic::join(ball, copy);
    repair(mesh);
    expect_sound(mesh);
    EXPECT_EQ(mesh.triangles.size(), ball.triangles.size());
    EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(ball), 1e-9);
  }
}

// A part that was exported twice, the second time a little beside: the union would have steps along all its edges.
TEST(RepairIntersections, ABodyAndItsCopyALittleBesideAreOne) {
  const SurfaceMesh box = analytic::box({30, 20, 10}, 1), ball = analytic::sphere(10, 4),
                    lens = analytic::lens(30, 40, 10);
  for (const SurfaceMesh& body : {box, ball, lens}) {
    const double diagonal = bounding_box(body.vertices).diagonal();
    const Vec3 beside = diagonal * Vec3(3e-4, -2e-4, 1e-4);
    SurfaceMesh mesh = analytic::join(body, analytic::moved(body, beside));
    const RepairResult result = repair(mesh);
    EXPECT_EQ(mesh.vertices, body.vertices);
    EXPECT_EQ(mesh.triangles, body.triangles);
    ASSERT_EQ(result.count(RepairKind::RepeatedShell), 1U);
    EXPECT_NEAR(result.total_size(RepairKind::RepeatedShell), surface_area(body), 1e-6 * surface_area(body));
    EXPECT_NEAR(result.changes.back().volume, enclosed_volume(body), 1e-6 * enclosed_volume(body));
  }
}

// Farther apart they are two bodies; so are thin ones whose other sides are as near.
TEST(RepairIntersections, BodiesThatAreNoCopiesAreUnited) {
  const SurfaceMesh plate = analytic::box({30, 20, 0.03}, 1);
  const SurfaceMesh box = analytic::box({30, 20, 10}, 1);
  for (const auto& [body, beside] : {std::pair(box, Vec3(0.05, 0.05, 0.05)), std::pair(plate, Vec3(5, 4, 0.01))}) {
    SurfaceMesh mesh = analytic::join(body, analytic::moved(body, beside));
    const RepairResult result = repair(mesh);
    expect_sound(mesh);
    EXPECT_EQ(result.count(RepairKind::RepeatedShell), 0U);
    EXPECT_GT(enclosed_volume(mesh), 1.001 * enclosed_volume(body));
  }
}

TEST(RepairIntersections, FoldsOfNoiseAreSmoothedWithoutLosingFaces) {
  const SurfaceMesh noisy = analytic::noisy(analytic::sphere(1, 4), 0.02, 5);
  SurfaceMesh mesh = noisy;
  ASSERT_FALSE(find_self_intersections(mesh).empty());
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(mesh.triangles, noisy.triangles);
  std::size_t moved = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) moved += mesh.vertices[v] != noisy.vertices[v];
  EXPECT_EQ(moved, result.count(RepairKind::SmoothedFold));
  EXPECT_LT(moved, mesh.vertices.size() / 10);
}

TEST(RepairIntersections, NoisySphereBecomesSound) {
  for (const double sigma : {0.005, 0.02, 0.05}) {
    const SurfaceMesh original = analytic::sphere(1, 4);
    SurfaceMesh mesh = analytic::noisy(original, sigma, 7);
    repair(mesh);
    expect_sound(mesh);
    EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(original), 0.03 * enclosed_volume(original));
  }
}

TEST(RepairIntersections, ASurfaceThatIsOneTangleIsNotMeshable) {
  EXPECT_THAT(message_of_failure(analytic::noisy(analytic::sphere(1, 3), 0.5, 11)), HasSubstr("intersects"));
}

}  // namespace
}  // namespace scan2fea
