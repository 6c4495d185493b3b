#include "preproc/surface/fit/shape_fit.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/find_features.hpp"
#include "preproc/surface/fit/sample_surface.hpp"
#include "preproc/surface/kernel/locate.hpp"
#include "preproc/surface/lattice/lattice.hpp"
#include "quality/triangle_measures.hpp"
#include "tests/analytic_meshes.hpp"

#include <Eigen/Eigenvalues>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace scan2fea {
namespace {

double shape_term(const ShapeEnergy& energy, const Vec3& p, const Vec3& a, const Vec3& b) {
  const double e = eta(p, a, b);
  const double over = std::max(0.0, e - energy.limit);
  return e * std::log(e) + energy.weight * over * over;
}

TEST(ShapeEnergy, IsSmallestForTheEquilateralTriangle) {
  const Derivatives d = shape_energy({}, {0, std::sqrt(3.0) / 2, 0}, {-0.5, 0, 0}, {0.5, 0, 0});
  EXPECT_NEAR(d.value, 0, 1e-15);
  EXPECT_NEAR(d.gradient.norm(), 0, 1e-14);
}

TEST(ShapeEnergy, GradientIsThatOfFiniteDifferences) {
  const Vec3 a(0.1, -0.3, 0.2), b(1.0, 0.2, -0.1), p(0.3, 0.7, 0.4);
  const ShapeEnergy energy;
  const Derivatives d = shape_energy(energy, p, a, b);
  EXPECT_NEAR(d.value, shape_term(energy, p, a, b), 1e-12 * d.value);
  constexpr double step = 1e-6;
  for (int k = 0; k < 3; ++k) {
    const Vec3 dx = step * Vec3::Unit(k);
    const double slope = (shape_term(energy, p + dx, a, b) - shape_term(energy, p - dx, a, b)) / (2 * step);
    EXPECT_NEAR(d.gradient[k], slope, 1e-6 * d.gradient.norm());
  }
}

// A tall triangle: the energy falls with the apex, so the curvature across the plane is positive and nothing is
// dropped.
TEST(ShapeEnergy, HessianIsThatOfFiniteDifferencesWhereTheEnergyIsConvex) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), p(0.4, 1.3, 0);
  const ShapeEnergy energy;
  const Derivatives d = shape_energy(energy, p, a, b);
  constexpr double step = 1e-6;
  for (int k = 0; k < 3; ++k) {
    const Vec3 dx = step * Vec3::Unit(k);
    const Vec3 column =
        (shape_energy(energy, p + dx, a, b).gradient - shape_energy(energy, p - dx, a, b).gradient) / (2 * step);
    EXPECT_NEAR((d.hessian.col(k) - column).norm(), 0, 1e-5 * d.hessian.norm());
  }
}

TEST(ShapeEnergy, HessianNeverHasNegativeCurvature) {
  const Vec3 a(0, 0, 0), b(1, 0, 0);
  for (const Vec3& p : {Vec3(0.5, 0.2, 0.1), Vec3(2, 0.5, -1), Vec3(0.1, 3, 0)}) {
    const Derivatives d = shape_energy({}, p, a, b);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(d.hessian);
    EXPECT_GE(solver.eigenvalues().minCoeff(), -1e-10 * solver.eigenvalues().maxCoeff());
  }
}

// Second-degree polynomials of the position: the constant gives the area, the rest is exact on every triangle.
TEST(SampleSurface, IntegratesQuadraticsExactlyWhateverTheSubdivision) {
  const SurfaceMesh box = analytic::box({2, 1, 1}, 1);
  const ReferenceSurface scan(box);
  for (const double longest_edge : {10.0, 0.5, 0.21}) {
    const SurfaceSamples s = sample_surface(scan, longest_edge, 1000000);
    double area = 0, x_squared = 0;
    for (const Sample& sample : s.samples) {
      area += sample.weight;
      x_squared += sample.weight * sample.point.x() * sample.point.x();
    }
    EXPECT_NEAR(area, 10, 1e-12);
    EXPECT_NEAR(x_squared, 4 * 8. / 3 + 4, 1e-12);  // four sides 2 x 1, the end at x = 2
  }
}

