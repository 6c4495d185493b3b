// What simplification must keep, whatever the shape: topology, volume, soundness, the number of triangles asked for.
#include "preproc/surface/simplification/simplify.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace scan2fea {
namespace {

// Signed volumes of the components, ascending: cavities first.
std::vector<double> component_volumes(const SurfaceMesh& mesh) {
  const Components components = find_components(mesh);
  std::vector<double> volumes(components.count, 0);
  for (const Triangle& t : mesh.triangles)
    volumes[components.of_vertex[t[0]]] += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6;
  std::sort(volumes.begin(), volumes.end());
  return volumes;
}

SimplifyResult simplify_to(SurfaceMesh& mesh, const TargetSize& size) {
  SimplifyOptions options;
  options.size = size;
  return simplify(mesh, options);
}

struct Shape {
  std::string name;
  SurfaceMesh mesh;
  std::size_t faces;  // wanted
};

std::ostream& operator<<(std::ostream& out, const Shape& shape) {
  return out << shape.name;
}

std::vector<Shape> shapes() {
  using namespace analytic;
  SurfaceMesh spheres;
  for (int i = 0; i < 27; ++i) spheres = join(spheres, moved(sphere(1, 2), 3.0 * Vec3(i % 3, i / 3 % 3, i / 9)));
  return {
      {"Torus", torus(3, 1, 96, 48), 1200},
      {"ThinTorus", torus(10, 0.3, 300, 12), 2000},
      {"Cavity", join(sphere(2, 4), reversed(sphere(1, 3))), 1500},
      {"GenusFive", slab_with_holes(5, 0.125), 1500},
      {"GenusFiveCoarse", slab_with_holes(5, 0.25), 300},
      {"Plate", box({100, 100, 2}, 2), 2000},
      {"PlateWithTrianglesWiderThanThick", box({100, 100, 2}, 2), 300},
      {"Rod", box({100, 0.5, 0.5}, 0.25), 1000},
      {"Cube", box({1, 1, 1}, 1), 400},
      {"CubeOfTwelveTriangles", box({1, 1, 1}, 1), 12},
      {"ManyComponents", spheres, 27 * 80},
  };
}

class SimplifyShape : public testing::TestWithParam<Shape> {};

TEST_P(SimplifyShape, KeepsTopologyVolumeAndSoundness) {
  const SurfaceMesh scan = GetParam().mesh;
  ASSERT_TRUE(find_self_intersections(scan).empty());
  SurfaceMesh mesh = scan;
  const SimplifyResult result = simplify_to(mesh, FaceCount{GetParam().faces});
  SCOPED_TRACE(result.fallback_reason);
  const SurfaceValidity before = check_validity(scan), after = check_validity(mesh);
  EXPECT_TRUE(after.closed());
  EXPECT_TRUE(after.manifold());
  EXPECT_TRUE(after.oriented());
  EXPECT_EQ(after.components, before.components);
  EXPECT_EQ(after.genus, before.genus);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  const double faces = static_cast<double>(GetParam().faces);
  // Creases may need more, and then the result says so.
  if (result.size_remark.empty())
    EXPECT_NEAR(static_cast<double>(mesh.triangles.size()), faces, std::max(2.0, 0.005 * faces));
  else
    EXPECT_GT(static_cast<double>(mesh.triangles.size()), faces);
  EXPECT_EQ(result.faces_after, mesh.triangles.size());

  const std::vector<double> wanted = component_volumes(scan), got = component_volumes(mesh);
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t c = 0; c < got.size(); ++c) EXPECT_NEAR(got[c], wanted[c], 1e-9 * std::abs(wanted[c]));
}

INSTANTIATE_TEST_SUITE_P(Shapes, SimplifyShape, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return shape.param.name; });

// Where the shape has more to it than the triangles asked for can hold, more are made.
TEST(Simplify, AsksForNoLessThanTheTopologyNeeds) {
  const SurfaceMesh scan = analytic::slab_with_holes(5, 0.25);
  SurfaceMesh mesh = scan;
  const SimplifyResult result = simplify_to(mesh, FaceCount{20});
  EXPECT_GT(mesh.triangles.size(), 20U);
  EXPECT_FALSE(result.size_remark.empty());
  EXPECT_EQ(result.fallback_reason, "");
  EXPECT_LT(measure_triangles(mesh).edge_ratio.mean, 1.3);
  EXPECT_TRUE(check_validity(mesh).closed());
  EXPECT_EQ(check_validity(mesh).genus, 5);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
}

TEST(Simplify, MayAskForMoreTrianglesThanTheScanHas) {
  SurfaceMesh mesh = analytic::sphere(1, 2);
  simplify_to(mesh, FaceRatio{5});
  EXPECT_NEAR(static_cast<double>(mesh.triangles.size()), 1600, 8);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
}

