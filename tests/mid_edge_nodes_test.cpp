#include "preproc/volume/mid_edge_nodes.hpp"

#include "preproc/volume/mid_edge_relocation.hpp"
#include "preproc/volume/tet_quality.hpp"
#include "preproc/volume/tetrahedralize.hpp"
#include "preproc/volume/two_sided_elements.hpp"
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
  EdgePlaces to = nearest_on_scan(mesh, TriangleTree(scan));
  const CurveResult result = curve_mid_edge_nodes(mesh, to);
  EXPECT_EQ(result.eased, 0u);
  EXPECT_GE(straight_error, 20 * std::abs(result.volume - truth));
  expect_all_valid(mesh);
}

// Of a bulge of so much over each edge: of an edge's length, outwards.
EdgePlaces bulges(const TetMesh& mesh, double of_edge) {
  EdgePlaces to = nearest_on_scan(mesh, TriangleTree(boundary_surface(mesh)));
  for (std::size_t e = 0; e < to.edges.size(); ++e) {
    const Vec3 &a = mesh.nodes[to.edges[e][0]], &b = mesh.nodes[to.edges[e][1]];
    to.places[e] = (a + b) / 2 + of_edge * (b - a).norm() * (a + b).normalized();
  }
  return to;
}

TEST(CurvedMidEdgeNodes, GoAsFarAsTheElementsStayGood) {
  TetMesh mesh = tetrahedralize(analytic::sphere(1, 1)).mesh;
  add_mid_edge_nodes(mesh);
  EdgePlaces to = bulges(mesh, -0.2);
  const std::vector<Vec3> wanted = to.places;
  const CurveResult result = curve_mid_edge_nodes(mesh, to);
  EXPECT_GT(result.eased, 0u);
  EXPECT_GT(result.curved, 0u);
  expect_all_valid(mesh);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) EXPECT_GE(curved_quality(mesh, t), 1) << t;
  // Each lies on the way from its edge's middle to where it was wanted.
  for (std::size_t e = 0; e < to.places.size(); ++e) {
    const Vec3 middle = (mesh.nodes[to.edges[e][0]] + mesh.nodes[to.edges[e][1]]) / 2;
    const Vec3 way = wanted[e] - middle, gone = to.places[e] - middle;
    EXPECT_NEAR(way.cross(gone).norm(), 0, 1e-12);
    EXPECT_LE(gone.norm(), way.norm() * (1 + 1e-12));
  }
}

TEST(CurvedMidEdgeNodes, InsideMakeRoomForThoseOfTheBoundary) {
  // With the nodes of inner edges in their middles, this much bend leaves elements poor; with them moved, fewer.
  TetMesh mesh = tetrahedralize(analytic::sphere(1, 1)).mesh;
  add_mid_edge_nodes(mesh);
  const EdgePlaces to = bulges(mesh, -0.1);
  std::vector<bool> held(mesh.nodes.size(), false);
  for (const BoundaryFace f : mesh.boundary) {
    const Triangle corners = boundary_triangle(mesh, f), middles = boundary_mid_edge_nodes(mesh, f);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % 3]);
      const auto at = std::lower_bound(to.edges.begin(), to.edges.end(), std::array<std::uint32_t, 2>{low, high});
      mesh.nodes[middles[k]] = to.places[static_cast<std::size_t>(at - to.edges.begin())];
      held[middles[k]] = true;
    }
  }
  const auto poor_of = [](const TetMesh& m) {
    std::vector<std::uint32_t> poor;
    for (std::uint32_t t = 0; t < m.tetrahedra.size(); ++t)
      if (curved_quality(m, t) < 1.5) poor.push_back(t);
    return poor;
  };
  const auto worst_of = [](const TetMesh& m) {
    double worst = 10;
    for (std::size_t t = 0; t < m.tetrahedra.size(); ++t) worst = std::min(worst, curved_quality(m, t));
    return worst;
  };
  const std::vector<std::uint32_t> before = poor_of(mesh);
  ASSERT_FALSE(before.empty());
  const TetMesh given = mesh;
  relocate_mid_edge_nodes(mesh, before, held, 1.5);
  EXPECT_LT(poor_of(mesh).size(), before.size());
  EXPECT_GE(worst_of(mesh), worst_of(given));
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
    if (held[v]) {
      EXPECT_EQ(mesh.nodes[v], given.nodes[v]);
    }
}

