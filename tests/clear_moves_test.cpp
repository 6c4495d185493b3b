#include "preproc/surface/kernel/clear_moves.hpp"

#include "preproc/surface/collapse/collapse.hpp"
#include "preproc/surface/fit/preserve_volume.hpp"
#include "preproc/surface/kernel/face_boxes.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace scan2fea {
namespace {

TEST(FaceBoxes, FindWhatATestOfAllFindsWhileFacesChange) {
  SurfaceMesh mesh = analytic::torus(3, 1, 20, 9);
  FaceBoxes boxes(mesh);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> offset(-0.5, 0.5);
  std::vector<bool> removed(mesh.triangles.size(), false);
  for (int change = 0; change < 200; ++change) {
    const std::uint32_t f = static_cast<std::uint32_t>(random() % mesh.triangles.size());
    if (change % 3 == 0) {
      boxes.remove(f);
      removed[f] = true;
    } else if (!removed[f]) {
      for (const std::uint32_t v : mesh.triangles[f]) {
        mesh.vertices[v] += Vec3(offset(random), offset(random), offset(random));
        for (std::uint32_t g = 0; g < mesh.triangles.size(); ++g)
          if (!removed[g] && std::count(mesh.triangles[g].begin(), mesh.triangles[g].end(), v) > 0)
            boxes.set(g, box_of_face(mesh, g));
      }
    }
    const BoundingBox query = box_of_face(mesh, static_cast<std::uint32_t>(random() % mesh.triangles.size()));
    std::vector<std::uint32_t> found, expected;
    boxes.for_each_overlap(query, [&](std::uint32_t g) { found.push_back(g); });
    std::sort(found.begin(), found.end());
    for (std::uint32_t g = 0; g < mesh.triangles.size(); ++g) {
      if (!removed[g] && boxes_meet(box_of_face(mesh, g), query)) expected.push_back(g);
    }
    ASSERT_EQ(found, expected) << "after change " << change;
  }
}

TEST(ClearMoves, GoAllTheWayWhereNothingIsInIt) {
  SurfaceMesh mesh = analytic::sphere(1, 3);
  std::vector<Vec3> targets = mesh.vertices;
  for (Vec3& p : targets) p *= 1.1;
  EXPECT_EQ(move_clear(mesh, targets).held, 0U);
  EXPECT_EQ(mesh.vertices, targets);
}

// The targets drive the two sides of a plate through one another towards one end.
TEST(ClearMoves, StopBeforeTheOtherSide) {
  SurfaceMesh mesh = analytic::box({10, 10, 0.5}, 0.5);
  std::vector<Vec3> targets = mesh.vertices;
  for (Vec3& p : targets) p.z() += 0.04 * p.x() * (p.z() > 0.25 ? -1 : 1);
  SurfaceMesh crossing = mesh;
  crossing.vertices = targets;
  ASSERT_FALSE(find_self_intersections(crossing).empty());
  EXPECT_GT(move_clear(mesh, targets).held, 0U);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
}

TEST(ClearMoves, RestoreTheVolumeBesideATightGap) {
  // Two plates a hundredth apart, each a little thinner than it should be.
  const auto plates = [](double thickness) {
    SurfaceMesh upper = analytic::box({4, 4, thickness}, 0.5);
    for (Vec3& p : upper.vertices) p.z() += 1.01 - 0.5 * (thickness - 1);
    SurfaceMesh lower = analytic::box({4, 4, thickness}, 0.5);
    for (Vec3& p : lower.vertices) p.z() -= 0.5 * (thickness - 1);
    return analytic::join(lower, upper);
  };
  const SurfaceMesh wanted = plates(1);
  SurfaceMesh mesh = plates(0.98);
  ASSERT_TRUE(preserve_volume_clear(mesh, wanted));
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(wanted), 1e-12 * enclosed_volume(wanted));
  EXPECT_TRUE(find_self_intersections(mesh).empty());
}

// Far fewer triangles than two sheets so close can take without meeting: contractions stop before.
TEST(Collapse, KeepsClearOfOtherSheets) {
  const SurfaceMesh shells = analytic::join(analytic::sphere(1, 4), analytic::reversed(analytic::sphere(0.97, 4)));
  const CollapseOptions options{.target_faces = 100, .cost = CollapseCost::edge_length};
  SurfaceMesh crossing = shells;
  collapse(crossing, options);
  ASSERT_FALSE(find_self_intersections(crossing).empty());
  SurfaceMesh mesh = shells;
  CollapseOptions clear = options;
  clear.keep_clear = true;
  collapse(mesh, clear);
  EXPECT_LT(mesh.triangles.size(), shells.triangles.size() / 4);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  EXPECT_EQ(check_validity(mesh).components, 2U);
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(shells), 1e-9);
}

}  // namespace
}  // namespace scan2fea