TEST(Simplify, RefusesSizesThatMeanNothing) {
  SurfaceMesh mesh = analytic::sphere(1, 2);
  for (const TargetSize& size :
       {TargetSize(FaceRatio{0}), TargetSize(MeanEdgeLength{-1}), TargetSize(LargestDeviation{0})})
    EXPECT_THROW(simplify_to(mesh, size), WrongUsage);
  EXPECT_EQ(mesh.triangles.size(), 320U);
}

TEST(Simplify, DeviationBoundsAllPoints) {
  const SurfaceMesh scan = analytic::torus(10, 3, 100, 50);
  constexpr double distance = 0.08;  // the scan's own facets are within 0.02 of the torus
  SurfaceMesh mesh = scan;
  SimplifyOptions options;
  options.size = LargestDeviation{.distance = distance};
  const SimplifyResult result = simplify(mesh, options);
  EXPECT_LE(bound_deviation(mesh, scan, {.limit = distance}).upper(), distance);
  EXPECT_LE(result.largest_deviation, distance);
  EXPECT_LT(mesh.triangles.size(), scan.triangles.size() / 2);
}

TEST(Simplify, ADeviationKeepsTheCreasesOfAPart) {
  const SurfaceMesh scan = analytic::cylinder(1, 0.5, 96, 8);
  constexpr double distance = 0.01;
  SurfaceMesh mesh = scan;
  SimplifyOptions options;
  options.size = LargestDeviation{.distance = distance};
  const SimplifyResult result = simplify(mesh, options);
  EXPECT_LE(bound_deviation(mesh, scan, {.limit = distance}).upper(), distance);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  EXPECT_EQ(result.feature_remark, "");
  // Both rims are closed chains of sharp edges, as long as the scan's but for their chords.
  const std::vector<Triangle> neighbours = face_neighbours(mesh, VertexStars(mesh));
  double length = 0;
  for (std::uint32_t f = 0; f < neighbours.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& t = mesh.triangles[f];
      const std::uint32_t g = neighbours[f][k];
      if (g < f || area_vector(mesh, t).normalized().dot(area_vector(mesh, mesh.triangles[g]).normalized()) > 0.5)
        continue;
      const Vec3 &a = mesh.vertices[t[(k + 1) % 3]], &b = mesh.vertices[t[(k + 2) % 3]];
      for (const Vec3& end : {a, b}) EXPECT_NEAR(std::hypot(end[0], end[1]), 1, distance);
      length += (b - a).norm();
    }
  EXPECT_NEAR(length, 4 * std::numbers::pi, 0.02 * 4 * std::numbers::pi);
}

TEST(Simplify, DeviationOutOfReachIsAnErrorOnlyWhereRequired) {
  SurfaceMesh mesh = analytic::noisy(analytic::sphere(10, 2), 0.2, 1);
  SimplifyOptions options;
  options.size = LargestDeviation{.distance = 1e-3};
  EXPECT_THROW(simplify(mesh, options), NotMeshable);
}

TEST(Simplify, AimsAtAFifthOfAPerCentOfTheDiagonalByDefault) {
  const SurfaceMesh scan = analytic::torus(10, 3, 100, 50);
  const double distance = 0.002 * bounding_box(scan.vertices).diagonal();
  SurfaceMesh by_default = scan, asked_for = scan;
  simplify(by_default);
  simplify_to(asked_for, LargestDeviation{.distance = distance});
  EXPECT_LE(bound_deviation(by_default, scan, {.limit = distance}).upper(), distance);
  EXPECT_EQ(by_default.vertices, asked_for.vertices);
  EXPECT_EQ(by_default.triangles, asked_for.triangles);
}

// The farthest of 43,200 vertices lie 0.46 % of the diagonal off the torus: to come within 0.2 % of them all would be
// to follow each.
TEST(Simplify, AnAimLeavesNoiseAside) {
  const SurfaceMesh torus = analytic::torus(3, 1, 360, 60);
  const double diagonal = bounding_box(torus.vertices).diagonal(), sigma = 0.001 * diagonal;
  SurfaceMesh of_smooth = torus, of_noisy = analytic::noisy(torus, sigma, 1);
  const SimplifyResult smooth = simplify(of_smooth), noisy = simplify(of_noisy);
  EXPECT_EQ(smooth.noise_in_aim, 0);
  EXPECT_NEAR(noisy.noise_in_aim, sigma, 0.3 * sigma);
  EXPECT_TRUE(noisy.keeps_deviation());
  EXPECT_LT(static_cast<double>(noisy.faces_after), 1.5 * static_cast<double>(smooth.faces_after));
  EXPECT_GT(static_cast<double>(noisy.faces_after), 0.5 * static_cast<double>(smooth.faces_after));
  double squares = 0;
  for (const Vec3& p : of_noisy.vertices) squares += std::pow(std::hypot(p.head<2>().norm() - 3, p.z()) - 1, 2);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(of_noisy.vertices.size())), sigma);
}

