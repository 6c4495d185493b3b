#include "preproc/surface/curved/fit_curves.hpp"

#include "preproc/surface/curved/keep_curved_volume.hpp"
#include "preproc/surface/simplification/simplify.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/triangle_tree.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

namespace scan2fea {
namespace {

constexpr double pi = std::numbers::pi;

std::vector<std::uint32_t> all_faces(const CurvedSurface& surface) {
  std::vector<std::uint32_t> all(surface.corners.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

double volume_of(const CurvedSurface& surface) {
  return curved_volume(surface, all_faces(surface), Vec3::Zero());
}

// Of nine points of each triangle, by a function of the place; weights as areas would be almost alike.
template <class Distance>
double rms(const CurvedSurface& surface, const Distance& distance) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t f = 0; f < surface.corners.triangles.size(); ++f)
    for (int i = 1; i < 6; ++i)
      for (int j = 1; i + j < 6; ++j, ++count) {
        const double b = i / 6.0, c = j / 6.0;
        sum += std::pow(distance(point_on(surface.triangle(f), {1 - b - c, b, c})), 2);
      }
  return std::sqrt(sum / static_cast<double>(count));
}

struct Made {
  SurfaceMesh straight;
  FittedCurves curves;
};

Made fitted(const SurfaceMesh& scan, std::size_t faces) {
  SimplifyOptions options;
  options.size = FaceCount{faces};
  Made made;
  Simplification simplification(scan, options);
  const SimplifyResult result = simplification.run(made.straight);
  made.curves = simplification.curved(result, made.straight);
  return made;
}

SurfaceMesh horned_ball() {
  SurfaceMesh ball = analytic::sphere(1, 6);
  for (Vec3& p : ball.vertices) p.z() += p.z() > 0 ? 0.8 * std::exp(-60 * p.head<2>().squaredNorm()) : 0;
  return ball;
}

TEST(CurvedSurface, OfStraightEdgesIsTheSurface) {
  const SurfaceMesh box = analytic::box({1, 2, 3}, 0.5);
  const CurvedSurface curved(box);
  EXPECT_NEAR(volume_of(curved), 6, 1e-12);
  EXPECT_EQ(curved.edges.size(), box.triangles.size() * 3 / 2);
  EXPECT_NEAR(enclosed_volume(in_four(curved)), 6, 1e-12);
}

TEST(CurvedSurface, VolumeGradientIsThatOfTheVolume) {
  CurvedSurface curved(analytic::sphere(1, 1));
  for (Vec3& p : curved.mid) p *= 1.03;
  std::vector<Vec3> gradient(curved.nodes(), Vec3::Zero());
  add_volume_gradient(curved, all_faces(curved), gradient);
  for (const std::size_t i : {std::size_t{3}, curved.corners.vertices.size() + 7})
    for (int k = 0; k < 3; ++k) {
      CurvedSurface moved = curved;
      const double step = 1e-5;
      moved.node(i)[k] += step;
      const double ahead = volume_of(moved);
      moved.node(i)[k] -= 2 * step;
      EXPECT_NEAR((ahead - volume_of(moved)) / (2 * step), gradient[i][k], 1e-8);
    }
}

TEST(CurvedSurface, PlacesOnAQuarterAreThoseOnTheWhole) {
  CurvedSurface curved(analytic::sphere(1, 0));
  const SurfaceMesh fine = in_four(curved);  // straight: both are on the same plane
  for (std::size_t q = 0; q < 4; ++q) {
    const std::array<double, 3> b{0.5, 0.3, 0.2};
    Vec3 on_quarter = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) on_quarter += b[k] * fine.vertices[fine.triangles[20 + q][k]];
    EXPECT_NEAR((on_quarter - point_on(curved.triangle(5), in_whole(q, b))).norm(), 0, 1e-14);
  }
}

// The third power of the edge or better: four times the triangles, an eighth of the error.
TEST(FitCurves, OnATorusTheErrorFallsWithTheThirdPower) {
  const SurfaceMesh scan = analytic::torus(3, 1, 300, 120);
  const double facets = 1 - std::cos(pi / 120);  // the scan's own, at the most
  const auto distance = [](const Vec3& p) { return std::hypot(std::hypot(p.x(), p.y()) - 3, p.z()) - 1; };
  const Made coarse = fitted(scan, 500), fine = fitted(scan, 2000);
  const double error = rms(coarse.curves.surface, distance);
  EXPECT_LT(error, 0.1 * rms(CurvedSurface(coarse.straight), distance));
  EXPECT_LT(rms(fine.curves.surface, distance), error / 8 + facets);
}

TEST(FitCurves, KeepsTheVolumeToRounding) {
  const SurfaceMesh scan = analytic::sphere(1, 5);
  const Made made = fitted(scan, 800);
  EXPECT_NEAR(volume_of(made.curves.surface) / enclosed_volume(scan), 1, 1e-9);
  EXPECT_EQ(made.curves.straight, 0U);
}

// All of a thin disc whose side is facets as wide as triangles lies in planes, but for the middles of some chords of
// its rims, which would take volume that nothing gives back.
TEST(FitCurves, KeepsTheVolumeWhereNothingElseCanMove) {
  for (const int sides : {24, 48, 96}) {
    const SurfaceMesh scan = analytic::cylinder(1, 0.02, sides, 1);
    const Made made = fitted(scan, 2000);
    EXPECT_NEAR(volume_of(made.curves.surface) / enclosed_volume(scan), 1, 1e-8) << sides;
  }
}

TEST(FitCurves, WhatCannotKeepTheVolumeStaysStraight) {
  const CurvedSurface straight(analytic::sphere(1, 2));
  CurvedSurface curves = straight;
  for (Vec3& p : curves.mid) p.normalize();
  std::vector<Vec3> directions(curves.nodes(), Vec3::Zero());
  const std::vector<double> volumes = volumes_of_components(straight.corners);
  CurvedSurface moved = curves;
  EXPECT_FALSE(keep_curved_volume(moved, volumes, directions));
  const auto keep = [&](const std::vector<Vec3>& along, CurvedSurface& shifted) {
    return keep_curved_volume(shifted, volumes, along);
  };
  EXPECT_EQ(settle(straight, keep, nullptr, curves, directions), straight.corners.triangles.size());
  EXPECT_EQ(curves.mid, straight.mid);
}

// The middle of a rim's chord lies in the end face, which is no farther from it than nothing.
TEST(FitCurves, NodesOfARimLieOnItsLine) {
  const Made made = fitted(analytic::cylinder(1, 2, 160, 60), 1500);
  const CurvedSurface& surface = made.curves.surface;
  std::size_t on_rim = 0;
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    const auto is_on_rim = [&](const Vec3& p) { return std::abs(p.z() - 2) < 1e-6 && p.head<2>().norm() > 0.99; };
    const auto [a, b] = surface.edges[e];
    if (!is_on_rim(surface.corners.vertices[a]) || !is_on_rim(surface.corners.vertices[b])) continue;
    ++on_rim;
    EXPECT_NEAR(surface.mid[e].z(), 2, 1e-9);
    EXPECT_NEAR(surface.mid[e].head<2>().norm(), 1, 3e-4);  // the scan's chords are 2e-4 inside
  }
  EXPECT_GE(on_rim, 20U);
  // And what is plane stays plane.
  for (std::size_t f = 0; f < surface.corners.triangles.size(); ++f) {
    const SixNodeTriangle x = surface.triangle(f);
    if (!std::all_of(x.begin(), x.begin() + 3, [](const Vec3& p) { return std::abs(p.z() - 2) < 1e-6; })) continue;
    for (const Vec3& p : x) EXPECT_NEAR(p.z(), 2, 1e-9);
  }
}

