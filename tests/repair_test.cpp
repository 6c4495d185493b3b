#include "preproc/surface/repair/repair.hpp"

#include "analytic_meshes.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;

void expect_sound(const SurfaceMesh& mesh) {
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_TRUE(validity.closed());
  EXPECT_TRUE(validity.manifold());
  EXPECT_EQ(validity.unused_vertices, 0u);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  EXPECT_GT(enclosed_volume(mesh), 0);
}

SurfaceMesh moved(SurfaceMesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.vertices) p += by;
  return mesh;
}

SurfaceMesh unit_box(int squares_per_side) {
  return analytic::box(Vec3::Ones(), 1.0 / squares_per_side);
}

template <class Predicate>
SurfaceMesh without_faces(SurfaceMesh mesh, const Predicate& gone) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return gone((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  });
  return mesh;
}

// One index for each place.
SurfaceMesh welded(SurfaceMesh mesh) {
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t)
      v = static_cast<std::uint32_t>(std::find(mesh.vertices.begin(), mesh.vertices.end(), Vec3(mesh.vertices[v])) -
                                     mesh.vertices.begin());
  return mesh;
}

// Each face with vertices of its own.
SurfaceMesh torn(const SurfaceMesh& mesh) {
  SurfaceMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto n = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  return soup;
}

RepairOptions closing_all() {
  RepairOptions options;
  options.largest_hole_of_diagonal.reset();
  return options;
}

std::string message_of_failure(SurfaceMesh mesh, const RepairOptions& options = {}) {
  try {
    repair(mesh, options);
  } catch (const NotMeshable& error) {
    return error.what();
  }
  ADD_FAILURE() << "expected NotMeshable";
  return {};
}

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

TEST(Repair, BoxWithoutASideGetsAFlatOne) {
  for (const int squares : {1, 5}) {
    SurfaceMesh mesh = without_faces(unit_box(squares), [](const Vec3& c) { return c.z() > 1 - 1e-9; });
    const SurfaceMesh original = mesh;
    const RepairResult result = repair(mesh, closing_all());
    expect_sound(mesh);
    EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-9);
    EXPECT_NEAR(surface_area(mesh), 6, 1e-9);
    ASSERT_EQ(result.count(RepairKind::ClosedHole), 1u);
    // What was there is still there, bit by bit and in its order.
    EXPECT_TRUE(std::equal(original.triangles.begin(), original.triangles.end(), mesh.triangles.begin()) ||
                squares > 1);  // the inner vertices of the missing side are gone, and renumber the others
  }
}

TEST(Repair, ALargeHoleIsAnErrorThatNamesItsPlaceSizeAndRemedy) {
  const std::string message =
      message_of_failure(without_faces(unit_box(4), [](const Vec3& c) { return c.z() > 1 - 1e-9; }));
  EXPECT_THAT(message, HasSubstr("(0.5, 0.5, 1)"));
  EXPECT_THAT(message, HasSubstr("1.41421"));
  EXPECT_THAT(message, HasSubstr("--largest-hole all"));
}

TEST(Repair, HoleInASphereIsClosedInItsShape) {
  const SurfaceMesh whole = analytic::sphere(1, 4);
  SurfaceMesh mesh = without_faces(whole, [](const Vec3& c) { return c.z() > 0.95; });
  const double volume_of_cap = std::numbers::pi * 0.05 * 0.05 * (3 - 0.05) / 3;
  repair(mesh);
  expect_sound(mesh);
  // A flat lid would lose the cap's volume.
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(whole), 0.2 * volume_of_cap);
  for (const Vec3& p : mesh.vertices) EXPECT_NEAR(p.norm(), 1, 0.01);
}

TEST(Repair, InsideOutBoxIsTurned) {
  SurfaceMesh mesh = analytic::reversed(unit_box(3));
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-12);
  EXPECT_EQ(result.count(RepairKind::TurnedFaces), 1u);
  EXPECT_NEAR(result.total_size(RepairKind::TurnedFaces), 6, 1e-12);
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

TEST(Repair, DoubledFacesAreHalved) {
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

TEST(Repair, DoubleWallBetweenBoxesIsTakenOut) {
  SurfaceMesh mesh = welded(analytic::join(unit_box(3), moved(unit_box(3), {1, 0, 0})));
  // Exactly coincident walls need exactly coincident vertices: thirds do not add up to one, places at x = 1 do.
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 1u);
  EXPECT_NEAR(enclosed_volume(mesh), 2, 1e-12);
  EXPECT_EQ(result.count(RepairKind::DuplicateFace), 36u);
}

