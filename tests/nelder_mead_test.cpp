#include "preproc/surface/placement/nelder_mead.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace scan2fea {
namespace {

using Vec2 = Eigen::Vector2d;

TEST(NelderMead, FindsTheMinimumOfABowl) {
  const auto cost = [](const Vec2& x) { return (x - Vec2(0.7, -0.3)).squaredNorm() + 0.5 * x[0] * x[1]; };
  // The gradient is zero where 2 x + y / 2 = 1.4 and x / 2 + 2 y = -0.6.
  const Vec2 minimum = (Eigen::Matrix2d() << 2, 0.5, 0.5, 2).finished().inverse() * Vec2(1.4, -0.6);
  const Vec2 found = minimise_by_simplex(cost, cost(Vec2::Zero()), 0.5, 200);
  EXPECT_LT((found - minimum).norm(), 1e-3);
}

TEST(NelderMead, NeedsNoGradient) {
  const auto cost = [](const Vec2& x) { return std::abs(x[0] - 1) + std::abs(x[1] + 2); };
  const Vec2 found = minimise_by_simplex(cost, cost(Vec2::Zero()), 0.5, 300);
  EXPECT_LT((found - Vec2(1, -2)).norm(), 1e-2);
}

TEST(NelderMead, StaysWhereTheCostIsFinite) {
  const auto cost = [](const Vec2& x) {
    return x[0] > 0.25 ? std::numeric_limits<double>::infinity() : (x - Vec2(1, 0)).squaredNorm();
  };
  const Vec2 found = minimise_by_simplex(cost, cost(Vec2::Zero()), 0.2, 200);
  EXPECT_LE(found[0], 0.25);
  EXPECT_GT(found[0], 0.2);
}

TEST(NelderMead, IsNeverWorseThanTheStartAndAsksNoMoreThanItMay) {
  int asked = 0;
  const auto cost = [&](const Vec2& x) {
    ++asked;
    return x.norm();
  };
  EXPECT_EQ(minimise_by_simplex(cost, 0, 1, 20).norm(), 0);
  EXPECT_LE(asked, 23);
}

}  // namespace
}  // namespace scan2fea
