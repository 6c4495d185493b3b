#include "quality/tetrahedron_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scan2fea {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

TetMesh one_tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  TetMesh mesh;
  mesh.nodes = {a, b, c, d};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.boundary = find_boundary(mesh.tetrahedra);
  return mesh;
}

TetMesh with_straight_mid_edge_nodes(TetMesh mesh) {
  for (const Tetrahedron& t : mesh.tetrahedra) {
    MidEdgeNodes mid;
    for (std::size_t e = 0; e < 6; ++e) {
      mid[e] = static_cast<std::uint32_t>(mesh.nodes.size());
      mesh.nodes.push_back(0.5 * (mesh.nodes[t[static_cast<std::size_t>(tetrahedron_edges[e][0])]] +
                                  mesh.nodes[t[static_cast<std::size_t>(tetrahedron_edges[e][1])]]));
    }
    mesh.mid_edge_nodes.push_back(mid);
  }
  return mesh;
}

TEST(TetrahedronMeasures, Regular) {
  const TetShape shape = measure_tetrahedron({1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1});
  EXPECT_NEAR(shape.min_dihedral_deg, degrees * std::acos(1.0 / 3), 1e-12);
  EXPECT_NEAR(shape.max_dihedral_deg, 70.528779365509308, 1e-12);
  EXPECT_NEAR(shape.scaled_jacobian, 1, 1e-14);
  EXPECT_NEAR(*shape.edge_ratio, 1, 1e-15);
  EXPECT_NEAR(*shape.radius_edge_ratio, std::sqrt(6.0) / 4, 1e-14);
}

TEST(TetrahedronMeasures, CornerOfACube) {
  const TetShape shape = measure_tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  EXPECT_NEAR(shape.min_dihedral_deg, degrees * std::atan(std::numbers::sqrt2), 1e-12);  // 54.7356
  EXPECT_NEAR(shape.max_dihedral_deg, 90, 1e-12);
  EXPECT_NEAR(shape.scaled_jacobian, std::numbers::sqrt2 / 2, 1e-14);
  EXPECT_NEAR(*shape.edge_ratio, std::numbers::sqrt2, 1e-14);
  EXPECT_NEAR(*shape.radius_edge_ratio, std::sqrt(3.0) / 2, 1e-14);
}

TEST(TetrahedronMeasures, ASliverKeepsItsDigits) {
  // A square whose diagonals are h apart: dihedral angles near 0 at the sides, near 180 at the diagonals.
  const double h = 1e-9;
  const TetShape shape = measure_tetrahedron({1, 0, 0}, {-1, 0, 0}, {0, 1, h}, {0, -1, h});
  EXPECT_NEAR(shape.min_dihedral_deg / (std::numbers::sqrt2 * degrees * h), 1, 1e-12);
  EXPECT_NEAR((180 - shape.max_dihedral_deg) / (2 * degrees * h), 1, 1e-5);  // what 180 leaves of the digits
}

TEST(TetrahedronMeasures, InvertedIsNegativeAndCounted) {
  const TetSummary summary = measure_tetrahedra(one_tetrahedron({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}));
  EXPECT_EQ(summary.inverted, 1U);
  EXPECT_NEAR(summary.scaled_jacobian.min, -std::numbers::sqrt2 / 2, 1e-14);
  EXPECT_NEAR(summary.volume, -1.0 / 6, 1e-15);
  EXPECT_NEAR(summary.max_dihedral_deg, 90, 1e-12);
}

TEST(TetrahedronMeasures, FiguresOfDegenerateOnesAreFinite) {
  const std::array<std::array<Vec3, 4>, 4> flat{{{Vec3(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                                 {Vec3(0, 0, 0), {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
                                                 {Vec3(0, 0, 0), {0, 0, 0}, {1, 0, 0}, {1, 0, 0}},
                                                 {Vec3(1, 1, 1), {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}};
  for (const auto& [a, b, c, d] : flat) {
    const TetSummary summary = measure_tetrahedra(one_tetrahedron(a, b, c, d));
    EXPECT_EQ(summary.inverted, 1U);
    EXPECT_EQ(summary.scaled_jacobian.min, 0);
    EXPECT_TRUE(std::isfinite(summary.min_dihedral_deg));
    EXPECT_TRUE(std::isfinite(summary.max_dihedral_deg));
    EXPECT_TRUE(std::isfinite(summary.edge_ratio));
    EXPECT_TRUE(std::isfinite(summary.radius_edge_ratio));
  }
}

TEST(TetrahedronMeasures, TheUnitDoesNotMatter) {
  const TetShape shape = measure_tetrahedron({0, 0, 0}, {1e-60, 0, 0}, {0, 1e-60, 0}, {0, 0, 1e-60});
  EXPECT_NEAR(shape.scaled_jacobian, std::numbers::sqrt2 / 2, 1e-14);
  EXPECT_NEAR(shape.max_dihedral_deg, 90, 1e-12);
}

TEST(TetrahedronMeasures, SummaryOfTwo) {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {1, 2, 3, 4}};  // the corner of a cube, and a regular one
  const TetSummary summary = measure_tetrahedra(mesh);
  EXPECT_EQ(summary.nodes, 5U);
  EXPECT_EQ(summary.tetrahedra, 2U);
  EXPECT_EQ(summary.order, 1);
  EXPECT_EQ(summary.inverted, 0U);
  EXPECT_NEAR(summary.scaled_jacobian.mean, (1 + std::numbers::sqrt2 / 2) / 2, 1e-14);
  EXPECT_NEAR(summary.scaled_jacobian.min, std::numbers::sqrt2 / 2, 1e-14);
  EXPECT_NEAR(summary.volume, 1.0 / 6 + 1.0 / 3, 1e-14);
}

TEST(TetrahedronMeasures, StraightSecondOrderEqualsFirst) {
  const TetMesh linear = one_tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const TetSummary first = measure_tetrahedra(linear),
                   second = measure_tetrahedra(with_straight_mid_edge_nodes(linear));
  EXPECT_EQ(second.order, 2);
  EXPECT_EQ(second.nodes, 10U);
  EXPECT_EQ(second.inverted, 0U);
  EXPECT_EQ(second.scaled_jacobian.min, first.scaled_jacobian.min);
  EXPECT_EQ(second.min_dihedral_deg, first.min_dihedral_deg);
}

TEST(TetrahedronMeasures, ACurvedEdgeCanInvert) {
  TetMesh mesh = with_straight_mid_edge_nodes(one_tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
  mesh.nodes[mesh.mid_edge_nodes[0][0]] = {0.2, 0, 0};
  const TetSummary summary = measure_tetrahedra(mesh);
  EXPECT_EQ(summary.inverted, 1U);
  EXPECT_GT(summary.scaled_jacobian.min, 0);  // of the corners
}

TEST(TetrahedronMeasures, OfNothingAreZero) {
  const TetSummary summary = measure_tetrahedra({});
  EXPECT_EQ(summary.tetrahedra, 0U);
  EXPECT_EQ(summary.min_dihedral_deg, 0);
}

}  // namespace
}  // namespace scan2fea
