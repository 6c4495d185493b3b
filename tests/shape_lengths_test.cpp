#include "preproc/surface/sizing/shape_lengths.hpp"

#include "preproc/surface/features/find_features.hpp"
#include "preproc/surface/kernel/micro_edges.hpp"
#include "preproc/surface/sizing/sizing_field.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

struct Parted {
  SurfaceMesh mesh;
  std::vector<double> length;
};

Parted part(SurfaceMesh mesh, double longest, double shortest = 0.01, double most_triangles = 1e9) {
  std::vector<FeatureEdge> creases = find_features(mesh).edges;
  std::vector<double> length = part_by_shape(mesh, creases, 1.5, shortest, longest, most_triangles);
  return {std::move(mesh), std::move(length)};
}

// Of the vertices for which `counts(place)`.
template <class Counts>
std::pair<double, double> range(const Parted& parted, const Counts& counts) {
  std::pair<double, double> found{1e300, 0};
  for (std::size_t v = 0; v < parted.length.size(); ++v) {
    if (!counts(parted.mesh.vertices[v])) continue;
    found.first = std::min(found.first, parted.length[v]);
    found.second = std::max(found.second, parted.length[v]);
  }
  return found;
}

TEST(ShapeLengths, OfAPlateAreShortAlongItsSidesAlone) {
  const Parted plate = part(analytic::box({100, 60, 2}, 100), 30);
  const auto [least_at_side, most_at_side] =
      range(plate, [](const Vec3& p) { return p.x() < 1e-9 && std::abs(p.y() - 30) < 20; });
  EXPECT_NEAR(least_at_side, 1.2, 0.1);  // 0.6 of a strip of 2
  EXPECT_NEAR(most_at_side, 1.2, 0.1);
  const auto [least_inside, most_inside] = range(plate, [](const Vec3& p) {
    return std::min({p.x(), 100 - p.x(), p.y(), 60 - p.y()}) > 25;
  });
  // Creases part its sides, so that it is no wall that a lattice could join.
  EXPECT_GT(least_inside, 20);
  EXPECT_LE(most_inside, 30);
}

TEST(ShapeLengths, AskForNoMoreTrianglesThanMayBe) {
  const SurfaceMesh plate = analytic::box({100, 60, 0.2}, 100);
  const std::size_t free = part(plate, 30).mesh.triangles.size();
  const Parted bounded = part(plate, 30, 0.01, 1000);
  EXPECT_GT(free, 10000u);
  EXPECT_LT(bounded.mesh.triangles.size(), 6000u) << "halved edges have about three quarters of the largest length";
  EXPECT_LT(predicted_triangles(bounded.mesh, {bounded.length}), 1001);
}

TEST(ShapeLengths, OfARoundBarFollowItsTurning) {
  const double radius = 2;
  const Parted bar = part(analytic::cylinder(radius, 60, 48, 30), 20);
  const auto [least, most] = range(bar, [](const Vec3& p) { return p.z() > 10 && p.z() < 50; });
  const double quarter = 1.3 * radius * std::numbers::pi / 4;
  EXPECT_GT(least, 0.8 * quarter);
  EXPECT_LT(most, 1.2 * quarter);
}

TEST(ShapeLengths, OfAThinShellAreTwiceItsWall) {
  const SurfaceMesh shell = analytic::join(analytic::sphere(30, 5), analytic::reversed(analytic::sphere(29, 5)));
  const auto [least, most] = range(part(shell, 15), [](const Vec3&) { return true; });
  EXPECT_NEAR(least, 2, 0.05);
  EXPECT_NEAR(most, 2, 0.05);
}

TEST(ShapeLengths, HaveALeast) {
  const Parted bar = part(analytic::cylinder(0.5, 60, 48, 30), 20, 2);
  EXPECT_DOUBLE_EQ(range(bar, [](const Vec3&) { return true; }).first, 2);
}

