#include "preproc/volume/interior_points.hpp"

#include "preproc/volume/surface_bound.hpp"
#include "preproc/volume/tetrahedralize.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

TEST(InsideTest, TellsTheSidesOfABoxEvenNearestToEdgesAndCorners) {
  const SurfaceMesh box = analytic::box({1, 1, 1}, 1);
  const InsideTest inside(box);
  for (double x = -0.55; x < 1.6; x += 0.1)
    for (double y = -0.55; y < 1.6; y += 0.1)
      for (double z = -0.55; z < 1.6; z += 0.1) {
        const bool truth = x > 0 && x < 1 && y > 0 && y < 1 && z > 0 && z < 1;
        EXPECT_EQ(inside({x, y, z}).inside, truth) << x << ' ' << y << ' ' << z;
      }
}

TEST(InsideTest, ACavityIsOutside) {
  const SurfaceMesh hollow = analytic::join(analytic::sphere(3, 3), analytic::reversed(analytic::sphere(1, 2)));
  const InsideTest inside(hollow);
  EXPECT_FALSE(inside({0.1, 0.2, 0.1}).inside);
  EXPECT_TRUE(inside({0, 2, 0.1}).inside);
  EXPECT_FALSE(inside({0, 4, 0}).inside);
  EXPECT_NEAR(inside({0, 2, 0}).distance, 1, 0.05);
}

TEST(LatticePoints, AreInsideClearOfTheSurfaceAndAsDenseAsAskedFor) {
  const SurfaceMesh sphere = analytic::sphere(1, 4);
  const InsideTest inside(sphere);
  const std::vector<double> sizes = surface_sizes(sphere);
  double h = 0;
  for (const double s : sizes) h += s / static_cast<double>(sizes.size());
  for (const double factor : {1.3, 1.6}) {
    const auto points = lattice_points(sphere, inside, {factor, InteriorSize::Unit::of_surface});
    for (const Vec3& p : points) EXPECT_LT(p.norm(), 1 - 0.25 * h);
    // Two points a cell, in the sphere less a shell about as thick as the clearance.
    const double cell = factor * h / 0.911;
    const double expected = 2 * 4 * std::numbers::pi / 3 * std::pow(1 - 0.3 * h, 3) / std::pow(cell, 3);
    EXPECT_NEAR(static_cast<double>(points.size()), expected, 0.1 * expected);
  }
}

TEST(LatticePoints, AreTheSameTwiceAndApart) {
  const SurfaceMesh torus = analytic::torus(3, 1, 40, 16);
  const InsideTest inside(torus);
  const auto a = lattice_points(torus, inside, {}), b = lattice_points(torus, inside, {});
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i], b[i]);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = i + 1; j < a.size(); ++j) ASSERT_GT((a[i] - a[j]).norm(), 0.2);
}

TEST(LatticePoints, GrowInwardsWhereAskedTo) {
  const SurfaceMesh box = analytic::box({1, 1, 1}, 0.02);
  const InsideTest inside(box);
  const std::size_t even = lattice_points(box, inside, {1.6, InteriorSize::Unit::of_surface}).size();
  const std::size_t grown = lattice_points(box, inside, {0.2, InteriorSize::Unit::model}).size();
  EXPECT_LT(grown * 2, even);
  EXPECT_GT(grown, 0u);
}

TEST(ThinWallShare, TellsAPlateFromABlock) {
  const SurfaceMesh plate = analytic::box({20, 20, 0.5}, 1), block = analytic::box({4, 4, 4}, 1);
  EXPECT_GT(thin_wall_share(plate, InsideTest(plate)), 0.8);
  EXPECT_EQ(thin_wall_share(block, InsideTest(block)), 0);
}

TEST(SurfaceBound, ABoxAllowsHalfARightAngle) {
  const SurfaceBound bound = surface_bound(analytic::box({1, 1, 1}, 0.25));
  EXPECT_NEAR(bound.min_dihedral_deg, 45, 1e-9);
}

TEST(SurfaceBound, AWedgeIsFoundWithItsPlace) {
  // A roof of 20 degrees over the x axis, cut so finely that no single element can fill it well.
  SurfaceMesh wedge;
  const double s = std::tan(20 * std::numbers::pi / 180);
  wedge.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 1, s}, {1, 1, s}};
  wedge.triangles = {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}, {2, 4, 5}, {2, 5, 3}, {0, 4, 2}, {1, 3, 5}};
  const SurfaceBound bound = surface_bound(wedge);
  EXPECT_LE(bound.min_dihedral_deg, 20 + 1e-9);
  EXPECT_GE(bound.min_dihedral_deg, 10 - 1e-9);
  ASSERT_TRUE(bound.min_dihedral_at);
  EXPECT_NEAR(bound.min_dihedral_at->y(), 0, 1e-12);
}

TEST(SurfaceBound, AThinWallIsFound) {
  // Right-angled triangles with legs of 1: the inscribed circle's radius is (2 - sqrt 2) / 2.
  const double thickness = 0.05, radius = 1 - std::numbers::sqrt2 / 2;
  const SurfaceMesh plate = analytic::box({4, 4, thickness}, 1);
  const SurfaceBound bound = surface_bound(plate);
  EXPECT_NEAR(bound.min_dihedral_deg, std::atan(thickness / radius) * 180 / std::numbers::pi, 1e-9);
  EXPECT_LE(measure_tetrahedra(tetrahedralize(plate).mesh).min_dihedral_deg, bound.min_dihedral_deg);
}

}  // namespace
}  // namespace scan2fea
