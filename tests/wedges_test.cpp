#include "preproc/surface/mending/wedges.hpp"

#include "preproc/surface/mending/defects.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace scan2fea {
namespace {

// A sphere out of which one edge was pulled to a ridge.
SurfaceMesh ridged_sphere() {
  SurfaceMesh mesh = analytic::sphere(1, 3);
  const Triangle& t = mesh.triangles[100];
  const double edge = (mesh.vertices[t[0]] - mesh.vertices[t[1]]).norm();
  for (const std::uint32_t v : {t[0], t[1]}) mesh.vertices[v] *= 1 + 1.6 * edge;
  return mesh;
}

// A block leaned over by 45 degrees: two of its edges are that sharp, and so are the scan's.
SurfaceMesh leaning_block(double edge_length) {
  SurfaceMesh mesh = analytic::box({4, 4, 4}, edge_length);
  for (Vec3& v : mesh.vertices) v.x() += v.z();
  return mesh;
}

double least_angle_deg(const SurfaceMesh& mesh) {
  double least = 180;
  for (const Triangle& t : mesh.triangles)
    least = std::min(least, smallest_angle_deg(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  return least;
}

double sharpest_deg(const SurfaceMesh& mesh, const ReferenceSurface& scan) {
  double sharpest = 180;
  for (const Wedge& w : find_wedges(mesh, MeshAdjacency(mesh).neighbours, scan, 90))
    sharpest = std::min(sharpest, w.angle_deg);
  return sharpest;
}

TEST(Wedges, AreOpenedWithoutHarm) {
  const SurfaceMesh scan = analytic::sphere(1, 5);
  const ReferenceSurface reference(scan);
  SurfaceMesh mesh = ridged_sphere();
  const double angle_before = least_angle_deg(mesh), sharpest_before = sharpest_deg(mesh, reference);
  WedgeOptions options;
  ASSERT_LT(sharpest_before, options.least_dihedral_deg);
  const WedgeResult result = open_wedges(mesh, reference, options);
  EXPECT_GT(result.before, 0u);
  EXPECT_EQ(result.after, 0u);
  EXPECT_GE(sharpest_deg(mesh, reference), options.least_dihedral_deg);
  EXPECT_GE(least_angle_deg(mesh), std::min(angle_before, options.least_angle_deg));
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  EXPECT_NEAR(enclosed_volume(mesh) / enclosed_volume(scan), 1, 1e-12);
}

TEST(Wedges, OfTheScanItselfAreLeftAlone) {
  const SurfaceMesh scan = leaning_block(0.25);
  SurfaceMesh mesh = leaning_block(0.5);
  const SurfaceMesh before = mesh;
  const WedgeResult result = open_wedges(mesh, ReferenceSurface(scan));
  EXPECT_EQ(result.before, 0u);
  EXPECT_EQ(mesh.vertices, before.vertices);
}

TEST(Wedges, HeldEdgesAreAsSharpAsMeant) {
  const SurfaceMesh scan = analytic::sphere(1, 4);
  SurfaceMesh mesh = ridged_sphere();
  const SurfaceMesh before = mesh;
  WedgeOptions options;
  options.constraints.assign(mesh.vertices.size(), VertexConstraint::fixed);
  const WedgeResult result = open_wedges(mesh, ReferenceSurface(scan), options);
  EXPECT_EQ(result.after, 0u);
  EXPECT_EQ(mesh.vertices, before.vertices);
}

// Whatever its own edges are like, a mesh that is finer than the scan does not take one edge of it for a crease.
TEST(Wedges, AreNotOfTheScanForOneOfItsEdges) {
  const SurfaceMesh scan = ridged_sphere();
  SurfaceMesh mesh = scan;
  std::vector<double> length(mesh.vertices.size(), 0.04);
  std::vector<FeatureEdge> none;
  halve_long_edges(mesh, length, none, 1, 1);
  ASSERT_GT(mesh.triangles.size(), 10 * scan.triangles.size());
  const std::vector<Wedge> wedges = find_wedges(mesh, MeshAdjacency(mesh).neighbours, ReferenceSurface(scan), 64);
  ASSERT_FALSE(wedges.empty());
  for (const Wedge& w : wedges) EXPECT_EQ(w.wanted_deg, 64);
}

// A plate in which one vertex of the upper sheet hangs close over one of the lower.
TEST(ThinPlaces, AreThickenedWhereTheyAreFew) {
  const Vec3 size(6, 6, 0.45);
  const SurfaceMesh scan = analytic::box(size, 0.25);
  SurfaceMesh mesh = analytic::box(size, 0.5);
  const auto above = std::find(mesh.vertices.begin(), mesh.vertices.end(), Vec3(3, 3, 0.45));
  const auto below = std::find(mesh.vertices.begin(), mesh.vertices.end(), Vec3(3, 3, 0));
  ASSERT_TRUE(above != mesh.vertices.end() && below != mesh.vertices.end());
  above->z() = 0.15;
  WedgeOptions options;
  options.least_angle_deg = 0;  // right-angled triangles lose a little
  const WedgeResult result = open_wedges(mesh, ReferenceSurface(scan), options);
  EXPECT_GT(result.before, 0u);
  EXPECT_EQ(result.after, 0u);
  EXPECT_GE((*above - *below).norm(), options.least_wall * 0.5);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  EXPECT_NEAR(enclosed_volume(mesh) / enclosed_volume(scan), 1, 1e-12);
}

TEST(ThinPlaces, OfAThinBodyAreLeftAlone) {
  const SurfaceMesh scan = analytic::box({6, 6, 0.15}, 0.25);
  SurfaceMesh mesh = analytic::box({6, 6, 0.15}, 0.5);
  const SurfaceMesh before = mesh;
  const WedgeResult result = open_wedges(mesh, ReferenceSurface(scan));
  EXPECT_EQ(result.before, 0u);
  EXPECT_EQ(mesh.vertices, before.vertices);
}

}  // namespace
}  // namespace scan2fea
