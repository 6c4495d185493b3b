#include "preproc/mesh/polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace scan2fea {
namespace {

SurfaceMesh cut(const std::vector<Vec3>& corners) {
  SurfaceMesh mesh;
  mesh.vertices = corners;
  std::vector<std::uint32_t> all(corners.size());
  std::iota(all.begin(), all.end(), 0u);
  append_polygon(mesh, all);
  return mesh;
}

bool has_edge(const SurfaceMesh& mesh, std::uint32_t a, std::uint32_t b) {
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if ((t[k] == a && t[(k + 1) % 3] == b) || (t[k] == b && t[(k + 1) % 3] == a)) return true;
  return false;
}

// Triangles that all turn the polygon's way and sum to its area cover it once.
void expect_covered_once(const SurfaceMesh& mesh, const Vec3& up, double area) {
  for (const Triangle& t : mesh.triangles) EXPECT_GT(area_vector(mesh, t).dot(up), 0);
  EXPECT_NEAR(surface_area(mesh), area, 1e-12 * area);
  EXPECT_EQ(mesh.triangles.size(), mesh.vertices.size() - 2);
}

TEST(Polygon, QuadIsSplitAlongItsShorterDiagonal) {
  const std::vector<Vec3> flat_kite{{-3, 0, 0}, {0, -1, 0}, {3, 0, 0}, {0, 1, 0}};
  const std::vector<Vec3> tall_kite{{-1, 0, 0}, {0, -3, 0}, {1, 0, 0}, {0, 3, 0}};
  EXPECT_TRUE(has_edge(cut(flat_kite), 1, 3));
  EXPECT_TRUE(has_edge(cut(tall_kite), 0, 2));
}

TEST(Polygon, ConcaveQuadIsSplitInsideThoughTheOtherDiagonalIsShorter) {
  const std::vector<Vec3> arrow{{0, 0, 0}, {1, -5, 0}, {0, 10, 0}, {-1, -5, 0}};
  const SurfaceMesh mesh = cut(arrow);
  EXPECT_TRUE(has_edge(mesh, 0, 2));
  expect_covered_once(mesh, {0, 0, 1}, 10);
}

TEST(Polygon, StarStaysItsOutline) {
  std::vector<Vec3> star;
  constexpr int points = 7;
  for (int k = 0; k < 2 * points; ++k) {
    const double angle = std::numbers::pi * k / points, radius = k % 2 == 0 ? 5 : 1;
    star.emplace_back(radius * std::cos(angle), 2.0, -radius * std::sin(angle));
  }
  const double area = 2 * points * 0.5 * 5 * 1 * std::sin(std::numbers::pi / points);
  expect_covered_once(cut(star), {0, 1, 0}, area);
}

TEST(Polygon, CornersInTheMiddleOfASideMakeNoDegenerateTriangle) {
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                 {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
  expect_covered_once(cut(square), {0, 0, 1}, 4);
}

TEST(Polygon, LargeCapsAreCovered) {
  for (const int n : {50, 2000}) {
    std::vector<Vec3> cap;
    for (int k = 0; k < n; ++k)
      cap.emplace_back(std::cos(2 * std::numbers::pi * k / n), std::sin(2 * std::numbers::pi * k / n), 0);
    expect_covered_once(cut(cap), {0, 0, 1}, 0.5 * n * std::sin(2 * std::numbers::pi / n));
  }
}

TEST(Polygon, CrossedAndDegeneratePolygonsEnd) {
  EXPECT_EQ(cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).triangles.size(), 2u);
  EXPECT_EQ(cut(std::vector<Vec3>(6, Vec3::Ones())).triangles.size(), 4u);
}

}  // namespace
}  // namespace scan2fea
