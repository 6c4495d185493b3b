#include "preproc/surface/lattice/orientation_field.hpp"

#include "preproc/surface/kernel/spatial_order.hpp"
#include "preproc/surface/lattice/position_field.hpp"
#include "preproc/surface/lattice/scale_relaxation.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scan2fea {
namespace {

FieldGraph graph_of(const SurfaceMesh& mesh, double edge_length) {
  return build_field_graph(
      refine_scan(mesh, {.edge_length = std::vector<double>(mesh.vertices.size(), edge_length)}, 0.7));
}

TEST(TangentFrame, IsRightHandedForEveryNormal) {
  for (const Vec3& at : analytic::sphere(1, 2).vertices) {
    const TangentFrame frame(at);
    EXPECT_NEAR(frame.x.cross(frame.y).dot(at), 1, 1e-12);
    EXPECT_NEAR(frame.x.dot(at), 0, 1e-12);
    EXPECT_NEAR(frame.x.norm(), 1, 1e-12);
  }
}

TEST(TangentFrame, TransportKeepsTheAxisOfTheRotation) {
  const std::vector<Vec3> normals = analytic::sphere(1, 1).vertices;
  for (const Vec3& a : normals)
    for (const Vec3& b : normals) {
      const Vec3 axis = a.cross(b);
      if (axis.norm() < 0.1) continue;
      const TangentFrame from(a), to(b);
      const Complex carried = transport(from, to) * from.coordinates(axis);
      EXPECT_NEAR(std::abs(carried - to.coordinates(axis)), 0, 1e-12);
      EXPECT_NEAR(std::abs(transport(from, to) * transport(to, from) - 1.0), 0, 1e-12);
    }
}

TEST(FieldGraph, LevelsKeepTheAreaAndTheSymmetry) {
  const SurfaceMesh torus = analytic::torus(3, 1, 120, 60);
  const FieldGraph graph = graph_of(torus, 0.2);
  EXPECT_GE(graph.levels.size(), 3U);
  for (const GraphLevel& level : graph.levels) {
    double area = 0;
    for (const double a : level.areas) area += a;
    EXPECT_NEAR(area, surface_area(torus), 1e-9 * area);
    for (std::uint32_t i = 0; i < level.size(); ++i) {
      EXPECT_NEAR(level.normals[i].norm(), 1, 1e-12);
      for (std::uint32_t e = level.first[i]; e < level.first[i + 1]; ++e) {
        const std::uint32_t j = level.neighbours[e];
        const auto begin = level.neighbours.begin() + level.first[j],
                   end = level.neighbours.begin() + level.first[j + 1];
        const auto mate = std::find(begin, end, i);
        ASSERT_NE(mate, end);
        EXPECT_FLOAT_EQ(level.weights[static_cast<std::size_t>(mate - level.neighbours.begin())], level.weights[e]);
      }
    }
  }
}

TEST(FieldGraph, TheTwoSidesOfAThinWallStayApart) {
  const FieldGraph graph = graph_of(analytic::box({4, 4, 0.02}, 0.1), 0.2);
  for (std::size_t l = 0; l + 1 < graph.levels.size(); ++l) {
    const GraphLevel& fine = graph.levels[l];
    for (std::size_t i = 0; i < fine.size(); ++i)
      if (std::abs(fine.normals[i][2]) > 0.99) {
        EXPECT_GT(fine.normals[i].dot(graph.levels[l + 1].normals[fine.parent[i]]), 0);
      }
  }
}

// Of each triangle, how many sixths of a full turn the field makes around it: +1 where five edges of a lattice will
// meet, -1 where seven.
std::vector<int> indices(const RefinedScan& scan, const GraphLevel& level, const std::vector<Complex>& directions) {
  std::vector<int> result;
  for (const Triangle& t : scan.mesh.triangles) {
    Complex around = 1;
    double turn = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = t[k], j = t[(k + 1) % 3];
      const Complex carry = transport(TangentFrame(level.normals[i]), TangentFrame(level.normals[j]));
      around *= carry;
      turn += std::remainder(std::arg(directions[j] * std::conj(directions[i] * carry)), M_PI / 3);
    }
    result.push_back(static_cast<int>(std::lround((turn + std::arg(around)) / (M_PI / 3))));
  }
  return result;
}

TEST(OrientationField, SphereHasTwelveSingularitiesOfValenceFive) {
  const SurfaceMesh sphere = analytic::sphere(1, 4);
  const RefinedScan scan = refine_scan(sphere, {.edge_length = std::vector<double>(sphere.vertices.size(), 0.2)}, 0.7);
  const FieldGraph graph = build_field_graph(scan);
  int five = 0;
  for (const int index : indices(scan, graph.levels.front(), compute_orientation_field(graph).directions)) {
    EXPECT_GE(index, 0);
    five += index;
  }
  EXPECT_EQ(five, 12);
}

// A torus is conformal to a flat one: edge lengths in proportion to the distance from the axis let a lattice without
// irregular vertices lie on it.
class ConformalTorus : public ::testing::Test {
 protected:
  static RefinedScan refined_torus() {
    SurfaceMesh torus = analytic::torus(3, 1, 180, 90);
    order_along_curve(torus);
    SizingField sizing;
    for (const Vec3& v : torus.vertices) sizing.edge_length.push_back(0.1 * std::hypot(v[0], v[1]));
    return refine_scan(torus, sizing, 0.7);
  }

  RefinedScan scan = refined_torus();
  FieldGraph graph = build_field_graph(scan);
};

TEST_F(ConformalTorus, OrientationHasNoSingularities) {
  const OrientationField field = compute_orientation_field(graph);
  for (const int index : indices(scan, graph.levels.front(), field.directions)) EXPECT_EQ(index, 0);
}

TEST_F(ConformalTorus, RelaxationKeepsTheLengths) {
  const std::vector<double> before = graph.levels.front().log_length;
  relax_scale(graph, compute_orientation_field(graph));
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(graph.levels.front().log_length[i], before[i], 0.1);
}

}  // namespace
}  // namespace scan2fea
