#include "quality/triangle_measures.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

TriangleShape shape_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto shape = measure_triangle(a, b, c);
  EXPECT_TRUE(shape.has_value());
  return shape.value_or(TriangleShape{});
}

TEST(TriangleMeasures, Equilateral) {
  const TriangleShape shape = shape_of({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  EXPECT_NEAR(shape.edge_ratio, 1, 1e-15);
  EXPECT_NEAR(shape.min_angle_deg, 60, 1e-13);
  EXPECT_NEAR(shape.max_angle_deg, 60, 1e-13);
  EXPECT_NEAR(shape.radius_ratio, 1, 1e-15);
}

TEST(TriangleMeasures, RightWithSidesThreeFourFive) {
  const TriangleShape shape = shape_of({0, 0, 0}, {3, 0, 0}, {0, 4, 0});
  EXPECT_DOUBLE_EQ(shape.edge_ratio, 5.0 / 3);
  EXPECT_DOUBLE_EQ(shape.min_angle_deg, degrees * std::atan(0.75));
  EXPECT_DOUBLE_EQ(shape.max_angle_deg, 90);
  EXPECT_DOUBLE_EQ(shape.radius_ratio, 2 * 1 / 2.5);  // r = 1, R = 2.5
}

TEST(TriangleMeasures, ANeedleKeepsItsDigits) {
  const double width = 1e-10;
  const TriangleShape shape = shape_of({0, 0, 0}, {1, 0, 0}, {1, width, 0});
  EXPECT_NEAR(shape.edge_ratio * width, 1, 1e-14);
  EXPECT_NEAR(shape.min_angle_deg / (degrees * width), 1, 1e-14);
  EXPECT_NEAR(shape.max_angle_deg, 90, 1e-12);
}

TEST(TriangleMeasures, ACapKeepsItsDigits) {
  const double height = 1e-10;
  const TriangleShape shape = shape_of({-1, 0, 0}, {1, 0, 0}, {0, height, 0});
  EXPECT_NEAR(shape.edge_ratio, 2, 1e-14);  // which is why the edge ratio alone does not see caps
  EXPECT_NEAR(shape.min_angle_deg / (degrees * height), 1, 1e-14);
  EXPECT_NEAR(shape.max_angle_deg, 180, 1e-7);
  EXPECT_GT(shape.radius_ratio, 0);
  EXPECT_LT(shape.radius_ratio, 1e-15);
}

TEST(TriangleMeasures, ZeroAreaHasNoShape) {
  EXPECT_FALSE(measure_triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}).has_value());
  EXPECT_FALSE(measure_triangle({0, 0, 0}, {1, 0, 0}, {1, 0, 0}).has_value());
  EXPECT_FALSE(measure_triangle({0, 0, 0}, {1, 1, 1}, {3, 3, 3}).has_value());
}

TEST(TriangleMeasures, TheUnitDoesNotMatter) {
  for (const double unit : {1e-250, 1e-9, 1e9, 1e250}) {
    const TriangleShape shape = shape_of(unit * Vec3(0, 0, 0), unit * Vec3(3, 0, 0), unit * Vec3(0, 4, 0));
    EXPECT_NEAR(shape.edge_ratio, 5.0 / 3, 1e-14);
    EXPECT_NEAR(shape.max_angle_deg, 90, 1e-12);
    EXPECT_NEAR(shape.radius_ratio, 0.8, 1e-14);
  }
}

// Right triangles over a common height 1, the k-th with edge ratio k.
SurfaceMesh fan_of_edge_ratios(std::uint32_t count) {
  SurfaceMesh mesh;
  for (std::uint32_t k = 2; k < count + 2; ++k) {
    const auto v = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{0, 0, 0}, {std::sqrt(double(k) * k - 1), 0, 0}, {0, 1, 0}});
    mesh.triangles.push_back({v, v + 1, v + 2});
  }
  return mesh;
}

TEST(TriangleMeasures, PercentilesAreTheValuesAtFloorOfPTimesN) {
  const TriangleSummary summary = measure_triangles(fan_of_edge_ratios(200));  // ratios 2 to 201
  EXPECT_NEAR(summary.edge_ratio.p50, 2 + 100, 1e-9);
  EXPECT_NEAR(summary.edge_ratio.p95, 2 + 190, 1e-9);
  EXPECT_NEAR(summary.edge_ratio.p99, 2 + 198, 1e-9);
  EXPECT_NEAR(summary.edge_ratio.max, 201, 1e-9);
  EXPECT_NEAR(summary.edge_ratio.mean, 101.5, 1e-9);
}

TEST(TriangleMeasures, OfOneTriangleAllPercentilesAreItsOwn) {
  const TriangleSummary summary = measure_triangles(fan_of_edge_ratios(1));
  EXPECT_DOUBLE_EQ(summary.edge_ratio.p50, summary.edge_ratio.max);
  EXPECT_DOUBLE_EQ(summary.edge_ratio.p99, summary.edge_ratio.max);
  EXPECT_DOUBLE_EQ(summary.min_angle_deg.mean, summary.min_angle_deg.min);
}

TEST(TriangleMeasures, ABoxIsMadeOfRightIsoscelesTriangles) {
  const TriangleSummary summary = measure_triangles(analytic::box({1, 2, 3}, 0.5));
  EXPECT_NEAR(summary.edge_ratio.mean, std::numbers::sqrt2, 1e-13);
  EXPECT_NEAR(summary.min_angle_deg.mean, 45, 1e-12);
  EXPECT_NEAR(summary.max_angle_deg, 90, 1e-12);
  EXPECT_EQ(summary.degenerate, 0U);
}

TEST(TriangleMeasures, DegenerateTrianglesAreCountedAndChangeNothingElse) {
  SurfaceMesh mesh = analytic::sphere(1, 2);
  const TriangleSummary before = measure_triangles(mesh);
  mesh.triangles.push_back({3, 3, 7});
  const TriangleSummary after = measure_triangles(mesh);
  EXPECT_EQ(after.degenerate, 1U);
  EXPECT_EQ(after.measured, before.measured);
  EXPECT_DOUBLE_EQ(after.edge_ratio.mean, before.edge_ratio.mean);
  EXPECT_DOUBLE_EQ(after.radius_ratio.min, before.radius_ratio.min);
}

TEST(TriangleMeasures, OfNothingButDegenerateTrianglesAreFinite) {
  const TriangleSummary summary = measure_triangles({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}});
  EXPECT_EQ(summary.measured, 0U);
  EXPECT_EQ(summary.degenerate, 1U);
  EXPECT_EQ(summary.edge_ratio.mean, 0);
}

}  // namespace
}  // namespace scan2fea
