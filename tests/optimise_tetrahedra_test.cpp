#include "preproc/volume/optimise_tetrahedra.hpp"

#include "preproc/volume/edge_removal.hpp"
#include "preproc/volume/entropy_smoothing.hpp"
#include "preproc/volume/max_min_relocation.hpp"
#include "preproc/volume/multi_face_removal.hpp"
#include "preproc/volume/tet_complex.hpp"
#include "preproc/volume/tet_quality.hpp"
#include "preproc/volume/tetrahedralize.hpp"
#include "preproc/volume/vertex_removal.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace scan2fea {
namespace {

double worst_quality(const TetMesh& mesh) {
  double least = 1e9;
  for (const Tetrahedron& t : mesh.tetrahedra)
    least = std::min(least, goal_quality(mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]], mesh.nodes[t[3]]));
  return least;
}

TetMesh unoptimised(const SurfaceMesh& surface, InteriorPoints interior) {
  TetrahedralizeOptions options;
  options.interior = interior;
  options.optimise.reset();
  return tetrahedralize(surface, options).mesh;
}

void expect_same_boundary(const TetMesh& before, const TetMesh& after) {
  ASSERT_EQ(before.boundary.size(), after.boundary.size());
  for (std::size_t i = 0; i < before.boundary.size(); ++i) {
    Triangle a = boundary_triangle(before, before.boundary[i]), b = boundary_triangle(after, after.boundary[i]);
    std::rotate(a.begin(), std::min_element(a.begin(), a.end()), a.end());
    std::rotate(b.begin(), std::min_element(b.begin(), b.end()), b.end());
    ASSERT_EQ(a, b) << i;
    for (const std::uint32_t v : a) ASSERT_EQ(before.nodes[v], after.nodes[v]);
  }
  EXPECT_EQ(find_boundary(after.tetrahedra).size(), after.boundary.size());
}

TEST(TetQuality, RegularTetrahedron) {
  const Vec3 a(1, 1, 1), b(-1, 1, -1), c(1, -1, -1), d(-1, -1, 1);
  EXPECT_NEAR(goal_quality(a, b, c, d), std::sqrt(8.0 / 9) / std::sin(22 * M_PI / 180), 1e-12);
  EXPECT_EQ(goal_quality(b, a, c, d), 0);
}

TEST(TetQuality, IsOneAtEachOfItsThreeGoals) {
  // Against the measures of the quality library, on many shapes.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(0, 1);
  const auto point = [&] { return Vec3(coordinate(random), coordinate(random), coordinate(random)); };
  const double degree = M_PI / 180;
  for (int k = 0; k < 1000; ++k) {
    const Vec3 a = point(), b = point(), c = point(), d = point();
    const TetShape shape = measure_tetrahedron(a, b, c, d);
    const double expected = std::min({std::sin(shape.min_dihedral_deg * degree) / std::sin(22 * degree),
                                      (1 + std::cos(shape.max_dihedral_deg * degree)) / (1 + std::cos(138 * degree)),
                                      shape.scaled_jacobian / 0.28});
    EXPECT_NEAR(goal_quality(a, b, c, d), std::max(expected, 0.0), 1e-9);
    // A floor changes nothing above it.
    const double floor = coordinate(random);
    const double floored = goal_quality(a, b, c, d, floor);
    if (expected > floor + 1e-9)
      EXPECT_EQ(floored, goal_quality(a, b, c, d));
    else
      EXPECT_LE(floored, floor + 1e-9);
  }
}

TEST(TetQuality, DoesNotDependOnTheOrderOfCornersNorOnSize) {
  const std::array<Vec3, 4> p{Vec3(0, 0, 0), Vec3(1, 0.1, 0), Vec3(0.2, 1.3, 0.1), Vec3(0.3, 0.2, 0.7)};
  const double q = goal_quality(p[0], p[1], p[2], p[3]);
  EXPECT_NEAR(goal_quality(p[1], p[2], p[0], p[3]), q, 1e-12);
  EXPECT_NEAR(goal_quality(p[3], p[2], p[1], p[0]), q, 1e-12);
  EXPECT_NEAR(goal_quality(1e-6 * p[0], 1e-6 * p[1], 1e-6 * p[2], 1e-6 * p[3]), q, 1e-9);
}

TEST(TetQuality, FlatElementsAreNotPositive) {
  EXPECT_LE(goal_quality({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0}), 0);
  EXPECT_LE(goal_quality({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}), 0);
}

