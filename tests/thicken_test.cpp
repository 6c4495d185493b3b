// Solids of open sheets.
#include "preproc/surface/repair/repair.hpp"
#include "tests/surfaces_to_repair.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

SurfaceMesh thickened(SurfaceMesh sheet, const Thickness& thickness) {
  repair(sheet, {.thickness = thickness});
  expect_sound(sheet);
  return sheet;
}

TEST(Thicken, AFlatPanelBecomesAPlateOnTheSideThatIsWanted) {
  const SurfaceMesh panel = analytic::sheet(3, 2, 0.5);
  for (const auto& [side, low, high] :
       {std::tuple(ThickenTo::both, -0.1, 0.1), {ThickenTo::front, 0.0, 0.2}, {ThickenTo::back, -0.2, 0.0}}) {
    const SurfaceMesh plate = thickened(panel, {0.2, side});
    EXPECT_NEAR(enclosed_volume(plate), 3 * 2 * 0.2, 1e-12);
    const BoundingBox box = bounding_box(plate.vertices);
    // A sheet has no outside: repair may turn it, but then both of its sides.
    EXPECT_NEAR(box.high.z() - box.low.z(), 0.2, 1e-12);
    EXPECT_NEAR(box.low.z(), low, 1e-12);
    EXPECT_NEAR(box.high.z(), high, 1e-12);
  }
}

TEST(Thicken, ABendKeepsItsThickness) {
  // An L of two plates at a right angle; half of the thickness is on either side of it.
  SurfaceMesh bent = analytic::sheet(4, 2, 0.5);
  for (Vec3& p : bent.vertices)
    if (p.x() > 2) p = {2, p.y(), p.x() - 2};
  const double t = 0.1;
  const SurfaceMesh solid = thickened(bent, {t, ThickenTo::both});
  EXPECT_NEAR(enclosed_volume(solid), 2 * t * 4, 1e-6);  // the outer corner gains what the inner one loses
  for (const Vec3& p : solid.vertices)
    if (p.x() < 1.9) {
      EXPECT_NEAR(std::abs(p.z()), t / 2, 1e-6);
    }
}

TEST(Thicken, AHalfBallBecomesAShell) {
  const SurfaceMesh cup = without_faces(analytic::sphere(1, 5), [](const Vec3& c) { return c.z() > 0; });
  const double t = 0.05;
  const SurfaceMesh shell = thickened(cup, {t, ThickenTo::both});
  const double outer = 1 + t / 2, inner = 1 - t / 2;
  const double whole = 4 * std::numbers::pi / 3 * (std::pow(outer, 3) - std::pow(inner, 3));
  // The rim of triangles is not where the ball is cut in half.
  EXPECT_NEAR(enclosed_volume(shell), whole * surface_area(cup) / surface_area(analytic::sphere(1, 5)), 0.01 * whole);
}

TEST(Thicken, ClosedBodiesStayAsTheyAre) {
  SurfaceMesh box = unit_box(2);
  repair(box, {.thickness = Thickness{0.1, ThickenTo::both}});
  EXPECT_EQ(box.vertices, unit_box(2).vertices);
  EXPECT_EQ(box.triangles, unit_box(2).triangles);
}

}  // namespace
}  // namespace scan2fea
