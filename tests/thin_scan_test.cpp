#include "preproc/surface/lattice/thin_scan.hpp"

#include "quality/triangle_measures.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace scan2fea {
namespace {

TEST(ThinScan, KeepsTopologyAndAboutTheShape) {
  const SurfaceMesh scan = analytic::torus(3, 1, 120, 60);
  SurfaceMesh thinned = scan;
  const std::vector<std::uint32_t> vertex = thin_scan(thinned, scan.vertices.size() / 6);
  EXPECT_EQ(thinned.vertices.size(), scan.vertices.size() / 6);
  const SurfaceValidity validity = check_validity(thinned);
  EXPECT_TRUE(validity.closed());
  EXPECT_TRUE(validity.manifold());
  EXPECT_EQ(validity.genus, 1);
  EXPECT_NEAR(surface_area(thinned), surface_area(scan), 0.02 * surface_area(scan));

  ASSERT_EQ(vertex.size(), scan.vertices.size());
  std::vector<bool> is_used(thinned.vertices.size(), false);
  for (std::size_t v = 0; v < vertex.size(); ++v) {
    ASSERT_LT(vertex[v], thinned.vertices.size());
    is_used[vertex[v]] = true;
    EXPECT_LT((thinned.vertices[vertex[v]] - scan.vertices[v]).norm(), 0.8);
  }
  EXPECT_EQ(std::count(is_used.begin(), is_used.end(), false), 0);
}

TEST(ThinScan, LeavesAScanThatHasFewEnough) {
  const SurfaceMesh scan = analytic::sphere(1, 3);
  SurfaceMesh thinned = scan;
  const std::vector<std::uint32_t> vertex = thin_scan(thinned, scan.vertices.size());
  EXPECT_EQ(thinned.vertices, scan.vertices);
  EXPECT_EQ(thinned.triangles, scan.triangles);
  for (std::uint32_t v = 0; v < vertex.size(); ++v) EXPECT_EQ(vertex[v], v);
}

TEST(ThinScan, EndsWhereTopologyAllowsNoMore) {
  SurfaceMesh tetrahedron = analytic::sphere(1, 2);
  thin_scan(tetrahedron, 1);
  EXPECT_EQ(tetrahedron.vertices.size(), 4U);
  EXPECT_TRUE(check_validity(tetrahedron).manifold());
}

}  // namespace
}  // namespace scan2fea