// A regular tetrahedron with a vertex inside, `height` above its first face.
TetMesh split_tetrahedron(double height) {
  TetMesh mesh;
  mesh.nodes = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  const Vec3 base = (mesh.nodes[0] + mesh.nodes[1] + mesh.nodes[2]) / 3;
  mesh.nodes.emplace_back(base + height * (mesh.nodes[3] - base).normalized());
  mesh.tetrahedra = {{0, 1, 2, 4}, {0, 1, 4, 3}, {0, 4, 2, 3}, {4, 1, 2, 3}};
  mesh.boundary = find_boundary(mesh.tetrahedra);
  return mesh;
}

TEST(VertexRemoval, RemovesAVertexWithoutRoomAndKeepsTheSurface) {
  const TetMesh before = split_tetrahedron(0.01);
  TetComplex complex(before);
  ASSERT_TRUE(VertexRemoval().mend(complex, 0, 1.02));
  const TetMesh after = complex.to_mesh(4);
  EXPECT_EQ(after.tetrahedra.size(), 1u);
  EXPECT_EQ(after.nodes.size(), 4u);
  expect_same_boundary(before, after);
  EXPECT_NEAR(total_volume(after), total_volume(before), 1e-14);
}

TEST(VertexRemoval, LeavesAVertexWhereNotEnoughIsGained) {
  const TetMesh before = split_tetrahedron(0.5);
  TetComplex complex(before);
  const double without = goal_quality(before.nodes[0], before.nodes[1], before.nodes[2], before.nodes[3]);
  ASSERT_GT(without, 0);
  EXPECT_FALSE(VertexRemoval().mend(complex, 0, 1.01 * without / worst_quality(before)));
  EXPECT_TRUE(VertexRemoval().mend(complex, 0, 0.99 * without / worst_quality(before)));
}

// A flat ring of n vertices, with a long axis through it: removing the axis is right for a short axis.
TetMesh ring_mesh(std::uint32_t n, double half_axis) {
  TetMesh mesh;
  mesh.nodes = {{0, 0, -half_axis}, {0, 0, half_axis}};
  for (std::uint32_t k = 0; k < n; ++k)
    mesh.nodes.emplace_back(std::cos(2 * M_PI * k / n), std::sin(2 * M_PI * k / n), 0);
  for (std::uint32_t k = 0; k < n; ++k) mesh.tetrahedra.push_back({0, 1, 2 + k, 2 + (k + 1) % n});
  mesh.boundary = find_boundary(mesh.tetrahedra);
  return mesh;
}

TEST(VertexRemoval, LeavesVerticesOfTheSurface) {
  TetComplex complex(ring_mesh(5, 0.01));
  EXPECT_FALSE(VertexRemoval().mend(complex, 0, 1.02));
}

TEST(EdgeRemoval, RemovesALongAxisAndKeepsTheSurface) {
  for (const std::uint32_t n : {3u, 4u, 5u, 6u, 7u}) {
    const TetMesh before = ring_mesh(n, 3);
    TetComplex complex(before);
    ASSERT_TRUE(remove_edge(complex, 0, 0, 1, n <= 5 ? 1.0 : 0.5)) << n;
    const TetMesh after = complex.to_mesh(before.nodes.size());
    EXPECT_EQ(after.tetrahedra.size(), 2 * (n - 2));
    expect_same_boundary(before, after);
    if (n <= 5) {
      EXPECT_GT(worst_quality(after), worst_quality(before));
    }
    EXPECT_NEAR(total_volume(after), total_volume(before), 1e-14);
  }
}

TEST(EdgeRemoval, KeepsABoundaryEdge) {
  TetComplex complex(ring_mesh(5, 1.5));
  EXPECT_FALSE(remove_edge(complex, 0, 2, 3, 0.01));
}

TEST(MultiFaceRemoval, UndoesEdgeRemoval) {
  for (const std::uint32_t n : {3u, 4u, 5u, 6u}) {
    // A short axis is better than none.
    const TetMesh start = ring_mesh(n, 0.4);
    TetComplex complex(start);
    const double with_axis = worst_quality(start);
    ASSERT_TRUE(remove_edge(complex, 0, 0, 1, 0.01)) << n;
    const TetMesh without = complex.to_mesh(start.nodes.size());
    if (worst_quality(without) >= with_axis) continue;
    bool removed = false;
    for (std::uint32_t t = 0; t < complex.slot_count() && !removed; ++t)
      for (std::size_t k = 0; complex.alive(t) && k < 4 && !removed; ++k)
        if (complex.element(t).corners[k] <= 1) removed = remove_faces(complex, t, k, 1.0005);
    ASSERT_TRUE(removed) << n;
    expect_same_boundary(start, complex.to_mesh(start.nodes.size()));
  }
}

