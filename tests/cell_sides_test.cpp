#include "preproc/surface/reconstruction/cell_sides.hpp"

#include "preproc/surface/kernel/point_neighbours.hpp"
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
  const DelaunayCells cells = Delaunay(part.points, point_spacing(part.points, PointNeighbours(part.points))).cells();
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
    wrong += sides[c] == (is_inside(centre) ? CellSide::outside : CellSide::inside);
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

}  // namespace
}  // namespace scan2fea
