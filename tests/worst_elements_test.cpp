#include "quality/worst_elements.hpp"

#include "tests/analytic_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <span>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;

// Of regular tetrahedra that touch nothing, `flat` of them pressed flat, the first the least.
TetMesh loose_tetrahedra(int count, const std::vector<double>& heights) {
  TetMesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.nodes.size());
    const double height = i < static_cast<int>(heights.size()) ? heights[static_cast<std::size_t>(i)] : 0.8165;
    const Vec3 at(2.0 * i, 0, 0);
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0.866, 0), Vec3(0.5, 0.2887, height)})
      mesh.nodes.push_back(at + p);
    mesh.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
  }
  mesh.boundary = find_boundary(mesh.tetrahedra);
  return mesh;
}

TEST(WorstElements, AreThoseOfLeastScaledJacobianTheWorstFirst) {
  const TetMesh mesh = loose_tetrahedra(6, {0.3, 0.05, 0.8, 0.1});
  const ElementMeasures measures = measure_elements(mesh, nullptr);
  const auto worst = worst_tetrahedra(mesh, measures, 3);
  ASSERT_EQ(worst.size(), 3U);
  EXPECT_EQ(worst[0].index, 1U);
  EXPECT_EQ(worst[1].index, 3U);
  EXPECT_EQ(worst[2].index, 0U);
  EXPECT_EQ(worst[0].shape.scaled_jacobian,
            *std::min_element(measures.scaled_jacobian.begin(), measures.scaled_jacobian.end()));
  EXPECT_NEAR(worst[0].place.x(), 2.5, 1e-12);
}

TEST(WorstElements, AreAtMostAllThatThereAre) {
  const TetMesh mesh = loose_tetrahedra(2, {});
  EXPECT_EQ(worst_tetrahedra(mesh, measure_elements(mesh, nullptr), 10).size(), 2U);
}

TEST(WorstElements, InsideOutIsSaid) {
  TetMesh mesh = loose_tetrahedra(3, {});
  std::swap(mesh.tetrahedra[2][0], mesh.tetrahedra[2][1]);
  const auto worst = worst_tetrahedra(mesh, measure_elements(mesh, nullptr), 1);
  EXPECT_EQ(worst[0].index, 2U);
  EXPECT_THAT(worst[0].cause, HasSubstr("inside out"));
}

TEST(WorstElements, AnEdgeOfThePartIsNamedWithItsAngle) {
  TetMesh wedge;  // two faces meet at 45 degrees along x; the others are covered by neighbours
  wedge.nodes = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 1, 1}, {0.5, 3, 0.5}, {-2, 2, 0.5}, {3, 2, 0.5}};
  wedge.tetrahedra = {{0, 1, 2, 3}, {1, 2, 3, 6}, {0, 2, 3, 5}};
  for (Tetrahedron& t : wedge.tetrahedra) {
    const Vec3 &a = wedge.nodes[t[0]], &b = wedge.nodes[t[1]], &c = wedge.nodes[t[2]], &d = wedge.nodes[t[3]];
    if ((b - a).cross(c - a).dot(d - a) < 0) std::swap(t[0], t[1]);
  }
  wedge.boundary = find_boundary(wedge.tetrahedra);
  const auto all = worst_tetrahedra(wedge, measure_elements(wedge, nullptr), 3);
  const auto first = std::find_if(all.begin(), all.end(), [](const auto& w) { return w.index == 0; });
  ASSERT_NE(first, all.end());
  EXPECT_THAT(first->cause, HasSubstr("45.0 degrees"));
}

TEST(WorstElements, NeedlesAndCapsAreToldApart) {
  SurfaceMesh box = analytic::box({4, 3, 2}, 1);
  const auto flat = static_cast<std::uint32_t>(box.triangles.size());
  const auto v = static_cast<std::uint32_t>(box.vertices.size());
  box.vertices.insert(box.vertices.end(), {Vec3(9, 0, 0), Vec3(10, 0, 0), Vec3(9.5, 0.05, 0), Vec3(10, 0.02, 0)});
  const auto w = static_cast<std::uint32_t>(box.vertices.size());
  box.vertices.insert(box.vertices.end(), {Vec3(9, 1, 0), Vec3(9.8, 1, 0), Vec3(9.8001, 1.00013, 0)});
  box.triangles.push_back({v, v + 1, v + 2});
  box.triangles.push_back({v, v + 1, v + 3});
  box.triangles.push_back({w, w + 1, w + 2});  // a needle with a corner of 128 degrees
  const auto all = worst_triangles(measure_elements(box, nullptr), 3);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_THAT(all[0].cause, HasSubstr("needle"));
  const std::span worst(all.data() + 1, 2);
  EXPECT_EQ(worst[0].index, flat + 1);
  EXPECT_THAT(worst[0].cause, HasSubstr("needle"));
  EXPECT_THAT(worst[0].cause, HasSubstr("open border"));
  EXPECT_THAT(worst[1].cause, HasSubstr("cap"));
}

TEST(WorstElements, TrianglesWithoutAreaHaveNoShape) {
  SurfaceMesh mesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}};
  EXPECT_EQ(worst_triangles(measure_elements(mesh, nullptr), 10).size(), 1U);
}

TEST(WorstElements, SetsAreThoseOfAnyMember) {
  const std::vector<NamedSet> sets{{"A", {1, 4}}, {"B", {2}}, {"C", {4, 9}}};
  EXPECT_THAT(sets_with(sets, std::vector<std::uint32_t>{4, 7}), testing::ElementsAre("A", "C"));
}

}  // namespace
}  // namespace scan2fea
