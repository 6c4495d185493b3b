#include "preproc/surface/lattice/lattice.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace scan2fea {
namespace {

LatticeOptions triangles(double count, Sizing sizing = Sizing::curvature) {
  LatticeOptions options;
  options.sizing.triangles = count;
  options.sizing.sizing = sizing;
  return options;
}

// Closed, manifold, with the components and genera of the scan and the wanted number of triangles.
void expect_same_topology(const SurfaceMesh& scan, const LatticeResult& result) {
  const HalfedgeMesh connectivity(result.mesh);  // throws where it is not a manifold
  for (HalfedgeMesh::Index h = 0; h < 3 * connectivity.face_slots(); ++h) ASSERT_FALSE(connectivity.is_border(h));
  auto euler = [](const SurfaceMesh& mesh) {
    std::vector<long> values = euler_characteristics(mesh, find_components(mesh));
    std::sort(values.begin(), values.end());
    return values;
  };
  EXPECT_EQ(euler(result.mesh), euler(scan));
}

void expect_count(const LatticeResult& result, double wanted) {
  EXPECT_EQ(result.failure, "");
  EXPECT_NEAR(static_cast<double>(result.mesh.triangles.size()) / wanted, 1, 0.005);
}

TEST(Lattice, SphereIsClosedAndHasTheWantedTriangles) {
  const SurfaceMesh scan = analytic::sphere(1, 5);
  for (const double count : {300.0, 2000.0, 8000.0}) {
    const LatticeResult result = remesh_by_lattice(scan, triangles(count));
    expect_same_topology(scan, result);
    expect_count(result, count);
  }
}

TEST(Lattice, TorusIsMostlyRegular) {
  const SurfaceMesh scan = analytic::torus(3, 1, 240, 90);
  const LatticeResult result = remesh_by_lattice(scan, triangles(6000));
  expect_same_topology(scan, result);
  expect_count(result, 6000);
  // Isotropic remeshing by local steps ends at 70 to 80 %.
  EXPECT_GT(result.regular_share, 0.93);
}

TEST(Lattice, GenusFiveIsKept) {
  const SurfaceMesh scan = analytic::slab_with_holes(5, 0.1);
  const LatticeResult result = remesh_by_lattice(scan, triangles(6000));
  expect_same_topology(scan, result);
  expect_count(result, 6000);
}

TEST(Lattice, NestedSpheresStayTwo) {
  const SurfaceMesh scan = analytic::join(analytic::sphere(1, 5), analytic::reversed(analytic::sphere(0.6, 4)));
  const LatticeResult result = remesh_by_lattice(scan, triangles(3000));
  expect_same_topology(scan, result);
  expect_count(result, 3000);
  // The cavity's orientation is kept.
  EXPECT_LT(enclosed_volume(result.mesh), enclosed_volume(analytic::sphere(1, 5)));
}

TEST(Lattice, SmallComponentsSurvive) {
  SurfaceMesh small = analytic::sphere(0.02, 3);
  for (Vec3& v : small.vertices) v += Vec3(2, 0, 0);
  const SurfaceMesh scan = analytic::join(analytic::sphere(1, 5), small);
  expect_same_topology(scan, remesh_by_lattice(scan, triangles(2000)));
}

TEST(Lattice, MayHaveMoreTrianglesThanTheScan) {
  const SurfaceMesh scan = analytic::box({1, 1, 1}, 1);  // 12 triangles
  const LatticeResult result = remesh_by_lattice(scan, triangles(3000, Sizing::uniform));
  expect_same_topology(scan, result);
  expect_count(result, 3000);
}

TEST(Lattice, DoesNotDependOnUnitsOrPlace) {
  const SurfaceMesh scan = analytic::torus(3, 1, 120, 60);
  SurfaceMesh other = scan;
  for (Vec3& v : other.vertices) v *= 1.0 / 1024;  // a power of two: the same digits
  const LatticeResult a = remesh_by_lattice(scan, triangles(3000)), b = remesh_by_lattice(other, triangles(3000));
  EXPECT_EQ(a.mesh.triangles.size(), b.mesh.triangles.size());
}

TEST(Lattice, EveryScanVertexIsNearItsVertexOfTheResult) {
  const SurfaceMesh scan = analytic::torus(3, 1, 120, 60);
  const LatticeResult result = remesh_by_lattice(scan, triangles(3000));
  ASSERT_EQ(result.vertex_of_scan_vertex.size(), scan.vertices.size());
  for (std::size_t v = 0; v < scan.vertices.size(); ++v) {
    const std::uint32_t w = result.vertex_of_scan_vertex[v];
    EXPECT_LT((scan.vertices[v] - result.mesh.vertices[w]).norm(), 2 * result.edge_length[w]);
  }
}

TEST(Lattice, SameForAnyNumberOfThreads) {
  const SurfaceMesh scan = analytic::noisy(analytic::torus(3, 1, 240, 90), 0.003, 1);
  std::vector<LatticeResult> results;
  for (const std::size_t threads : {1U, 2U, 4U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(remesh_by_lattice(scan, triangles(5000)));
  }
  for (const LatticeResult& r : results) {
    EXPECT_EQ(r.mesh.vertices, results[0].mesh.vertices);
    EXPECT_EQ(r.mesh.triangles, results[0].mesh.triangles);
  }
}

TEST(Lattice, HandlesThinnerThanItsTrianglesAreKept) {
  // Genus 5 in 60 triangles; a ring so thin that one cell goes round its tube.
  for (const auto& [scan, count] :
       {std::pair{analytic::slab_with_holes(5, 0.25), 60.0}, std::pair{analytic::torus(3, 0.05, 400, 8), 200.0}}) {
    const LatticeResult result = remesh_by_lattice(scan, triangles(count));
    expect_same_topology(scan, result);
    EXPECT_TRUE(result.contracted);
    EXPECT_NE(result.failure, "");  // more triangles than that are needed
  }
}

TEST(Lattice, CanBeCancelled) {
  const SurfaceMesh scan = analytic::sphere(1, 4);
  const Progress stop([](std::string_view, double fraction) { return fraction < 0.4; });
  EXPECT_THROW(remesh_by_lattice(scan, triangles(500), stop), Cancelled);
}

}  // namespace
}  // namespace scan2fea
