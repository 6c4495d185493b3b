// A bound on the distance of a triangle from a surface: never less than it is, and near to it.
#include "preproc/surface/thinning/distance_bound.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <random>

namespace scan2fea {
namespace {

using Corners = std::array<Vec3, 3>;

constexpr double resolution = 0.01;

TEST(DistanceBound, OfTrianglesEdgesAndPointsOverAPlane) {
  const TriangleTree plane(analytic::sheet(10, 10, 1));
  const Vec3 a(2, 2, 1), b(6, 3, 1), c(4, 7, 1.5);
  for (const auto& [corners, distance] :
       {std::pair{Corners{a, b, c}, 1.5}, {Corners{a, b, b}, 1.0}, {Corners{a, c, c}, 1.5}, {Corners{c, c, c}, 1.5}}) {
    const double bound = bound_of_distance(corners, plane, 0, resolution);
    EXPECT_GE(bound, distance);
    EXPECT_LE(bound, distance + 2 * resolution);
  }
}

// What is enough is not looked at more closely.
TEST(DistanceBound, StopsWhereItIsEnough) {
  const TriangleTree plane(analytic::sheet(10, 10, 1));
  const double bound = bound_of_distance({Vec3(2, 2, 0), Vec3(6, 3, 0), Vec3(4, 7, 0)}, plane, 5, resolution);
  EXPECT_LE(bound, 5);
  EXPECT_GT(bound, 1);
}

// No point of the triangle is farther.
TEST(DistanceBound, HoldsBesideASphere) {
  const TriangleTree sphere(analytic::sphere(1, 3));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-2, 2), share(0, 1);
  for (int i = 0; i < 20; ++i) {
    Corners corners;
    for (Vec3& corner : corners) corner = {coordinate(random), coordinate(random), coordinate(random)};
    const double bound = bound_of_distance(corners, sphere, 0, resolution);
    for (int j = 0; j < 200; ++j) {
      const double s = share(random), t = share(random) * (1 - s);
      const Vec3 p = (1 - s - t) * corners[0] + s * corners[1] + t * corners[2];
      EXPECT_LE(std::sqrt(sphere.closest(p).squared_distance), bound);
    }
  }
}

}  // namespace
}  // namespace scan2fea
