#include "preproc/surface/sizing/size_limits.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/simplification/simplify.hpp"
#include "preproc/surface/sizing/sizing_field.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(SizeLimits, HoldWithinBoxesAndBallsAlone) {
  const SurfaceMesh sphere = analytic::sphere(10, 4);
  const SizeLimits limits{.boxes = {{.box = {.low = {-20, -20, 8}, .high = {20, 20, 20}}, .length = 0.5}},
                          .balls = {{.ball = {.centre = {-10, 0, 0}, .radius = 3}, .length = 0.3}},
                          .elements_across = {}};
  const std::vector<double> longest = longest_edges(sphere, limits, 1);
  const double edge = 2.0;  // more than the triangles are wide: those at the limits' rims may go either way
  for (std::size_t v = 0; v < longest.size(); ++v) {
    const Vec3& p = sphere.vertices[v];
    const double from_ball = (p - Vec3(-10, 0, 0)).norm();
    if (p.z() > 8) {
      EXPECT_LE(longest[v], 0.5);
    } else if (from_ball < 3) {
      EXPECT_LE(longest[v], 0.3);
    } else if (p.z() < 8 - edge && from_ball > 3 + edge) {
      EXPECT_EQ(longest[v], infinity);
    }
  }
}

TEST(SizeLimits, GiveLargeTrianglesVerticesWhereTheyAreNeeded) {
  SurfaceMesh cube = analytic::box({10, 10, 10}, 10);  // 12 triangles
  std::vector<FeatureEdge> no_features;
  const SizeLimits limits{
      .boxes = {}, .balls = {{.ball = {.centre = {5, 6, 10}, .radius = 1}, .length = 0.4}}, .elements_across = {}};
  refine_within_limits(cube, no_features, limits);
  EXPECT_NEAR(enclosed_volume(cube), 1000, 1e-9);
  EXPECT_TRUE(check_validity(cube).closed());
  std::size_t inside = 0;
  for (const Vec3& p : cube.vertices) inside += (p - Vec3(5, 6, 10)).norm() < 1 ? 1 : 0;
  EXPECT_GT(inside, 12U);  // some 20 for edges of 0.4
}

TEST(SizeLimits, KnowTheThicknessOfWalls) {
  const SurfaceMesh plate = analytic::box({20, 20, 2}, 0.5);
  const std::vector<double> longest = longest_edges(plate, {.boxes = {}, .balls = {}, .elements_across = 4}, 3);
  for (std::size_t v = 0; v < longest.size(); ++v) {
    const Vec3& p = plate.vertices[v];
    const double from_side = std::min({p.x(), 20 - p.x(), p.y(), 20 - p.y()});
    if (from_side > 2) {
      EXPECT_LE(longest[v], 0.5);
      EXPECT_GE(longest[v], 0.4);
    } else if (p.z() > 0.6 && p.z() < 1.4) {
      EXPECT_EQ(longest[v], infinity);  // the sides are 20 apart
    }
  }
  for (const double l :
       longest_edges(analytic::box({20, 20, 20}, 1), {.boxes = {}, .balls = {}, .elements_across = 4}, 3))
    EXPECT_EQ(l, infinity);
}

TEST(SizeLimits, TakeTrianglesFromTheRest) {
  const SurfaceMesh sphere = analytic::sphere(10, 5);
  const std::vector<double> wanted(sphere.vertices.size(), 1.0);
  const double triangles = predicted_triangles(sphere, {wanted});
  const std::vector<double> longest = longest_edges(
      sphere,
      {.boxes = {}, .balls = {{.ball = {.centre = {0, 0, 10}, .radius = 2}, .length = 0.4}}, .elements_across = {}}, 1);
  const std::vector<double> more = within_limits(sphere, wanted, longest, 0.2, std::nullopt);
  EXPECT_GT(predicted_triangles(sphere, {more}), 1.1 * triangles);
  const std::vector<double> same = within_limits(sphere, wanted, longest, 0.2, triangles);
  EXPECT_NEAR(predicted_triangles(sphere, {same}), triangles, 0.02 * triangles);
  for (std::size_t v = 0; v < same.size(); ++v) {
    EXPECT_LE(same[v], longest[v]);
    if (sphere.vertices[v].z() < 0) {
      EXPECT_GT(same[v], 1);
    }
  }
}

