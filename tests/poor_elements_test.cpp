#include "preproc/volume/poor_elements.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scan2fea {
namespace {

// Two tetrahedra on the face 0 1 2, a regular one and one of height 0.1 over it; `surface` has their first nodes.
TetMesh regular_and_flat() {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}};
  const Vec3 centre = (mesh.nodes[0] + mesh.nodes[1] + mesh.nodes[2]) / 3;
  mesh.nodes.push_back(centre + Vec3(0, 0, std::sqrt(2.0 / 3)));
  mesh.nodes.push_back(centre - Vec3(0, 0, 0.1));
  mesh.tetrahedra = {{0, 1, 2, 3}, {1, 0, 2, 4}};
  return mesh;
}

TEST(PoorElements, AreToldWithTheSurfacesEdgeLengthThere) {
  const TetMesh mesh = regular_and_flat();
  SurfaceMesh surface;
  surface.vertices.assign(mesh.nodes.begin(), mesh.nodes.begin() + 3);
  surface.triangles = {{0, 1, 2}};
  const std::vector<PoorElement> poor = find_poor_elements(mesh, surface, 24);
  ASSERT_EQ(poor.size(), 1u);
  // The flat one's sides rise by 0.1 over a third of the triangle's height.
  EXPECT_NEAR(poor[0].min_dihedral_deg, std::atan(0.1 / (std::sqrt(0.75) / 3)) * 180 / M_PI, 1e-9);
  EXPECT_NEAR(poor[0].longest_edge, 1, 1e-12);
  EXPECT_NEAR(poor[0].surface_edge, 1, 1e-12);
  EXPECT_NEAR(poor[0].centre.z(), -0.025, 1e-12);
  EXPECT_TRUE(find_poor_elements(mesh, surface, 10).empty());
}

TEST(PoorElements, OfTheInsideAreNotTheSurfaces) {
  EXPECT_TRUE(find_poor_elements(regular_and_flat(), {}, 24).empty());
}

}  // namespace
}  // namespace scan2fea