TEST(SampleSurface, ThinnedSamplesKeepTheAreaAndCoverEverySide) {
  const SurfaceMesh box = analytic::box({2, 1, 1}, 0.1);
  const SurfaceSamples s = sample_surface(ReferenceSurface(box), 10, 500);
  double area = 0;
  Vec3 moment = Vec3::Zero();
  for (const Sample& sample : s.samples) {
    area += sample.weight;
    moment += sample.weight * sample.point;
  }
  EXPECT_NEAR(area, 10, 0.05);
  EXPECT_NEAR((moment / area - Vec3(1, 0.5, 0.5)).norm(), 0, 0.02);
}

TEST(Locate, FindsTheNearestPointFromAFarStart) {
  const SurfaceMesh sphere = analytic::sphere(1, 3);
  const ReferenceSurface on(sphere);
  const WalkableMesh walkable{sphere, on.stars, on.neighbours, on.face_normals};
  const Vec3 direction = Vec3(1, 2, 3).normalized();
  for (const std::uint32_t start : {0U, 500U, 1000U}) {
    const Location at = locate(walkable, {1.02 * direction, direction, 1}, start, 0.5);
    EXPECT_LT((point_at(sphere, at) - direction).norm(), 0.02);
  }
}

// A plate of two sheets, much thinner than its triangles: a point above the upper sheet that lies nearer to the lower
// one's vertices must still be given to the side whose normal it has.
TEST(Locate, DoesNotFallThroughAThinWall) {
  const SurfaceMesh plate = analytic::box({10, 10, 0.2}, 1);
  const ReferenceSurface on(plate);
  const WalkableMesh walkable{plate, on.stars, on.neighbours, on.face_normals};
  std::uint32_t lower = 0;
  while (on.face_normals[lower].z() > -0.9) ++lower;
  const Location at = locate(walkable, {{9.7, 9.7, 0.15}, {0, 0, 1}, 1}, lower, 0.05);
  EXPECT_GT(on.face_normals[at.face].z(), 0.9);
}

class NoisySphere : public testing::Test {
 protected:
  static constexpr int levels = 3;
  SurfaceMesh fine = analytic::sphere(1, 5);
  ReferenceSurface scan{fine};
  double edge = equilateral_edge(4 * M_PI, 20 * std::pow(4, levels));
  SurfaceMesh mesh = analytic::noisy(analytic::sphere(1, levels), 0.15 * edge, 1);
};

TEST_F(NoisySphere, BecomesRoundAndEquilateral) {
  const double before = measure_triangles(mesh).edge_ratio.mean;
  const ShapeFitResult result = optimise_shape_and_fit(mesh, scan);
  EXPECT_LT(measure_triangles(mesh).edge_ratio.mean, 0.5 * (1 + before));
  EXPECT_LT(measure_triangles(mesh).edge_ratio.mean, 1.15);
  // A mesh that balances its error has an RMS of at most the sagitta of an edge, h^2 / 8 R.
  const double sagitta = edge * edge / 8;
  EXPECT_LT(result.rms_distance, sagitta);
  double sum = 0;
  for (const Vec3& p : mesh.vertices) sum += std::pow(p.norm() - 1, 2);
  EXPECT_LT(std::sqrt(sum / static_cast<double>(mesh.vertices.size())), sagitta);
  for (const Triangle& t : mesh.triangles) EXPECT_GT(area_vector(mesh, t).dot(mesh.vertices[t[0]]), 0);
}

