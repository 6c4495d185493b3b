// Repair of real scans: what is wrong with them is known and gets mended, and all else stays as it was.
#include "preproc/mesh/read_surface.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"
#include "tests/scans.hpp"
#include "tests/surfaces_to_repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace scan2fea {
namespace {

// The scan without the triangles around five of its vertices and those that touch them: five holes.
SurfaceMesh with_five_holes(SurfaceMesh mesh) {
  std::set<std::uint32_t> near;
  for (std::uint32_t k = 0; k < 5; ++k) {
    const auto centre = static_cast<std::uint32_t>((2 * k + 1) * mesh.vertices.size() / 10);
    std::set<std::uint32_t> around;
    for (const Triangle& t : mesh.triangles)
      if (std::ranges::find(t, centre) != t.end()) around.insert(t.begin(), t.end());
    near.insert(around.begin(), around.end());
  }
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::ranges::any_of(t, [&](std::uint32_t v) { return near.contains(v); });
  });
  return mesh;
}

TEST(RepairScans, CamelLosesItsCrossingsAndNothingElse) {
  SurfaceMesh mesh = read_surface(scan("camel.off"));
  const SurfaceMesh original = mesh;
  const std::vector<FacePair> crossings = find_self_intersections(original);
  ASSERT_FALSE(crossings.empty());  // their number is CGAL's: cgal_agreement_test
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 1u);
  EXPECT_EQ(result.intersecting_pairs, crossings.size());
  EXPECT_EQ(mesh.triangles, original.triangles);
  ASSERT_EQ(mesh.vertices.size(), original.vertices.size());
  std::set<std::uint32_t> corners;
  for (const auto& [face, other] : crossings)
    for (const std::uint32_t f : {face, other})
      corners.insert(original.triangles[f].begin(), original.triangles[f].end());
  std::size_t moved = 0;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.vertices[v] != original.vertices[v]) {
      ++moved;
      EXPECT_TRUE(corners.contains(v));
    }
  EXPECT_EQ(moved, result.count(RepairKind::SmoothedFold));
  // Farther than this would change the shape.
  const double limit = 0.01 * bounding_box(mesh.vertices).diagonal();
  for (const RepairChange& change : result.changes) {
    EXPECT_EQ(change.kind, RepairKind::SmoothedFold);
    EXPECT_LE(change.size, limit);
  }
}

TEST(RepairScans, BunnyGetsItsFiveHolesClosed) {
  SurfaceMesh mesh = with_five_holes(read_surface(scan("bunny00.off")));
  const SurfaceMesh original = mesh;
  const RepairResult result = repair(mesh);
  expect_sound(mesh);
  EXPECT_EQ(check_validity(mesh).components, 1u);
  EXPECT_EQ(result.count(RepairKind::ClosedHole), 5u);
  EXPECT_EQ(check_validity(mesh).genus, 0);
  EXPECT_EQ(result.faces_removed, 0u);
  EXPECT_EQ(mesh.triangles.size(), original.triangles.size() + result.faces_added);
}

TEST(RepairScans, SoundScansStayAsTheyAre) {
  for (const char* name : {"bunny00.off", "refined_elephant.off", "fandisk.off"}) {
    SurfaceMesh mesh = read_surface(scan(name));
    const SurfaceMesh original = mesh;
    EXPECT_TRUE(repair(mesh).unchanged());
    EXPECT_EQ(mesh.vertices, original.vertices);
    EXPECT_EQ(mesh.triangles, original.triangles);
  }
}

}  // namespace
}  // namespace scan2fea
