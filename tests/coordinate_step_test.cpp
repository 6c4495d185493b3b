// How coarse coordinates are, and where it shows.
#include "preproc/mesh/coordinate_step.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

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

// A dozen values beside one another on each axis.
std::vector<Vec3> dozen(const Vec3& first, const Vec3& step) {
  std::vector<Vec3> points;
  for (int i = 0; i < 12; ++i) points.push_back(first + i * step);
  return points;
}

// As the shortest text that is read so has it: sums of tenths have all digits otherwise.
std::vector<Vec3> rounded(std::vector<Vec3> points, double step) {
  for (Vec3& p : points)
    for (double& x : p) x = std::round(x / step) / std::round(1 / step);
  return points;
}

TEST(CoordinateStep, OfFloatsIsThatOfTheFarthestCoordinates) {
  const auto step = coordinate_step(dozen({-far_away, 2.25, 0}, {0.5, 1.0 / 1024, 1.0 / 65536}), 1e-9);
  ASSERT_TRUE(step);
  EXPECT_FALSE(step->digits);
  EXPECT_DOUBLE_EQ(step->length.x(), 0.5);
  EXPECT_LE(step->length.z(), 1e-6);
  EXPECT_DOUBLE_EQ(coordinate_step(dozen({16777216, 0, 0}, {2, 0, 0}), 1e-9)->length.x(), 2);
}

TEST(CoordinateStep, OfDecimalsIsThatOfTheLastDigit) {
  const auto step = coordinate_step(rounded(dozen({12.3, 0.456, 1}, {1.1, 0.013, 0}), 0.001), 1e-9);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->digits, 3);
  EXPECT_NEAR(step->length.x(), 0.1, 1e-12);
  EXPECT_NEAR(step->length.y(), 0.001, 1e-12);
  EXPECT_EQ(step->length.z(), 0) << "one value";
}

TEST(CoordinateStep, OfDecimalsIsNotThatOfAFewLargerOnes) {
  // "10.0" among 8.5 and the like has two digits, as they have, and the same step.
  std::vector<Vec3> points = rounded(dozen({8.5, 0, 0}, {0.1, 0, 0}), 0.1);
  points.push_back({10, 0, 0});
  EXPECT_NEAR(coordinate_step(points, 1e-9)->length.x(), 0.1, 1e-12);
}

TEST(CoordinateStep, OfDecimalsInFloatsIsTheSame) {
  std::vector<Vec3> points = rounded(dozen({12.3, 45.6, 78.9}, {0.1, 0.1, 0.1}), 0.1);
  for (Vec3& p : points) p = p.cast<float>().cast<double>();
  const auto step = coordinate_step(points, 1e-9);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->digits, 3);
  EXPECT_NEAR(step->length.x(), 0.1, 1e-12);
}

TEST(CoordinateStep, OfTwoHeightsIsNone) {
  // A cone's apex and rim at whole numbers say nothing of the digits.
  std::vector<Vec3> points;
  for (int i = 0; i < 48; ++i) points.push_back({10 * std::cos(i / 7.0), 10 * std::sin(i / 7.0), i < 47 ? 0.0 : 15.0});
  EXPECT_FALSE(coordinate_step(points, 1e-6));
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
