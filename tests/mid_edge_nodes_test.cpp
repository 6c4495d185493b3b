#include "preproc/volume/mid_edge_nodes.hpp"

#include "preproc/volume/jacobian_bounds.hpp"
#include "preproc/volume/tetrahedralize.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace scan2fea {
namespace {

TEST(MidEdgeNodes, OneNodePerEdgeInTheMiddleOfIt) {
  const TetMesh corners = tetrahedralize(analytic::box({2, 1, 1}, 0.5)).mesh;
  TetMesh mesh = corners;
  add_mid_edge_nodes(mesh);
  ASSERT_EQ(mesh.order(), 2);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const auto a = mesh.tetrahedra[t][static_cast<std::size_t>(tetrahedron_edges[e][0])];
      const auto b = mesh.tetrahedra[t][static_cast<std::size_t>(tetrahedron_edges[e][1])];
      edges.insert(std::minmax(a, b));
      EXPECT_EQ(mesh.nodes[mesh.mid_edge_nodes[t][e]], (mesh.nodes[a] + mesh.nodes[b]) / 2);
    }
  EXPECT_EQ(mesh.nodes.size(), corners.nodes.size() + edges.size());
  EXPECT_EQ(mesh.tetrahedra, corners.tetrahedra);
}

// Nodes and middles of one element whose edges bulge.
struct Curved {
  std::array<Vec3, 4> corners{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  std::array<Vec3, 6> middles;
  Curved() {
    for (std::size_t e = 0; e < 6; ++e)
      middles[e] = (corners[static_cast<std::size_t>(tetrahedron_edges[e][0])] +
                    corners[static_cast<std::size_t>(tetrahedron_edges[e][1])]) /
                   2;
  }
  Vec3 at(double x, double y, double z) const {
    const double w = 1 - x - y - z;
    return w * (2 * w - 1) * corners[0] + x * (2 * x - 1) * corners[1] + y * (2 * y - 1) * corners[2] +
           z * (2 * z - 1) * corners[3] + 4 * w * x * middles[0] + 4 * x * y * middles[1] + 4 * w * y * middles[2] +
           4 * w * z * middles[3] + 4 * x * z * middles[4] + 4 * y * z * middles[5];
  }
  double jacobian(double x, double y, double z) const {
    const double d = 1e-5;
    return (at(x + d, y, z) - at(x - d, y, z))
               .cross(at(x, y + d, z) - at(x, y - d, z))
               .dot(at(x, y, z + d) - at(x, y, z - d)) /
           (8 * d * d * d);
  }
};

TEST(JacobianBounds, AStraightElementHasOneValue) {
  const Curved element;
  for (const double c : jacobian_coefficients(element.corners, element.middles)) EXPECT_NEAR(c, 1, 1e-14);
}

TEST(JacobianBounds, EncloseTheJacobianOfACurvedElementAndMeetItAtTheCorners) {
  Curved element;
  element.middles[1] += Vec3(0.1, 0.15, -0.05);
  element.middles[3] += Vec3(-0.1, 0.05, 0.1);
  element.middles[5] += Vec3(0.05, -0.12, 0.02);
  const auto c = jacobian_coefficients(element.corners, element.middles);
  const auto [low, high] = std::minmax_element(c.begin(), c.end());
  for (double x = 0; x <= 1; x += 0.125)
    for (double y = 0; x + y <= 1; y += 0.125)
      for (double z = 0; x + y + z <= 1; z += 0.125) {
        EXPECT_GE(element.jacobian(x, y, z), *low - 1e-6);
        EXPECT_LE(element.jacobian(x, y, z), *high + 1e-6);
      }
  EXPECT_NEAR(c[0], element.jacobian(0, 0, 0), 1e-6);
  EXPECT_NEAR(c[2], element.jacobian(0, 1, 0), 1e-6);
}

TEST(CurvedMidEdgeNodes, MakeASphereTwentyTimesBetter) {
  const SurfaceMesh surface = analytic::sphere(1, 3), scan = analytic::sphere(1, 6);
  TetMesh mesh = tetrahedralize(surface).mesh;
  const double truth = 4 * std::numbers::pi / 3;
  const double straight_error = std::abs(total_volume(mesh) - truth);
  add_mid_edge_nodes(mesh);
  EXPECT_NEAR(curved_volume(mesh), total_volume(mesh), 1e-12);
  const CurveResult result = curve_mid_edge_nodes(mesh, TriangleTree(scan));
  EXPECT_EQ(result.too_far + result.invalid, 0u);
  EXPECT_GE(straight_error, 20 * std::abs(curved_volume(mesh) - truth));
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto c = jacobian_coefficients(mesh, t);
    EXPECT_GT(*std::min_element(c.begin(), c.end()), 0);
  }
}

TEST(CurvedMidEdgeNodes, StayStraightWhereAnElementWouldTurnOver) {
  // A scan with a dent that reaches deep into the coarse mesh's elements.
  SurfaceMesh scan = analytic::sphere(1, 5);
  for (Vec3& v : scan.vertices)
    if (v.z() > 0.9) v *= 1 - 3 * (v.z() - 0.9);
  TetMesh mesh = tetrahedralize(analytic::sphere(1, 1)).mesh;
  add_mid_edge_nodes(mesh);
  CurveOptions options;
  options.largest_displacement = 1;
  const CurveResult result = curve_mid_edge_nodes(mesh, TriangleTree(scan), options);
  EXPECT_GT(result.curved, 0u);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto c = jacobian_coefficients(mesh, t);
    EXPECT_GT(*std::min_element(c.begin(), c.end()), 0);
  }
  EXPECT_GE(result.least_jacobian, options.least_jacobian);
}

TEST(CurvedMidEdgeNodes, AScanTooFarAwayIsLeftAlone) {
  TetMesh mesh = tetrahedralize(analytic::sphere(1, 2)).mesh;
  add_mid_edge_nodes(mesh);
  const std::vector<Vec3> straight = mesh.nodes;
  const CurveResult result = curve_mid_edge_nodes(mesh, TriangleTree(analytic::sphere(2, 4)));
  EXPECT_EQ(result.curved, 0u);
  EXPECT_EQ(result.too_far, mesh.boundary.size() * 3 / 2);
  EXPECT_EQ(mesh.nodes, straight);
}

}  // namespace
}  // namespace scan2fea
