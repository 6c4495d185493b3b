#include "preproc/surface/kernel/canonical_frame.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace scan2fea {
namespace {

// With axes that the normals tell apart, with one or three that they don't, with faces that all are equal, and with
// triangles that are no image of one another though the shape is.
std::vector<std::pair<std::string, SurfaceMesh>> parts() {
  return {{"plate", analytic::box({60, 40, 8}, 4)},
          {"cube", analytic::box({20, 20, 20}, 4)},
          {"two boxes",
           analytic::join(analytic::box({20, 20, 20}, 5), analytic::moved(analytic::box({20, 20, 20}, 5), {30, 0, 0}))},
          {"cylinder", analytic::cylinder(5, 20, 72, 10)},
          {"ball", analytic::sphere(25, 4)},
          {"sheet", analytic::sheet(30, 20, 3)},
          {"lens", analytic::lens(40, 96, 24)},
          {"torus", analytic::torus(20, 6, 48, 24)},
          {"rough ball", analytic::noisy(analytic::sphere(25, 4), 0.05, 3)},
          {"block with fin", analytic::block_with_fin(0.5)}};
}

TEST(CanonicalFrame, IsThePartsOwnToTheLastBit) {
  for (const auto& [name, part] : parts()) {
    SurfaceMesh first, placed;
    CanonicalFrame(part, first);
    for (unsigned seed = 1; seed <= 12; ++seed) {
      SurfaceMesh other = analytic::elsewhere(part, seed);
      for (Vec3& p : other.vertices) p *= std::pow(25.4, static_cast<int>(seed % 5) - 2);
      CanonicalFrame(other, placed);
      EXPECT_TRUE(placed.vertices == first.vertices) << name << ", placement " << seed;
      EXPECT_TRUE(placed.triangles == first.triangles) << name << ", placement " << seed;
    }
  }
}

TEST(CanonicalFrame, MovesThePartAsARigidBody) {
  for (const auto& [name, part] : parts()) {
    SurfaceMesh placed;
    const CanonicalFrame frame(part, placed);
    for (Vec3& p : placed.vertices) p *= frame.unit();
    const double size = bounding_box(part.vertices).diagonal();
    EXPECT_NEAR(enclosed_volume(placed), enclosed_volume(part), 1e-8 * size * size * size) << name;  // no mirror image
    EXPECT_NEAR(surface_area(placed), surface_area(part), 1e-8 * size * size) << name;
  }
}

TEST(CanonicalFrame, PlanesOfTheGivenAxesComeBackExactly) {
  const SurfaceMesh part = analytic::moved(analytic::box({60, 40, 8}, 4), {0.1, -20, 0});
  SurfaceMesh placed;
  CanonicalFrame(part, placed).bring_back(placed.vertices, part);
  std::array<int, 2> on_planes{};
  for (const Vec3& p : placed.vertices) {
    on_planes[0] += p.x() == 0.1;
    on_planes[1] += p.z() == 0;
  }
  EXPECT_EQ(on_planes[0], 11 * 3);   // 40 x 8 by 4
  EXPECT_EQ(on_planes[1], 16 * 11);  // 60 x 40 by 4
}

TEST(CanonicalFrame, OtherPointsComeBackToRounding) {
  const SurfaceMesh part = analytic::elsewhere(analytic::torus(20, 6, 48, 24), 4);
  SurfaceMesh placed;
  const CanonicalFrame frame(part, placed);
  const double size = bounding_box(part.vertices).diagonal();
  for (const Vec3& p : part.vertices) EXPECT_LT((frame.back(frame.to_frame(p)) - p).norm(), 1e-9 * size);
}

}  // namespace
}  // namespace scan2fea
