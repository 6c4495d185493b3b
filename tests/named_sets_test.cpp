#include "preproc/mesh/named_sets.hpp"

#include "tests/structured_tets.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

using Members = std::vector<std::uint32_t>;

TEST(NamedSets, HoldEachMemberOnceAndSorted) {
  EXPECT_EQ(named_set("clamp", {5, 1, 5, 3}).members, (Members{1, 3, 5}));
}

TEST(NamedSets, AreFoundWhateverTheCase) {
  const std::vector<NamedSet> sets{{"clamp", {1}}, {"Load", {2}}};
  EXPECT_EQ(find_set(sets, "LOAD"), 1U);
  EXPECT_EQ(find_set(sets, "loads"), 2U);
}

TEST(NamedSets, GoWithWhatEachNewFaceWas) {
  const std::vector<NamedSet> sets{{"clamp", {0, 2}}, {"gone", {7}}};
  const Members origin{2, 1, 2, ~0U, 0};
  const std::vector<NamedSet> carried = carried_sets(sets, origin);
  EXPECT_EQ(carried, (std::vector<NamedSet>{{"clamp", {0, 2, 4}}, {"gone", {}}}));
}

TEST(NamedSets, HaveTheVerticesOfTheirFaces) {
  const SurfaceMesh mesh{std::vector<Vec3>(5, Vec3::Zero()), {{0, 1, 2}, {2, 1, 4}, {2, 3, 0}}};
  EXPECT_EQ(vertices_of_faces(mesh, Members{0, 1}), (Members{0, 1, 2, 4}));
}

TEST(NamedSets, OfASecondOrderMeshHaveTheNodesBetweenCorners) {
  const TetMesh mesh = analytic::tetrahedra_of_box({1, 1, 1}, {1, 1, 1}, 2);
  ASSERT_FALSE(mesh.boundary.empty());
  EXPECT_EQ(nodes_of_faces(mesh, Members{0}).size(), 6U);
  const Triangle corners = boundary_triangle(mesh, mesh.boundary[0]);
  for (const std::uint32_t n : nodes_of_faces(mesh, Members{0})) {
    const Vec3 normal =
        (mesh.nodes[corners[1]] - mesh.nodes[corners[0]]).cross(mesh.nodes[corners[2]] - mesh.nodes[corners[0]]);
    EXPECT_NEAR((mesh.nodes[n] - mesh.nodes[corners[0]]).dot(normal), 0, 1e-12);
  }
}

}  // namespace
}  // namespace scan2fea
