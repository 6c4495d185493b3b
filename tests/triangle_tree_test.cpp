#include "quality/triangle_tree.hpp"

#include "preproc/mesh/error.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace scan2fea {
namespace {

std::vector<Vec3> random_points(std::size_t count, double range) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> coordinate(-range, range);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = {coordinate(generator), coordinate(generator), coordinate(generator)};
  return points;
}

double nearest_by_trying_all(const SurfaceMesh& mesh, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 q = closest_point_on_triangle(p, mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]);
    nearest = std::min(nearest, (p - q).squaredNorm());
  }
  return nearest;
}

TEST(ClosestPointOnTriangle, InEachOfTheSevenRegions) {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  EXPECT_EQ(closest_point_on_triangle({1, 1, 5}, a, b, c), Vec3(1, 1, 0));
  EXPECT_EQ(closest_point_on_triangle({2, -1, 1}, a, b, c), Vec3(2, 0, 0));
  EXPECT_EQ(closest_point_on_triangle({-1, 2, 1}, a, b, c), Vec3(0, 2, 0));
  EXPECT_EQ(closest_point_on_triangle({3, 3, 1}, a, b, c), Vec3(2, 2, 0));
  EXPECT_EQ(closest_point_on_triangle({-1, -1, 1}, a, b, c), a);
  EXPECT_EQ(closest_point_on_triangle({9, -1, 1}, a, b, c), b);
  EXPECT_EQ(closest_point_on_triangle({-1, 9, 1}, a, b, c), c);
}

TEST(ClosestPointOnTriangle, NoPointOfTheTriangleIsNearer) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const double flatness : {1.0, 1e-3, 1e-9, 0.0})
    for (const Vec3& p : random_points(50, 2)) {
      const Vec3 a(unit(generator), 0, 0), b(unit(generator), unit(generator) * flatness, 0), c(1, flatness, flatness);
      const double distance = (closest_point_on_triangle(p, a, b, c) - p).norm();
      for (int trial = 0; trial < 200; ++trial) {
        const double r = std::sqrt(unit(generator)), s = unit(generator);
        EXPECT_LE(distance, ((1 - r) * a + r * (1 - s) * b + r * s * c - p).norm() + 1e-12);
      }
    }
}

TEST(ClosestPointOnTriangle, OfAPointOrASegment) {
  EXPECT_EQ(closest_point_on_triangle({3, 4, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}), Vec3(0, 0, 0));
  EXPECT_EQ(closest_point_on_triangle({1.5, 4, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}), Vec3(1.5, 0, 0));
}

TEST(TriangleTree, FindsWhatTryingAllFinds) {
  for (const SurfaceMesh& mesh :
       {analytic::torus(1, 0.4, 31, 17), analytic::box({1, 2, 3}, 1), analytic::sphere(1, 0)}) {
    const TriangleTree tree(mesh);
    for (const Vec3& p : random_points(300, 3)) {
      const ClosestPoint found = tree.closest(p);
      EXPECT_DOUBLE_EQ(found.squared_distance, nearest_by_trying_all(mesh, p));
      EXPECT_DOUBLE_EQ((found.point - p).squaredNorm(), found.squared_distance);
      const auto& [i, j, k] = mesh.triangles[found.triangle];
      EXPECT_EQ(closest_point_on_triangle(p, mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]), found.point);
    }
  }
}

TEST(TriangleTree, AHintChangesNoDistance) {
  const SurfaceMesh mesh = analytic::noisy(analytic::sphere(1, 3), 0.1, 2);
  const TriangleTree tree(mesh);
  std::uint32_t hint = 0;
  for (const Vec3& p : random_points(300, 2)) {
    const ClosestPoint found = tree.closest(p, hint);
    EXPECT_DOUBLE_EQ(found.squared_distance, tree.closest(p).squared_distance);
    hint = (hint + 7) % static_cast<std::uint32_t>(mesh.triangles.size());
  }
}

TEST(TriangleTree, WithinADistanceOrNotAtAll) {
  const TriangleTree tree(analytic::box({1, 1, 1}, 1));
  EXPECT_FALSE(tree.closest_within({0.5, 0.5, 2}, 0.99).has_value());
  const auto found = tree.closest_within({0.5, 0.5, 2}, 1.01);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->point, Vec3(0.5, 0.5, 1));
}

TEST(TriangleTree, OfASubsetKnowsNoOther) {
  const SurfaceMesh mesh = analytic::box({1, 1, 1}, 1);
  std::vector<std::uint32_t> bottom;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (area_vector(mesh, mesh.triangles[t]).z() < 0) bottom.push_back(t);
  EXPECT_DOUBLE_EQ(TriangleTree(mesh, bottom).closest({0.5, 0.5, 3}).squared_distance, 9);
}

TEST(TriangleTree, OverlapsAreTheBoxesThatMeet) {
  const SurfaceMesh mesh = analytic::torus(1, 0.4, 31, 17);
  const TriangleTree tree(mesh);
  for (const Vec3& corner : random_points(50, 1)) {
    const BoundingBox box{corner, corner + Vec3(0.1, 0.3, 0.2)};
    std::set<std::uint32_t> found, expected;
    tree.for_each_overlap(box, [&](std::uint32_t t) { EXPECT_TRUE(found.insert(t).second); });
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [i, j, k] = mesh.triangles[t];
      const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
      const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
      if ((low.array() <= box.high.array()).all() && (high.array() >= box.low.array()).all()) expected.insert(t);
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(TriangleTree, ManyEqualTrianglesDoNotOverflow) {
  SurfaceMesh mesh = analytic::sphere(1, 0);
  mesh.triangles.assign(1000, mesh.triangles[0]);
  EXPECT_NEAR(TriangleTree(mesh).closest(mesh.vertices[mesh.triangles[0][0]]).squared_distance, 0, 1e-30);
}

TEST(TriangleTree, LeafOrderIsAPermutation) {
  const SurfaceMesh mesh = analytic::sphere(1, 2);
  const TriangleTree tree(mesh);
  EXPECT_EQ(std::set<std::uint32_t>(tree.leaf_order().begin(), tree.leaf_order().end()).size(), mesh.triangles.size());
}

TEST(TriangleTree, OfNothingIsRefused) {
  EXPECT_THROW(TriangleTree(SurfaceMesh{}), InvalidInput);
}

}  // namespace
}  // namespace scan2fea