TEST(Repair, SingleWallInABoxIsTakenOut) {
  SurfaceMesh mesh = welded(analytic::join(
      unit_box(3), moved(without_faces(unit_box(3), [](const Vec3& c) { return c.x() < 1e-9; }), {1, 0, 0})));
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 1u);
  EXPECT_NEAR(enclosed_volume(mesh), 2, 1e-12);
  ASSERT_EQ(result.count(RepairKind::InnerWall), 1u);
  EXPECT_NEAR(result.total_size(RepairKind::InnerWall), 1, 1e-12);
}

TEST(Repair, FlapIsTakenOff) {
  SurfaceMesh mesh = unit_box(2);
  const SurfaceMesh original = mesh;
  const auto tip = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0.5, 0.5, 2});
  mesh.triangles.push_back({mesh.triangles[0][0], mesh.triangles[0][1], tip});
  repair(mesh);
  EXPECT_EQ(mesh.triangles, original.triangles);
  EXPECT_EQ(mesh.vertices, original.vertices);
}

TEST(Repair, BoxesThatShareAnEdgeComeApart) {
  SurfaceMesh mesh = welded(analytic::join(unit_box(2), moved(unit_box(2), {1, 1, 0})));
  ASSERT_GT(check_validity(mesh).non_manifold_edges, 0u);
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 2u);
  EXPECT_EQ(result.count(RepairKind::SplitVertex), 3u);
  EXPECT_NEAR(enclosed_volume(mesh), 2, 0.02);
}

TEST(Repair, BoxesThatShareAVertexComeApart) {
  SurfaceMesh mesh = welded(analytic::join(unit_box(2), moved(unit_box(2), {1, 1, 1})));
  ASSERT_EQ(check_validity(mesh).non_manifold_vertices, 1u);
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 2u);
  EXPECT_EQ(result.count(RepairKind::SplitVertex), 1u);
  EXPECT_EQ(result.count(RepairKind::PartedTouch), 2u);
  EXPECT_NEAR(enclosed_volume(mesh), 2, 0.01);
}

TEST(Repair, SoupOfSeparateFacesIsWelded) {
  const SurfaceMesh box = unit_box(4);
  SurfaceMesh mesh = torn(box);
  repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(mesh.vertices.size(), box.vertices.size());
  EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-12);
}

TEST(Repair, TouchingVerticesThatCloseNoBorderAreNotWelded) {
  SurfaceMesh mesh = analytic::join(unit_box(2), moved(unit_box(2), {1, 1, 1}));
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(result.count(RepairKind::WeldedVertex), 0u);
  EXPECT_EQ(check_validity(mesh).components, 2u);
}

TEST(Repair, DegenerateFacesLeaveNoSlit) {
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

TEST(Repair, TJunctionIsClosed) {
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

TEST(Repair, SpecksAndUnusedVerticesAreDropped) {
  const SurfaceMesh ball = analytic::sphere(10, 3);
  const SurfaceMesh speck = analytic::sphere(0.05, 1);
  SurfaceMesh mesh = analytic::join(ball, moved(speck, {12, 0, 0}));
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
  SurfaceMesh mesh = analytic::join(ball, moved(sheet, {12, 0, 0}));
  const RepairResult result = repair(mesh);
  EXPECT_EQ(mesh.triangles, ball.triangles);
  EXPECT_EQ(result.count(RepairKind::DroppedFragment), 1u);
}

TEST(Repair, CrossingSolidsBecomeOne) {
  const SurfaceMesh ball = analytic::sphere(1, 4);
  const double distance = 1.21;
  SurfaceMesh mesh = analytic::join(ball, moved(ball, {distance, 0.07, 0.03}));
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 1u);
  EXPECT_EQ(result.count(RepairKind::UnitedShell), 2u);
  // Two balls less the lens that they have in common.
  const double d = Vec3(distance, 0.07, 0.03).norm();
  const double lens = std::numbers::pi * (4 + d) * (2 - d) * (2 - d) / 12;
  EXPECT_NEAR(enclosed_volume(mesh), 2 * enclosed_volume(ball) - lens, 0.01);
}

TEST(Repair, BoxesThatTouchAlongFacesBecomeOne) {
  SurfaceMesh mesh = analytic::join(analytic::box({2, 2, 1}, 1), moved(unit_box(1), {0.5, 0.5, 1}));
  repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 1u);
  EXPECT_NEAR(enclosed_volume(mesh), 5, 1e-9);
}

TEST(Repair, BoxWithinABoxThatReachesOutIsUnited) {
  SurfaceMesh mesh = analytic::join(unit_box(3), moved(analytic::box({0.2, 0.2, 2}, 0.2), {0.4, 0.4, -0.5}));
  repair(mesh);
  expect_sound(mesh);
  EXPECT_NEAR(enclosed_volume(mesh), 1 + 0.04, 1e-9);
}

