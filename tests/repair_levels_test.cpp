// How far a repair goes, and what it tells of what it left out or made up.
#include "preproc/surface/repair/repair.hpp"
#include "preproc/surface/repair/solid_volume.hpp"
#include "tests/error_from.hpp"
#include "tests/surfaces_to_repair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;

SurfaceMesh crossing_balls() {
  const SurfaceMesh ball = analytic::sphere(1, 3);
  return analytic::join(ball, analytic::moved(ball, {1.21, 0.07, 0.03}));
}

TEST(RepairLevels, OffTakesWhatIsSoundAndNothingElse) {
  const RepairOptions off{.level = RepairLevel::off};
  const SurfaceMesh box = unit_box(3);
  SurfaceMesh mesh = box;
  EXPECT_TRUE(repair(mesh, off).unchanged());
  EXPECT_EQ(mesh.vertices, box.vertices);
  EXPECT_EQ(mesh.triangles, box.triangles);
  EXPECT_THAT(message_of_failure(torn(box), off), HasSubstr("open"));
  EXPECT_THAT(message_of_failure(crossing_balls(), off), HasSubstr("crosses"));
  SurfaceMesh turned = box;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_THAT(message_of_failure(turned, off), HasSubstr("manifold"));
  EXPECT_THAT(message_of_failure(analytic::reversed(box), off), HasSubstr("inside out"));
}

TEST(RepairLevels, GentleJoinsButMakesNothingUp) {
  const RepairOptions gentle{.level = RepairLevel::gentle};
  SurfaceMesh mesh = torn(unit_box(3));
  repair(mesh, gentle);
  expect_sound(mesh);
  EXPECT_NEAR(enclosed_volume(mesh), 1, 1e-12);
  const SurfaceMesh open = without_faces(unit_box(4), [](const Vec3& c) { return c.x() < 0.2 && c.y() < 0.2; });
  EXPECT_THAT(message_of_failure(open, gentle), HasSubstr("open"));
  EXPECT_THAT(message_of_failure(crossing_balls(), gentle), HasSubstr("crosses"));
}

TEST(RepairLevels, WrapMakesASolidOfWhatNothingElseMends) {
  const SurfaceMesh tangle = analytic::noisy(analytic::sphere(1, 3), 0.5, 11);
  message_of_failure(tangle);
  SurfaceMesh mesh = tangle;
  const RepairResult result = repair(mesh, {.level = RepairLevel::wrap});
  expect_sound(mesh);
  ASSERT_EQ(result.count(RepairKind::Wrapped), 1u);
  EXPECT_TRUE(is_made_up(RepairKind::Wrapped));
  // Outside of the scan by the distance that is told.
  const BoundingBox scan = bounding_box(tangle.vertices), around = bounding_box(mesh.vertices);
  const double distance = result.total_size(RepairKind::Wrapped);
  EXPECT_LT((around.high - scan.high).cwiseAbs().maxCoeff(), 1.5 * distance);
  EXPECT_LT((around.low - scan.low).cwiseAbs().maxCoeff(), 1.5 * distance);
}

TEST(RepairLevels, WrapLeavesAloneWhatGentlerStepsMend) {
  SurfaceMesh mesh = torn(unit_box(3)), same = mesh;
  repair(mesh, {.level = RepairLevel::wrap});
  repair(same);
  EXPECT_EQ(mesh.vertices, same.vertices);
  EXPECT_EQ(mesh.triangles, same.triangles);
}

TEST(RepairLevels, WrapRefusesFacesWithoutArea) {
  const SurfaceMesh line{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}};
  EXPECT_THAT(message_of_failure(line, {.level = RepairLevel::wrap}), HasSubstr("no face has an area"));
}

