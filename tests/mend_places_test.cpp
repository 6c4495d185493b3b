#include "preproc/surface/mending/mend_places.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/mending/constraint_projection.hpp"
#include "quality/deviation_bound.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace scan2fea {
namespace {

const Vec3 tip = Vec3(0.3, 0.5, 0.8).normalized();
constexpr double limit = 0.02;  // six times the sagitta of the mesh's triangles

std::uint32_t nearest_vertex(const SurfaceMesh& mesh, const Vec3& p) {
  const auto nearest = std::min_element(mesh.vertices.begin(), mesh.vertices.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - p).squaredNorm() < (b - p).squaredNorm();
  });
  return static_cast<std::uint32_t>(nearest - mesh.vertices.begin());
}

double least_angle_deg(const SurfaceMesh& mesh) {
  double least = 180;
  for (const Triangle& t : mesh.triangles)
    least = std::min(least, smallest_angle_deg(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  return least;
}

// Interior, degrees.
double sharpest_edge_deg(const SurfaceMesh& mesh) {
  const MeshAdjacency adjacency(mesh);
  double sharpest = 360;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Hinge hinge{f, k, {}, area_vector(mesh, mesh.triangles[adjacency.neighbours[f][k]])};
      sharpest = std::min(sharpest, hinge.angle_deg(mesh));
    }
  return sharpest;
}

void expect_sound(const SurfaceMesh& mesh) {
  const auto validity = check_validity(mesh);
  EXPECT_TRUE(validity.closed());
  EXPECT_TRUE(validity.manifold());
  EXPECT_EQ(validity.genus, 0);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
}

class MendPlaces : public testing::Test {
 protected:
  MendPlacesResult mend(SurfaceMesh& mesh, const ShorterEdges& place, const MendPlacesOptions& options) {
    const TriangleTree tree(scan_);
    return mend_places(mesh, none_, ReferenceSurface(scan_), &tree, {&place, 1}, options);
  }

  const SurfaceMesh scan_ = analytic::sphere(1, 5);
  const SurfaceMesh even_ = analytic::sphere(1, 3);
  FeatureNet none_;
};

TEST_F(MendPlaces, NarrowTrianglesAreMendedAndNothingElseMoves) {
  SurfaceMesh mesh = even_;
  const std::uint32_t v = nearest_vertex(mesh, tip);
  const auto beside = std::find_if(mesh.triangles.begin(), mesh.triangles.end(),
                                   [&](const Triangle& t) { return t[0] == v || t[1] == v || t[2] == v; });
  const std::uint32_t w = (*beside)[0] == v ? (*beside)[1] : (*beside)[0];
  mesh.vertices[v] = (0.15 * mesh.vertices[v] + 0.85 * mesh.vertices[w]).normalized();
  ASSERT_LT(least_angle_deg(mesh), 15);
  const SurfaceMesh before = mesh;
  const MendPlacesResult result = mend(mesh, {{mesh.vertices[v], 0.2}, 0.75}, {.limit = limit});
  EXPECT_EQ(result.mended, 1U);
  EXPECT_EQ(result.left, 0U);
  EXPECT_GE(least_angle_deg(mesh), 30);
  EXPECT_LE(bound_deviation(mesh, scan_, {.limit = limit}).upper(), limit);
  expect_sound(mesh);
  for (std::size_t u = 0; u < before.vertices.size(); ++u)
    if ((before.vertices[u] - tip).norm() > 1) {
      EXPECT_EQ(mesh.vertices[u], before.vertices[u]);
    }
}

// An edge is pulled out to a ridge; half the angle over it would bound that of tetrahedra.
TEST_F(MendPlaces, FoldsAreOpened) {
  SurfaceMesh mesh = even_;
  const Triangle t = mesh.triangles[100];
  const double edge = (mesh.vertices[t[0]] - mesh.vertices[t[1]]).norm();
  for (const std::uint32_t v : {t[0], t[1]}) mesh.vertices[v] *= 1 + 1.6 * edge;
  ASSERT_LT(sharpest_edge_deg(mesh), 55);
  const ShorterEdges place{{(mesh.vertices[t[0]] + mesh.vertices[t[1]]) / 2, 2 * edge}, 0.75};
  const MendPlacesResult result = mend(mesh, place, {.limit = limit});
  EXPECT_EQ(result.left, 0U);
  EXPECT_GE(sharpest_edge_deg(mesh), 60);
  EXPECT_GE(least_angle_deg(mesh), 30);
  expect_sound(mesh);
}

// Two vertices beside each other change places: faces around them turn over and cross.
TEST_F(MendPlaces, TanglesAreLaidOutAnew) {
  SurfaceMesh mesh = even_;
  const Triangle t = mesh.triangles[100];
  const Vec3 there = mesh.vertices[t[0]];
  std::swap(mesh.vertices[t[0]], mesh.vertices[t[1]]);
  const ReferenceSurface scan(scan_);
  const SurfaceDefects defects = find_defects(mesh, scan, scan_vertices_of_faces(mesh, scan), 0);
  ASSERT_FALSE(defects.meshable());
  const MendPlacesResult result = mend_tangles(mesh, none_, scan, defects, {.limit = limit});
  EXPECT_GE(result.mended, 1U);
  EXPECT_EQ(result.left, 0U);
  EXPECT_GE(least_angle_deg(mesh), 25);
  expect_sound(mesh);
  for (std::size_t v = 0; v < even_.vertices.size(); ++v)
    if ((even_.vertices[v] - there).norm() > 1) {
      EXPECT_EQ(mesh.vertices[v], even_.vertices[v]);
    }
}

TEST_F(MendPlaces, LeavesWhatLacksNothing) {
  SurfaceMesh mesh = even_;
  const MendPlacesResult result = mend(mesh, {{tip, 0.25}, 0.5}, {.limit = limit});
  EXPECT_EQ(result.mended, 0U);
  EXPECT_EQ(result.left, 0U);
  EXPECT_EQ(mesh.vertices, even_.vertices);
  EXPECT_EQ(mesh.triangles, even_.triangles);
}

TEST_F(MendPlaces, RefusesOptionsOutOfRange) {
  SurfaceMesh mesh = even_;
  EXPECT_THROW(mend(mesh, {{tip, 0.25}, 0.5}, {.limit = 0}), WrongUsage);
  EXPECT_THROW(mend(mesh, {{tip, 0.25}, 0.5}, {.limit = 1, .least_angle_deg = 60}), WrongUsage);
}

}  // namespace
}  // namespace scan2fea
