#include "preproc/surface/sizing/sizing_field.hpp"

#include "preproc/mesh/error.hpp"
#include "tests/analytic_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace scan2fea {
namespace {

double largest_gradient(const SurfaceMesh& mesh, const SizingField& field) {
  double largest = 0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      largest = std::max(largest, std::abs(field.edge_length[a] - field.edge_length[b]) /
                                      (mesh.vertices[a] - mesh.vertices[b]).norm());
    }
  return largest;
}

TEST(SizingField, AsksForTheWantedNumberOfTriangles) {
  for (const Sizing sizing : {Sizing::uniform, Sizing::curvature})
    for (const double triangles : {500.0, 5000.0, 100000.0}) {
      const SurfaceMesh torus = analytic::torus(3, 1, 120, 60);
      const SizingField field = compute_sizing_field(torus, {.triangles = triangles, .sizing = sizing, .factors = {}});
      EXPECT_NEAR(predicted_triangles(torus, field) / triangles, 1, 1e-6);
    }
}

TEST(SizingField, UniformIsUniform) {
  const SurfaceMesh torus = analytic::torus(3, 1, 120, 60);
  const SizingField field = compute_sizing_field(torus, {.sizing = Sizing::uniform, .factors = {}});
  const auto [low, high] = std::minmax_element(field.edge_length.begin(), field.edge_length.end());
  EXPECT_NEAR(*low, *high, 1e-12 * *high);
}

TEST(SizingField, IsShorterWhereTheSurfaceBendsMore) {
  // A torus bends most at the inner side of the tube.
  const SurfaceMesh torus = analytic::torus(1.5, 1, 120, 60);
  const SizingField field = compute_sizing_field(torus, {.triangles = 4000, .factors = {}});
  std::size_t inner = 0, outer = 0;
  for (std::size_t v = 0; v < torus.vertices.size(); ++v) {
    const auto radius = [&](std::size_t w) { return std::hypot(torus.vertices[w][0], torus.vertices[w][1]); };
    if (radius(v) < radius(inner)) inner = v;
    if (radius(v) > radius(outer)) outer = v;
  }
  EXPECT_LT(field.edge_length[inner], field.edge_length[outer]);
}

TEST(SizingField, GradationHolds) {
  // A box's edges have all the curvature, its sides none.
  const SurfaceMesh box = analytic::box({1, 1, 1}, 0.04);
  for (const double gradation : {0.05, 0.12, 0.3}) {
    const SizingField field = compute_sizing_field(box, {.triangles = 4000, .gradation = gradation, .factors = {}});
    EXPECT_LE(largest_gradient(box, field), 1.1 * gradation);
  }
}

TEST(SizingField, ScalesWithTheModel) {
  SurfaceMesh torus = analytic::torus(3, 1, 60, 30);
  const SizingField field = compute_sizing_field(torus, {.triangles = 2000, .factors = {}});
  for (Vec3& v : torus.vertices) v *= 1e-6;
  const SizingField tiny = compute_sizing_field(torus, {.triangles = 2000, .factors = {}});
  for (std::size_t v = 0; v < torus.vertices.size(); ++v)
    EXPECT_NEAR(tiny.edge_length[v] * 1e6, field.edge_length[v], 1e-6 * field.edge_length[v]);
}

TEST(SizingField, FactorsShortenEdgesWhereTheyAreGiven) {
  const SurfaceMesh sphere = analytic::sphere(1, 4);
  std::vector<double> factors(sphere.vertices.size(), 1.0);
  for (std::size_t v = 0; v < factors.size(); ++v)
    if (sphere.vertices[v][2] > 0.9) factors[v] = 0.5;
  const SizingField field = compute_sizing_field(sphere, {.triangles = 3000, .factors = factors});
  EXPECT_NEAR(predicted_triangles(sphere, field), 3000, 1);
  double top = 0, bottom = 0;
  for (std::size_t v = 0; v < factors.size(); ++v) {
    if (sphere.vertices[v][2] > 0.99) top = field.edge_length[v];
    if (sphere.vertices[v][2] < -0.99) bottom = field.edge_length[v];
  }
  EXPECT_LT(top, 0.8 * bottom);
}

TEST(SizingField, SmallComponentsGetTheirTriangles) {
  const SurfaceMesh both = analytic::join(analytic::sphere(100, 4), analytic::sphere(0.1, 3));
  const std::size_t first_of_small = analytic::sphere(100, 4).vertices.size();
  const SizingField field = compute_sizing_field(both, {.triangles = 5000, .factors = {}});
  for (std::size_t v = first_of_small; v < both.vertices.size(); ++v) EXPECT_LT(field.edge_length[v], 0.1);
}

TEST(SizingField, RefusesOptionsOutOfRange) {
  const SurfaceMesh sphere = analytic::sphere(1, 2);
  EXPECT_THROW(compute_sizing_field(sphere, {.triangles = 0, .factors = {}}), WrongUsage);
  EXPECT_THROW(compute_sizing_field(sphere, {.gradation = 0, .factors = {}}), WrongUsage);
  const std::vector<double> too_few(3, 1.0);
  EXPECT_THROW(compute_sizing_field(sphere, {.factors = too_few}), WrongUsage);
}

}  // namespace
}  // namespace scan2fea
