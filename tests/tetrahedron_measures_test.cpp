#include "quality/tetrahedron_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

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

TEST(TetrahedronMeasures, AnglesOfFaces) {
  const FaceAngles regular = measure_face_angles({1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1});
  EXPECT_NEAR(regular.min_deg, 60, 1e-12);
  EXPECT_NEAR(regular.max_deg, 60, 1e-12);
  const FaceAngles corner = measure_face_angles({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  EXPECT_NEAR(corner.min_deg, 45, 1e-12);
  EXPECT_NEAR(corner.max_deg, 90, 1e-12);
  // A cap: its apex lies just above the middle of a regular base, where edges meet at almost 120 degrees.
  const double h = 1e-4;
  const FaceAngles cap =
      measure_face_angles({1, 0, 0}, {-0.5, std::sqrt(0.75), 0}, {-0.5, -std::sqrt(0.75), 0}, {0, 0, h});
  EXPECT_NEAR(cap.max_deg, 120, 1e-5);
  EXPECT_LT(cap.max_deg, 120);
  EXPECT_NEAR(cap.min_deg, 30, 1e-5);
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
  EXPECT_LT(summary.scaled_jacobian.min, 0);
}

// Elements of which every node was moved.
std::vector<TetMesh> bent_tetrahedra() {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> shift(-0.06, 0.06);
  std::vector<TetMesh> bent;
  for (int i = 0; i < 40; ++i) {
    bent.push_back(with_straight_mid_edge_nodes(one_tetrahedron({0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.1, 0.3, 1})));
    for (Vec3& p : bent.back().nodes) p += Vec3(shift(generator), shift(generator), shift(generator));
  }
  return bent;
}

TEST(TetrahedronMeasures, OfBentElementsAreNotThoseOfTheirCorners) {
  for (const TetMesh& mesh : bent_tetrahedra()) {
    const CurvedTetrahedron x = curved_tetrahedron(mesh, 0);
    double least = 1e9;
    constexpr int n = 12;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        for (int k = 0; i + j + k <= n; ++k) {
          const auto [u, v, w] =
              derivatives_at(x, {double(n - i - j - k) / n, double(i) / n, double(j) / n, double(k) / n});
          least = std::min(least, u.cross(v).dot(w));
        }
    // Chords are at most as long as the curved edges, so this is an upper bound.
    double product = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      double of_corner = 1;
      for (std::size_t d = 0; d < 4; ++d) of_corner *= d == c ? 1 : (x[c] - x[d]).norm();
      product = std::max(product, of_corner);
    }
    const TetShape shape = measure_tetrahedron(mesh, 0);
    const double sampled = std::numbers::sqrt2 * least / product;
    EXPECT_LE(shape.scaled_jacobian, sampled + 1e-12);
    EXPECT_GE(shape.scaled_jacobian, 0.95 * sampled - 0.02);
    EXPECT_NE(shape.scaled_jacobian, measure_tetrahedron(x[0], x[1], x[2], x[3]).scaled_jacobian);
  }
}

// Between the tangents of the two faces at right angles to the edge, by differences.
TEST(TetrahedronMeasures, DihedralAnglesAreThoseOfTheCurvedFaces) {
  for (const TetMesh& mesh : bent_tetrahedra()) {
    const CurvedTetrahedron x = curved_tetrahedron(mesh, 0);
    const auto at = [&](const std::array<double, 4>& b) {
      Vec3 p = Vec3::Zero();
      for (std::size_t i = 0; i < 4; ++i) p += b[i] * (2 * b[i] - 1) * x[i];
      for (std::size_t e = 0; e < 6; ++e)
        p += 4 * b[static_cast<std::size_t>(tetrahedron_edges[e][0])] *
             b[static_cast<std::size_t>(tetrahedron_edges[e][1])] * x[4 + e];
      return p;
    };
    double least = 180, largest = 0;
    for (const auto& [i, j] : tetrahedron_edges)
      for (const double along : {0.0, 0.5, 1.0}) {
        std::array<double, 4> b{0, 0, 0, 0};
        b[static_cast<std::size_t>(i)] = 1 - along;
        b[static_cast<std::size_t>(j)] = along;
        constexpr double step = 1e-6;
        const auto towards = [&](std::size_t corner) {
          std::array<double, 4> c = b;
          for (double& value : c) value *= 1 - step;
          c[corner] += step;
          return Vec3((at(c) - at(b)) / step);
        };
        std::vector<Vec3> sides;
        Vec3 edge = towards(static_cast<std::size_t>(along < 1 ? j : i));
        edge.normalize();
        for (std::size_t k = 0; k < 4; ++k)
          if (static_cast<int>(k) != i && static_cast<int>(k) != j) {
            const Vec3 t = towards(k);
            sides.push_back((t - t.dot(edge) * edge).normalized());
          }
        const double angle = std::acos(sides[0].dot(sides[1])) * 180 / std::numbers::pi;
        least = std::min(least, angle);
        largest = std::max(largest, angle);
      }
    const TetShape shape = measure_tetrahedron(mesh, 0);
    EXPECT_NEAR(shape.min_dihedral_deg, least, 0.01);
    EXPECT_NEAR(shape.max_dihedral_deg, largest, 0.01);
  }
}

TEST(TetrahedronMeasures, ACurvedEdgeIsAsLongAsItsCurve) {
  TetMesh mesh = with_straight_mid_edge_nodes(one_tetrahedron({0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, 1, 2}));
  const double straight = *measure_tetrahedron(mesh, 0).edge_ratio;
  EXPECT_NEAR(straight, std::sqrt(6) / 2, 1e-12);
  mesh.nodes[mesh.mid_edge_nodes[0][0]].y() = -0.1;  // a parabola over a chord of 2, as high as 0.1
  const double arc = std::sqrt(1.04) + std::asinh(0.2) / 0.2;
  EXPECT_NEAR(*measure_tetrahedron(mesh, 0).edge_ratio, std::sqrt(6) / arc, 1e-5);
}

TEST(TetrahedronMeasures, OfNothingAreZero) {
  const TetSummary summary = measure_tetrahedra({});
  EXPECT_EQ(summary.tetrahedra, 0U);
  EXPECT_EQ(summary.min_dihedral_deg, 0);
}

}  // namespace
}  // namespace scan2fea