TEST(SizeLimits, RefuseWhatMeansNothing) {
  const SurfaceMesh sphere = analytic::sphere(1, 1);
  const BoundingBox box{.low = {0, 0, 0}, .high = {1, 1, 1}}, inverted{.low = {1, 1, 1}, .high = {0, 0, 0}};
  EXPECT_THROW(longest_edges(sphere, {.boxes = {{box, 0}}, .balls = {}, .elements_across = {}}, 1), WrongUsage);
  EXPECT_THROW(longest_edges(sphere, {.boxes = {{inverted, 1}}, .balls = {}, .elements_across = {}}, 1), WrongUsage);
  EXPECT_THROW(longest_edges(sphere, {.boxes = {}, .balls = {{{Vec3::Zero(), -1}, 1}}, .elements_across = {}}, 1),
               WrongUsage);
  EXPECT_THROW(longest_edges(sphere, {.boxes = {}, .balls = {}, .elements_across = 0}, 1), WrongUsage);
}

TEST(SizeLimits, RefuseAPlaceThatHoldsNoSurface) {
  std::vector<FeatureEdge> none;
  const auto refine = [&](SizeLimits limits) {
    SurfaceMesh sphere = analytic::sphere(1, 1);
    refine_within_limits(sphere, none, limits);
  };
  const BoundingBox inside{.low = {-0.1, -0.1, -0.1}, .high = {0.1, 0.1, 0.1}};
  EXPECT_THROW(refine({.boxes = {{inside, 0.1}}, .balls = {}, .elements_across = {}}), WrongUsage);
  EXPECT_THROW(refine({.boxes = {}, .balls = {{{Vec3(9, 0, 0), 1}, 0.1}}, .elements_across = {}}), WrongUsage);
  EXPECT_NO_THROW(refine({.boxes = {}, .balls = {{{Vec3(1, 0, 0), 0.1}, 0.1}}, .elements_across = {}}));
}

TEST(SizeLimits, RefuseMoreTrianglesThanMemoryHolds) {
  const BoundingBox half{.low = {0, -2, -2}, .high = {2, 2, 2}};
  for (const SizeLimits& limits : {SizeLimits{.boxes = {{half, 1e-7}}, .balls = {}, .elements_across = {}},
                                   {.boxes = {}, .balls = {{{Vec3(1, 0, 0), 0.5}, 1e-7}}, .elements_across = {}}}) {
    SurfaceMesh sphere = analytic::sphere(1, 2);
    std::vector<FeatureEdge> none;
    EXPECT_THROW(refine_within_limits(sphere, none, limits), NotMeshable);
  }
}

double mean_edge(const SurfaceMesh& mesh, const auto& counts) {
  double sum = 0, edges = 0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = mesh.vertices[t[k]], &b = mesh.vertices[t[(k + 1) % 3]];
      if (!counts((a + b) / 2)) continue;
      sum += (a - b).norm();
      ++edges;
    }
  return sum / edges;
}

TEST(SizeLimits, AreMetByTheSurface) {
  const auto in_ball = [](const Vec3& p) { return (p - Vec3(10, 10, 10)).norm() < 3; };
  for (const TargetSize& size : {TargetSize(MeanEdgeLength{1.5}), TargetSize(FaceCount{4000})}) {
    SurfaceMesh mesh = analytic::box({20, 20, 10}, 10);
    SimplifyOptions options;
    options.size = size;
    options.limits.balls = {{.ball = {.centre = {10, 10, 10}, .radius = 3}, .length = 0.5}};
    simplify(mesh, options);
    EXPECT_TRUE(check_validity(mesh).closed());
    EXPECT_LE(mean_edge(mesh, in_ball), 0.5);
    EXPECT_GE(mean_edge(mesh, in_ball), 0.35);
    EXPECT_GE(mean_edge(mesh, [](const Vec3& p) { return p.z() < 2; }), 0.8);
  }
}

TEST(SizeLimits, NeedTheLattice) {
  SurfaceMesh mesh = analytic::sphere(1, 3);
  SimplifyOptions options;
  options.method = SimplifyMethod::collapse;
  options.limits.elements_across = 2;
  EXPECT_THROW(simplify(mesh, options), WrongUsage);
}

}  // namespace
}  // namespace scan2fea
