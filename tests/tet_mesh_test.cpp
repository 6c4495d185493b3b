#include "preproc/mesh/tet_mesh.hpp"

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

}  // namespace
}  // namespace scan2fea
