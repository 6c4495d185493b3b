#include "preproc/mesh/surface_mesh.hpp"

#include "preproc/mesh/face_neighbours.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <vector>

namespace scan2fea {
namespace {

TEST(SurfaceMesh, BoxHasItsVolumeAndArea) {
  const SurfaceMesh box = analytic::box({2, 3, 5}, 0.5);
  EXPECT_NEAR(enclosed_volume(box), 30, 1e-12);
  EXPECT_NEAR(surface_area(box), 62, 1e-12);
  EXPECT_NEAR(enclosed_volume(analytic::reversed(box)), -30, 1e-12);
}

TEST(SurfaceMesh, VolumeKeepsItsDigitsFarFromTheOrigin) {
  SurfaceMesh box = analytic::box({2, 3, 5}, 0.5);
  for (Vec3& v : box.vertices) v += Vec3::Constant(1e6);
  EXPECT_NEAR(enclosed_volume(box), 30, 1e-8);
}

TEST(SurfaceMesh, AnalyticMeshesAreWhatTheySay) {
  EXPECT_NEAR(enclosed_volume(analytic::sphere(2, 5)), 4.0 / 3 * std::numbers::pi * 8, 0.02);
  EXPECT_NEAR(enclosed_volume(analytic::torus(3, 1, 200, 100)), 2 * std::numbers::pi * std::numbers::pi * 3, 0.1);
  const SurfaceMesh slab = analytic::slab_with_holes(5, 0.25);
  EXPECT_NEAR(enclosed_volume(slab), 33 - 5, 1e-12);
  // Euler: V - F/2 = 2 - 2 genus
  EXPECT_EQ(static_cast<long>(slab.vertices.size()) - static_cast<long>(slab.triangles.size()) / 2, 2 - 2 * 5);
}

// Also of faces that name a vertex twice, and of edges with any number of faces.
TEST(FaceNeighbours, AreMutual) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    SurfaceMesh mesh;
    mesh.vertices.assign(5, Vec3::Zero());
    std::uniform_int_distribution<std::uint32_t> vertex(0, 4);
    for (int f = 0; f < 1 + trial % 9; ++f) mesh.triangles.push_back({vertex(random), vertex(random), vertex(random)});
    const std::vector<Triangle> neighbours = face_neighbours(mesh, VertexStars(mesh));
    for (std::uint32_t f = 0; f < neighbours.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t g = neighbours[f][k];
        if (g == no_face) continue;
        bool is_mutual = false;
        for (std::size_t j = 0; j < 3; ++j)
          is_mutual =
              is_mutual || (neighbours[g][j] == f && mesh.triangles[g][(j + 1) % 3] == mesh.triangles[f][(k + 2) % 3] &&
                            mesh.triangles[g][(j + 2) % 3] == mesh.triangles[f][(k + 1) % 3]);
        EXPECT_TRUE(is_mutual);
      }
    }
  }
}

}  // namespace
}  // namespace scan2fea
