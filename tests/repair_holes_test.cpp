// Holes that are closed, and holes that are kept.
#include "preproc/surface/repair/repair.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/surfaces_to_repair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;

RepairOptions keeping_holes() {
  RepairOptions options;
  options.holes = Holes::keep;
  return options;
}

SurfaceMesh tube() {
  return without_faces(analytic::cylinder(1, 4, 40, 20), [](const Vec3& p) { return p[2] < 1e-9 || p[2] > 4 - 1e-9; });
}

TEST(RepairHoles, BoxWithoutASideGetsAFlatOne) {
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

TEST(RepairHoles, ALargeHoleIsAnErrorThatNamesItsPlaceSizeAndRemedy) {
  const std::string message =
      message_of_failure(without_faces(unit_box(4), [](const Vec3& c) { return c.z() > 1 - 1e-9; }));
  EXPECT_THAT(message, HasSubstr("(0.5, 0.5, 1)"));
  EXPECT_THAT(message, HasSubstr("1.41421"));
  EXPECT_THAT(message, HasSubstr("--largest-hole all"));
}

TEST(RepairHoles, HoleInASphereIsClosedInItsShape) {
  const SurfaceMesh whole = analytic::sphere(1, 4);
  SurfaceMesh mesh = without_faces(whole, [](const Vec3& c) { return c.z() > 0.95; });
  const double volume_of_cap = std::numbers::pi * 0.05 * 0.05 * (3 - 0.05) / 3;
  repair(mesh);
  expect_sound(mesh);
  // A flat lid would lose the cap's volume.
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(whole), 0.2 * volume_of_cap);
  for (const Vec3& p : mesh.vertices) EXPECT_NEAR(p.norm(), 1, 0.01);
}

TEST(RepairHoles, OpenSurfacesStayOpenWhereHolesAreKept) {
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

TEST(RepairHoles, ASheetInTwoPiecesIsWeldedWhereHolesAreKept) {
  SurfaceMesh mesh = torn(analytic::sheet(4, 3, 0.5));
  repair(mesh, keeping_holes());
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_TRUE(validity.manifold());
  EXPECT_EQ(validity.components, 1u);
  EXPECT_EQ(validity.boundary_edges, 2u * (8 + 6));
}

TEST(RepairHoles, AnOpenSurfaceIsTurnedOutwardsWhereThatMeansSomething) {
  SurfaceMesh inside_out = analytic::reversed(tube());
  repair(inside_out, keeping_holes());
  EXPECT_GT(enclosed_volume(inside_out), 0);
  for (const SurfaceMesh& sheet : {analytic::sheet(4, 3, 0.5), analytic::reversed(analytic::sheet(4, 3, 0.5))}) {
    SurfaceMesh mesh = sheet;
    repair(mesh, keeping_holes());
    EXPECT_EQ(mesh.triangles, sheet.triangles);
  }
}

TEST(RepairHoles, IntersectionsOfOpenSurfacesAreRemovedAndTheirBordersStay) {
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

TEST(RepairHoles, KeepingHolesChangesNothingOfClosedSurfaces) {
  SurfaceMesh closed = analytic::noisy(analytic::sphere(1, 4), 0.02, 1), kept = closed;
  repair(closed);
  repair(kept, keeping_holes());
  EXPECT_EQ(closed.triangles, kept.triangles);
  EXPECT_EQ(closed.vertices, kept.vertices);
}

// A corner that was torn off and moved, and a loose face between corners of others: of the hole's border some corners
// lie on one another as the planar triangulation of holes sees them.
TEST(RepairHoles, CornersOfABorderMayLieOnOneAnother) {
  SurfaceMesh mesh{{{4, 1, 0},
                    {7, 1, 0},
                    {4, 2, 0},
                    {7, 2, 0},
                    {4, 1, 1},
                    {7, 1, 1},
                    {4, 2, 1},
                    {7, 2, 1},
                    {3, 3, 4},
                    {7, 2, 1},
                    {4, 2, 1},
                    {4, 1 + 0x1p-18, 1}},
                   {{0, 2, 3},
                    {0, 3, 1},
                    {11, 5, 7},
                    {8, 9, 10},
                    {0, 1, 5},
                    {0, 5, 4},
                    {2, 6, 7},
                    {2, 7, 3},
                    {0, 4, 6},
                    {0, 6, 2},
                    {1, 3, 7},
                    {1, 7, 5}}};
  repair(mesh, closing_all());
  expect_sound(mesh);
}

}  // namespace
}  // namespace scan2fea