// The faces of an octahedron around a vertex that may move.
StarFaces octahedron_star() {
  const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  StarFaces faces;
  for (const double i : {-1.0, 1.0})
    for (const double j : {-1.0, 1.0})
      for (const double k : {-1.0, 1.0}) {
        // (f0, f1, f2, centre) positive.
        if (i * j * k > 0)
          faces.push_back({i * x, k * z, j * y});
        else
          faces.push_back({i * x, j * y, k * z});
      }
  return faces;
}

TEST(VertexMoves, FindTheCentreOfAnOctahedron) {
  const StarFaces faces = octahedron_star();
  const Vec3 start(0.4, 0.25, -0.3);
  const double before = star_quality(faces, start);
  ASSERT_GT(before, 0);
  Vec3 x = start;
  double quality = before;
  for (int k = 0; k < 20; ++k) smooth_by_entropy(faces, x, quality);
  EXPECT_LT(x.norm(), 1e-6);
  EXPECT_DOUBLE_EQ(quality, star_quality(faces, x));
  x = start;
  quality = before;
  EXPECT_TRUE(relocate_max_min(faces, x, quality, 40));
  EXPECT_LT(x.norm(), 0.05);
  EXPECT_GT(quality, before);
}

TEST(OptimiseTetrahedra, NeverWorseBoundaryKeptAllPositive) {
  for (const SurfaceMesh& surface :
       {analytic::sphere(1, 3), analytic::noisy(analytic::sphere(1, 3), 0.02, 7), analytic::box({3, 1, 1}, 0.3),
        analytic::torus(3, 1, 40, 16),
        analytic::join(analytic::sphere(3, 3), analytic::reversed(analytic::sphere(2, 3)))})
    for (const InteriorPoints interior : {InteriorPoints::lattice, InteriorPoints::tetgen}) {
      const TetMesh before = unoptimised(surface, interior);
      TetMesh after = before;
      const OptimiseResult result = optimise_tetrahedra(after, surface.vertices.size());
      expect_same_boundary(before, after);
      EXPECT_GE(worst_quality(after), worst_quality(before));
      EXPECT_DOUBLE_EQ(result.worst_after, worst_quality(after));
      EXPECT_GT(worst_quality(after), 0.5);
      EXPECT_NEAR(total_volume(after), total_volume(before), 1e-10 * total_volume(before));
    }
}

TEST(OptimiseTetrahedra, ASurfaceOfNeedlesDoesNotBlowUp) {
  // A box of twelve triangles, a hundred times as long as thick: nothing good can be had.
  const TetMesh before = unoptimised(analytic::box({100, 3, 1}, 100), InteriorPoints::tetgen);
  TetMesh after = before;
  optimise_tetrahedra(after, 0);
  expect_same_boundary(before, after);
  EXPECT_LT(after.tetrahedra.size(), 2 * before.tetrahedra.size() + 1000);
}

TEST(OptimiseTetrahedra, StoppedAtAnyMomentItIsValidAndNoWorse) {
  const TetMesh before = unoptimised(analytic::noisy(analytic::sphere(1, 4), 0.005, 3), InteriorPoints::tetgen);
  for (const double milliseconds : {0.0, 1.0, 3.0, 10.0}) {
    TetMesh after = before;
    const auto time =
        std::chrono::duration_cast<Progress::Clock::duration>(std::chrono::duration<double, std::milli>(milliseconds));
    optimise_tetrahedra(after, 0, {}, Progress().until(Progress::Clock::now() + time));
    expect_same_boundary(before, after);
    EXPECT_GE(worst_quality(after), worst_quality(before));
    EXPECT_NEAR(total_volume(after), total_volume(before), 1e-10 * total_volume(before));
  }
}

TEST(OptimiseTetrahedra, SameBytesTwice) {
  const SurfaceMesh surface = analytic::noisy(analytic::sphere(1, 3), 0.01, 5);
  const TetMesh a = tetrahedralize(surface).mesh, b = tetrahedralize(surface).mesh;
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) ASSERT_EQ(a.nodes[i], b.nodes[i]);
}

TEST(OptimiseTetrahedra, CanBeInterrupted) {
  TetMesh mesh = unoptimised(analytic::sphere(1, 3), InteriorPoints::tetgen);
  EXPECT_THROW(optimise_tetrahedra(mesh, 0, {}, Progress([](auto, double) { return false; })), Cancelled);
}

}  // namespace
}  // namespace scan2fea
