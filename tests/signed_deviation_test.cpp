#include "quality/signed_deviation.hpp"

#include "tests/analytic_meshes.hpp"
#include "tests/structured_tets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

SurfaceMesh scaled(SurfaceMesh mesh, double factor) {
  for (Vec3& p : mesh.vertices) p *= factor;
  return mesh;
}

TEST(SignedDeviation, IsPositiveWhereTheMeshLiesOutside) {
  const SurfaceMesh ball = analytic::sphere(10, 4);
  const TriangleTree tree(ball);
  const double chord = 0.02;  // of this tessellation, below the radius
  for (const double d : signed_deviations(scaled(ball, 1.05), tree)) EXPECT_NEAR(d, 0.5, chord + 0.05 * chord);
  for (const double d : signed_deviations(scaled(ball, 0.95), tree)) EXPECT_NEAR(d, -0.5, chord + 0.05 * chord);
}

TEST(SignedDeviation, OfTheReferenceHasTheSameSign) {
  const SurfaceMesh ball = analytic::sphere(10, 4), larger = scaled(ball, 1.05);
  for (const double d : signed_deviations_of_reference(ball, larger, TriangleTree(larger))) EXPECT_NEAR(d, 0.5, 0.03);
}

TEST(SignedDeviation, IsZeroOnTheReferenceItself) {
  const SurfaceMesh box = analytic::box({4, 3, 2}, 0.5);
  for (const double d : signed_deviations(box, TriangleTree(box))) EXPECT_NEAR(d, 0, 1e-12);
}

TEST(SignedDeviation, OfPointsIsThatOfTheTrianglesNearestToThem) {
  const SurfaceMesh ball = analytic::sphere(10, 3);
  std::vector<Vec3> points;
  for (const Triangle& t : ball.triangles) {
    const Vec3 middle = (ball.vertices[t[0]] + ball.vertices[t[1]] + ball.vertices[t[2]]) / 3;
    points.push_back(middle + (middle.z() > 0 ? 0.3 : -0.2) * area_vector(ball, t).normalized());
  }
  points.pop_back();
  const std::vector<double> found = signed_deviations_from_points(points, ball);
  ASSERT_EQ(found.size(), ball.triangles.size());
  for (std::size_t f = 0; f < points.size(); ++f) EXPECT_NEAR(found[f], points[f].z() > 0 ? -0.3 : 0.2, 0.01);
  EXPECT_TRUE(std::isnan(found.back()));
}

// A vault, z = 2 + x (2 - x) / 4, which elements of second order have exactly.
TEST(SignedDeviation, OfPointsIsThatOfTheCurvedFace) {
  TetMesh mesh = analytic::tetrahedra_of_box({2, 2, 2}, {2, 2, 2}, 2);
  const auto vault = [](double x) { return 0.25 * x * (2 - x); };
  for (Vec3& p : mesh.nodes)
    if (p.z() == 2) p.z() += vault(p.x());
  std::vector<Vec3> points;
  for (double x = 0.05; x < 2; x += 0.1)
    for (double y = 0.05; y < 2; y += 0.1)
      points.push_back(Vec3(x, y, 2 + vault(x)) + 0.01 * Vec3(-0.25 * (2 - 2 * x), 0, 1).normalized());
  const std::vector<double> found = signed_deviations_from_points(points, mesh);
  ASSERT_EQ(found.size(), mesh.outer_faces());
  std::size_t measured = 0;
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (std::isnan(found[f])) continue;
    ++measured;
    EXPECT_NEAR(found[f], -0.01, 3e-4);  // pieces of a 16th of an edge lie up to 2.5e-4 below the vault
  }
  EXPECT_EQ(measured, 8U);  // the vault's faces: two for each of four blocks
}

// The scan's own orientation does not matter.
TEST(SignedDeviation, TakesItsSignFromTheMesh) {
  SurfaceMesh turned = analytic::sphere(10, 3);
  const SurfaceMesh larger = scaled(turned, 1.1);
  for (Triangle& t : turned.triangles) std::swap(t[0], t[1]);
  for (const double d : signed_deviations(larger, TriangleTree(turned))) EXPECT_GT(d, 0.9);
}