TEST(Simplify, SaysWhichCreasesItCouldNotKeep) {
  // Two rims of 96 facets and twelve triangles.
  SurfaceMesh mesh = analytic::cylinder(1, 0.1, 96, 8);
  const SimplifyResult result = simplify_to(mesh, FaceCount{12});
  ASSERT_GT(result.feature_edges, 0u);
  EXPECT_EQ(result.feature_remark.empty(), result.feature_edges_kept > 0) << result.feature_remark;
}

TEST(Simplify, MoreTrianglesThanFitIntoTheMemoryAreRefusedAtOnce) {
  SurfaceMesh part = analytic::box({1, 1, 1}, 1);
  EXPECT_THROW(simplify_to(part, MeanEdgeLength{1e-6}), NotMeshable);
  EXPECT_EQ(part.triangles.size(), 12U);
}

TEST(Simplify, NoDeviationHasNoSize) {
  SurfaceMesh part = analytic::box({1, 1, 1}, 1);
  SimplifyOptions options;
  options.size = LargestDeviation{.distance = 0};
  EXPECT_THROW(simplify(part, options), WrongUsage);
}

TEST(Simplify, ATinyDeviationOfAPartIsMetByItsOwnFacets) {
  // Faces as small as the deviation asks for at first would fill any memory.
  SurfaceMesh part = analytic::box({1, 1, 1}, 0.25);
  const SurfaceMesh scan = part;
  SimplifyOptions options;
  options.size = LargestDeviation{.distance = 1e-6};
  simplify(part, options);
  EXPECT_LE(bound_deviation(part, scan, {.limit = 1e-6}).upper(), 1e-6);
}

TEST(Simplify, MakesMoreTrianglesThanTheScanHas) {
  SurfaceMesh mesh = analytic::sphere(1, 3);
  const std::size_t faces = 5 * mesh.triangles.size();
  const SimplifyResult result = simplify_to(mesh, FaceCount{faces});
  EXPECT_EQ(result.fallback_reason, "");
  EXPECT_NEAR(static_cast<double>(mesh.triangles.size()), static_cast<double>(faces),
              0.01 * static_cast<double>(faces));
  EXPECT_GE(measure_triangles(mesh).min_angle_deg.min, 35);
}

TEST(Simplify, KeepsTheCreasesOfAPartOfFewFacets) {
  // A disc of 24 facets, each many times as large as the triangles.
  SurfaceMesh mesh = analytic::cylinder(1, 0.5, 24, 1);
  const SimplifyResult result = simplify_to(mesh, FaceCount{4000});
  EXPECT_EQ(result.fallback_reason, "");
  EXPECT_EQ(result.feature_remark, "");
  EXPECT_EQ(result.feature_edges, 48U);
  // The rims' corners are there, but for a fifth of an edge (0.074) by which vertices slide along chords.
  for (int i = 0; i < 24; ++i) {
    const double angle = std::numbers::pi * i / 12;
    double nearest = 1;
    for (const Vec3& v : mesh.vertices)
      nearest = std::min(nearest, (v - Vec3(std::cos(angle), std::sin(angle), 0)).norm());
    EXPECT_LT(nearest, 0.015);
  }
}

// How far a box's vertices are from its nearest plane side.
double off_the_sides(const SurfaceMesh& mesh, const Vec3& size) {
  double most = 0;
  for (const Vec3& v : mesh.vertices)
    most = std::max(most, std::min(v.cwiseAbs().minCoeff(), (v - size).cwiseAbs().minCoeff()));
  return most;
}

TEST(Simplify, SidesOfASlenderBarStayPlane) {
  const Vec3 size(100, 2, 2);
  for (const double length : {0.4, 0.5}) {
    SurfaceMesh mesh = analytic::box(size, 200);
    simplify_to(mesh, MeanEdgeLength{length});
    EXPECT_LE(off_the_sides(mesh, size), 1e-9) << length;
  }
}

TEST(Simplify, CreasesTooFineAtFirstAreKeptByTheSmallerTriangles) {
  // Triangles that the deviation would allow are larger than the end faces.
  for (const Vec3& size : {Vec3(100, 2, 2), Vec3(200, 2, 2), Vec3(100, 1, 3)}) {
    SurfaceMesh mesh = analytic::box(size, 300);
    const SimplifyResult result = simplify(mesh);
    EXPECT_EQ(result.feature_edges_too_fine, 0U) << size[0];
    EXPECT_LE(off_the_sides(mesh, size), 1e-3) << size[0];
  }
}

}  // namespace
}  // namespace scan2fea