TEST(Repair, ASpikeThroughTheFarSideIsCutWhereItIs) {
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

TEST(Repair, FoldsOfNoiseAreSmoothedWithoutLosingFaces) {
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

TEST(Repair, NoisySphereBecomesSound) {
  for (const double sigma : {0.005, 0.02, 0.05}) {
    const SurfaceMesh original = analytic::sphere(1, 4);
    SurfaceMesh mesh = analytic::noisy(original, sigma, 7);
    repair(mesh);
    expect_sound(mesh);
    EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(original), 0.03 * enclosed_volume(original));
  }
}

TEST(Repair, ASurfaceThatIsOneTangleIsNotMeshable) {
  EXPECT_THAT(message_of_failure(analytic::noisy(analytic::sphere(1, 3), 0.5, 11)), HasSubstr("intersects"));
}

RepairOptions keeping_holes() {
  RepairOptions options;
  options.holes = Holes::keep;
  return options;
}

SurfaceMesh tube() {
  return without_faces(analytic::cylinder(1, 4, 40, 20), [](const Vec3& p) { return p[2] < 1e-9 || p[2] > 4 - 1e-9; });
}

TEST(Repair, OpenSurfacesStayOpenWhereHolesAreKept) {
  const SurfaceMesh sphere = analytic::sphere(1, 4);
  const SurfaceMesh punctured = without_faces(sphere, [](const Vec3& p) { return p[2] > 0.9 || p[0] > 0.95; });
  for (const SurfaceMesh& open : {analytic::sheet(4, 3, 0.5), tube(), punctured}) {
    SurfaceMesh mesh = open;
    const std::size_t border = check_validity(mesh).boundary_edges;
    repair(mesh, keeping_holes());
    EXPECT_EQ(mesh.triangles.size(), open.triangles.size());
    EXPECT_EQ(check_validity(mesh).boundary_edges, border);
    EXPECT_TRUE(check_validity(mesh).manifold());
  }
}

TEST(Repair, ASheetInTwoPiecesIsWeldedWhereHolesAreKept) {
  SurfaceMesh mesh = torn(analytic::sheet(4, 3, 0.5));
  repair(mesh, keeping_holes());
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_TRUE(validity.manifold());
  EXPECT_EQ(validity.components, 1u);
  EXPECT_EQ(validity.boundary_edges, 2u * (8 + 6));
}

TEST(Repair, AnOpenSurfaceIsTurnedOutwardsWhereThatMeansSomething) {
  SurfaceMesh inside_out = analytic::reversed(tube());
  repair(inside_out, keeping_holes());
  EXPECT_GT(enclosed_volume(inside_out), 0);
  for (const SurfaceMesh& sheet : {analytic::sheet(4, 3, 0.5), analytic::reversed(analytic::sheet(4, 3, 0.5))}) {
    SurfaceMesh mesh = sheet;
    repair(mesh, keeping_holes());
    EXPECT_EQ(mesh.triangles, sheet.triangles);
  }
}

TEST(Repair, IntersectionsOfOpenSurfacesAreRemovedAndTheirBordersStay) {
  // A spike from inside through the wall of a tube, and a tube across a sheet.
  SurfaceMesh spiked = tube();
  std::uint32_t middle = 0;
  for (std::uint32_t v = 0; v < spiked.vertices.size(); ++v)
    if ((spiked.vertices[v] - Vec3(1, 0, 2)).norm() < 1e-9) middle = v;
  spiked.vertices[middle] = Vec3(-1.5, 0, 2);
  const std::size_t border = check_validity(spiked).boundary_edges;
  repair(spiked, keeping_holes());
  EXPECT_TRUE(check_validity(spiked).manifold());
  EXPECT_EQ(check_validity(spiked).boundary_edges, border);
  EXPECT_TRUE(find_self_intersections(spiked).empty());
}

TEST(Repair, KeepingHolesChangesNothingOfClosedSurfaces) {
  SurfaceMesh closed = analytic::noisy(analytic::sphere(1, 4), 0.02, 1), kept = closed;
  repair(closed);
  repair(kept, keeping_holes());
  EXPECT_EQ(closed.triangles, kept.triangles);
  EXPECT_EQ(closed.vertices, kept.vertices);
}

TEST(Repair, IsDeterministic) {
  SurfaceMesh first = analytic::noisy(analytic::sphere(1, 4), 0.03, 3);
  SurfaceMesh second = first;
  repair(first);
  repair(second);
  EXPECT_EQ(first.vertices, second.vertices);
  EXPECT_EQ(first.triangles, second.triangles);
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