// A mesh of somebody else's may be inside out: what lies outside of the reference still does.
TEST(SignedDeviation, OfAMeshThatIsInsideOutHasTheSameSign) {
  const SurfaceMesh ball = analytic::sphere(10, 3);
  SurfaceMesh larger = scaled(ball, 1.05);
  for (Triangle& t : larger.triangles) std::swap(t[0], t[1]);
  const TriangleTree tree(ball);
  for (const double d : signed_deviations(larger, tree)) EXPECT_GT(d, 0.4);
  for (const double d : signed_deviations_of_nodes(larger, tree)) EXPECT_GT(d, 0.4);
  for (const double d : signed_deviations_of_reference(ball, larger, TriangleTree(larger))) EXPECT_GT(d, 0.4);
  for (const double d : signed_deviations_from_points(ball.vertices, larger))
    if (!std::isnan(d)) EXPECT_GT(d, 0.4);
  TetMesh cube = analytic::tetrahedra_of_box({2, 2, 2}, {2, 2, 2}, 1);
  for (Vec3& p : cube.nodes) p = 1.1 * (p - Vec3::Ones());
  for (Tetrahedron& t : cube.tetrahedra) std::swap(t[0], t[1]);
  cube.boundary = find_boundary(cube.tetrahedra);
  SurfaceMesh smaller = analytic::box({2, 2, 2}, 1);
  for (Vec3& p : smaller.vertices) p -= Vec3::Ones();
  for (const double d : signed_deviations(cube, TriangleTree(smaller))) EXPECT_NEAR(d, 0.1, 0.05);
}

TEST(SignedDeviation, OfNodesIsTheirOwn) {
  const SurfaceMesh ball = analytic::sphere(10, 3);
  const TriangleTree tree(ball);
  for (const double factor : {1.05, 0.95})
    for (const double d : signed_deviations_of_nodes(scaled(ball, factor), tree))
      EXPECT_NEAR(d, 10 * (factor - 1), 0.05 * std::abs(10 * (factor - 1)));
}

// A cube of eight blocks in a larger cube: the node in its middle has none.
TEST(SignedDeviation, OfNodesInsideThereIsNone) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = analytic::tetrahedra_of_box({2, 2, 2}, {2, 2, 2}, order);
    SurfaceMesh larger = analytic::box({3, 3, 3}, 1);
    for (Vec3& p : larger.vertices) p -= Vec3::Constant(0.5);
    const std::vector<double> deviations = signed_deviations_of_nodes(mesh, TriangleTree(larger));
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const Vec3& p = mesh.nodes[n];
      if (p.minCoeff() > 0 && p.maxCoeff() < 2)
        EXPECT_TRUE(std::isnan(deviations[n]));
      else
        EXPECT_NEAR(deviations[n], -0.5, 1e-12);
    }
  }
}

// One dent: the sample in the middle of the triangle over it tells of it, though its corners lie on the reference. The
// mean height over the pyramid is a third of its own, which the rule only comes near, since it has a tip.
TEST(SignedDeviation, SeesWhatLiesBetweenTheCorners) {
  SurfaceMesh roof;
  roof.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {1, 1, -0.4}};
  roof.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const SurfaceMesh flat{{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}}, {{0, 1, 2}}};
  EXPECT_NEAR(signed_deviations(flat, TriangleTree(roof)).front(), 0.4 / 3, 0.05);
}

// Half of the triangle is above the plane and half below.
TEST(SignedDeviation, IsTheMeanOfATriangle) {
  const SurfaceMesh plane = {{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const SurfaceMesh tilted = {{{0, 0, 0.2}, {3, 0, -0.1}, {0, 3, -0.1}}, {{0, 1, 2}}};
  EXPECT_NEAR(signed_deviations(tilted, TriangleTree(plane)).front(), 0, 1e-12);
  SurfaceMesh raised = tilted;
  for (Vec3& p : raised.vertices) p.z() += 0.25;
  EXPECT_NEAR(signed_deviations(raised, TriangleTree(plane)).front(), 0.25, 1e-12);
}

}  // namespace
}  // namespace scan2fea
