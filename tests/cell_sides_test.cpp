#include "preproc/surface/reconstruction/cell_sides.hpp"

#include "preproc/surface/kernel/point_neighbours.hpp"
#include "preproc/surface/reconstruction/hole_voids.hpp"
#include "preproc/surface/reconstruction/reconstruct.hpp"
#include "preproc/surface/repair/repair.hpp"
#include "quality/validity.hpp"
#include "tests/sampled_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

bool is_in_hole(const Vec3& p) {
  return std::min(std::hypot(p[0] - 60, p[1] - 13), std::hypot(p[0] - 60, p[1] - 37)) < 5;
}

// Inside angle_bracket.
bool is_inside(const Vec3& p) {
  if (p[1] < 0 || p[1] > 50 || std::min(p[0], p[2]) < 0 || p[0] > 80 || p[2] > 60) return false;
  if (p[0] < 8 && p[2] < 8 && std::hypot(p[0] - 8, p[2] - 8) > 8) return false;
  if (p[0] > 10 && p[2] > 10) return p[0] < 16 && p[2] < 16 && std::hypot(p[0] - 16, p[2] - 16) > 6;
  return p[2] > 10 || !is_in_hole(p);
}

void expect_right_sides(double noise_of_diagonal) {
  const SampledPart part = angle_bracket(2.5, noise_of_diagonal, 1);
  const DelaunayCells cells = Delaunay(part.points).cells();
  const Primitives found =
      find_primitives(part.points, nearest_in_space(part.points, part.outwards, 20), part.outwards);
  const std::vector<CellSide> sides = sides_by_shapes(part.points, cells, found);
  double known = 0, wrong = 0, all = 0;
  for (std::size_t c = 0; c < sides.size(); ++c) {
    const auto& corners = cells.corners[c];
    if (std::ranges::find(corners, DelaunayCells::infinite) != corners.end()) {
      EXPECT_EQ(sides[c], CellSide::unknown);
      continue;
    }
    Vec3 centre = Vec3::Zero();
    for (const std::uint32_t v : corners) centre += part.points[v] / 4;
    ++all;
    known += sides[c] != CellSide::unknown;
    const bool said_inside = sides[c] == CellSide::inside;
    wrong += sides[c] != CellSide::unknown && said_inside != is_inside(centre);
  }
  EXPECT_GT(known, 0.5 * all);
  EXPECT_LT(wrong, 0.01 * known);
}

TEST(CellSides, AreThoseOfThePart) {
  expect_right_sides(0);
  expect_right_sides(0.001);
}

TEST(CellSides, AHoleOfFewPointsStaysOpen) {
  SampledPart part = angle_bracket(2, 0.001, 2);
  // Of the wall of one hole, and of what is about it, one point in four.
  std::size_t count = 0;
  std::erase_if(part.points, [&](const Vec3& p) { return std::hypot(p[0] - 60, p[1] - 13) < 8 && ++count % 4 != 0; });
  SurfaceMesh surface = reconstruct({.points = part.points, .normals = {}, .scanners = {}}).surface;
  repair(surface);
  EXPECT_EQ(check_validity(surface).genus, 2);
  EXPECT_NEAR(enclosed_volume(surface) / 63'129, 1, 0.01);
}

// The mouth of a hole as it is closed by triangles between the points about it.
TEST(HoleVoids, ALidIsNamedWithPlaceAndRadius) {
  const SampledPart part = angle_bracket(2.5, 0, 1);
  const Primitives found =
      find_primitives(part.points, nearest_in_space(part.points, part.outwards, 20), part.outwards);
  const std::vector<HoleVoid> voids = find_hole_voids(part.points, found);
  ASSERT_EQ(voids.size(), 2);
  SurfaceMesh surface = reconstruct({.points = part.points, .normals = {}, .scanners = {}}).surface;
  EXPECT_TRUE(find_bridged_voids(surface, voids).empty());
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (const Vec3& p : {Vec3(54, 13, 10), Vec3(63, 8, 10), Vec3(63, 18, 10)}) surface.vertices.push_back(p);
  surface.triangles.push_back({first, first + 1, first + 2});
  const std::vector<BridgedVoid> bridged = find_bridged_voids(surface, voids);
  ASSERT_EQ(bridged.size(), 1);
  EXPECT_LT((bridged[0].place - Vec3(60, 13, 10)).norm(), 2.5);
  EXPECT_NEAR(voids[bridged[0].of].radius_at(0), 5, 0.05);
}

}  // namespace
}  // namespace scan2fea
