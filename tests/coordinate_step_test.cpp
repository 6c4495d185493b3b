// How coarse coordinates are, and where it shows.
#include "preproc/mesh/coordinate_step.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace scan2fea {
namespace {

constexpr double far_away = 6329871.5;

// As text with so many significant digits has it.
SurfaceMesh with_digits(SurfaceMesh mesh, int digits) {
  for (Vec3& p : mesh.vertices)
    for (double& x : p) {
      char text[32];
      std::snprintf(text, sizeof text, "%.*g", digits, x);
      x = std::strtod(text, nullptr);
    }
  return mesh;
}

SurfaceMesh in_floats(SurfaceMesh mesh) {
  for (Vec3& p : mesh.vertices)
    for (double& x : p) x = static_cast<double>(static_cast<float>(x));
  return mesh;
}

TEST(CoordinateStep, OfFloatsIsThatOfTheFarthestCoordinate) {
  const auto step = coordinate_step({{-6329171.5, 2.3F, 3.7F}, {-far_away, 4.123457F, 5.765433F}}, 1e-9);
  ASSERT_TRUE(step);
  EXPECT_FALSE(step->digits);
  EXPECT_DOUBLE_EQ(step->length.x(), 0.5);
  EXPECT_LE(step->length.z(), 1e-6);
  EXPECT_DOUBLE_EQ(coordinate_step({{16777216, 0, 0}, {16777318, 0, 0}}, 1e-9)->length.x(), 2);
}

TEST(CoordinateStep, OfDecimalsIsThatOfTheLastDigit) {
  const auto step = coordinate_step({{12.3, 0.0456, 0}, {-98.7, 0.1, 200}}, 1e-9);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->digits, 3);
  EXPECT_NEAR(step->length.x(), 0.1, 1e-12);
  EXPECT_NEAR(step->length.y(), 0.001, 1e-12);
  EXPECT_EQ(step->length.z(), 0) << "two steps of 100 across";
}

TEST(CoordinateStep, OfDecimalsInFloatsIsTheSame) {
  const auto step = coordinate_step({{12.3F, 45.6F, 78.9F}, {1.23F, 4.56F, 7.89F}}, 1e-9);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->digits, 3);
  EXPECT_NEAR(step->length.x(), 0.1, 1e-12);
}

TEST(CoordinateStep, OfNumbersWithAllDigitsIsNone) {
  EXPECT_FALSE(coordinate_step({{1.0 / 3, 2.0 / 7, std::sqrt(2)}, {0.1, far_away, 0}}, 1e-6));
}

TEST(VisibleCoordinateStep, IsThatOfASmoothSurfaceInFewDigits) {
  const SurfaceMesh ball = analytic::sphere(25, 5);  // edges of 1
  for (const int digits : {2, 3}) {
    const auto step = visible_coordinate_step(with_digits(ball, digits));
    ASSERT_TRUE(step) << digits;
    EXPECT_EQ(step->digits, digits);
    EXPECT_NEAR(step->length.x(), std::pow(10, 2 - digits), 1e-12);
  }
  for (const int digits : {4, 7}) EXPECT_FALSE(visible_coordinate_step(with_digits(ball, digits))) << digits;
  EXPECT_FALSE(visible_coordinate_step(with_digits(analytic::sphere(25, 2), 3))) << "edges of eighty steps";
}

TEST(VisibleCoordinateStep, IsThatOfFloatsFarAway) {
  const SurfaceMesh ball = analytic::sphere(25, 5);
  const auto step = visible_coordinate_step(in_floats(analytic::moved(ball, {far_away, 0, 0})));
  ASSERT_TRUE(step);
  EXPECT_FALSE(step->digits);
  EXPECT_DOUBLE_EQ(step->length.maxCoeff(), 0.5);
  EXPECT_FALSE(visible_coordinate_step(in_floats(ball)));
  EXPECT_FALSE(visible_coordinate_step(analytic::moved(ball, {far_away, 0, 0})));
}

TEST(VisibleCoordinateStep, IsNotThatOfRoundNumbersThatAreMeant) {
  EXPECT_FALSE(visible_coordinate_step(analytic::box({60, 40, 20}, 60)));
  EXPECT_FALSE(visible_coordinate_step(analytic::box({10, 10, 10}, 10)));
  EXPECT_FALSE(visible_coordinate_step({{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 1}}, {{0, 1, 2}, {0, 2, 3}}}));
  EXPECT_FALSE(visible_coordinate_step(analytic::box({30, 20, 10}, 1)));
  EXPECT_FALSE(visible_coordinate_step(with_digits(analytic::cylinder(10, 30, 48, 1), 4)));
}

TEST(VisibleCoordinateStep, IsNotThatOfNoiseAboveIt) {
  EXPECT_FALSE(visible_coordinate_step(with_digits(analytic::noisy(analytic::sphere(25, 5), 0.2, 1), 4)));
}

}  // namespace
}  // namespace scan2fea
