// Repair of the real scans: what is wrong with them is known and gets mended, and all else stays as it was.
#include "preproc/mesh/read_surface.hpp"
#include "preproc/surface/repair/repair.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"
#include "tests/scans.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace scan2fea {
namespace {

#define READ_OR_SKIP(mesh, name)                                                                \
  const auto scan = find_scan(name);                                                            \
  if (!scan) GTEST_SKIP() << "no " << name << "; set SCAN2FEA_DATA to the folder of the scans"; \
  SurfaceMesh mesh = read_surface(*scan)

void expect_sound(const SurfaceMesh& mesh) {
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_TRUE(validity.closed());
  EXPECT_TRUE(validity.manifold());
  EXPECT_EQ(validity.components, 1u);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  EXPECT_GT(enclosed_volume(mesh), 0);
}

TEST(RepairScans, HorseLosesItsFourCrossingsAndNothingElse) {
  READ_OR_SKIP(mesh, "horse.ply");
  const SurfaceMesh original = mesh;
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(result.intersecting_pairs, 4u);
  ASSERT_EQ(mesh.vertices.size(), original.vertices.size());
  EXPECT_EQ(mesh.triangles.size(), original.triangles.size());
  std::size_t moved = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) moved += mesh.vertices[v] != original.vertices[v];
  EXPECT_EQ(moved, result.count(RepairKind::SmoothedFold));
  EXPECT_LE(moved, 24u);  // no more than the corners of the crossing faces
  // No measured place moves by more than a hundredth of a per cent.
  const double limit = 1e-4 * bounding_box(mesh.vertices).diagonal();
  for (const RepairChange& change : result.changes)
    if (change.kind == RepairKind::SmoothedFold) {
      EXPECT_LT(change.size, limit);
    }
}

TEST(RepairScans, BunnyGetsItsFiveHolesClosed) {
  READ_OR_SKIP(mesh, "stanford-bunny.obj");
  const SurfaceMesh original = mesh;
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(result.count(RepairKind::ClosedHole), 5u);
  EXPECT_EQ(check_validity(mesh).genus, 0);
  EXPECT_EQ(result.faces_removed, 0u);
  EXPECT_EQ(mesh.triangles.size(), original.triangles.size() + result.faces_added);
}

TEST(RepairScans, SoundScansStayAsTheyAre) {
  for (const char* name : {"igea.ply", "fandisk.obj"}) {
    READ_OR_SKIP(mesh, name);
    const SurfaceMesh original = mesh;
    EXPECT_TRUE(repair(mesh).unchanged());
    EXPECT_EQ(mesh.vertices, original.vertices);
    EXPECT_EQ(mesh.triangles, original.triangles);
  }
}

}  // namespace
}  // namespace scan2fea
