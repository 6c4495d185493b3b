#include "preproc/surface/placement/place_vertex.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace scan2fea {
namespace {

constexpr StarObjective all_objectives[] = {StarObjective::shannon, StarObjective::a_entropy,
                                            StarObjective::regularised_a_entropy, StarObjective::entropy_weighted,
                                            StarObjective::mean_edge_ratio};
const Vec3 up(0, 0, 1);

std::vector<Vec3> regular_link(std::size_t sides, double radius = 1) {
  std::vector<Vec3> link;
  for (std::size_t i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(sides);
    link.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return link;
}

std::vector<Vec3> irregular_link() {
  return {{1, 0, 0.1}, {0.7, 0.9, 0}, {-0.4, 1.2, -0.1}, {-1.1, 0.1, 0.05}, {-0.3, -0.8, 0}, {0.8, -0.7, 0.1}};
}

// Any turn in space must give the same answer: nothing may depend on the axes.
Eigen::Matrix3d some_rotation() {
  return (Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized()) * Eigen::AngleAxisd(-1.7, Vec3::UnitX())).matrix();
}

TEST(StarNormal, IsThatOfTheLink) {
  EXPECT_NEAR((star_normal(regular_link(7)) - up).norm(), 0, 1e-12);
  const std::vector<Vec3> folded{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(star_normal(folded).norm(), 0);
}

TEST(PlaceVertex, PhiFindsTheCentreOfARegularLink) {
  const auto link = regular_link(6, 2.5);
  const auto placed = place_vertex({Vec3(1.4, 0.7, 0), link}, up, {.newton_steps = 10});
  EXPECT_TRUE(placed.feasible);
  EXPECT_LT(placed.position.norm(), 1e-3 * 2.5);
  EXPECT_NEAR(placed.cost, 0, 1e-5);
}

TEST(PlaceVertex, MeanEdgeRatioFindsTheCentreOfARegularLink) {
  const auto link = regular_link(6);
  PlaceVertexOptions options{.objective = StarObjective::mean_edge_ratio};
  options.simplex_evaluations = 200;
  const auto placed = place_vertex({Vec3(0.3, 0.2, 0), link}, up, options);
  EXPECT_LT(placed.position.norm(), 0.01);
}

TEST(PlaceVertex, NoObjectiveGetsWorseAndAllStayFeasible) {
  const auto link = irregular_link();
  const Vec3 normal = star_normal(link);
  for (const StarObjective objective : all_objectives)
    for (const Vec3& start : {Vec3(0, 0, 0), Vec3(0.3, 0.4, 0), Vec3(-0.5, 0.1, 0)}) {
      const PlaceVertexOptions options{.objective = objective};
      const auto placed = place_vertex({start, link}, normal, options);
      ASSERT_TRUE(placed.feasible);
      EXPECT_LE(placed.cost, star_cost(objective, {start, link}) + 1e-12) << name_of(objective);
      EXPECT_TRUE(is_star_feasible({placed.position, link}, normal, options.smallest_normal_cosine));
      EXPECT_NEAR((placed.position - start).dot(normal), 0, 1e-12) << "leaves the tangent plane";
    }
}

TEST(PlaceVertex, NewtonEndsWhereTheGradientVanishes) {
  const auto link = irregular_link();
  const Vec3 normal = star_normal(link);
  const PlaceVertexOptions options{.newton_steps = 20};
  const Vec3 x = place_vertex({Vec3(0.2, 0.1, 0), link}, normal, options).position;
  const double here = star_cost(StarObjective::entropy_weighted, {x, link});
  for (const Vec3& direction :
       {Vec3::UnitX().cross(normal).normalized().eval(), Vec3::UnitY().cross(normal).normalized().eval()})
    for (const double step : {-0.01, 0.01})
      EXPECT_GT(star_cost(StarObjective::entropy_weighted, {x + step * direction, link}), here);
}

TEST(PlaceVertex, TurnsAndScalesWithTheStar) {
  const auto link = irregular_link();
  const Eigen::Matrix3d turn = some_rotation();
  const double scale = 1e-3;
  std::vector<Vec3> turned;
  for (const Vec3& p : link) turned.push_back(scale * (turn * p) + Vec3(5, 6, 7));
  const Vec3 start(0.2, 0.1, 0);
  const PlaceVertexOptions options{.newton_steps = 20};
  const Vec3 x = place_vertex({start, link}, star_normal(link), options).position;
  const Vec3 y = place_vertex({scale * (turn * start) + Vec3(5, 6, 7), turned}, star_normal(turned), options).position;
  EXPECT_NEAR(((y - Vec3(5, 6, 7)) / scale - turn * x).norm(), 0, 1e-4);
}

TEST(PlaceVertex, RecoversFromAnInvertedStart) {
  const auto link = regular_link(6);
  const auto placed = place_vertex({Vec3(3, 0, 0), link}, up);
  EXPECT_TRUE(placed.feasible);
  EXPECT_LT(placed.position.norm(), 0.1);
}

TEST(PlaceVertex, ReportsAStarWithoutAFeasiblePlace) {
  const auto link = regular_link(5);
  const auto placed = place_vertex({Vec3(0.1, 0, 0), link}, -up);
  EXPECT_FALSE(placed.feasible);
  EXPECT_EQ(placed.position, Vec3(0.1, 0, 0));
}

TEST(PlaceVertex, LiftedPlacesObeyTheConstraint) {
  const auto link = regular_link(6);
  const Star star{Vec3(0.1, 0.1, 0), link};
  const Lift dome = [](const Vec3& x) { return Vec3(x[0], x[1], 0.2 * (1 - x.squaredNorm())); };
  const auto placed = place_vertex(star, up, {}, dome);
  EXPECT_TRUE(placed.feasible);
  EXPECT_NEAR(placed.position[2], 0.2 * (1 - placed.position.head<2>().squaredNorm()), 1e-12);

  // A lift that throws the optimum beyond the link: the vertex stays nearer to where it was.
  const Lift away_from_centre = [](const Vec3& x) { return x.norm() < 0.05 ? Vec3(9, 9, 0) : x; };
  const auto kept = place_vertex(star, up, {}, away_from_centre);
  EXPECT_TRUE(kept.feasible);
  EXPECT_TRUE(is_star_feasible({kept.position, link}, up, 0.05));
}

}  // namespace
}  // namespace scan2fea
