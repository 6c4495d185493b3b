#include "preproc/volume/patch_relocation.hpp"

#include "preproc/volume/descent.hpp"
#include "preproc/volume/tet_complex.hpp"
#include "preproc/volume/tet_quality.hpp"
#include "preproc/volume/tetrahedralize.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

TEST(Descent, FindsTheBottomOfABentValley) {  // Rosenbrock's
  const Energy valley = [](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
    const double across = x[1] - x[0] * x[0], along = 1 - x[0];
    gradient = Eigen::Vector2d(-400 * x[0] * across - 2 * along, 200 * across);
    return 100 * across * across + along * along;
  };
  Eigen::VectorXd x = Eigen::Vector2d(-1.2, 1);
  descend(valley, x, 200);
  EXPECT_NEAR(x[0], 1, 1e-3);
  EXPECT_NEAR(x[1], 1, 1e-3);
}

TEST(Descent, StaysWhereThereIsAValue) {
  const Energy half = [](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {  // falls towards a wall at 0
    if (!(x[0] > 0)) return std::numeric_limits<double>::infinity();
    gradient = Eigen::VectorXd::Ones(1);
    return x[0];
  };
  Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 1.0);
  descend(half, x, 50);
  EXPECT_GT(x[0], 0);
  EXPECT_LT(x[0], 0.5);
}

TEST(GoalTerms, HaveTheGoalQualityAsTheirLeast) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0.3, 0.8, 0);
  for (const Vec3& d : {Vec3(0.4, 0.3, 0.7), Vec3(0.4, 0.3, 0.1), Vec3(2, 0.1, 0.4), Vec3(-0.5, -0.5, 0.3)}) {
    const GoalTerms terms = goal_terms(a, b, c, d, 1);
    EXPECT_NEAR(*std::ranges::min_element(terms), goal_quality(a, b, c, d), 1e-12);
  }
}

// A ball's elements with all inner nodes driven aside together, as no single one can go back.
struct Driven {
  TetMesh mesh;
  std::size_t boundary;
  explicit Driven(double by) {
    const SurfaceMesh ball = analytic::sphere(1, 2);
    boundary = ball.vertices.size();
    mesh = tetrahedralize(ball).mesh;
    for (std::size_t v = boundary; v < mesh.nodes.size(); ++v)
      mesh.nodes[v].x() += by * (1 - mesh.nodes[v].squaredNorm());
  }
};

std::uint32_t worst_of(const TetComplex& complex) {
  std::uint32_t worst = 0;
  for (std::uint32_t t = 0; t < complex.slot_count(); ++t)
    if (complex.alive(t) && complex.quality(t) < complex.quality(worst)) worst = t;
  return worst;
}

TEST(PatchRelocation, BringsNodesBackThatWereDrivenAsideTogether) {
  const Driven driven(0.3), undriven(0);
  TetComplex complex(driven.mesh);
  const double before = complex.quality(worst_of(complex));
  ASSERT_GT(before, 0);
  const TetComplex good(undriven.mesh);
  for (int patch = 0; patch < 20; ++patch)
    if (!relocate_patch(complex, worst_of(complex), {})) break;
  EXPECT_GT(complex.quality(worst_of(complex)), std::max(1.5 * before, 0.9 * good.quality(worst_of(good))));
  for (std::uint32_t v = 0; v < driven.boundary; ++v) EXPECT_EQ(complex.node(v), driven.mesh.nodes[v]);
}

TEST(PatchRelocation, KeepsToTheWaysOfTheBoundary) {
  const Driven driven(0.3);
  TetComplex complex(driven.mesh);
  const double most = 0.05;
  // Along the ball.
  const BoundaryWays ways = [&](std::uint32_t v, const Vec3& wanted) -> std::optional<WayPoint> {
    const Vec3& given = driven.mesh.nodes[v];
    const Vec3 way = wanted - given;
    const Vec3 place = (given + std::min(1.0, 0.9 * most / std::max(way.norm(), 1e-300)) * way).normalized();
    return WayPoint{place, place, false};
  };
  const double before = complex.quality(worst_of(complex));
  ASSERT_TRUE(relocate_patch(complex, worst_of(complex), ways));
  EXPECT_GT(complex.quality(worst_of(complex)), before);
  double moved = 0;
  for (std::uint32_t v = 0; v < driven.boundary; ++v) {
    EXPECT_NEAR(complex.node(v).norm(), 1, 1e-12);
    moved = std::max(moved, (complex.node(v) - driven.mesh.nodes[v]).norm());
  }
  EXPECT_GT(moved, 0);
  EXPECT_LE(moved, most);
}

TEST(PatchRelocation, LeavesWhatItCannotLift) {
  const Driven driven(0);
  TetComplex complex(driven.mesh);
  const std::uint32_t worst = worst_of(complex);
  EXPECT_FALSE(relocate_patch(complex, worst, {}, {.gain = 10}));
  for (std::uint32_t v = 0; v < complex.node_count(); ++v) EXPECT_EQ(complex.node(v), driven.mesh.nodes[v]);
}

}  // namespace
}  // namespace scan2fea
