#include "preproc/surface/lattice/clean_connectivity.hpp"

#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "quality/triangle_measures.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scan2fea {
namespace {

long irregularity(const SurfaceMesh& mesh) {
  std::vector<long> valence(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ++valence[v];
  long sum = 0;
  for (const long v : valence) sum += std::abs(v - 6);
  return sum;
}

std::vector<double> uniform_length(const SurfaceMesh& mesh) {
  return std::vector<double>(mesh.vertices.size(),
                             equilateral_edge(surface_area(mesh), static_cast<double>(mesh.triangles.size())));
}

TEST(CleanConnectivity, MendsWhatFlipsHaveBroken) {
  SurfaceMesh torus = analytic::torus(3, 1, 120, 45);
  HalfedgeMesh broken(torus);
  std::vector<bool> touched(torus.vertices.size(), false);
  for (HalfedgeMesh::Index h = 0; h < 3 * broken.face_slots(); h += 3) {
    const Triangle t = broken.triangle(h / 3), u = broken.triangle(broken.opposite(h) / 3);
    bool clear = broken.can_flip(h);
    for (const Triangle& f : {t, u})
      for (const std::uint32_t v : f) clear = clear && !touched[v];
    if (!clear) continue;
    for (const Triangle& f : {t, u})
      for (const std::uint32_t v : f) touched[v] = true;
    broken.flip(h);
  }
  SurfaceMesh mesh = broken.to_surface();
  ASSERT_GT(irregularity(mesh), 1000);
  std::vector<double> length = uniform_length(mesh);
  const ConnectivityResult result = improve_connectivity(mesh, length);
  EXPECT_GT(result.flips, 0U);
  EXPECT_EQ(irregularity(mesh), 0);
  EXPECT_EQ(length.size(), mesh.vertices.size());
}

TEST(CleanConnectivity, MeetsTheNumberOfTriangles) {
  for (const std::size_t wanted : {9000U, 10700U, 10900U, 12000U}) {
    SurfaceMesh mesh = analytic::torus(3, 1, 120, 45);  // 10,800 triangles
    std::vector<double> length = uniform_length(mesh);
    improve_connectivity(mesh, length, {.triangles = wanted});
    EXPECT_LE(mesh.triangles.size(), wanted);
    EXPECT_GE(mesh.triangles.size() + 1, wanted);
    EXPECT_EQ(euler_characteristics(mesh, find_components(mesh)), std::vector<long>{0});
    HalfedgeMesh still_manifold(mesh);
  }
}

TEST(CleanConnectivity, FollowsTheVertices) {
  SurfaceMesh mesh = analytic::torus(3, 1, 120, 45);
  const SurfaceMesh before = mesh;
  std::vector<double> length = uniform_length(mesh);
  const double edge = length[0];
  const ConnectivityResult result = improve_connectivity(mesh, length, {.triangles = 10000});
  EXPECT_GT(result.collapses, 0U);
  ASSERT_EQ(result.vertex_of_old.size(), before.vertices.size());
  for (std::size_t v = 0; v < before.vertices.size(); ++v)
    EXPECT_LT((before.vertices[v] - mesh.vertices[result.vertex_of_old[v]]).norm(), 2 * edge);
}

TEST(CleanConnectivity, LeavesATetrahedronAlone) {
  SurfaceMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  std::vector<double> length(4, 1.0);
  improve_connectivity(mesh, length, {.triangles = 2});
  EXPECT_EQ(mesh.triangles.size(), 4U);
}

}  // namespace
}  // namespace scan2fea
