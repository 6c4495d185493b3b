#include "preproc/surface/relax.hpp"

#include "analytic_meshes.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/surface/error_sizing.hpp"
#include "preproc/surface/star_objective.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace scan2fea {
namespace {

double mean_edge_ratio(const SurfaceMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    sum += edge_ratio(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  }
  return sum / static_cast<double>(mesh.triangles.size());
}

// Mean area of the triangles whose centroid satisfies the predicate.
template <class Where>
double mean_area(const SurfaceMesh& mesh, Where where) {
  double sum = 0;
  std::size_t count = 0;
  for (const Triangle& t : mesh.triangles) {
    if (!where(Vec3((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3))) continue;
    sum += area_vector(mesh, t).norm() / 2;
    ++count;
  }
  return sum / static_cast<double>(count);
}

// A torus of long thin triangles on the same torus, finer.
class Torus : public testing::Test {
 protected:
  SurfaceMesh fine = analytic::torus(1, 0.4, 160, 64);
  ReferenceSurface scan{fine};
  SurfaceMesh mesh = analytic::torus(1, 0.4, 32, 24);
  std::vector<double> uniform = std::vector<double>(fine.vertices.size(), 0.12);
};

TEST_F(Torus, BecomesNearlyEquilateralAndStaysATorusOnTheScan) {
  const double before = mean_edge_ratio(mesh);
  const std::size_t triangles = mesh.triangles.size();
  relax(mesh, scan, uniform);
  EXPECT_LT(mean_edge_ratio(mesh), 1.25);
  EXPECT_LT(mean_edge_ratio(mesh), 0.75 * before);
  EXPECT_EQ(mesh.triangles.size(), triangles);
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_TRUE(validity.closed() && validity.manifold());
  EXPECT_EQ(validity.genus, 1);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  for (const Vec3& p : mesh.vertices) {
    const double around = std::hypot(p.x(), p.y()) - 1;
    EXPECT_NEAR(std::hypot(around, p.z()), 0.4, 0.002);
  }
}

TEST_F(Torus, TrianglesAreSmallWhereTheSizingIs) {
  std::vector<double> graded(fine.vertices.size());
  for (std::size_t v = 0; v < graded.size(); ++v) graded[v] = 0.12 + 0.02 * fine.vertices[v].x();
  RelaxOptions options;
  options.passes = 1;
  options.sweeps = 200;
  relax(mesh, scan, graded, options);
  const double ratio = mean_area(mesh, [](const Vec3& p) { return p.x() > 0.9; }) /
                       mean_area(mesh, [](const Vec3& p) { return p.x() < -0.9; });
  const double wanted = std::pow((0.12 + 0.02 * 1.15) / (0.12 - 0.02 * 1.15), 2);
  // Lloyd's method spreads the vertices by diffusion: more than half of the way there, and not beyond.
  EXPECT_GT(ratio, std::sqrt(wanted));
  EXPECT_LT(ratio, 1.1 * wanted);
}

TEST_F(Torus, ComesOutTheSameForAnyNumberOfThreads) {
  SurfaceMesh one = mesh;
  SurfaceMesh several = mesh;
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    relax(one, scan, uniform);
  }
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 4);
    relax(several, scan, uniform);
  }
  EXPECT_EQ(one.vertices, several.vertices);
  EXPECT_EQ(one.triangles, several.triangles);
}

TEST_F(Torus, RefusesASizingOfAnotherScan) {
  uniform.pop_back();
  EXPECT_THROW(relax(mesh, scan, uniform), WrongUsage);
}

// A sphere meshed finely above the equator and coarsely below: the error is below.
TEST(ErrorFactors, AskForShorterEdgesWhereTheMeshIsFarFromTheScan) {
  const SurfaceMesh fine = analytic::sphere(1, 5);
  const ReferenceSurface scan(fine);
  SurfaceMesh mesh = analytic::sphere(1, 3);
  for (Vec3& p : mesh.vertices) {
    if (p.z() < -0.5) p *= 0.97;
  }
  const std::vector<double> factors = error_factors(mesh, scan, 0.5);
  for (std::size_t v = 0; v < factors.size(); ++v) {
    const double z = fine.vertices[v].z();
    if (z < -0.8) {
      EXPECT_LT(factors[v], 1);
    } else if (z > 0.5) {
      EXPECT_GT(factors[v], 1);
    }
  }
}

TEST(ErrorFactors, RenewalKeepsTheNumberOfTriangles) {
  const SurfaceMesh fine = analytic::sphere(1, 4);
  const ReferenceSurface scan(fine);
  SurfaceMesh mesh = analytic::noisy(analytic::sphere(1, 2), 0.03, 1);
  std::vector<double> edge_length(fine.vertices.size(), 0.3);
  renew_from_error(edge_length, mesh, scan, 0.3);
  double demand = 0;
  for (const Triangle& t : fine.triangles) {
    const double h = (edge_length[t[0]] + edge_length[t[1]] + edge_length[t[2]]) / 3;
    demand += area_vector(fine, t).norm() / (h * h);
  }
  EXPECT_NEAR(demand, 2 * scan.area / (0.3 * 0.3), 1e-9 * demand);
  EXPECT_NE(edge_length.front(), edge_length.back());
}

}  // namespace
}  // namespace scan2fea
