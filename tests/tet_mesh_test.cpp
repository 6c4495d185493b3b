#include "preproc/mesh/tet_mesh.hpp"

#include "preproc/mesh/element_faces.hpp"

#include <gtest/gtest.h>

namespace scan2fea {
namespace {

TetMesh two_tetrahedra() {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  mesh.boundary = find_boundary(mesh.tetrahedra);
  return mesh;
}

TEST(TetMesh, SharedFaceIsNotBoundary) {
  EXPECT_EQ(two_tetrahedra().boundary.size(), 6U);
}

TEST(TetMesh, ElementsThatLieInOneAnotherAreFound) {
  using Elements = std::vector<Tetrahedron>;
  EXPECT_FALSE(find_element_faces({{0, 1, 2, 3}, {1, 2, 3, 4}}).overlapping);
  const auto third = find_element_faces({{0, 1, 2, 3}, {1, 2, 3, 4}, {1, 3, 2, 5}}).overlapping;
  ASSERT_TRUE(third);
  EXPECT_NE((*third)[0], (*third)[1]);
  for (const Elements& twice :
       {Elements{{0, 1, 2, 3}, {2, 0, 1, 3}}, Elements{{0, 1, 2, 3}, {1, 2, 3, 4}, {4, 3, 2, 1}}})
    EXPECT_TRUE(find_element_faces(twice).overlapping);
}

TEST(TetMesh, BoundaryEnclosesTheSumOfTheElements) {
  const TetMesh mesh = two_tetrahedra();
  EXPECT_GT(total_volume(mesh), 0);
  EXPECT_NEAR(enclosed_volume(boundary_surface(mesh)), total_volume(mesh), 1e-14);
}

TEST(TetMesh, FaceNumbersAreAbaqus) {
  // S1..S4 of the unit tetrahedron lie in the planes opposite nodes 4, 3, 1, 2.
  const std::array<std::size_t, 4> opposite{3, 2, 0, 1};
  for (std::size_t f = 0; f < 4; ++f)
    for (const int corner : tetrahedron_faces[f]) EXPECT_NE(static_cast<std::size_t>(corner), opposite[f]);
}

// The Jacobian is linear in each single node, so the volume is, too: a node in the middle of an edge moves a third of
// the edge's two faces with it.
TEST(TetMesh, VolumeIsThatOfTheCurvedElement) {
  TetMesh mesh;
  mesh.nodes = {{1e3, 0, 0}, {1e3 + 1, 0, 0}, {1e3, 1, 0}, {1e3, 0, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.boundary = find_boundary(mesh.tetrahedra);
  mesh.mid_edge_nodes.emplace_back();
  for (std::size_t e = 0; e < 6; ++e) {
    mesh.mid_edge_nodes[0][e] = static_cast<std::uint32_t>(mesh.nodes.size());
    mesh.nodes.emplace_back(0.5 * (mesh.nodes[static_cast<std::size_t>(tetrahedron_edges[e][0])] +
                                   mesh.nodes[static_cast<std::size_t>(tetrahedron_edges[e][1])]));
  }
  EXPECT_NEAR(total_volume(mesh), 1.0 / 6, 1e-13);
  mesh.nodes[4] += Vec3(0, -0.1, -0.2);  // 12, of the faces in the planes y = 0 and z = 0
  EXPECT_NEAR(total_volume(mesh), 1.0 / 6 + (0.1 + 0.2) * 0.5 / 3, 1e-12);
  Vec3 closed = Vec3::Zero();
  double area = 0;
  for (const BoundaryFace f : mesh.boundary) {
    closed += face_vector_area(mesh, f);
    area += face_area(mesh, f);
  }
  EXPECT_LE(closed.norm(), 1e-12) << "the faces' normals balance";
  EXPECT_GT(area, 1.5 + std::sqrt(3) / 2);
}

}  // namespace
}  // namespace scan2fea
