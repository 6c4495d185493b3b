#include "quality/prism_cover.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace scan2fea {
namespace {

constexpr double any_height = std::numeric_limits<double>::infinity();

struct Surface {
  explicit Surface(SurfaceMesh m)
      : mesh(std::move(m)), tree(mesh), edges(mesh, tree), box(bounding_box(mesh.vertices)) {}

  PrismCover cover() const { return {tree, edges, box}; }
  std::uint32_t leaf_at(const Vec3& p) const { return tree.leaf_of(tree.closest(p).triangle); }

  SurfaceMesh mesh;
  TriangleTree tree;
  LeafEdges edges;
  BoundingBox box;
};

// A triangle at height `z` over the middle of a sheet of side 3.
struct Above {
  Vec3 a, b, c;
  explicit Above(double z) : a(0.31, 0.42, z), b(2.53, 0.77, z), c(1.12, 2.61, z) {}
  Vec3 middle() const { return (a + b + c) / 3; }
  double area() const { return 0.5 * (b - a).cross(c - a).norm(); }
};

double area_of(const PrismCover::Polygon& polygon) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size; ++i)
    twice += (polygon.corners[i - 1] - polygon.corners[0]).cross(polygon.corners[i] - polygon.corners[0]);
  return 0.5 * twice.norm();
}

TEST(PrismCover, PartsTheTriangleByWhatLiesOverIt) {
  for (const bool is_reversed : {false, true}) {
    const SurfaceMesh sheet = analytic::sheet(3, 3, 0.25);
    const Surface surface(is_reversed ? analytic::reversed(sheet) : sheet);
    PrismCover cover = surface.cover();
    const Above t(0.2);
    ASSERT_TRUE(cover.covers(t.a, t.b, t.c, surface.leaf_at(t.middle()), any_height));
    EXPECT_NEAR(cover.largest_height(), 0.2, 1e-12);
    double area = 0;
    for (const PrismCover::Part& part : cover.parts()) {
      if (part.height < 0) continue;
      EXPECT_NEAR(part.height, 0.2, 1e-12);
      area += area_of(cover.foot_of(part));
    }
    EXPECT_NEAR(area, t.area(), 1e-12);
  }
}

TEST(PrismCover, FindsTheHighestPointWhereverTheWalkBegins) {
  SurfaceMesh mesh = analytic::sheet(3, 3, 0.25);
  for (Vec3& v : mesh.vertices) v.z() = 0.1 * std::exp(-(v - Vec3(1.25, 1.25, 0)).squaredNorm());
  const Surface surface(mesh);
  PrismCover cover = surface.cover();
  const Above t(0);
  for (const Vec3& from : {t.middle(), t.a, t.b, t.c}) {
    ASSERT_TRUE(cover.covers(t.a, t.b, t.c, surface.leaf_at(from), any_height));
    EXPECT_NEAR(cover.largest_height(), 0.1, 1e-12);
    EXPECT_NEAR((cover.foot_of_highest() - Vec3(1.25, 1.25, 0)).norm(), 0, 1e-12);
  }
}

TEST(PrismCover, HasNoAnswerOverABorderOrBesideTheSurface) {
  SurfaceMesh holed = analytic::sheet(3, 3, 0.25);
  const Above t(0.2);
  const Surface whole(holed);
  holed.triangles.erase(holed.triangles.begin() + static_cast<std::ptrdiff_t>(whole.tree.closest(t.middle()).triangle));
  const Surface surface(holed);
  PrismCover cover = surface.cover();
  EXPECT_FALSE(cover.covers(t.a, t.b, t.c, surface.leaf_at(t.middle()), any_height));
  const Vec3 far(5, 0, 0);
  EXPECT_FALSE(cover.covers(t.a + far, t.b + far, t.c + far, surface.leaf_at(t.middle() + far), any_height));
  // What the walk passes all over too high is not asked further.
  EXPECT_FALSE(whole.cover().covers(t.a, t.b, t.c, whole.leaf_at(t.middle()), 0.1));
  EXPECT_FALSE(whole.cover().covers(t.a, t.a, t.b, whole.leaf_at(t.middle()), any_height));
}

TEST(PrismCover, CutsAreNoBorders) {
  SurfaceMesh soup;
  const SurfaceMesh sheet = analytic::sheet(3, 3, 0.25);
  for (const Triangle& t : sheet.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(sheet.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const Surface surface(soup);
  const Above t(0.2);
  EXPECT_TRUE(surface.cover().covers(t.a, t.b, t.c, surface.leaf_at(t.middle()), any_height));
}

// A triangle whose edge lies on a right-angled edge of a body: the side below touches it and must not be walked down.
TEST(PrismCover, WallsBesideTheTriangleDoNotMatter) {
  const Surface surface(analytic::box({3, 3, 3}, 0.5));
  PrismCover cover = surface.cover();
  ASSERT_TRUE(cover.covers({0, 0, 3.1}, {3, 0, 3.1}, {0, 3, 3.1}, surface.leaf_at({1, 1, 3}), 1));
  EXPECT_NEAR(cover.largest_height(), 0.1, 1e-12);
}

TEST(PrismCover, OfAFoldCountsWhatIsTurnedAsTheWhole) {
  // x goes forth, back and forth again: between 1.32 and 1.82 lie three layers, the one in the middle upside down.
  SurfaceMesh mesh = analytic::sheet(3, 3, 0.1);
  for (Vec3& v : mesh.vertices) {
    const double x = v.x();
    v.x() = x + 0.9 * std::sin(2 * x);
    v.z() = 0.1 * x;
  }
  const Surface surface(mesh);
  PrismCover cover = surface.cover();
  const Vec3 a(1, 1.1, 0), b(2.1, 1.2, 0), c(1.5, 1.9, 0);
  for (const double x : {0.5, 1.5, 2.5}) {  // from any of the layers
    ASSERT_TRUE(cover.covers(a, b, c, surface.leaf_at({x + 0.9 * std::sin(2 * x), 1.4, 0.1 * x}), any_height));
    double area = 0;
    for (const PrismCover::Part& part : cover.parts()) {
      const auto& [p, q, r] = surface.tree.corners_of_leaf(part.leaf);
      const bool is_upside_down = (q - p).cross(r - p).z() < 0;
      EXPECT_TRUE(!is_upside_down || part.height < 0);
      if (part.height >= 0) area += area_of(cover.foot_of(part));
    }
    EXPECT_GT(area, 1.2 * 0.5 * (b - a).cross(c - a).norm());
    EXPECT_LT(area, 2 * 0.5 * (b - a).cross(c - a).norm());
  }
}

}  // namespace
}  // namespace scan2fea
