#include "preproc/surface/mending/local_refinement.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace scan2fea {
namespace {

const Vec3 tip = Vec3(0.3, 0.5, 0.8).normalized();

// A sphere with a slim horn, which triangles of the size of the whole are too large for.
SurfaceMesh horned_sphere(int levels) {
  SurfaceMesh mesh = analytic::sphere(1, levels);
  for (Vec3& p : mesh.vertices) {
    const double from_tip = (p - tip).norm() / 0.12;
    p *= 1 + 0.15 * std::exp(-from_tip * from_tip);
  }
  return mesh;
}

constexpr double limit = 0.02;  // six times the sagitta of the coarse sphere's triangles

TEST(LocalRefinement, ReachesTheLimitForEveryPointAndChangesOnlyWhatIsAround) {
  const SurfaceMesh scan = horned_sphere(6);
  // So near that moving vertices alone does not do.
  constexpr double near = limit / 2;
  const SurfaceMesh before = analytic::sphere(1, 3);
  ASSERT_GT(bound_deviation(before, scan, {.limit = near}).upper(), 0.1);
  SurfaceMesh mesh = before;
  const BoundedRefinementResult result = refine_within(mesh, ReferenceSurface(scan), {.limit = near});
  EXPECT_LE(result.largest_deviation, near);
  EXPECT_LE(bound_deviation(mesh, scan, {.limit = near}).upper(), near);
  EXPECT_GT(result.changes.inserted, 0U);
  EXPECT_EQ(mesh.vertices.size(), before.vertices.size() + result.changes.inserted);
  EXPECT_EQ(mesh.triangles.size(), before.triangles.size() + 2 * result.changes.inserted);

  const auto validity = check_validity(mesh);
  EXPECT_TRUE(validity.closed());
  EXPECT_TRUE(validity.manifold());
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  for (std::size_t v = 0; v < before.vertices.size(); ++v)
    if ((before.vertices[v] - tip).norm() > 1) {
      EXPECT_EQ(mesh.vertices[v], before.vertices[v]);
    }
}

TEST(LocalRefinement, LeavesASurfaceWithinTheLimitAlone) {
  const SurfaceMesh scan = analytic::sphere(1, 5);
  const SurfaceMesh before = analytic::sphere(1, 3);
  SurfaceMesh mesh = before;
  const ReferenceSurface reference(scan);
  EXPECT_EQ(refine_within(mesh, reference, {.limit = limit}).changes.patches, 0U);
  EXPECT_EQ(refine_worst(mesh, reference, std::vector<double>(mesh.triangles.size(), 0), {.limit = limit}).patches, 0U);
  EXPECT_EQ(mesh.vertices, before.vertices);
  EXPECT_EQ(mesh.triangles, before.triangles);
}

TEST(LocalRefinement, InsertsNoMoreThanAllowed) {
  const SurfaceMesh scan = horned_sphere(6);
  const ReferenceSurface reference(scan);
  for (const std::size_t most : {std::size_t{0}, std::size_t{2}}) {
    SurfaceMesh mesh = analytic::sphere(1, 3);
    const double before = bound_deviation(mesh, scan, {}).upper();
    const BoundedRefinementResult result = refine_within(mesh, reference, {.limit = limit, .most_vertices = most});
    EXPECT_LE(result.changes.inserted, most);
    EXPECT_LT(result.largest_deviation, before);
    EXPECT_TRUE(find_self_intersections(mesh).empty());
  }
}

// The scan's vertices alone show the horn: the fit's samples, here none, may have missed it.
TEST(LocalRefinement, LowersTheWorstWithoutABound) {
  const SurfaceMesh scan = horned_sphere(6);
  SurfaceMesh mesh = analytic::sphere(1, 3);
  const double before = bound_deviation(mesh, scan, {}).upper();
  const std::vector<double> unknown(mesh.triangles.size(), 0);
  const LocalRefinementResult result =
      refine_worst(mesh, ReferenceSurface(scan), unknown, {.limit = limit, .most_places = 1});
  EXPECT_GT(result.patches, 0U);
  EXPECT_LT(bound_deviation(mesh, scan, {}).upper(), 0.7 * before);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
}

TEST(LocalRefinement, GivesTheSameBytesForAnyNumberOfThreads) {
  const SurfaceMesh scan = horned_sphere(5);
  const ReferenceSurface reference(scan);
  SurfaceMesh one = analytic::sphere(1, 3), several = one;
  {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 1);
    refine_within(one, reference, {.limit = limit});
  }
  {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 4);
    refine_within(several, reference, {.limit = limit});
  }
  EXPECT_EQ(one.vertices, several.vertices);
  EXPECT_EQ(one.triangles, several.triangles);
}

TEST(LocalRefinement, EdgesOnLinesAreSplitHalfWayAlongThem) {
  const FeatureLine corner{.points = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}}, .vertices = {}};
  EXPECT_TRUE(corner.point_at(middle_place(corner, 0, 2)).isApprox(Vec3(2, 0, 0)));
  EXPECT_TRUE(corner.point_at(middle_place(corner, 1.0 / 3, 1.5)).isApprox(Vec3(2.25, 0, 0)));
  // The last side of a square, and half of the first.
  const FeatureLine square{
      .points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, .vertices = {}, .closed = true};
  EXPECT_TRUE(square.point_at(middle_place(square, 3, 0.5)).isApprox(Vec3(0, 0.25, 0)));
}

TEST(LocalRefinement, RefusesOptionsOutOfRange) {
  const SurfaceMesh scan = analytic::sphere(1, 3);
  const ReferenceSurface reference(scan);
  SurfaceMesh mesh = scan;
  EXPECT_THROW(refine_within(mesh, reference, {.limit = 0}), WrongUsage);
  EXPECT_THROW(refine_within(mesh, reference, {.limit = 1, .least_angle_deg = 60}), WrongUsage);
  EXPECT_THROW(refine_within(mesh, reference, {.limit = 1, .rounds = 0}), WrongUsage);
}

}  // namespace
}  // namespace scan2fea