TEST(ShapeLengths, AreNotThoseOfStripsThatTheShortestEdgesCannotPart) {
  const Parted plate = part(analytic::box({100, 60, 0.01}, 100), 30, 2);
  EXPECT_DOUBLE_EQ(range(plate, [](const Vec3&) { return true; }).first, 30);
}

TEST(ShapeLengths, OfAWireOfSliversDoNotMakeMillionsOfThem) {
  // Facets a thousand times as long as wide: each halving makes three slivers of one.
  const Parted parted = part(analytic::cylinder(1, 300, 12, 1), 2, 0.3, 8000);
  EXPECT_LE(parted.mesh.triangles.size(), 250000U);
  EXPECT_EQ(parted.length.size(), parted.mesh.vertices.size());
  for (const double length : parted.length) EXPECT_LE(length, 2);
}

TEST(IsPart, TellsPlanesFromFreeForms) {
  EXPECT_TRUE(is_part(analytic::box({3, 2, 1}, 0.2)));
  EXPECT_TRUE(is_part(analytic::cylinder(2, 10, 48, 20)));
  EXPECT_FALSE(is_part(analytic::sphere(1, 4)));
  EXPECT_FALSE(is_part(analytic::noisy(analytic::box({3, 2, 1}, 0.2), 0.005, 1)));
}

TEST(MicroEdges, AreContracted) {
  SurfaceMesh box = analytic::box({10, 10, 10}, 5);
  // A vertex twice, joined by two needles: as where two corners nearly met.
  const Triangle cut = box.triangles.front();
  const auto twin = static_cast<std::uint32_t>(box.vertices.size());
  box.vertices.push_back(box.vertices[cut[0]] + 1e-6 * (box.vertices[cut[1]] - box.vertices[cut[0]]) +
                         1e-6 * (box.vertices[cut[2]] - box.vertices[cut[0]]));
  box.triangles.front() = {cut[0], cut[1], twin};
  box.triangles.push_back({cut[1], cut[2], twin});
  box.triangles.push_back({cut[2], cut[0], twin});
  ASSERT_TRUE(check_validity(box).closed());
  const SurfaceMesh clean = without_micro_edges(box, 1e-3);
  EXPECT_EQ(clean.vertices.size(), box.vertices.size() - 1);
  EXPECT_TRUE(check_validity(clean).closed());
  EXPECT_NEAR(enclosed_volume(clean), 1000, 1e-2);
}

TEST(MicroEdges, VerticesBesideEdgesAreJoinedToThem) {
  SurfaceMesh box = analytic::box({10, 10, 10}, 10);
  // The middle of a diagonal, a little off it: one flat triangle.
  const Triangle flat = box.triangles.front();
  const auto middle = static_cast<std::uint32_t>(box.vertices.size());
  const auto& p = box.vertices;
  std::size_t k = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if ((p[flat[(i + 1) % 3]] - p[flat[i]]).norm() > (p[flat[(k + 1) % 3]] - p[flat[k]]).norm()) k = i;
  const std::uint32_t a = flat[k], b = flat[(k + 1) % 3], c = flat[(k + 2) % 3];
  const Vec3 on = 0.5 * (p[a] + p[b]);
  box.vertices.push_back(on + 1e-6 * (p[c] - on));
  box.triangles.front() = {a, b, middle};
  box.triangles.push_back({b, c, middle});
  box.triangles.push_back({c, a, middle});
  const SurfaceMesh clean = without_micro_edges(box, 1e-3);
  EXPECT_TRUE(check_validity(clean).closed());
  for (const Triangle& t : clean.triangles) EXPECT_GT(area_vector(clean, t).norm(), 1);
  EXPECT_NEAR(enclosed_volume(clean), 1000, 1e-2);
}

TEST(MicroEdges, AreNoneOfASoundSurface) {
  const SurfaceMesh ball = analytic::sphere(1, 3);
  EXPECT_EQ(without_micro_edges(ball, 1e-4).triangles, ball.triangles);
}

}  // namespace
}  // namespace scan2fea
