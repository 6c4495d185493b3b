#include "preproc/surface/sizing/even_planes.hpp"

#include "preproc/surface/kernel/cut_surface.hpp"
#include "quality/triangle_measures.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace scan2fea {
namespace {

// A rectangle with `count` vertices on each side, all of whose triangles reach to its middle: a fan of needles.
SurfaceMesh fan(double width, double height, int count) {
  SurfaceMesh mesh;
  const std::array<Vec3, 5> corners{Vec3(0, 0, 1), {width, 0, 1}, {width, height, 1}, {0, height, 1}, {0, 0, 1}};
  mesh.vertices = {Vec3(width / 2, height / 2, 1)};
  for (std::size_t side = 0; side < 4; ++side)
    for (int i = 0; i < count; ++i)
      mesh.vertices.push_back(corners[side] + (corners[side + 1] - corners[side]) * i / count);
  const auto around = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t v = 0; v < around; ++v) mesh.triangles.push_back({0, 1 + v, 1 + (v + 1) % around});
  return mesh;
}

TEST(EvenPlanes, AFanOfNeedlesIsCutEvenly) {
  for (const auto& [width, height, count] : {std::tuple(100., 100., 100), {30., 3., 40}, {20., 60., 120}}) {
    const SurfaceMesh before = fan(width, height, count);
    const double longest = 3 * std::max(width, height) / count;
    const SurfaceMesh after = with_even_planes(before, longest, 2e-6 * std::hypot(width, height));
    EXPECT_NEAR(surface_area(after), width * height, 1e-9 * width * height);
    const std::vector<FeatureEdge> border = boundary_edges(after);
    EXPECT_EQ(border, boundary_edges(before)) << "vertices and border stay";
    for (const Triangle& t : after.triangles) {
      EXPECT_GT(area_vector(after, t).z(), 0);
      for (std::size_t k = 0; k < 3; ++k) {
        const FeatureEdge edge = feature_edge(t[k], t[(k + 1) % 3]);
        if (!std::ranges::binary_search(border, edge)) {
          EXPECT_LE((after.vertices[edge[0]] - after.vertices[edge[1]]).norm(), longest);
        }
      }
    }
    const double few = 80 * width * height / (longest * longest) + 60 * count;
    EXPECT_LT(static_cast<double>(after.triangles.size()), few) << "halved needles would be " << count << " times many";
  }
}

TEST(EvenPlanes, WhatBendsStays) {
  const SurfaceMesh ball = analytic::sphere(5, 3);
  EXPECT_EQ(with_even_planes(ball, 0.1, 1e-6).triangles, ball.triangles);
}

}  // namespace
}  // namespace scan2fea
