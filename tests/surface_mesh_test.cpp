#include "preproc/mesh/surface_mesh.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <numbers>

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

}  // namespace
}  // namespace scan2fea