TEST(RepairLevels, WhatIsLeftOutAndMadeUpIsListedWithItsAreaAndVolume) {
  const SurfaceMesh open = without_faces(unit_box(8), [](const Vec3& c) {
    return c.z() > 1 - 1e-9 && std::abs(c.x() - 0.5) < 0.126 && std::abs(c.y() - 0.5) < 0.126;
  });
  SurfaceMesh mesh = analytic::join(open, analytic::moved(analytic::sphere(0.01, 2), {2, 0, 0}));
  const RepairResult result = repair(mesh);
  double lost_volume = 0, made_up_area = 0;
  for (const RepairChange& change : result.changes) {
    if (is_lost(change.kind)) lost_volume += change.volume;
    if (is_made_up(change.kind)) made_up_area += change.area;
  }
  EXPECT_NEAR(lost_volume, enclosed_volume(analytic::sphere(0.01, 2)), 1e-15);
  EXPECT_NEAR(made_up_area, 1.0 / 16, 1e-9);
  EXPECT_EQ(result.bodies, 1u);
}

TEST(RepairLevels, BodiesThatAreKeptAreChosen) {
  const SurfaceMesh rod = analytic::box({4, 0.1, 0.1}, 0.1), ball = analytic::sphere(1, 3),
                    pebble = analytic::sphere(0.3, 2), speck = analytic::sphere(0.05, 2);
  SurfaceMesh all =
      analytic::join(analytic::join(ball, analytic::moved(rod, {2, 0, 0})),
                     analytic::join(analytic::moved(pebble, {0, 3, 0}), analytic::moved(speck, {0, 0, 3})));
  const auto bodies = [&](const KeptBodies& kept) {
    SurfaceMesh mesh = all;
    return repair(mesh, {.bodies = kept}).bodies;
  };
  EXPECT_EQ(bodies(AllBodies{}), 4u);
  EXPECT_EQ(bodies(BodiesOfNote{}), 3u);  // the rod is a hundredth of the ball's volume, but longer
  EXPECT_EQ(bodies(LargestBodies{1}), 1u);
  EXPECT_EQ(bodies(LargestBodies{2}), 2u);
  EXPECT_EQ(bodies(BodiesAbove{2}), 2u);
  SurfaceMesh mesh = all;
  const auto error = error_from<NotMeshable>([&] { repair(mesh, {.bodies = BodiesAbove{1000}}); });
  EXPECT_THAT(error.what(), testing::HasSubstr("--keep"));
}

TEST(RepairLevels, ACavityGoesWithItsBody) {
  const SurfaceMesh hollow = analytic::join(analytic::sphere(1, 3), analytic::reversed(analytic::sphere(0.05, 2)));
  SurfaceMesh mesh = analytic::join(hollow, analytic::moved(analytic::sphere(2, 3), {5, 0, 0}));
  repair(mesh);
  EXPECT_NEAR(enclosed_volume(mesh),
              enclosed_volume(analytic::sphere(1, 3)) - enclosed_volume(analytic::sphere(0.05, 2)) +
                  enclosed_volume(analytic::sphere(2, 3)),
              1e-9);
  repair(mesh, {.bodies = LargestBodies{1}});
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(analytic::sphere(2, 3)), 1e-9);
}

TEST(SolidVolume, IsThatOfTheSolidHoweverItsFacesTellIt) {
  EXPECT_NEAR(*volume_of_solid(torn(unit_box(2))), 1, 1e-12);
  EXPECT_NEAR(*volume_of_solid(analytic::reversed(unit_box(2))), 1, 1e-12);
  const SurfaceMesh halves =
      analytic::join(analytic::box({2, 2, 1}, 0.5), analytic::moved(analytic::box({2, 2, 2}, 0.4), {1, 0, 0}));
  EXPECT_NEAR(*volume_of_solid(halves), 4 + 8 - 2, 1e-9);
  EXPECT_FALSE(volume_of_solid(analytic::sheet(2, 1, 0.5)).has_value());
}

TEST(SolidVolume, HoldsTheBodiesThatRepairDrops) {
  const SurfaceMesh speck = analytic::sphere(0.04, 2);
  EXPECT_NEAR(*volume_of_solid(analytic::join(unit_box(3), analytic::moved(speck, {2, 0, 0}))),
              1 + enclosed_volume(speck), 1e-12);
}

}  // namespace
}  // namespace scan2fea
