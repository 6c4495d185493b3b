#include "quality/wall_thickness.hpp"

#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace scan2fea {
namespace {

Vec3 middle_of(const SurfaceMesh& mesh, std::uint32_t f) {
  const auto& [a, b, c] = mesh.triangles[f];
  return (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
}

Vec3 normal_of(const SurfaceMesh& mesh, std::uint32_t f) {
  return area_vector(mesh, mesh.triangles[f]).normalized();
}

// Calls visit(middle, normal, wall) for each triangle.
void for_each_middle(const SurfaceMesh& mesh, const WallOptions& options, const auto& visit) {
  const TriangleTree tree(mesh);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Vec3 middle = middle_of(mesh, f), normal = normal_of(mesh, f);
    visit(middle, normal, find_wall(mesh, tree, middle, normal, options));
  }
}

TEST(WallThickness, OfASlab) {
  const SurfaceMesh slab = analytic::box({10, 10, 1}, 0.5);
  const TriangleTree tree(slab);
  int deep = 0;
  for_each_middle(slab, {.deepest = 3}, [&](const Vec3& p, const Vec3& n, const auto& wall) {
    const double from_side = std::min({p.x(), p.y(), 10 - p.x(), 10 - p.y()});
    if (std::abs(n.z()) < 0.5) {
      EXPECT_FALSE(wall);  // the sides are 10 apart
    } else if (from_side > 0.5) {
      ++deep;
      ASSERT_TRUE(wall);
      EXPECT_NEAR(wall->thickness, 1, 1e-5);
      EXPECT_NEAR((wall->across - (p - n)).norm(), 0, 1e-5);
      EXPECT_LT(normal_of(slab, wall->opposite).dot(n), -0.99);
    } else {
      EXPECT_FALSE(wall);  // the ball touches the side
    }
  });
  EXPECT_GT(deep, 1000);
}

TEST(WallThickness, IsNotLookedForDeeperThanAsked) {
  const SurfaceMesh slab = analytic::box({10, 10, 1}, 0.5);
  for_each_middle(slab, {.deepest = 0.99}, [](const Vec3&, const Vec3&, const auto& wall) { EXPECT_FALSE(wall); });
}

TEST(WallThickness, OfAShellFromBothSidesButNotOfItsCavity) {
  const SurfaceMesh shell = analytic::join(analytic::sphere(3, 4), analytic::reversed(analytic::sphere(2, 4)));
  std::size_t found = 0;
  for_each_middle(shell, {.deepest = 5}, [&](const Vec3& p, const Vec3& n, const auto& wall) {
    if (!wall) return;
    ++found;
    EXPECT_NEAR(wall->thickness, 1, 0.01);
    EXPECT_EQ(wall->across.norm() > 2.5, p.norm() < 2.5);
    EXPECT_LT(normal_of(shell, wall->opposite).dot(n), -0.9);
  });
  EXPECT_EQ(found, shell.triangles.size());
}

// Between two planes at an angle a, a ball that touches one of them at the distance s from their edge touches the other
// at the same one.
TEST(WallThickness, OfAWedgeGrowsFromItsEdgeWhereItIsSharpEnough) {
  for (const double angle_deg : {20., 50., 70.}) {
    const double angle = angle_deg * std::numbers::pi / 180;
    SurfaceMesh wedge = analytic::box({4, 4, 1}, 0.25);
    for (Vec3& v : wedge.vertices) {  // the side x = 0 becomes the edge
      const double s = v.x() + 1e-3;
      v = s * Vec3(std::cos(v.z() * angle), 0, std::sin(v.z() * angle)) + Vec3(0, v.y(), 0);
    }
    int found = 0;
    for_each_middle(wedge, {.deepest = 1}, [&](const Vec3& p, const Vec3& n, const auto& wall) {
      if (!wall) return;
      if (std::abs(n.y()) > 0.5) return;
      ++found;
      const double s = std::hypot(p.x(), p.z());
      EXPECT_NEAR(wall->thickness, 2 * s * std::sin(angle / 2), 1e-3 * s);
    });
    if (angle_deg < 60)
      EXPECT_GT(found, 50) << angle_deg;
    else
      EXPECT_EQ(found, 0);
  }
}

TEST(WallThickness, TheAngleBetweenTheSidesIsAnOption) {
  SurfaceMesh slab = analytic::box({10, 10, 1}, 0.5);
  for (Vec3& v : slab.vertices) v.z() *= 1 + 0.1 * v.x();  // the upper side rises by 5.7 degrees
  const auto count = [&](double opposing) {
    int found = 0;
    for_each_middle(slab, {.deepest = 3, .opposing = opposing},
                    [&](const Vec3&, const Vec3&, const auto& wall) { found += wall ? 1 : 0; });
    return found;
  };
  EXPECT_EQ(count(-std::cos(5 * std::numbers::pi / 180)), 0);
  EXPECT_GT(count(-std::cos(6 * std::numbers::pi / 180)), 1000);
}

TEST(WallThickness, OfATube) {
  const SurfaceMesh tube =
      analytic::join(analytic::cylinder(3, 20, 128, 60),
                     analytic::reversed(analytic::moved(analytic::cylinder(2, 16, 128, 48), {0, 0, 2})));
  std::size_t asked = 0;
  for_each_middle(tube, {.deepest = 2.5}, [&](const Vec3& p, const Vec3& n, const auto& wall) {
    if (std::abs(n.z()) > 0.5 || p.z() < 4 || p.z() > 16) return;
    ++asked;
    ASSERT_TRUE(wall);
    EXPECT_NEAR(wall->thickness, 1, 0.01);
  });
  EXPECT_GT(asked, 5000u);
}

// The largest ball touches a ball everywhere: what is found depends on the triangles, but is a diameter all the same.
TEST(WallThickness, OfABallIsItsDiameterWhereAnyIsFound) {
  for_each_middle(analytic::sphere(1, 3), {.deepest = 3}, [](const Vec3&, const Vec3&, const auto& wall) {
    if (!wall) return;
    EXPECT_GE(wall->thickness, 0.86 * 2 * 0.98);
    EXPECT_LE(wall->thickness, 2);
  });
}

TEST(WallThickness, NoneBehindConvexVertices) {
  const SurfaceMesh ball = analytic::sphere(1, 3);
  const TriangleTree tree(ball);
  for (const Vec3& v : ball.vertices) EXPECT_FALSE(find_wall(ball, tree, v, v.normalized(), {.deepest = 3}));
}

// Whatever the shape: nothing of the surface is in the ball.
TEST(WallThickness, TheBallIsEmpty) {
  const SurfaceMesh mesh = analytic::noisy(
      analytic::join(analytic::torus(3, 1, 80, 40), analytic::reversed(analytic::torus(3, 0.6, 60, 30))), 0.01, 3);
  const TriangleTree tree(mesh);
  int found = 0;
  for_each_middle(mesh, {.deepest = 1}, [&](const Vec3& p, const Vec3& n, const auto& wall) {
    if (!wall) return;
    ++found;
    const double radius = wall->thickness * wall->thickness / (2 * (p - wall->across).dot(n));
    EXPECT_GE(std::sqrt(tree.closest(p - radius * n).squared_distance), radius * (1 - 1e-5));
    EXPECT_LE(wall->thickness, 2 * radius * (1 + 1e-9));
    EXPECT_GE(wall->thickness, std::sqrt(0.75) * 2 * radius * (1 - 1e-3));
  });
  EXPECT_GT(found, 1000);
}

}  // namespace
}  // namespace scan2fea