// Both ways: points of the curved triangles, and the scan's vertices to pieces of them.
void expect_within(const CurvedSurface& surface, const SurfaceMesh& scan, double bound) {
  const TriangleTree of_scan(scan);
  SurfaceMesh pieces;
  constexpr int cuts = 8;
  for (std::size_t f = 0; f < surface.corners.triangles.size(); ++f) {
    const auto place = [&](int i, int j) {
      const double b = static_cast<double>(i) / cuts, c = static_cast<double>(j) / cuts;
      return point_on(surface.triangle(f), {1 - b - c, b, c});
    };
    for (int i = 0; i <= cuts; ++i)
      for (int j = 0; i + j <= cuts; ++j)
        ASSERT_LE(std::sqrt(of_scan.closest(place(i, j)).squared_distance), bound) << f;
    for (int i = 0; i < cuts; ++i)
      for (int j = 0; i + j < cuts; ++j)
        for (const bool turned : {false, true}) {
          if (turned && i + j + 1 >= cuts) continue;
          const auto first = static_cast<std::uint32_t>(pieces.vertices.size());
          pieces.vertices.push_back(turned ? place(i + 1, j + 1) : place(i, j));
          pieces.vertices.push_back(place(i + 1, j));
          pieces.vertices.push_back(place(i, j + 1));
          pieces.triangles.push_back({first, first + 1, first + 2});
        }
  }
  const TriangleTree of_curves(pieces);
  for (const Vec3& p : scan.vertices) ASSERT_LE(std::sqrt(of_curves.closest(p).squared_distance), 1.02 * bound);
}

