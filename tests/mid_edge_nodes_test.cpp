#include "preproc/volume/mid_edge_nodes.hpp"

#include "preproc/volume/tetrahedralize.hpp"
#include "quality/jacobian_bound.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

void expect_all_valid(const TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    ASSERT_GT(min_jacobian_bound(curved_tetrahedron(mesh, t)).lower, 0) << t;
}

TEST(CurvedMidEdgeNodes, MakeASphereTwentyTimesBetter) {
  const SurfaceMesh surface = analytic::sphere(1, 3), scan = analytic::sphere(1, 6);
  TetMesh mesh = tetrahedralize(surface).mesh;
  const double truth = 4 * std::numbers::pi / 3;
  const double straight_error = std::abs(total_volume(mesh) - truth);
  add_mid_edge_nodes(mesh);
  const CurveResult result = curve_mid_edge_nodes(mesh, TriangleTree(scan));
  EXPECT_EQ(result.too_far + result.invalid, 0u);
  EXPECT_GE(straight_error, 20 * std::abs(result.volume - truth));
  expect_all_valid(mesh);
}

TEST(CurvedMidEdgeNodes, OfARimGoToItsLine) {
  // The middle of a rim's chord lies in the end face, which is no farther from it than nothing.
  const auto rim_of = [](const SurfaceMesh& mesh) {
    std::vector<std::array<std::uint32_t, 2>> rim;
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        const auto on_rim = [&](std::uint32_t v) {
          const Vec3& p = mesh.vertices[v];
          return std::abs(p.z() - 2) < 1e-9 && std::hypot(p.x(), p.y()) > 1 - 1e-9;
        };
        if (a < b && on_rim(a) && on_rim(b)) rim.push_back({a, b});
      }
    std::sort(rim.begin(), rim.end());
    return rim;
  };
  const SurfaceMesh surface = analytic::cylinder(1, 2, 16, 6), scan = analytic::cylinder(1, 2, 160, 60);
  TetMesh mesh = tetrahedralize(surface).mesh;
  add_mid_edge_nodes(mesh);
  const ScanLines lines{rim_of(surface), scan.vertices, rim_of(scan)};
  ASSERT_EQ(lines.edges.size(), 16U);
  curve_mid_edge_nodes(mesh, TriangleTree(scan), {}, lines);
  expect_all_valid(mesh);
  std::size_t checked = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [i, j] = tetrahedron_edges[e];
      const auto ends =
          std::minmax(mesh.tetrahedra[t][static_cast<std::size_t>(i)], mesh.tetrahedra[t][static_cast<std::size_t>(j)]);
      const std::array<std::uint32_t, 2> edge{ends.first, ends.second};
      if (!std::binary_search(lines.edges.begin(), lines.edges.end(), edge)) continue;
      const Vec3& p = mesh.nodes[mesh.mid_edge_nodes[t][e]];
      EXPECT_NEAR(std::hypot(p.x(), p.y()), 1, 1e-3);
      EXPECT_NEAR(p.z(), 2, 1e-12);
      ++checked;
    }
  EXPECT_GE(checked, 16U);
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
  expect_all_valid(mesh);
  EXPECT_GE(result.least_jacobian, options.least_jacobian);
}

TEST(CurvedMidEdgeNodes, AScanTooFarAwayIsLeftAlone) {
  TetMesh mesh = tetrahedralize(analytic::sphere(1, 2)).mesh;
  add_mid_edge_nodes(mesh);
  const std::vector<Vec3> straight = mesh.nodes;
  const CurveResult result = curve_mid_edge_nodes(mesh, TriangleTree(analytic::sphere(2, 4)));
  EXPECT_EQ(result.curved, 0u);
  EXPECT_NEAR(result.volume, total_volume(mesh), 1e-12);
  EXPECT_EQ(result.too_far, mesh.boundary.size() * 3 / 2);
  EXPECT_EQ(mesh.nodes, straight);
}

}  // namespace
}  // namespace scan2fea