TEST_F(NoisySphere, BothSidesAndTheTailFitAsWell) {
  ShapeFitOptions options;
  options.both_sides = true;
  options.lift_tail_of_diagonal = 0.001;
  const ShapeFitResult result = optimise_shape_and_fit(mesh, scan, options);
  EXPECT_LT(result.rms_distance, edge * edge / 8);
  EXPECT_LT(measure_triangles(mesh).edge_ratio.mean, 1.15);
}

TEST_F(NoisySphere, AFixedVertexStaysInPlace) {
  ShapeFitOptions options;
  options.constraints.assign(mesh.vertices.size(), VertexConstraint::free);
  options.constraints[7] = VertexConstraint::fixed;
  const Vec3 place = mesh.vertices[7];
  optimise_shape_and_fit(mesh, scan, options);
  EXPECT_EQ(mesh.vertices[7], place);
}

TEST_F(NoisySphere, ComesOutTheSameForAnyNumberOfThreads) {
  SurfaceMesh one = mesh;
  SurfaceMesh several = mesh;
  ShapeFitOptions options;
  options.both_sides = true;
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    optimise_shape_and_fit(one, scan, options);
  }
  {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 4);
    optimise_shape_and_fit(several, scan, options);
  }
  EXPECT_EQ(one.vertices, several.vertices);
}

// Fewer scan triangles than mesh triangles: long scan triangles must be sampled densely enough to hold every face.
TEST_F(NoisySphere, FitsAScanCoarserThanItself) {
  const SurfaceMesh coarse = analytic::sphere(1, 2);
  const ShapeFitResult result = optimise_shape_and_fit(mesh, ReferenceSurface(coarse));
  EXPECT_LT(result.rms_distance, 0.02);
  EXPECT_LT(measure_triangles(mesh).edge_ratio.mean, 1.2);
}

TEST_F(NoisySphere, RefusesOptionsOutOfRange) {
  ShapeFitOptions options;
  options.fidelity_of_diagonal = 0;
  EXPECT_THROW(optimise_shape_and_fit(mesh, scan, options), WrongUsage);
}

TEST(ShapeFit, VerticesSlideAlongLinesButChordsStayNear) {
  const SurfaceMesh scan = analytic::cylinder(1, 2, 120, 60);
  const FeatureScan features(scan, find_features(scan).edges, {.least = 0.001});
  LatticeOptions options;
  options.sizing.triangles = 3000;
  LatticeResult lattice = remesh_by_lattice(features, options);
  ASSERT_EQ(lattice.net.lines.size(), 2U);
  const auto largest_deviation = [](const FeatureLine& line) {
    double largest = 0;
    for (std::size_t i = 0; i < line.vertices.size(); ++i)
      largest = std::max(
          largest, chord_deviation(line, line.vertices[i].place, line.vertices[(i + 1) % line.vertices.size()].place));
    return largest;
  };
  // Uneven to begin with, so that there is something to gain.
  for (FeatureLine& line : lattice.net.lines)
    for (std::size_t i = 0; i < line.vertices.size(); i += 2) {
      line.vertices[i].place = std::min(line.vertices[i].place + 0.6, 120.0);
      lattice.mesh.vertices[line.vertices[i].vertex] = line.point_at(line.vertices[i].place);
    }
  const std::vector<FeatureLine> before = lattice.net.lines;
  optimise_shape_and_fit(lattice.mesh, lattice.net, ReferenceSurface(features));
  for (std::size_t l = 0; l < before.size(); ++l) {
    const FeatureLine& line = lattice.net.lines[l];
    EXPECT_LE(largest_deviation(line), std::max(largest_deviation(before[l]), lattice.net.tolerance) + 1e-9);
    bool moved = false;
    for (std::size_t i = 0; i < line.vertices.size(); ++i) {
      moved = moved || line.vertices[i].place != before[l].vertices[i].place;
      EXPECT_EQ(lattice.mesh.vertices[line.vertices[i].vertex], line.point_at(line.vertices[i].place));
    }
    EXPECT_TRUE(moved);
  }
}

}  // namespace
}  // namespace scan2fea