TEST(CurvedMidEdgeNodes, AScanTooFarAwayIsLeftAlone) {
  TetMesh mesh = tetrahedralize(analytic::sphere(1, 2)).mesh;
  add_mid_edge_nodes(mesh);
  const std::vector<Vec3> straight = mesh.nodes;
  EdgePlaces to = nearest_on_scan(mesh, TriangleTree(analytic::sphere(2, 4)));
  const CurveResult result = curve_mid_edge_nodes(mesh, to);
  EXPECT_EQ(result.curved, 0u);
  EXPECT_NEAR(result.volume, total_volume(mesh), 1e-12);
  EXPECT_EQ(mesh.nodes, straight);
}

// A regular tetrahedron on a tetrahedron, stretched: the outer two sides of each meet at an edge of the boundary.
TetMesh two_tetrahedra(double stretch) {
  TetMesh mesh;
  mesh.nodes = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}, {5. / 3, 5. / 3, -5. / 3}};
  for (Vec3& p : mesh.nodes) p.z() *= stretch;
  mesh.tetrahedra = {{0, 1, 3, 2}, {0, 1, 2, 4}};
  for (Tetrahedron& t : mesh.tetrahedra) {
    const Vec3& a = mesh.nodes[t[0]];
    if ((mesh.nodes[t[1]] - a).cross(mesh.nodes[t[2]] - a).dot(mesh.nodes[t[3]] - a) < 0) std::swap(t[0], t[1]);
  }
  mesh.boundary = find_boundary(mesh.tetrahedra);
  return mesh;
}

TEST(TwoSidedElements, ArePartedAndTheBoundaryStays) {
  TetMesh mesh = two_tetrahedra(1);
  const SurfaceMesh before = boundary_surface(mesh);
  const double volume = total_volume(mesh);
  std::vector<std::array<std::uint32_t, 2>> creases;
  for (std::uint32_t a = 0; a < 5; ++a)
    for (std::uint32_t b = a + 1; b < 5; ++b) creases.push_back({a, b});
  TetMesh creased = mesh;
  EXPECT_EQ(part_two_sided_elements(creased, 5, creases), 0u);
  EXPECT_EQ(creased.tetrahedra, mesh.tetrahedra);

  EXPECT_GT(part_two_sided_elements(mesh, 5, {}), 0u);
  EXPECT_NEAR(total_volume(mesh), volume, 1e-12);
  EXPECT_EQ(boundary_surface(mesh).triangles.size(), before.triangles.size());
  std::vector<int> sides(mesh.tetrahedra.size(), 0);
  for (const BoundaryFace f : mesh.boundary) ++sides[f.tetrahedron];
  EXPECT_LE(*std::max_element(sides.begin(), sides.end()), 1);
}

// What is parted is to be curved, for which it needs a quality of its own.
TEST(TwoSidedElements, LeaveNoneBehindThatIsTooPoorToBeCurved) {
  std::size_t parted = 0;
  for (double stretch = 0.3; stretch < 3; stretch += 0.02) {
    TetMesh mesh = two_tetrahedra(stretch);
    if (part_two_sided_elements(mesh, 5, {}) == 0) continue;
    ++parted;
    for (const Tetrahedron& t : mesh.tetrahedra)
      EXPECT_GE(goal_quality(mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]], mesh.nodes[t[3]]), 0.9) << stretch;
  }
  EXPECT_GT(parted, 10U);
}

}  // namespace
}  // namespace scan2fea