struct Bounded {
  SimplifyResult result;
  SurfaceMesh straight;
  FittedCurves curves;
};

Bounded bounded(const SurfaceMesh& scan, double bound, bool curved) {
  SimplifyOptions options;
  options.size = LargestDeviation{.distance = bound};
  options.curved = curved;
  Bounded made;
  Simplification simplification(scan, options);
  made.result = simplification.run(made.straight);
  made.curves = simplification.curved(made.result, made.straight);
  return made;
}

// Of a ball with a thin horn, whose triangles are far smaller than the ball's: a bound of the straight surface holds
// for the curved one, too.
TEST(FitCurves, KeepsADeviationThatStraightTrianglesHave) {
  const double bound = 0.004;
  const SurfaceMesh scan = horned_ball();
  const Bounded made = bounded(scan, bound, false);
  ASSERT_TRUE(made.result.keeps_deviation());
  EXPECT_LT(made.curves.straight, made.straight.triangles.size() / 20);
  expect_within(made.curves.surface, scan, bound);
}

// The horn's triangles are as small as straight ones, the ball's half as long as its nodes are apart.
TEST(FitCurves, FewerCurvedTrianglesKeepADeviation) {
  const SurfaceMesh torus = analytic::torus(3, 1, 240, 96);
  for (const auto& [scan, bound, share] : {std::tuple(horned_ball(), 0.004, 0.6), std::tuple(torus, 0.01, 0.3)}) {
    const Bounded made = bounded(scan, bound, true);
    ASSERT_TRUE(made.result.keeps_deviation());
    EXPECT_TRUE(made.result.is_of_curved);
    const auto straight = static_cast<double>(bounded(scan, bound, false).straight.triangles.size());
    EXPECT_LT(static_cast<double>(made.straight.triangles.size()), share * straight);
    expect_within(made.curves.surface, scan, bound);
    EXPECT_NEAR(volume_of(made.curves.surface) / enclosed_volume(scan), 1, 1e-9);
  }
}

TEST(FitCurves, NoTwoTrianglesMeetInAThinFold) {
  // A plate whose thickness is a third of an edge, bent.
  SurfaceMesh plate = analytic::box({4, 4, 0.1}, 0.05);
  for (Vec3& p : plate.vertices) p.z() += 0.4 * std::sin(1.5 * p.x());
  const Made made = fitted(plate, 1200);
  ASSERT_TRUE(find_self_intersections(made.straight).empty());
  EXPECT_TRUE(find_self_intersections(in_four(made.curves.surface)).empty());
  EXPECT_NEAR(volume_of(made.curves.surface) / enclosed_volume(plate), 1, 1e-9);
}

TEST(FitCurves, TheSameForAnyNumberOfThreads) {
  const SurfaceMesh scan = analytic::torus(3, 1, 120, 48);
  const auto nodes_with = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return fitted(scan, 600).curves.surface.mid;
  };
  EXPECT_EQ(nodes_with(1), nodes_with(4));
}

}  // namespace
}  // namespace scan2fea
