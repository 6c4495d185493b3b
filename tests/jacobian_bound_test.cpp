#include "quality/jacobian_bound.hpp"

#include <gtest/gtest.h>

#include <random>

namespace scan2fea {
namespace {

CurvedTetrahedron straight(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  CurvedTetrahedron nodes{a, b, c, d};
  for (std::size_t e = 0; e < 6; ++e)
    nodes[4 + e] = 0.5 * (nodes[static_cast<std::size_t>(tetrahedron_edges[e][0])] +
                          nodes[static_cast<std::size_t>(tetrahedron_edges[e][1])]);
  return nodes;
}

CurvedTetrahedron unit() {
  return straight({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
}

// From the shape functions: N_i = L_i (2 L_i - 1) at the corners, 4 L_i L_j on the edges.
double jacobian(const CurvedTetrahedron& nodes, const Vec3& local) {
  const std::array<double, 4> l{1 - local.sum(), local.x(), local.y(), local.z()};
  const std::array<Vec3, 4> gradient{Vec3(-1, -1, -1), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  Eigen::Matrix3d columns = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 4; ++i) columns += nodes[i] * ((4 * l[i] - 1) * gradient[i]).transpose();
  for (std::size_t e = 0; e < 6; ++e) {
    const auto i = static_cast<std::size_t>(tetrahedron_edges[e][0]),
               j = static_cast<std::size_t>(tetrahedron_edges[e][1]);
    columns += nodes[4 + e] * (4 * (l[i] * gradient[j] + l[j] * gradient[i])).transpose();
  }
  return columns.col(0).cross(columns.col(1)).dot(columns.col(2));
}

double smallest_sampled(const CurvedTetrahedron& nodes) {
  constexpr int n = 24;
  double smallest = jacobian(nodes, Vec3::Zero());
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j)
      for (int k = 0; i + j + k <= n; ++k) smallest = std::min(smallest, jacobian(nodes, Vec3(i, j, k) / n));
  return smallest;
}

TEST(JacobianBound, OfStraightEdgesIsSixVolumes) {
  const JacobianBound bound = min_jacobian_bound(straight({0, 0, 0}, {2, 0, 0}, {1, 3, 0}, {0, 1, 5}));
  EXPECT_NEAR(bound.lower, 30, 1e-12);
  EXPECT_NEAR(bound.upper, 30, 1e-12);
}

TEST(JacobianBound, AMidEdgeNodeBeforeTheQuarterPointInverts) {
  // The crack-tip element: the Jacobian vanishes at the corner when the node sits at a quarter of the edge.
  for (std::size_t e = 0; e < 6; ++e) {
    CurvedTetrahedron nodes = unit();
    const Vec3 from = nodes[static_cast<std::size_t>(tetrahedron_edges[e][0])];
    const Vec3 to = nodes[static_cast<std::size_t>(tetrahedron_edges[e][1])];
    nodes[4 + e] = 0.74 * from + 0.26 * to;
    EXPECT_GT(min_jacobian_bound(nodes).lower, 0);
    nodes[4 + e] = 0.76 * from + 0.24 * to;
    EXPECT_LE(min_jacobian_bound(nodes).upper, 0);
  }
}

TEST(JacobianBound, EnclosesTheSampledMinimum) {
  std::mt19937 generator(11);
  std::normal_distribution<double> shift(0, 0.08);
  int valid = 0, invalid = 0;
  for (int trial = 0; trial < 200; ++trial) {
    CurvedTetrahedron nodes = unit();
    for (std::size_t e = 4; e < 10; ++e) nodes[e] += Vec3(shift(generator), shift(generator), shift(generator));
    const double sampled = smallest_sampled(nodes);
    const JacobianBound bound = min_jacobian_bound(nodes);
    EXPECT_LE(bound.lower, bound.upper);
    EXPECT_LE(bound.lower, sampled + 1e-12);
    if (bound.lower > 0) {
      EXPECT_GT(sampled, 0);
      ++valid;
    }
    if (bound.upper <= 0) {
      EXPECT_LT(sampled, 0.02);
      ++invalid;
    }
  }
  EXPECT_GT(valid, 20);
  EXPECT_GT(invalid, 20);
}

TEST(JacobianBound, IsAsCloseAsItIsWanted) {
  std::mt19937 generator(12);
  std::normal_distribution<double> shift(0, 0.04);
  for (int trial = 0; trial < 100; ++trial) {
    CurvedTetrahedron nodes = unit();
    for (std::size_t e = 4; e < 10; ++e) nodes[e] += Vec3(shift(generator), shift(generator), shift(generator));
    const JacobianBound bound = min_jacobian_bound(nodes, 0.01, JacobianWanted::value);
    // The largest coefficient is a small multiple of the straight Jacobian, which is 1.
    EXPECT_LE(bound.upper - bound.lower, 0.01 * 3);
    EXPECT_LE(bound.lower, smallest_sampled(nodes) + 1e-12);
    EXPECT_GE(bound.lower, smallest_sampled(nodes) - 0.05);
  }
}

TEST(JacobianBound, OfAMirroredElementIsNegative) {
  EXPECT_LT(min_jacobian_bound(straight({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1})).upper, 0);
}

TEST(JacobianBound, TakesMidpointsWhereTheMeshHasNone) {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  EXPECT_EQ(curved_tetrahedron(mesh, 0), unit());
}

}  // namespace
}  // namespace scan2fea
